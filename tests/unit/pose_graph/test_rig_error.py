"""Covariances of poses by errors of the rig file that an audit found."""

from types import SimpleNamespace

import numpy as np
import pytest

from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, so3_exp, so3_log
from recon4.model.calibration_figures import CalibrationFigures, ParameterFigures
from recon4.model.odometry_figures import HeightDoubt
from recon4.pose_graph.known_errors import EXACT, KnownErrors, RigError, audited_error
from recon4.pose_graph.uncertainty import pose_uncertainty
from recon4.workflows.workflow import Run
from tests.unit.pose_graph.test_uncertainty import chain


def found(sensor: str, quantity: str, axis: str, change: float, status: str = "off"):
    unit = {"rotation": "rad", "position": "m", "clock": "s"}[quantity]
    return ParameterFigures(
        sensor=sensor, quantity=quantity, axis=axis, unit=unit, change=change, sd=1e-4,
        status=status,
    )  # fmt: skip


def turned(*yaw_deg: float) -> SE3:
    return SE3.stack(SE3.from_rpy(0.0, 0.0, np.deg2rad(a), t=[a, 0.0, 0.0]) for a in yaw_deg)


def cov_of(error: RigError, T_map_body: SE3, *, on_earth: bool = False) -> Array:
    modes = error.modes(T_map_body, on_earth=on_earth)
    return modes @ np.swapaxes(modes, 1, 2)


def test_an_error_that_turns_with_the_body_cancels_out_where_the_body_stands_as_at_the_start():
    cov = cov_of(RigError(turn_rad=0.01, shift_m=0.02), turned(0, 360, 180, 90))

    np.testing.assert_allclose(cov[:2], 0.0, atol=1e-15)
    # Half a turn about z: what was to the left is to the right, twice as far from where it was.
    np.testing.assert_allclose(np.diag(cov[2])[:3], [4e-4, 4e-4, 0.0], atol=1e-7)
    np.testing.assert_allclose(np.diag(cov[2])[3:], [16e-4, 16e-4, 0.0], atol=1e-6)
    np.testing.assert_allclose(np.diag(cov[3])[:3], [2e-4, 2e-4, 0.0], atol=1e-7)


def test_on_the_earth_it_is_the_same_everywhere():
    cov = cov_of(RigError(turn_rad=0.01, shift_m=0.02), turned(0, 90, 180), on_earth=True)

    np.testing.assert_allclose(
        cov, np.tile(np.diag([1e-4] * 3 + [4e-4] * 3), (3, 1, 1)), 2e-4, 1e-12
    )


def test_it_is_the_covariance_of_errors_drawn_in_the_body():
    rng = np.random.default_rng(3)
    R = turned(0, 40, 130).R
    drawn = rng.normal(0.0, 0.01, (20_000, 3))
    errors = np.einsum("kij,nj->kni", R - R[0], drawn)

    cov = cov_of(RigError(turn_rad=0.01), turned(0, 40, 130))

    sampled = np.einsum("kni,knj->kij", errors, errors) / len(drawn)
    np.testing.assert_allclose(cov[:, ROTATION, ROTATION], sampled, atol=1.5e-5)


def test_a_turned_body_turns_a_local_map_about_its_first_pose():
    """An Airy 1.4° off on a walk of 16 m, right to 5 mm in shape, stated 4 mm and was 16 cm off."""
    T = turned(20, 60, 150)
    axis = np.array([0.0, 0.01, 0.0])
    reported = T @ SE3(so3_exp(axis), np.zeros(3))
    aligned = T[0] @ reported[0].inverse() @ reported
    error = np.concatenate([so3_log(aligned.R @ np.swapaxes(T.R, 1, 2)), aligned.t - T.t], axis=1)

    body, lidar = (RigError(turn_rad=0.01, of_body=one) for one in (True, False))

    np.testing.assert_allclose(body.modes(T, on_earth=False)[:, :, 1], error, atol=0.015)
    assert np.abs(error[2, TRANSLATION]).max() > 1.0
    np.testing.assert_array_equal(body.modes(T, on_earth=True), lidar.modes(T, on_earth=True))
    shape = [
        pose_uncertainty(chain(20), known=KnownErrors(rig=one)).shape_rms_m for one in (body, lidar)
    ]
    assert shape[0] == pytest.approx(shape[1], rel=1e-3)


def test_a_lidar_above_the_body_that_turns_it_shifts_it_aside():
    body = RigError(turn_rad=0.01, of_body=True)

    assert body.seen_at(np.array([0.0, 0.3, 0.4])).shift_m == pytest.approx(0.005)
    of_two = RigError(turn_rad=0.01, shift_m=0.02)
    assert of_two.seen_at(np.array([0.0, 0.3, 0.4])) == of_two


