"""Ground, buildings and vegetation among the points of a map."""

import numpy as np
import pytest

from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.structure import StructureCells
from recon4.mapping.undistort import place_with_origins
from recon4.model.classes import PointClass
from recon4.settings import MapSettings
from tests.unit.classes.scanned_scenes import ROOM, box, cylinder, scanned

GROUND, BUILDING, OPEN = (
    int(code) for code in (PointClass.GROUND, PointClass.BUILDING, PointClass.UNCLASSIFIED)
)
VEGETATION = {3, 4, 5}


class AllStand:
    """Nothing moves."""

    def of(self, row, count):
        return np.full(count, OPEN, np.uint8)


def built(folder, walk, *, surface="fitted"):
    inputs = MapInputs(walk, walk.trajectory, classes=AllStand())
    settings = MapSettings(surface=surface, tile_m=20.0, voxel_m=0.03)
    return build_map(inputs, folder, settings=settings)


def points_of(tiles):
    """Points, classes."""
    parts = [(tile.xyz_m(), tile.read(["classification"])["classification"]) for tile in tiles]
    return tuple(np.concatenate(part) for part in zip(*parts, strict=True))


def share(classes, rows, *wanted):
    assert rows.sum() > 100
    return np.isin(classes[rows], wanted).mean()


@pytest.fixture(scope="module", params=["fitted", "raw"])
def furnished(request, tmp_path_factory):
    """Points of a room with a table and a cupboard, and their classes."""
    table = box("table", (3.0, -2.2, 0.70), (5.0, -0.8, 0.75))
    cupboard = box("cupboard", (4.0, 2.4, 0.0), (5.2, 2.95, 1.9))
    walk, _ = scanned(box("room", *ROOM), table, cupboard, seconds=6.0)
    return points_of(built(tmp_path_factory.mktemp("map"), walk, surface=request.param))


def test_a_floor_is_ground_and_walls_and_ceiling_are_building(furnished):
    p, classes = furnished

    floor = np.abs(p[:, 2]) < 0.03
    ceiling = np.abs(p[:, 2] - 3.0) < 0.03
    wall = (np.abs(p[:, 0] - 9.0) < 0.03) & (p[:, 2] > 0.1) & (p[:, 2] < 2.9)
    assert share(classes, floor, GROUND) > 0.97
    assert share(classes, ceiling, BUILDING) > 0.95
    assert share(classes, wall, BUILDING) > 0.95
    assert not VEGETATION & set(classes.tolist())


def test_a_table_is_no_ground_and_a_cupboard_no_building(furnished):
    p, classes = furnished

    table = (np.abs(p[:, 2] - 0.75) < 0.03) & (p[:, 1] < -0.85) & (p[:, 1] > -2.15)
    table &= (p[:, 0] > 3.05) & (p[:, 0] < 4.95)
    cupboard = (np.abs(p[:, 1] - 2.4) < 0.03) & (p[:, 0] > 4.1) & (p[:, 0] < 5.1)
    cupboard &= (p[:, 2] > 0.2) & (p[:, 2] < 1.7)
    assert share(classes, table, GROUND) == 0.0
    assert share(classes, table, OPEN) > 0.95
    assert share(classes, cupboard, OPEN) > 0.9


def test_without_a_floor_below_the_walk_there_are_no_such_classes():
    cells = StructureCells()
    walk, _ = scanned(box("room", (-3.0, -3.0, -9.0), (9.0, 3.0, 3.0)), seconds=4.0)
    for frame in walk.frames:
        placed = place_with_origins(frame, walk.trajectory, walk.rig)
        cells.add(placed, np.ones(len(frame), bool), frame.echo)

    assert cells.structure(walk.trajectory.T_a_b.t) is None


def test_a_full_table_of_cells_keeps_the_first_ones():
    walk, _ = scanned(box("room", *ROOM), cylinder("pole", lambda t: (5.0, 0.0), 0.2), seconds=4.0)
    small, large = StructureCells(most=500), StructureCells()
    for cells in (small, large):
        for frame in walk.frames:
            placed = place_with_origins(frame, walk.trajectory, walk.rig)
            cells.add(placed, np.ones(len(frame), bool), frame.echo)

    assert small.is_full
    assert not large.is_full
