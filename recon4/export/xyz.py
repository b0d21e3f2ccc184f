"""The map as lines of text: coordinates, intensity and class."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.export.account import PointAccount
from recon4.export.names import check_name
from recon4.export.points import CRS_OF_MAP, OutputCrs, PointSource
from recon4.export.reread import account_of_text
from recon4.export.selection import DELIVERED, PointSelection
from recon4.export.tuning import LAZ
from recon4.mapping.tiles import TileSet
from recon4.progress import Progress, Silent
from recon4.store.atomic import atomic_file


def export_xyz(
    map_: Path | TileSet,
    path: Path,
    output: OutputCrs = CRS_OF_MAP,
    *,
    selection: PointSelection = DELIVERED,
    progress: Progress | None = None,
) -> int:
    """Write a map as text, streaming: x, y and z to 0.1 mm, intensity and class, a point each line.

    Intensity is the normalized one if the map has it. The first line names the columns, as
    CloudCompare reads it.

    Args:
        map_: Artifact of the stage ``map``, or what is open of it.
        path: File to write, ``.xyz``.
        output: CRS of the coordinates; text has no place to name it.
        selection: Which points are written.
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If there are no points, or the name is not one of such a file.
        StoreError: If the file cannot be written (`NoSpace`: disk full) or reads back wrong.
    """
    check_name(path, ".xyz")
    watch = progress or Silent()
    source = PointSource.of(map_, output, selection, progress=watch)
    meant = PointAccount()
    with atomic_file(path) as temporary:
        with temporary.open("wb") as file:
            file.write(b"//X Y Z Intensity Classification\n")
            for block in source.blocks([source.intensity], watch):
                classes, values = block.columns["classification"], block.columns[source.intensity]
                # The nearest numbers to the decimals that are written: they read back the same.
                xyz = np.rint(block.xyz * 1e4) / 1e4
                intensity = np.rint(values.astype(np.float64) * 10.0) / 10.0
                rows = np.column_stack([xyz, intensity, classes])
                np.savetxt(file, rows, fmt="%.4f %.4f %.4f %.1f %d")
                meant.add(block.xyz, classes)
                meant.add_stored(rows + 0.0)  # no negative zeros
        source.seal(temporary)
        found = account_of_text(temporary, watch)
        meant.compare(found, path.name, within_m=LAZ.scale_m)
    return meant.count
