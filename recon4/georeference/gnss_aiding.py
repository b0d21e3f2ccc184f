"""Prepare fixes of a GNSS/INS for the aiding of odometry.

The attitudes aid the odometry while it runs. In a turn a clock 100 ms off makes a heading of them
that is wrong by 10°, and the odometry bends. The sway of a person, or the turns of a vehicle, show
the clock before: the gyroscope measures every turn between two attitudes, at another time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from recon4.geometry.se3 import Array, so3_log
from recon4.georeference.crs import GeodeticOrigin, to_enu
from recon4.georeference.ins_attitudes import attitudes, ins_mount
from recon4.georeference.tuning import JUMPS
from recon4.georeference.tuning_clocks import RECEIVER_CLOCK
from recon4.model.rig import Rig
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.registration.aiding import GnssAiding
from recon4.registration.tuning import OdometryTuning
from recon4.settings import OdometrySettings
from recon4.settings.tuning import tuned


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
    tuning = tuned(OdometryTuning, settings)
    sd_m = np.fmax(np.nan_to_num(gnss.sd_enu_m[good], nan=0.0), tuning.gnss_sd_m)
    R_ins_body = ins_mount(gnss, rig, imu=imu, usual=np.eye(3)).T
    t_ns, R_enu_body = gnss.t_ns[good], attitudes(gnss.rpy_ned_rad[good]) @ R_ins_body
    clock_s = receiver_clock_s(t_ns, R_enu_body, imu=imu, rig=rig) if imu is not None else 0.0
    steady = ~jumping(p_enu, t_ns)
    return GnssAiding(
        t_ns=(t_ns + round(1e9 * clock_s))[steady],
        p_enu=p_enu[steady],
        sd_m=sd_m[steady],
        R_enu_body=R_enu_body[steady],
        attitude_sd_rad=tuning.heading_sd_rad,
        p_body_antenna=rig.p_body_antenna,
    )


def jumping(p_enu: Array, t_ns: Times) -> NDArray[np.bool_]:
    """Fixes that lie beside the median of those around them, as by reflected signals, (N,).

    Who walks on lies on that median himself, whatever the speed; a turn bends it a little.

    Args:
        p_enu: Positions [m], (N, 3).
        t_ns: Their times [ns], increasing, (N,).
    """
    if len(t_ns) < JUMPS.around:
        return np.zeros(len(t_ns), np.bool_)
    median = median_filter(p_enu, size=(JUMPS.around, 1), mode="nearest")
    half = JUMPS.around // 2
    moved_m = np.linalg.norm(median[half:] - median[:-half], axis=1)
    speed_m_s = float(np.median(moved_m / (1e-9 * (t_ns[half:] - t_ns[:-half]))))
    beside_m = np.linalg.norm(p_enu - median, axis=1)
    beside_m[:half] = beside_m[-half:] = 0.0  # half a window is no median
    return np.asarray(beside_m > JUMPS.jump_m + JUMPS.turn_s * speed_m_s)


def receiver_clock_s(t_ns: Times, R_enu_body: Array, *, imu: ImuSamples, rig: Rig) -> float:
    """Time to be added to attitudes so that they turn when the gyroscope does [s]; 0 = none.

    Args:
        t_ns: Times of the attitudes on the rig's clock, (N,).
        R_enu_body: The attitudes, (N, 3, 3).
        imu: Samples on the rig's clock.
        rig: How the IMU is mounted.
    """
    if len(imu) < 2:
        return 0.0
    start_ns, end_ns = imu.t_ns[[0, -1]]
    reach_ns = round(1e9 * RECEIVER_CLOCK.largest_s)
    rows = np.flatnonzero(
        (np.diff(t_ns) <= RECEIVER_CLOCK.max_gap_ns)
        & (t_ns[:-1] - reach_ns >= start_ns)
        & (t_ns[1:] + reach_ns <= end_ns)
    )[: RECEIVER_CLOCK.max_turns]
    if len(rows) < RECEIVER_CLOCK.min_turns:
        return 0.0
    seen = so3_log(np.swapaxes(R_enu_body[rows], 1, 2) @ R_enu_body[rows + 1])
    at_s = (imu.t_ns - start_ns) / 1e9
    gyro = imu.gyro_rad_s @ rig.T_body_imu.R.T
    # Turns of a tenth of a second are small: their vectors add up.
    steps = 0.5 * (gyro[1:] + gyro[:-1]) * np.diff(at_s)[:, None]
    turned = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    first_s, last_s = ((t_ns[k] - start_ns) / 1e9 for k in (rows, rows + 1))

    def differ(clock_s: float) -> float:
        felt = np.column_stack(
            [
                np.interp(last_s + clock_s, at_s, axis) - np.interp(first_s + clock_s, at_s, axis)
                for axis in turned.T
            ]
        )
        off = seen - felt
        return float(np.linalg.norm(off - np.median(off, axis=0), axis=1).mean())

    grid_s = np.arange(
        -RECEIVER_CLOCK.largest_s,
        RECEIVER_CLOCK.largest_s + 0.5 * RECEIVER_CLOCK.grid_s,
        RECEIVER_CLOCK.grid_s,
    )
    errors = np.array([differ(float(clock_s)) for clock_s in grid_s])
    best = int(errors.argmin())
    clock_s = float(grid_s[best])
    inside = 0 < best < len(grid_s) - 1
    clear = errors[best] < RECEIVER_CLOCK.clearly * differ(0.0)
    return clock_s if inside and clear and abs(clock_s) >= RECEIVER_CLOCK.least_s else 0.0
