"""Figures of a map that was made, and its files beside the tiles."""

from __future__ import annotations

from pathlib import Path

from recon4.evaluation.thickness import plane_thickness
from recon4.export.laz import export_map_laz
from recon4.export.points import CRS_OF_MAP, OutputCrs
from recon4.first_view.files import FIRST_FILES, write_first_files
from recon4.geometry.se3 import Array
from recon4.georeference.crs_file import read_crs
from recon4.mapping.tiles import TileSet
from recon4.model.figures import MapFigures
from recon4.progress import Progress
from recon4.slices.map_crs import frame_of
from recon4.workflows.corrected_classes import CorrectionsInMap, corrected


def map_figures(
    tiles: TileSet, corrections: CorrectionsInMap, bent_ratio: float | None
) -> MapFigures:
    """Figures of a map.

    Args:
        tiles: The map.
        corrections: Of classes, that it was made with.
        bent_ratio: Of a map that decisions carried along.
    """
    low, high = (tuple(corner.tolist()) for corner in tiles.bounds_m)
    return MapFigures(
        points=len(tiles),
        bounds_m=(low, high),
        strays=tiles.strays,
        surface="fitted" if tiles.surface == "fitted" else "raw",
        thickness=plane_thickness(tiles),
        thickness_as_measured=(
            plane_thickness(tiles.as_measured()) if tiles.surface == "fitted" else None
        ),
        corrections=corrected(corrections, tiles.notes.corrected),
        bent_ratio=bent_ratio,
    )


def write_map_files(folder: Path, level: Path, walk_m: Array, *, progress: Progress) -> None:
    """Write what lies beside the tiles of a map.

    Args:
        folder: Artifact with the tiles.
        level: Of the stage ``level``; ``map.laz`` is in its CRS.
        walk_m: Positions of the sensors [m], (W, 3).
        progress: Of the stage.
    """
    crs = read_crs(level)
    out = OutputCrs(crs.wkt, crs.to_crs) if crs else CRS_OF_MAP
    export_map_laz(folder, folder / "map.laz", out, progress=progress)
    frame = frame_of({"map": folder, "level": level})
    write_first_files(folder / FIRST_FILES, TileSet.open(folder), frame, walk_m=walk_m)
