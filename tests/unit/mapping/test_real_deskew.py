"""Undistortion of a real scan against that of another program (gtsam_points, IMU at 100 Hz)."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares

from recon4.geometry.se3 import SE3, align_points, so3_exp
from recon4.mapping.undistort import place
from recon4.model.multiframe import Multiframe
from recon4.model.rig import load_rig
from recon4.model.trajectory import Trajectory

KNOTS_NS = 10_000_000 * np.arange(12)
"""Poses of an IMU."""
RIG = load_rig("single-vlp16")
IN_SENSOR = replace(
    RIG, sensors=(replace(RIG.sensors[0], model="OS1-64", T_body_sensor=SE3.identity()),)
)


def scan(folder, number):
    """Raw points as a multiframe, and the points that the other program undistorted."""
    raw, other = (
        np.fromfile(folder / f"{name}_{number}.bin", "<f4").reshape(-1, 3)
        for name in ("raw", "deskewed")
    )
    times_s = np.fromfile(folder / f"times_{number}.bin", "<f4").astype(np.float64)
    nothing = np.zeros(len(raw), np.uint8)
    frame = Multiframe(
        0,
        0,
        100_000_000,
        xyz=raw,
        intensity=nothing.astype(np.uint16),
        ring=nothing,
        sensor=nothing,
        echo=nothing,
        dt_ns=np.rint(1e9 * times_s).astype(np.int32),
    )
    return frame, other.astype(np.float64)


def motion(frame, other):
    """The poses that the other program had: fitted to some of its points."""
    T = align_points(other, frame.xyz.astype(np.float64))

    def poses(x):
        steps = x.reshape(-1, 6)
        return Trajectory(KNOTS_NS, SE3(so3_exp(steps[:, :3]) @ T.R, T.t + steps[:, 3:]))

    def errors(x):
        return (place(frame, poses(x), IN_SENSOR) - other).ravel()

    return poses(least_squares(errors, np.zeros(6 * len(KNOTS_NS)), max_nfev=12).x)


@pytest.mark.parametrize("number", ["00", "01"])
def test_a_fast_turn_is_undistorted_as_by_another_program(data, number):
    frame, other = scan(data("sequences/os1-deskew"), number)
    rows = np.arange(len(frame))

    trajectory = motion(frame.take(rows[::25]), other[::25])

    held_out = rows[rows % 25 != 0]
    error_m = np.linalg.norm(
        place(frame.take(held_out), trajectory, IN_SENSOR) - other[held_out], axis=1
    )
    rigid = align_points(other, frame.xyz.astype(np.float64)) @ frame.xyz.astype(np.float64)
    assert np.sqrt(np.mean(error_m**2)) < 0.01
    assert np.sqrt(np.mean(np.sum((rigid - other) ** 2, axis=1))) > 0.1  # what there is to undo
