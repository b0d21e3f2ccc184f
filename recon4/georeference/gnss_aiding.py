"""Prepare fixes of a GNSS/INS for the aiding of odometry."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array, so3_exp
from recon4.georeference.crs import GeodeticOrigin, to_enu
from recon4.georeference.receiver_clock import receiver_clock_s
from recon4.model.rig import Rig
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.registration.aiding import GnssAiding
from recon4.settings import OdometrySettings

_R_ENU_NED = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
_R_DOWN_UP = np.diag([1.0, -1.0, -1.0])
"""Rotation from a body frame with z up to one with x forward and z down."""


def make_gnss_aiding(
    gnss: GnssSamples | None,
    rig: Rig,
    settings: OdometrySettings,
    *,
    imu: ImuSamples | None = None,
) -> GnssAiding | None:
    """GNSS aiding by RTK fixes with heading; None if there are fewer than two.

    Args:
        gnss: Positions and attitudes of the INS.
        rig: Lever arm and time offset.
        settings: Smallest standard deviations; whether GNSS is used at all.
        imu: Samples that show an error of the receiver's clock; None = its stamps are used.
    """
    if gnss is None or not settings.use_gnss:
        return None
    measured = np.column_stack([gnss.height_m, gnss.rpy_ned_rad])
    good = np.isfinite(measured).all(axis=1) & (gnss.quality == GnssQuality.RTK_FIXED)
    if good.sum() < 2:
        return None
    first = int(np.flatnonzero(good)[0])
    origin = GeodeticOrigin(gnss.lat_rad[first], gnss.lon_rad[first], gnss.height_m[first])
    p_enu = to_enu(
        origin, gnss.lat_rad[good], gnss.lon_rad[good], ellipsoidal_height_m=gnss.height_m[good]
    )
    sd_m = np.fmax(np.nan_to_num(gnss.sd_enu_m[good], nan=0.0), settings.gnss_sd_m)
    t_ns, R_enu_body = gnss.t_ns[good], attitudes(gnss.rpy_ned_rad[good])
    clock_s = receiver_clock_s(t_ns, R_enu_body, imu=imu, rig=rig) if imu is not None else 0.0
    return GnssAiding(
        t_ns=t_ns + round(1e9 * clock_s),
        p_enu=p_enu,
        sd_m=sd_m,
        R_enu_body=R_enu_body,
        attitude_sd_rad=settings.heading_sd_rad,
        p_body_antenna=rig.p_body_antenna,
    )


def attitudes(rpy_ned_rad: Array) -> Array:
    """Attitudes of an INS as ``R_enu_body``, (N, 3, 3), from roll, pitch, heading, (N, 3)."""
    roll, pitch, heading = rpy_ned_rad.T
    x, y, z = np.eye(3)
    R_ned_down = (
        so3_exp(heading[:, None] * z) @ so3_exp(pitch[:, None] * y) @ so3_exp(roll[:, None] * x)
    )
    return np.asarray(_R_ENU_NED @ R_ned_down @ _R_DOWN_UP)
