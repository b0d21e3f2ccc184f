"""Export of slices to files, in a child process of the compute pool."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.mapping.tiles import surface_text
from recon4.review.stamp import stamp_file
from recon4.slices.compare import compare, signed_text
from recon4.slices.export import SliceSelection, write_csv, write_dxf, write_laz
from recon4.slices.geotiff import write_geotiff
from recon4.slices.points import SliceWindow
from recon4.slices.sheet import SheetText, lay_out, source_text, write_sheet
from recon4.slices.slice_image import RasterGrid, draw
from recon4_app.slices.model import ExportContext, SliceExportRequest
from recon4_app.slices.slice_work import (
    Artifacts,
    map_frame,
    map_of,
    reference_of,
    span_of,
    stamp_text,
    window_of,
)
from recon4_app.slices.tuning import EXPORT_IMAGES


def export(
    artifacts: Artifacts,
    ask: SliceExportRequest,
    out: str,
    *,
    reference: str,
    context: ExportContext,
) -> str:
    """Write an export of slices in the format of its suffix, with the approval if there is one.

    Raises:
        Altered: If a tile differs from the approved one.
    """
    path, evidence = Path(out), context.evidence
    tiles, frame = map_of(artifacts, evidence).on(ask.surface), map_frame(artifacts)
    planes = ask.plane.slice_plane().repeated(ask.count, spacing_m=ask.spacing_m)
    window = SliceWindow(**ask.window.model_dump()) if ask.window else None
    chosen = SliceSelection(tiles, planes, window)
    if path.suffix == ".laz":
        write_laz(chosen, path, frame=frame)
    elif path.suffix == ".csv":
        write_csv(chosen, path, frame=frame)
    elif path.suffix == ".dxf":
        write_dxf(chosen, path, frame=frame, flat=ask.flat)
    elif path.suffix == ".tif":
        _export_geotiff(artifacts, ask, path, reference=reference, context=context)
    else:
        _export_sheet(artifacts, ask, path, reference=reference, context=context)
    if evidence and path.suffix in (".laz", ".csv", ".dxf"):
        stamp_file(path, path, evidence.stamp)
    return out


def _export_geotiff(
    artifacts: Artifacts,
    ask: SliceExportRequest,
    path: Path,
    *,
    reference: str,
    context: ExportContext,
) -> None:
    tiles, plane = map_of(artifacts, context.evidence).on(ask.surface), ask.plane.slice_plane()
    window = window_of(ask, tiles, plane)
    side_m = max(window.right - window.left, window.top - window.bottom)
    paper = RasterGrid(window, max(EXPORT_IMAGES.finest_m, side_m / EXPORT_IMAGES.max_geotiff_px))
    against = reference_of(reference, ask.method)
    made = draw(tiles, plane, paper, color=ask.color, reference=against)
    stamp = stamp_text(context.evidence)
    description = f"{context.project}: {surface_text(tiles.surface)}. {stamp}"
    frame = map_frame(artifacts)
    rgba = made.rgba(span_of(ask, made), "light")
    write_geotiff(made, path, frame=frame, rgba=rgba, description=description)


def _export_sheet(
    artifacts: Artifacts,
    ask: SliceExportRequest,
    path: Path,
    *,
    reference: str,
    context: ExportContext,
) -> None:
    tiles, plane = map_of(artifacts, context.evidence).on(ask.surface), ask.plane.slice_plane()
    against = reference_of(reference, ask.method)
    layout = lay_out(window_of(ask, tiles, plane), ask.size, ask.scale)
    made = draw(tiles, plane, layout.paper, color=ask.color, reference=against)
    compared = ""
    if against is not None and ask.color == "distance":
        found = compare(tiles, [plane], against, rng=np.random.default_rng(1))
        compared = f"{found.fit.text}; {signed_text(found.point_weighted.signed)}"
    text = SheetText(
        compared=compared,
        project=context.project,
        frame=map_frame(artifacts).text,
        sources=source_text(context.key),
        approval=stamp_text(context.evidence),
        surface=surface_text(tiles.surface),
        reference=against.caption if against else "",
        sensors=tiles.notes.sensors,
    )
    write_sheet(made, layout, path, span=span_of(ask, made), text=text)
