"""Formats of point clouds a map is written to: an ending, and who writes it."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from recon4.errors import ConfigError
from recon4.export.copc import export_copc
from recon4.export.laz import export_laz
from recon4.export.names import COPC, check_name
from recon4.export.pcd import export_pcd
from recon4.export.ply import export_ply
from recon4.export.points import CRS_OF_MAP, OutputCrs
from recon4.export.selection import DELIVERED, PointSelection
from recon4.export.xyz import export_xyz
from recon4.mapping.tiles import TileSet
from recon4.progress import Progress


class CloudWriter(Protocol):
    """Writes a map to a file, and returns how many points it wrote."""

    def __call__(
        self,
        map_: Path | TileSet,
        path: Path,
        output: OutputCrs = CRS_OF_MAP,
        *,
        selection: PointSelection = DELIVERED,
        progress: Progress | None = None,
    ) -> int: ...


CLOUD_FORMATS: dict[str, CloudWriter] = {
    COPC: export_copc,
    ".laz": export_laz,
    ".ply": export_ply,
    ".pcd": export_pcd,
    ".xyz": export_xyz,
}
"""Ending -> who writes such a file; the first that matches counts."""


def cloud_writer(path: Path) -> CloudWriter:
    """Who writes a file of points, by its ending.

    Raises:
        ConfigError: If no map is written to such a file.
    """
    name = path.name.lower()
    ending = next((one for one in CLOUD_FORMATS if name.endswith(one)), None)
    if ending is None:
        raise ConfigError(
            f"a map is written as {', '.join(CLOUD_FORMATS)}, .e57, .ptx, got {path.name}"
        )
    check_name(path, ending)
    return CLOUD_FORMATS[ending]
