"""Where an odometry begins if fixes of a GNSS/INS say it."""

from __future__ import annotations

from recon4.registration.aiding import GnssAiding
from recon4.registration.motion import MotionState
from recon4.registration.tuning import OdometryTuning
from recon4.settings import OdometrySettings
from recon4.settings.tuning import tuned


def start_at_fixes(
    state: MotionState, aiding: GnssAiding, settings: OdometrySettings
) -> tuple[MotionState, GnssAiding | None]:
    """The initial state in the frame of the fixes, and the fixes if there is one at its time.

    Fixes that begin later are in another frame than the odometry, and place nothing.
    """
    T_enu_body = aiding.pose(state.t_ns)
    if T_enu_body is None:
        return state, None
    placed = state.at_pose(
        T_enu_body, sd_rad=aiding.attitude_sd_rad, sd_m=tuned(OdometryTuning, settings).gnss_sd_m
    )
    return placed, aiding
