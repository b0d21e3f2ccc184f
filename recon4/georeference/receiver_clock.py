"""The clock of a GNSS/INS against that of the IMU: both feel the body turn.

The attitudes aid the odometry while it runs. In a turn a clock 100 ms off makes a heading of them
that is wrong by 10°, and the odometry bends. The sway of a person, or the turns of a vehicle, show
the clock before: the gyroscope measures every turn between two attitudes, at another time.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array, so3_log
from recon4.georeference.tuning_clocks import RECEIVER_CLOCK
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times


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
