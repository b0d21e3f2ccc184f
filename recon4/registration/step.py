"""What odometry reports of one multiframe."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.model.multiframe import Multiframe
from recon4.model.trajectory import Times
from recon4.registration.degeneracy import of_rigid_pose, weakest_twist
from recon4.registration.frame_fit import FrameFit, motion_cov
from recon4.registration.motion import Prediction, middle_of


@dataclass(frozen=True, slots=True, eq=False)
class OdometryStep:
    """Result of odometry for one multiframe. Lost tracking is a result, not an error."""

    frame_id: int
    t_mid_ns: int
    T_odom_body: SE3
    """Pose at the middle of the frame."""
    t_ns: Times
    """Times of the dense poses [ns], after the last of the frame before, (K,)."""
    T_dense: SE3
    """Poses at these times, a batch of K."""
    error_m: float
    """Mean distance of the matched segments from the local map [m]; NaN without a match."""
    match_ratio: float
    """Part of the segments that found a plane, 0..1."""
    rounds: int
    converged: bool
    degeneracy: float
    """See `Match.degeneracy`."""
    prediction_offset_m: float
    """How far the LiDAR moved the prediction [m]."""
    lost: bool
    motion_cov: Array
    """Covariance of the motion over the frame, turn and shift in odom axes, (6, 6)."""
    weak_direction: Array = field(default_factory=lambda: np.full(3, np.nan))
    """See `Match.weak_direction`, in odom axes; NaN where it is unknown."""
    weak_sd_m: float = float("nan")
    """Standard deviation of the position along it by the LiDARs of this frame alone [m]."""
    weak_twist: Array = field(default_factory=lambda: np.full(6, np.nan))
    """See `weakest_twist`: turn and shift of the body that are observed least, in odom axes …"""
    weak_twist_sd_m: float = float("nan")
    """… the standard deviation of its size by the LiDARs of this frame alone [m] …"""
    typical_m: float = float("nan")
    """… the distance of the points at which it has that size [m] …"""
    weak_twist_information: float = float("nan")
    """… and the information on it per weight of the points, whatever their number."""
    stationary: bool = False
    """Whether the IMU says that the body stands."""
    bridged: bool = False
    """Whether only a registration to the scans before a gap says how the body got here."""
    piece: int = 0
    """Number of the piece of the walk; the motion from one piece to the next is not known."""
    weak_motion_sd_m: float = 0.0
    """Standard deviation of the motion over the frame along the weak direction, as an accelerometer
    carries it from where it is observed [m]; 0 = it is observed, or nothing carries it."""


def make_step(
    frame: Multiframe, prediction: Prediction, fit: FrameFit, *, T_dense: SE3, lost: bool
) -> OdometryStep:
    """What is reported of a frame with these dense poses."""
    end = prediction.T_odom_body[-1]
    t_ns = frame.t_ns + np.round(prediction.t_s * 1e9).astype(np.int64)
    return OdometryStep(
        frame.frame_id,
        frame.t_mid_ns,
        middle_of(prediction.t_s, T_dense),
        t_ns,
        T_dense,
        fit.match.mean_m,
        fit.match.match_ratio,
        fit.rounds,
        fit.converged,
        fit.match.degeneracy,
        float(np.linalg.norm(T_dense.t[-1] - end.t)),
        lost,
        motion_cov(prediction.prior if lost else fit.P),
        fit.match.weak_direction,
        fit.weak_sd_m,
        *weakest_twist(of_rigid_pose(fit.H_lidar)),
        fit.stationary,
    )