def test_exchanged_lidars_leave_no_turn_known():
    """A mount turned by 180°: the turn about z is wrong, too, though an error of the body about
    any axis leaves it as it is to first order.
    """
    large = cov_of(audited_error([found("a", "rotation", "y", np.pi)]), turned(0, 90))
    small = cov_of(audited_error([found("a", "rotation", "y", 0.02)]), turned(0, 90))

    assert np.sqrt(large[1, 2, 2]) > 1.0
    assert np.sqrt(large[1, 5, 5]) > 1.0
    assert np.sqrt(small[1, 2, 2]) < 1e-4
    assert not large[0].any()


def test_the_worst_lidar_counts_and_neither_imu_nor_antenna():
    nothing = [found("imu", "rotation", "x", 0.5), found("gnss", "position", "x", 0.5)]
    small = [found("a", "rotation", "y", 0.003), found("a", "rotation", "z", 0.004)]
    large = [found("b", "rotation", "x", 0.02), found("b", "rotation", "y", 9.0, "consistent")]

    assert audited_error([*nothing, found("a", "rotation", "x", 0.5, "consistent")]) == EXACT
    assert audited_error(small).turn_rad == pytest.approx(0.35 * 0.005)
    assert audited_error([*nothing, *small, *large]).turn_rad == pytest.approx(0.35 * 0.02)


def test_a_lidar_that_is_alone_may_be_turned_as_well_as_its_imu():
    turned_by = [found("imu", "rotation", "x", 0.03), found("imu", "rotation", "y", 0.04)]
    others = [found("imu", "clock", "", 0.02), found("imu", "rotation", "z", 0.5, "consistent")]

    alone = audited_error([*turned_by, *others])

    assert np.sqrt(3.0) * alone.turn_rad == pytest.approx(np.sqrt(0.5) * 0.05)
    assert alone.shift_m == 0.0
    assert alone.of_body and not audited_error([found("a", "rotation", "x", 0.03)]).of_body
    assert not audited_error([found("imu", "rotation", "x", 0.5 * np.pi)]).of_body


def test_a_mount_and_a_clock_that_are_off_shift_the_body():
    moved = audited_error([found("a", "position", "x", 0.3), found("a", "position", "y", 0.4)])
    late = audited_error([found("a", "clock", "", -0.02)])

    assert moved.shift_m == pytest.approx(0.35 * 0.5) and moved.turn_rad == 0.0
    assert late.shift_m == pytest.approx(0.35 * 1.3 * 0.02)
    assert late.turn_rad == pytest.approx(0.35 * 0.02)


def test_poses_of_a_graph_state_it():
    graph = chain(60)

    exact, off = (
        pose_uncertainty(graph, known=KnownErrors(rig=rig))
        for rig in (EXACT, RigError(shift_m=0.05))
    )

    added = (off.cov - exact.cov)[:, TRANSLATION, TRANSLATION]
    np.testing.assert_allclose(added[:14], 0.0, atol=1e-12)  # not turned yet
    assert np.sqrt(np.linalg.eigvalsh(added[35])[-1]) == pytest.approx(0.1, rel=0.01)
    assert off.helpful.largest_m > exact.helpful.largest_m + 0.05
    assert off.shape_rms_m > exact.shape_rms_m + 0.02


@pytest.mark.parametrize("applied", [False, True])
def test_an_audit_counts_unless_the_rig_was_calibrated(applied: bool):
    runs = {"calibration": SimpleNamespace(figures=CalibrationFigures(applied=applied))}

    run = Run(SimpleNamespace(runs=runs))

    assert run.rig_audit == (None if applied else "calibration")
    assert ("calibration" in run.measurements) is applied


def test_a_ride_makes_the_heights_after_it_unknown():
    ride = HeightDoubt(start_s=10.0, end_s=15.0, rise_m=-3.4)
    t_ns = 10**18 + np.array([0, 10, 12, 15, 20], np.int64) * 10**9
    known, T = KnownErrors(heights=(ride,)), turned(0, 90, 90, 90, 0)

    local, placed = (
        modes @ np.swapaxes(modes, 1, 2)
        for modes in (known.modes(t_ns, T, on_earth=on_earth) for on_earth in (False, True))
    )

    sd_m = np.sqrt(local[:, 5, 5])
    np.testing.assert_allclose(sd_m, [0.0, 0.0, 0.4 * 3.4, 3.4, 3.4], atol=1e-12)
    local[:, 5, 5] = 0.0
    assert not local.any()
    assert not placed.any()  # positions on the earth have their own heights
