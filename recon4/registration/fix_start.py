"""Where an odometry begins if fixes of a GNSS/INS say it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from recon4.registration.aiding import GnssAiding
from recon4.registration.motion import MotionState, Prediction
from recon4.registration.state_vector import STATE, VECTOR
from recon4.registration.tuning import OdometryTuning
from recon4.registration.tuning_motion import MOVING_START
from recon4.settings import OdometrySettings
from recon4.settings.tuning import tuned


def start_at_fixes(
    state: MotionState,
    aiding: GnssAiding | None,
    settings: OdometrySettings,
    *,
    predict: Callable[[MotionState, int], Prediction],
) -> tuple[MotionState, GnssAiding | None]:
    """The initial state in the frame of the fixes, and the fixes if they begin in time.

    A receiver does not begin with the LiDAR: the motion to the first fix is predicted. Who moves
    then has moved before, too. Fixes that begin later are in another frame than the odometry, and
    neither place nor pull anything.
    """
    first = None if aiding is None else aiding.first(state.t_ns)
    if aiding is None or first is None:
        return state, None
    at_ns, T = first
    met = predict(state, at_ns).end if at_ns > state.t_ns else state
    T = T @ met.T_odom_body.inverse() @ state.T_odom_body
    least_m, variance = tuned(OdometryTuning, settings).gnss_sd_m, np.diag(met.P)
    sd_rad = np.hypot(aiding.attitude_sd_rad, np.sqrt(variance[STATE.rotation].max()))
    sd_m = np.hypot(least_m, np.sqrt(variance[STATE.position].max()))
    begun = state.at_pose(T, sd_rad=float(sd_rad), sd_m=float(sd_m))
    moving = aiding.velocity(at_ns)
    if moving is None:
        return begun, aiding
    velocity = moving - begun.R @ state.R.T @ met.vector[VECTOR.velocity]
    vector = begun.vector.copy()
    vector[VECTOR.position] -= 1e-9 * (at_ns - state.t_ns) * velocity
    grown = (met.P - state.P)[STATE.velocity, STATE.velocity]
    sd_m_s = np.hypot(MOVING_START.sd_m_s, np.sqrt(np.diag(grown).max()))
    return replace(begun, vector=vector).moving(velocity, float(sd_m_s)), aiding
