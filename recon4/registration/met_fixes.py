"""Where an odometry and fixes of a GNSS/INS meet: at its start, or later while it goes on."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_log
from recon4.registration.aiding import GnssAiding
from recon4.registration.motion import MotionState, Prediction
from recon4.registration.state_vector import STATE, VECTOR
from recon4.registration.tuning import OdometryTuning
from recon4.registration.tuning_motion import AIDING, MOVING_START
from recon4.settings import OdometrySettings
from recon4.settings.tuning import tuned
from recon4.units import STANDARD_GRAVITY_M_S2


class MetFixes:
    """Fixes in the frame of an odometry, a run between two outages after the other.

    The odometry begins in the frame of fixes that begin in time. Of those that come later it knows
    no place: it has drifted, or has a frame of its own. Each later run is therefore taken into its
    frame at the first fix, and holds the motion from there on; the pose graph has the places.
    """

    def __init__(self, aiding: GnssAiding | None, settings: OdometrySettings) -> None:
        self._runs = [] if aiding is None else aiding.runs()
        self._begin_ns = [int(run.t_ns[0]) for run in self._runs]
        self._run: GnssAiding | None = None
        self._start: MotionState
        self._least_m = tuned(OdometryTuning, settings).gnss_sd_m
        self.fixes: GnssAiding | None = None
        """Those of the last run that was met, in the frame of the odometry."""

    def begin(
        self, state: MotionState, predict: Callable[[MotionState, int], Prediction]
    ) -> MotionState:
        """The initial state in the frame of the fixes, if they begin in time.

        A receiver does not begin with the LiDAR: the motion to the first fix is predicted. Who
        moves then has moved before, too.
        """
        self._start = state
        self._run = next((run for run in self._runs if run.first(state.t_ns)), None)
        self.fixes = self._run
        first = None if self._run is None else self._run.first(state.t_ns)
        if self._run is None or first is None:
            return state
        at_ns, T = first
        met = predict(state, at_ns).end if at_ns > state.t_ns else state
        T = T @ met.T_odom_body.inverse() @ state.T_odom_body
        variance = np.diag(met.P)
        sd_rad = np.hypot(self._run.attitude_sd_rad, np.sqrt(variance[STATE.rotation].max()))
        sd_m = np.hypot(self._least_m, np.sqrt(variance[STATE.position].max()))
        begun = state.at_pose(T, sd_rad=float(sd_rad), sd_m=float(sd_m))
        moving = self._run.velocity(at_ns)
        if moving is None or np.linalg.norm(moving) <= MOVING_START.moving_m_s:
            return begun  # who stands is known better
        velocity = moving - begun.R @ state.R.T @ met.vector[VECTOR.velocity]
        vector = begun.vector.copy()
        vector[VECTOR.position] -= 1e-9 * (at_ns - state.t_ns) * velocity
        grown = (met.P - state.P)[STATE.velocity, STATE.velocity]
        sd_m_s = np.hypot(MOVING_START.sd_m_s, np.sqrt(np.diag(grown).max()))
        return replace(begun, vector=vector).moving(velocity, float(sd_m_s))

    def meet(self, state: MotionState) -> MotionState:
        """Take the run that begins by now into the frame of the odometry; the state after that.

        Velocity and gravity that the fixes contradict, or know better, are theirs: where nothing
        observes the motion both may be wrong by more than they state.
        """
        number = bisect_right(self._begin_ns, state.t_ns)
        if not number or self._runs[number - 1] is self._run:
            return state
        run = self._runs[number - 1]
        T_enu_body = run.pose(state.t_ns)
        if T_enu_body is None:
            return state
        T_odom_enu = state.T_odom_body @ T_enu_body.inverse()
        if state.vector[VECTOR.gravity].any():
            down = T_odom_enu.R @ self._start.vector[VECTOR.gravity]
            if _knows(state, "gravity", down, sd=run.attitude_sd_rad * STANDARD_GRAVITY_M_S2):
                T_odom_enu = _without_tilt(T_odom_enu, T_enu_body)
            else:
                state = _falling(state, down, self._start)
        self._run, self.fixes = run, run.seen_from(T_odom_enu)
        velocity = self.fixes.velocity(state.t_ns)
        if velocity is None or _knows(state, "velocity", velocity, sd=MOVING_START.sd_m_s):
            return state
        return state.moving(velocity, MOVING_START.sd_m_s)


def _knows(state: MotionState, name: str, measured: Array, *, sd: float) -> bool:
    """Whether a state knows a vector better than fixes that measure it, and agrees with them."""
    rows = getattr(STATE, name)
    off = measured - state.vector[getattr(VECTOR, name)]
    stated = state.P[rows, rows]
    agrees = off @ np.linalg.solve(stated + sd**2 * np.eye(3), off) < AIDING.outlier_sd**2
    return bool(agrees and np.diag(stated).max() < sd**2)


def _without_tilt(T_odom_enu: SE3, T_enu_body: SE3) -> SE3:
    """The same frame with both axes up parallel, at the same place of the body."""
    turn = SE3.from_rpy(0.0, 0.0, float(so3_log(T_odom_enu.R)[2]), t=[0.0, 0.0, 0.0])
    return SE3(turn.R, (T_odom_enu @ T_enu_body).t - turn.R @ T_enu_body.t)


def _falling(state: MotionState, gravity: Array, start: MotionState) -> MotionState:
    """The same motion with another gravity, and what the accelerometer misses as at the start."""
    vector, P = state.vector.copy(), state.P.copy()
    vector[VECTOR.accel_bias] = start.vector[VECTOR.accel_bias]
    vector[VECTOR.gravity] = gravity
    for rows in (STATE.accel_bias, STATE.gravity):
        P[rows, :] = P[:, rows] = 0.0
        P[rows, rows] = start.P[rows, rows]
    return replace(state, vector=vector, P=P)
