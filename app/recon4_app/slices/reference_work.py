"""Files that become references, read in child processes."""

from __future__ import annotations

from pathlib import Path

from recon4.recording.formats.reference_clouds import is_text
from recon4.recording.tables.clouds import preview_cloud
from recon4.slices.meshes import is_mesh
from recon4.slices.reference import ReferenceFacts
from recon4.slices.reference_import import MapPlace, import_reference
from recon4_app.slices.reference_model import AddReference, ReferenceFile, ReferencePreview
from recon4_app.slices.slice_work import Artifacts, map_frame, tiles_of


def preview_reference(path: str, artifacts: Artifacts, ask: ReferenceFile) -> ReferencePreview:
    """The first rows of a table and what its columns are taken for."""
    file = Path(path)
    if is_mesh(file) or not is_text(file):
        return ReferencePreview(table=None)
    place = _place(artifacts).in_crs if ask.frame != "map" else None
    return ReferencePreview(table=preview_cloud(file, ask.choice, place=place))


def add_reference(
    path: str, out: str, add: AddReference, *, artifacts: Artifacts
) -> ReferenceFacts:
    """Import a file of unknown origin."""
    return import_reference(
        Path(path), Path(out), name=add.name, read_as=add.read_as, place=_place(artifacts)
    )


def _place(artifacts: Artifacts) -> MapPlace:
    return MapPlace(map_frame(artifacts), tiles_of(artifacts["map"]).bounds_m)
