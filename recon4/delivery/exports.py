"""Writes any kind of file of a finished project, and says what was written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from recon4.delivery.kinds import ExportedFile, ExportKind, kind_named
from recon4.errors import StoreError
from recon4.export.findings import export_findings
from recon4.export.map_files import export_poses, map_to_export, points_text, write_map
from recon4.export.options import ExportOptions
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.products.fitted_plans import FittedPlans
from recon4.progress import Progress
from recon4.review.approval_state import WRITTEN_AS_DRAFT, approval_state
from recon4.review.approved import approval_of
from recon4.review.evidence import Evidence
from recon4.store.project import read_artifacts


def export_file(
    project: Path, kind_name: str, folder: Path, *, options: ExportOptions, progress: Progress
) -> ExportedFile:
    """Write a file of a project, and read it back if it holds points.

    Args:
        project: The project folder.
        kind_name: Of `recon4.delivery.kinds.KINDS`.
        folder: Where the file is written; its name begins with that of the project.
        options: What is wanted.
        progress: Counts points.

    Raises:
        Altered: If the map was approved and is not what was approved; nothing is written.
        ConfigError: If there is no such kind, or the map does not have what is wanted.
        GeoreferenceError: If a CRS is requested and the map is not georeferenced.
        StoreError: If there is no map yet, or the file cannot be written or reads back wrong.
    """
    kind = kind_named(kind_name, options)
    wanted, keys = _wanted(project, options)
    state = WRITTEN_AS_DRAFT if options.draft else approval_state(project, keys)
    path = folder / f"{project.name}-{kind.name}"
    points, text = write_kind(project, kind, path, wanted=wanted, progress=progress)
    made = ExportedFile.of(path, text, state, map_key=keys["map"], progress=progress)
    return replace(made, points=points)


def write_layers_file(
    project: Path, path: Path, options: ExportOptions, *, progress: Progress
) -> str:
    """Write trajectory, points, findings, notes and double walls as a GeoPackage; what is in it.

    Raises:
        Altered, GeoreferenceError, StoreError: As `export_file`.
    """
    return _write_layers(project, path, _wanted(project, options)[0], progress=progress)


def _wanted(project: Path, options: ExportOptions) -> tuple[WantedFile, dict[str, str]]:
    """What files of a project are made of, and the keys of its artifacts."""
    artifacts = read_artifacts(project)
    if "map" not in artifacts:
        raise StoreError(CodedText("export-no-map", project=project.name))
    keys = {name: one.name for name, one in artifacts.items()}
    approval = None if options.draft else approval_of(project, keys)
    return WantedFile(artifacts, approval.evidence if approval else None, options), keys


@dataclass(frozen=True, slots=True)
class WantedFile:
    """What a file is made of."""

    artifacts: Mapping[str, Path]
    """Of the run; it has a map."""
    evidence: Evidence | None
    """Of its approval; None = not approved, or a draft."""
    options: ExportOptions
    plans: FittedPlans = field(default_factory=FittedPlans)
    """Of its map: DXF and GeoJSON of a delivery draw the same ones."""


def write_kind(
    project: Path, kind: ExportKind, path: Path, *, wanted: WantedFile, progress: Progress
) -> tuple[int, str]:
    """Write a file; how many points it has, and what is in it in words.

    Raises:
        Altered, ConfigError, GeoreferenceError, StoreError: As `export_file`.
    """
    if kind.point_bytes:
        map_ = map_to_export(wanted.artifacts, wanted.evidence, wanted.options)
        points = write_map(map_, path, progress=progress)
        return points, points_text(points, len(map_.tiles), map_.tiles.strays)
    if kind.name.startswith("poses"):
        poses = export_poses(project, path, draft=wanted.options.draft)
        return 0, CodedText("poses-all", poses=poses)
    if kind.name.startswith("findings"):
        return 0, CodedText("findings-all", findings=export_findings(project, path))
    if kind.name == "layers.gpkg":
        return 0, _write_layers(project, path, wanted, progress=progress)
    return 0, _write_product(kind, path, wanted, progress=progress)


def _write_layers(project: Path, path: Path, wanted: WantedFile, *, progress: Progress) -> str:
    from recon4.delivery.geopackage_layers import LayerSource, write_layers

    artifacts, evidence = wanted.artifacts, wanted.evidence
    if evidence:
        evidence.check_frame(artifacts)
        evidence.artifact("level", artifacts["level"]).check("trajectory.npz")
    folder = artifacts["map"]
    tiles = evidence.open_map(folder) if evidence else TileSet.open(folder)
    source = LayerSource(artifacts["level"], tiles, wanted.options.crs)
    return write_layers(project, path, source, progress=progress)


def _write_product(kind: ExportKind, path: Path, wanted: WantedFile, *, progress: Progress) -> str:
    from recon4.products.write import ProductOptions, ProductSource, write_product
    from recon4.slices.map_crs import frame_of

    options, artifacts, evidence = wanted.options, wanted.artifacts, wanted.evidence
    if evidence:
        evidence.check_frame(artifacts)
    frame = frame_of(dict(artifacts), options.crs)
    folder = artifacts["map"]
    tiles = evidence.open_map(folder) if evidence else TileSet.open(folder)
    progress.start(kind.title, 1, "files")
    text = write_product(
        _PRODUCTS[kind.name.partition(".")[0]],
        ProductSource(tiles, frame, evidence.stamp if evidence else None, wanted.plans),
        path,
        options=ProductOptions(
            storey=options.storey,
            pixel_m=options.pixel_m,
            cell_m=options.cell_m,
            surface="dsm" if kind.name.startswith("dsm") else "dtm",
        ),
    )
    progress.advance()
    return text


_PRODUCTS: Mapping[str, Literal["plan", "orthophoto", "terrain"]] = {
    "plan": "plan",
    "orthophoto": "orthophoto",
    "dtm": "terrain",
    "dsm": "terrain",
    "contours": "terrain",
}
