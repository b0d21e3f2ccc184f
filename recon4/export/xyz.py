"""The map as lines of text: coordinates, intensity and class."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.export.names import check_name
from recon4.export.points import CRS_OF_MAP, OutputCrs, PointSource
from recon4.mapping.tiles import TileSet
from recon4.progress import Progress
from recon4.store.atomic import atomic_file


def export_xyz(
    map_: Path | TileSet,
    path: Path,
    output: OutputCrs = CRS_OF_MAP,
    *,
    all_points: bool = False,
    progress: Progress | None = None,
) -> int:
    """Write a map as text, streaming: x, y and z to 0.1 mm, intensity and class, a point each line.

    Intensity is the normalized one if the map has it. The first line names the columns, as
    CloudCompare reads it.

    Args:
        map_: Artifact of the stage ``map``, or what is open of it.
        path: File to write, ``.xyz``.
        output: CRS of the coordinates; text has no place to name it.
        all_points: Also the points that the map leaves out (`recon4.model.classes`).
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If the map has no points, or the name is not one of such a file.
        StoreError: If the file cannot be written (`NoSpace`: disk full).
    """
    check_name(path, ".xyz")
    source = PointSource.of(map_, output, all_points=all_points)
    with atomic_file(path) as temporary, temporary.open("wb") as file:
        file.write(b"//X Y Z Intensity Classification\n")
        for block in source.blocks([source.intensity], progress):
            last = [block.columns[name] for name in (source.intensity, "classification")]
            np.savetxt(file, np.column_stack([block.xyz, *last]), fmt="%.4f %.4f %.4f %.1f %d")
    return source.count
