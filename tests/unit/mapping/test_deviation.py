"""Standard deviations of points follow from the covariances of their poses."""

import laspy
import numpy as np
import pytest

from recon4.export.laz import export_laz
from recon4.geometry.se3 import so3_exp
from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.deviation import PoseCovariances, point_deviations
from recon4.mapping.tile import DEVIATION
from recon4.settings import MapSettings
from tests.room_walks import room_walk


def test_deviations_are_those_of_points_of_disturbed_poses():
    """20 000 draws of each pose, and the points that it carries."""
    rng = np.random.default_rng(1)
    root = rng.normal(size=(3, 6, 6)) * np.repeat([0.002, 0.01], 3)[:, None]
    cov = root @ root.transpose(0, 2, 1)
    position_m = rng.normal(size=(3, 3)) * 10.0
    p_map = position_m[[0, 1, 2, 2]] + rng.normal(size=(4, 3)) * 15.0
    frame_id = np.array([0, 1, 2, 2], np.uint32)

    found = point_deviations(PoseCovariances(position_m, cov), p_map, frame_id)

    for row, frame in enumerate(frame_id):
        draws = rng.multivariate_normal(np.zeros(6), cov[frame], size=20_000)
        d = p_map[row] - position_m[frame]
        moved = draws[:, 3:] + so3_exp(draws[:, :3]) @ d - d
        expected = np.sqrt(np.linalg.eigvalsh(np.cov(moved.T))[-1])
        assert float(found[row]) == pytest.approx(expected, rel=0.03)


def test_a_shift_alone_is_the_same_everywhere():
    cov = np.zeros((1, 6, 6))
    cov[0, 3:, 3:] = np.diag([0.01, 0.02, 0.03]) ** 2
    p_map = np.array([[0.0, 0.0, 0.0], [50.0, 0.0, -3.0]])

    found = point_deviations(PoseCovariances(np.zeros((1, 3)), cov), p_map, np.zeros(2, np.uint32))

    np.testing.assert_allclose(found, 0.03, rtol=1e-3)


def test_equal_variances_have_a_largest_one():
    cov = np.zeros((1, 6, 6))
    cov[0, 3:, 3:] = 0.0004 * np.eye(3)

    found = point_deviations(
        PoseCovariances(np.zeros((1, 3)), cov), np.ones((1, 3)), np.zeros(1, np.uint32)
    )

    np.testing.assert_allclose(found, 0.02, rtol=1e-3)


def test_a_map_has_deviations_that_grow_with_the_distance_from_the_pose(tmp_path):
    walk = room_walk(frames=3)
    position_m = walk.trajectory.at(np.array([walk[k].t_ns for k in range(3)])).t
    cov = np.zeros((3, 6, 6))
    cov[:, :3, :3] = 0.01**2 * np.eye(3)
    inputs = MapInputs(walk, walk.trajectory, covariances=PoseCovariances(position_m, cov))
    (tmp_path / "map").mkdir()

    tiles = build_map(inputs, tmp_path / "map", settings=MapSettings())
    export_laz(tiles, tmp_path / "map.laz")

    for tile in tiles:
        columns = tile.read(["frame_id", DEVIATION])
        away_m = np.linalg.norm(tile.xyz_m() - position_m[columns["frame_id"]], axis=1)
        np.testing.assert_allclose(columns[DEVIATION], 0.01 * away_m, rtol=2e-3, atol=6e-5)
    written = np.sort(np.array(laspy.read(tmp_path / "map.laz")[DEVIATION]))
    stored = np.sort(np.concatenate([tile.read([DEVIATION])[DEVIATION] for tile in tiles]))
    np.testing.assert_allclose(written, stored, atol=0.00006)
