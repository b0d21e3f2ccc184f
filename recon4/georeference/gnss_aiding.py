"""Prepare fixes of a GNSS/INS for the aiding of odometry."""

from __future__ import annotations

import numpy as np

from recon4.georeference.crs import GeodeticOrigin, to_enu
from recon4.georeference.ins_attitudes import attitudes, ins_mount
from recon4.georeference.receiver_clock import receiver_clock_s
from recon4.model.rig import Rig
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.registration.aiding import GnssAiding
from recon4.settings import OdometrySettings


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
    R_ins_body = ins_mount(gnss, rig, imu=imu, usual=np.eye(3)).T
    t_ns, R_enu_body = gnss.t_ns[good], attitudes(gnss.rpy_ned_rad[good]) @ R_ins_body
    clock_s = receiver_clock_s(t_ns, R_enu_body, imu=imu, rig=rig) if imu is not None else 0.0
    return GnssAiding(
        t_ns=t_ns + round(1e9 * clock_s),
        p_enu=p_enu,
        sd_m=sd_m,
        R_enu_body=R_enu_body,
        attitude_sd_rad=settings.heading_sd_rad,
        p_body_antenna=rig.p_body_antenna,
    )
