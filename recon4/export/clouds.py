"""Formats of point clouds a map is written to: an ending, and who writes it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from recon4.errors import ConfigError
from recon4.export.copc import export_copc
from recon4.export.laz import export_laz
from recon4.export.names import COPC, check_name
from recon4.export.pcd import export_pcd
from recon4.export.ply import export_ply
from recon4.export.points import CRS_OF_MAP, OutputCrs
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
        strays: bool = False,
        progress: Progress | None = None,
    ) -> int: ...


@dataclass(frozen=True, slots=True)
class CloudFormat:
    """A format of files of points."""

    write: CloudWriter
    classes: bool
    """Whether it says which points are stray returns."""


CLOUD_FORMATS = {
    COPC: CloudFormat(export_copc, classes=True),
    ".laz": CloudFormat(export_laz, classes=True),
    ".ply": CloudFormat(export_ply, classes=False),
    ".pcd": CloudFormat(export_pcd, classes=False),
    ".xyz": CloudFormat(export_xyz, classes=False),
}
"""Ending -> format; the first that matches counts."""


def cloud_format(path: Path, *, strays: bool = False) -> CloudFormat:
    """The format of a file by its ending.

    Args:
        path: The file.
        strays: Whether stray returns are to be in it.

    Raises:
        ConfigError: If no map, or no stray return, is written to such a file.
    """
    name = path.name.lower()
    ending = next((one for one in CLOUD_FORMATS if name.endswith(one)), None)
    if ending is None:
        raise ConfigError(f"a map is written as {', '.join(CLOUD_FORMATS)}, .e57, got {path.name}")
    check_name(path, ending)
    found = CLOUD_FORMATS[ending]
    if strays and not found.classes:
        able = [one for one, format_ in CLOUD_FORMATS.items() if format_.classes]
        raise ConfigError(f"stray returns are written to {', '.join(able)} only, got {path.name}")
    return found
