"""Attitudes of a GNSS/INS as rotations, and whose they are.

Receivers state the attitude of the body or that of their IMU in its own axes, and no file says
which. Gravity does: turned into the axes of the earth, the specific force points up.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array, so3_exp
from recon4.georeference.tuning import ATTITUDES
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples, ImuSamples

_R_ENU_NED = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
_R_DOWN_UP = np.diag([1.0, -1.0, -1.0])
"""Rotation from a body frame with z up to one with x forward and z down."""


def attitudes(rpy_ned_rad: Array) -> Array:
    """Attitudes of an INS as ``R_enu_ins``, (N, 3, 3), from roll, pitch, heading, (N, 3)."""
    roll, pitch, heading = rpy_ned_rad.T
    x, y, z = np.eye(3)
    R_ned_down = (
        so3_exp(heading[:, None] * z) @ so3_exp(pitch[:, None] * y) @ so3_exp(roll[:, None] * x)
    )
    return np.asarray(_R_ENU_NED @ R_ned_down @ _R_DOWN_UP)


def ins_mount(gnss: GnssSamples, rig: Rig, *, imu: ImuSamples | None, usual: Array) -> Array:
    """Rotation ``R_body_ins``, (3, 3): that of the IMU or none, whichever agrees with gravity.

    Args:
        gnss: Attitudes of the INS.
        rig: How the IMU is mounted.
        imu: Its samples, or None.
        usual: What counts where gravity does not tell: without an accelerometer, or if the IMU is
            hardly turned.
    """
    known = np.isfinite(gnss.rpy_ned_rad[:, :2]).all(axis=1)
    t_ns = gnss.t_ns[known]
    if imu is None or len(t_ns) < 2 or rig.T_body_imu.angle() < ATTITUDES.turned_rad:
        return usual
    inside = (imu.t_ns >= t_ns[0]) & (imu.t_ns <= t_ns[-1]) & np.isfinite(imu.accel_m_s2).all(1)
    if inside.sum() < ATTITUDES.min_samples:
        return usual
    # A heading does not change what is vertical. Samples meet the next attitude.
    vertical = attitudes(gnss.rpy_ned_rad[known] * [1.0, 1.0, 0.0])[:, 2]
    vertical_ins = vertical[np.searchsorted(t_ns, imu.t_ns[inside])]
    force_imu = imu.accel_m_s2[inside]

    def mean_upward(R_body_ins: Array) -> float:
        force_ins = force_imu @ rig.T_body_imu.R.T @ R_body_ins
        return float(np.mean(np.einsum("ni,ni->n", vertical_ins, force_ins)))

    return max((rig.T_body_imu.R, np.eye(3)), key=mean_upward)
