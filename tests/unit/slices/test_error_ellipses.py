"""Error ellipses of places, and that residuals carry them."""

import numpy as np
import pytest

from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.deviation import PoseCovariances
from recon4.settings import MapSettings
from recon4.slices.control_points import ControlPoint
from recon4.slices.error_ellipses import error_ellipse, place_covariance
from recon4.slices.measured_points import MeasuredPosition
from recon4.slices.residual_table import residual_csv
from recon4.slices.residuals import ControlContext, residuals
from tests.room_walks import room_walk


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    walk = room_walk(frames=3)
    out = tmp_path_factory.mktemp("room") / "map"
    out.mkdir()
    return build_map(MapInputs(walk, walk.trajectory), out, settings=MapSettings()), walk


def test_the_long_axis_of_an_ellipse_has_its_azimuth_from_north():
    east, north = np.sin(np.deg2rad(30.0)), np.cos(np.deg2rad(30.0))
    axes = np.array([[east, -north, 0.0], [north, east, 0.0], [0.0, 0.0, 1.0]])

    found = error_ellipse(axes @ np.diag([0.03, 0.01, 0.02]) ** 2 @ axes.T)

    assert (found.major_m, found.minor_m, found.up_m) == pytest.approx((0.03, 0.01, 0.02))
    assert found.azimuth_deg == pytest.approx(30.0)


def test_a_turn_of_the_pose_moves_a_place_across_the_line_of_sight(room):
    tiles, walk = room
    tile = max(tiles, key=len)
    place, here = tile.xyz_m()[0], walk.trajectory.at(walk.trajectory.t_ns[:1]).t[0]
    heading = np.zeros((6, 6))
    heading[2, 2] = 0.01**2  # about the vertical

    def covariances_at(t_ns):
        cov = np.broadcast_to(heading, (len(t_ns), 6, 6))
        return PoseCovariances(np.tile(here, (len(t_ns), 1)), cov)

    found = error_ellipse(place_covariance(tiles, place, covariances_at))

    d = place - here
    across_deg = np.rad2deg(np.arctan2(d[1], -d[0])) % 180.0
    assert found.major_m == pytest.approx(0.01 * np.hypot(d[0], d[1]), rel=1e-6)
    assert found.minor_m < 1e-9 and found.up_m == 0.0
    assert abs((found.azimuth_deg - across_deg + 90.0) % 180.0 - 90.0) < 1e-6


def test_a_place_without_points_has_no_covariance(room):
    assert place_covariance(room[0], np.array([500.0, 0.0, 0.0]), lambda _: None) is None


def test_residuals_carry_what_the_map_states_of_their_place():
    points = [ControlPoint("A", (0.0, 0.0, 0.0)), ControlPoint("B", (1.0, 0.0, 0.0))]
    measured = {
        "A": MeasuredPosition.full(np.array([0.01, 0.0, 0.0])),
        "B": MeasuredPosition.full(np.array([1.0, 0.0, 0.0])),
    }
    stated = {"A": np.diag([0.02, 0.01, 0.03]) ** 2}

    report = residuals(points, measured, ControlContext(covariances=stated))

    first, second = report.rows
    assert first.stated.major_m == pytest.approx(0.02) and first.stated.azimuth_deg == 90.0
    assert second.stated is None
    assert "A,check,0.0100,0.0000,0.0000,0.0100,0.0100,0.0200,0.0100,90.0000,0.0300,3,0.0100" in (
        residual_csv(report)
    )
