"""Ground, buildings and vegetation among the points of a map."""

import numpy as np
import pytest

from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.cell_runs import CellRuns, cell_keys, coordinate_sums
from recon4.mapping.structure import find_structure
from recon4.mapping.undistort import Placed, place_with_origins
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


def counted(walk, folder, **options):
    folder.mkdir()
    runs = CellRuns(folder, **options)
    for frame in walk.frames:
        placed = place_with_origins(frame, walk.trajectory, walk.rig)
        runs.add(placed, np.ones(len(frame), bool), frame.echo)
    return runs


def test_without_a_floor_below_the_walk_there_are_no_such_classes(tmp_path):
    walk, _ = scanned(box("room", (-3.0, -3.0, -9.0), (9.0, 3.0, 3.0)), seconds=4.0)

    assert find_structure(counted(walk, tmp_path / "runs"), walk.trajectory.T_a_b.t) is None


@pytest.fixture(scope="module")
def pole():
    """A walk in a room with a pole."""
    pole = cylinder("pole", lambda t: (5.0, 0.0), 0.2)
    return scanned(box("room", *ROOM), pole, seconds=4.0)[0]


def test_many_runs_and_one_give_the_same_cells(pole, tmp_path):
    runs = [counted(pole, tmp_path / "one"), counted(pole, tmp_path / "many", places=1 << 11)]
    one, many = (
        [np.concatenate(part) for part in zip(*r.merged(least=2, most=10**6), strict=True)]
        for r in runs
    )

    assert len(list((tmp_path / "many").glob("cells-*"))) > 4
    assert len(list((tmp_path / "one").glob("cells-*"))) == 1
    np.testing.assert_array_equal(one[0], many[0])
    np.testing.assert_array_equal(one[1], many[1])
    assert (np.diff(one[0]) > 0).all()


def test_the_cells_of_the_first_runs_are_kept(pole, tmp_path):
    runs = counted(pole, tmp_path / "runs", places=1 << 11)
    every, some = (
        np.concatenate([part.key for part in runs.merged(least=2, most=most)])
        for most in (10**6, 3000)
    )

    first = np.load(tmp_path / "runs" / "cells-0.npy")
    assert 1000 < len(some) <= 3000 < len(every)
    assert np.isin(some, every).all()
    assert np.isin(np.intersect1d(first, every), some).all()


def test_means_of_cells_are_those_of_their_returns(tmp_path):
    xyz = np.random.default_rng(3).uniform((-5.0, -3.0, -2.0), (5.0, 3.0, -1.0), (20_000, 3))
    (tmp_path / "runs").mkdir()
    runs = CellRuns(tmp_path / "runs")
    placed = Placed(xyz, np.zeros((len(xyz), 3)))
    runs.add(placed, np.ones(len(xyz), bool), np.zeros(len(xyz), np.uint8))

    for cells in runs.merged(least=2, most=10**6):
        means = coordinate_sums(cells) / cells.total[:, :1]
        key = cell_keys(np.floor(xyz / (0.2, 0.2, 0.1)).astype(int))
        for row in range(0, len(means), 100):
            mine = xyz[key == cells.key[row]]
            assert len(mine) == cells.total[row, 0]
            np.testing.assert_allclose(means[row], mine.mean(axis=0), atol=5e-4)
