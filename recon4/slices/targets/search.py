"""Search of a whole map for survey targets, tile by tile."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from recon4.mapping.tiles import TileSet
from recon4.progress import Progress
from recon4.slices.targets.boards import board_places, border_cells, find_boards
from recon4.slices.targets.candidate import TargetCandidate
from recon4.slices.targets.cells import TargetCells, cells_of, usual_intensity, value_field
from recon4.slices.targets.near import PlacePoints
from recon4.slices.targets.plates import bright_cells, find_plates
from recon4.slices.targets.spheres import SpherePlaces, find_spheres, sphere_places
from recon4.slices.tuning_targets import PLATES, SPHERES


def find_targets(
    tiles: TileSet, *, radii_m: Sequence[float] = (), progress: Progress
) -> list[TargetCandidate]:
    """Plates, boards and spheres of a map; the memory is that of a tile and of what it has found.

    Args:
        tiles: The map.
        radii_m: Radii of spheres that a survey states; none = those that are usual.
        progress: Receives every tile, then every place that may be a target.

    Raises:
        StoreError: If the map cannot be read.
    """
    radii = tuple(sorted({round(one, 4) for one in radii_m if one > 0.0})) or SPHERES.radii_m
    usual, value = usual_intensity(tiles, PLATES.usual), value_field(tiles)
    bright, places, score = [np.zeros((0, 3))], [np.zeros((0, 3))], [np.zeros(0)]
    spheres = [SpherePlaces(np.zeros((0, 3)), np.zeros(0), np.zeros(0))]
    borders = list[TargetCells]()
    progress.start("targets", len(tiles.tiles), "tiles")
    for tile in tiles:
        if len(tile):
            cells = cells_of(tile, value)
            bright.append(bright_cells(cells, usual))
            there, like = board_places(cells)
            places.append(there)
            score.append(like)
            low = np.array(tile.origin_m)
            borders.append(border_cells(cells, low, low + tiles.tile_m))
            spheres.append(sphere_places(cells, radii))
        progress.advance()
    if borders:
        there, like = board_places(TargetCells.joined(borders))
        places.append(there)
        score.append(like)
    near = PlacePoints(tiles, value)
    return [
        *find_plates(near, np.concatenate(bright), usual, progress=progress),
        *find_boards(near, np.concatenate(places), np.concatenate(score), progress=progress),
        *find_spheres(near, SpherePlaces.joined(spheres), progress=progress),
    ]
