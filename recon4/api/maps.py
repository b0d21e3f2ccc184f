"""The points of a finished map."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from recon4.errors import StoreError
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.mapping.tiles import Surface, TileSet
    from recon4.review.stamp import Stamp
    from recon4.slices.map_crs import MapFrame

PLANAR = "map_2d"
"""Stage that only recordings of a 2-D laser alone have."""


def read_tiles(project: str | PathLike[str], *, surface: Surface = "fitted") -> TileSet:
    """Open the points of a map. They stay on the disk until they are read, tile by tile.

    A tile gives ``xyz_m()``, float64 (N, 3) in the map, and ``read(["intensity", …])``, a column
    of N rows for each name of `TileSet.fields`. With ``limit=n`` both give an even sample of n
    points. What was approved is compared with its hashes while it is read.

    Args:
        project: Folder of a finished project.
        surface: ``fitted``: on the surfaces that were fitted to all returns; ``raw``: where they
            were measured; ``strays``: only the points that the map leaves out.

    Raises:
        Altered: If the map was approved and is not what was approved.
        StoreError: If there is no map, or it is damaged.

    >>> tiles = api.read_tiles("walk")
    >>> sum(len(tile.xyz_m()) for tile in tiles) == len(tiles)
    True
    >>> tiles.tiles[0].read(["intensity_normalized", "t_ns"], limit=10)["t_ns"].shape
    (10,)
    """
    return open_map(Path(project)).tiles.on(surface)


@dataclass(frozen=True, slots=True)
class OpenedMap:
    """A map whose bytes are compared with its approval while they are read."""

    tiles: TileSet
    frame: MapFrame
    stamp: Stamp | None
    """Its approval; None = a draft."""


def open_map(project: Path, *, draft: bool = False, crs: str = "") -> OpenedMap:
    """Open the map of a finished project.

    Args:
        project: The folder.
        draft: Without its approval, whether or not there is one.
        crs: Code of the CRS of its frame; empty = that of the map.

    Raises:
        Altered: If it was approved and is not what was approved, or the approval does not count.
        GeoreferenceError: If a CRS is requested and the map is not georeferenced.
        StoreError: If there is no map, it is a 2-D map, or it is damaged.
    """
    from recon4.mapping.tiles import TileSet
    from recon4.review.approved import approval_of
    from recon4.slices.map_crs import frame_of
    from recon4.store.project import read_artifacts

    artifacts = read_artifacts(project)
    if PLANAR in artifacts:
        raise StoreError(CodedText("map-2d-no-points", project=str(project)))
    keys = {stage: folder.name for stage, folder in artifacts.items()}
    approval = None if draft else approval_of(project, keys)
    if approval:
        approval.evidence.check_frame(artifacts)
    frame = frame_of(artifacts, crs)
    if not approval:
        return OpenedMap(TileSet.open(artifacts["map"]), frame, None)
    return OpenedMap(approval.evidence.open_map(artifacts["map"]), frame, approval.stamp)
