"""Work of finding survey targets in a map, in child processes."""

from __future__ import annotations

from pathlib import Path

from recon4.mapping.tiles import TileSet
from recon4.model.plain import to_plain
from recon4.progress import Silent
from recon4.slices.control_points import ControlPoint
from recon4.slices.targets.named import TargetList, listed, named
from recon4.slices.targets.search import find_targets
from recon4.store.atomic import write_json
from recon4_app.slices.model import ControlState


def search_targets(map_folder: str, radii_m: list[float], out: str) -> None:
    """Write the targets of a map as JSON, without names."""
    tiles = TileSet.open(Path(map_folder))
    found = listed(find_targets(tiles, radii_m=radii_m, progress=Silent()))
    write_json(Path(out), to_plain(found))


def name_targets(found: TargetList, state: ControlState, crs: str) -> TargetList:
    """The targets with the names of the survey, if there is one.

    Raises:
        GeoreferenceError: If PROJ does not know the system, or the points are not in it.
    """
    points = [ControlPoint(**point.model_dump()) for point in state.points]
    return named(found, points, crs=crs)
