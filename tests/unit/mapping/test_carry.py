"""Maps that decisions carry along."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.carry import CarriedTo, bent_ratio, carry_map
from recon4.mapping.deviation import PoseCovariances
from recon4.mapping.tiles import TileSet
from recon4.mapping.tuning import CARRY
from recon4.progress import Silent
from recon4.settings import MapSettings
from tests.room_walks import T0_NS, room_walk

SETTINGS = MapSettings(voxel_m=0.02, tile_m=5.0)
FRAMES = 24


def shifted(trajectory, bend_m):
    """Moved by 2 cm and turned by 1 mrad, and bent: the second half of the walk is off."""
    t_s = (trajectory.t_ns - T0_NS) * 1e-9
    part = 1.0 / (1.0 + np.exp(-(t_s - 0.05 * FRAMES) / 0.05))
    turn = np.tile([0.0, 0.0, 1e-3], (len(t_s), 1))
    t = np.array([0.012, -0.016, 0.002]) + np.outer(part, [0.6 * bend_m, 0.8 * bend_m, 0.0])
    return replace(trajectory, T_a_b=SE3(so3_exp(turn), t) @ trajectory.T_a_b)


def covariances(walk, trajectory, sd_m):
    poses = trajectory.at(walk.t_mid_ns)
    return PoseCovariances(poses.t, np.tile(sd_m**2 * np.eye(6), (len(walk), 1, 1)))


def made(walk, trajectory, folder, sd_m):
    folder.mkdir()
    inputs = MapInputs(walk, trajectory, covariances=covariances(walk, trajectory, sd_m))
    return build_map(inputs, folder, settings=SETTINGS)


@pytest.fixture(scope="module")
def walk():
    return room_walk(frames=FRAMES, points=6000)


@pytest.fixture(scope="module")
def before(walk, tmp_path_factory):
    folder = tmp_path_factory.mktemp("before") / "map"
    made(walk, walk.trajectory, folder, 0.001)
    return folder


def carried_to(walk, after, sd_m=0.002):
    return CarriedTo(walk.rig, after, walk.t_mid_ns, covariances(walk, after, sd_m))


def by_name(tiles):
    """Number of each point, the same in every map of the walk -> its row, place and fields."""
    names = ("t_ns", "sensor", "ring", "intensity")
    read = [tile.read([*names, "range_m", "position_sd_m", "normal"]) for tile in tiles]
    fields = {name: np.concatenate([one[name] for one in read]) for name in read[0]}
    number = (fields["t_ns"] - T0_NS + 500) // 1000
    for name, values in (("sensor", 2), ("ring", 16), ("intensity", 1 << 16)):
        number = number * values + fields[name]
    return number, fields | {"p_map": np.concatenate([tile.xyz_m() for tile in tiles])}


def test_a_carried_map_lies_where_a_map_made_again_lies(walk, before, tmp_path):
    after = shifted(walk.trajectory, 0.002)
    whole = made(walk, after, tmp_path / "whole", 0.002)

    to = carried_to(walk, after)
    bent = carry_map(before, walk.trajectory, to, out=tmp_path / "carried", progress=Silent())

    carried = TileSet.open(tmp_path / "carried")
    assert bent is not None
    assert bent <= CARRY.bent_ratio
    assert len(carried) == len(TileSet.open(before)) > 10_000
    assert carried.notes == TileSet.open(before).notes
    (a, mine), (b, theirs) = by_name(carried.as_measured()), by_name(whole.as_measured())
    _, i, j = np.intersect1d(a, b, return_indices=True)
    assert len(i) > 0.9 * len(a)
    apart_m = np.linalg.norm(mine["p_map"][i] - theirs["p_map"][j], axis=1)
    assert (np.quantile(apart_m, [0.5, 0.99]) < [0.0004, 0.001]).all()
    np.testing.assert_allclose(mine["range_m"][i], theirs["range_m"][j], atol=0.002)
    sd_m = mine["position_sd_m"][i].astype(float)
    np.testing.assert_allclose(sd_m, theirs["position_sd_m"][j], atol=0.0003)
    off_m = [from_walls_m(tiles, after, walk) for tiles in (carried, whole)]
    assert abs(off_m[0] - off_m[1]) < 0.0003


def from_walls_m(tiles, after, walk):
    """Mean distance of points to the nearest wall, where the walk that is not bent has it."""
    T = after.T_a_b[0] @ walk.trajectory.T_a_b[0].inverse()
    p = T.inverse() @ np.concatenate([tile.xyz_m() for tile in tiles])
    walls = np.array([[-3.0, -3.0, -1.4], [5.0, 3.0, 1.6]])
    return np.abs(p[:, None] - walls).min(axis=(1, 2)).mean()


def test_bounds_and_rows_of_a_carried_map_are_those_of_its_points(walk, before, tmp_path):
    to = carried_to(walk, shifted(walk.trajectory, 0.0))

    carry_map(before, walk.trajectory, to, out=tmp_path, progress=Silent())

    for was, tile in zip(TileSet.open(before), TileSet.open(tmp_path), strict=True):
        p_map = tile.xyz_m()
        assert (tile.start, tile.stop, tile.strays) == (was.start, was.stop, was.strays)
        np.testing.assert_allclose(tile.low_m, p_map.min(axis=0), atol=1e-4)
        np.testing.assert_allclose(tile.high_m, p_map.max(axis=0), atol=1e-4)
        assert np.linalg.norm(p_map - was.xyz_m(), axis=1).min() > 0.01


def test_a_map_whose_visits_move_apart_is_not_carried(walk, before, tmp_path):
    to = carried_to(walk, shifted(walk.trajectory, 0.03))

    assert bent_ratio(TileSet.open(before), to.moves_from(walk.trajectory)) > 0.2
    assert carry_map(before, walk.trajectory, to, out=tmp_path, progress=Silent()) is None
    assert list(tmp_path.iterdir()) == []


def test_a_map_of_other_fields_is_not_carried(walk, before, tmp_path):
    to = replace(carried_to(walk, shifted(walk.trajectory, 0.0)), covariances=None)

    assert carry_map(before, walk.trajectory, to, out=tmp_path, progress=Silent()) is None
