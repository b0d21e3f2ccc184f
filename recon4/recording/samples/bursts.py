"""Samples of an IMU whose stamps come in bursts: they were measured evenly.

    read in one go      stamps    42  42  42  70  70  70  [ms]      samples   22  32  42  50  60  70
    too few digits      stamps    10  10  10  40  40  40            samples   10  20  30  40  50  60

A constant may be left: the odometry finds the clock of an IMU.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.report import ImportReport
from recon4.recording.samples.tuning import BURSTS


def first_of_bursts(t_ns: Times) -> NDArray[np.intp] | None:
    """Rows of the first stamps of bursts; None = they do not come in bursts.

    Args:
        t_ns: Stamps in order, or in that of arrival, without copies [ns], (N,).
    """
    steps = np.diff(t_ns)
    ahead = steps >= 0
    going_on = steps[ahead & (steps < BURSTS.longest_ns)]
    if len(going_on) < BURSTS.fewest or not going_on.any():
        return None
    short = ahead & (steps <= BURSTS.short * np.mean(going_on))
    if np.count_nonzero(short) < BURSTS.least * len(steps):
        return None
    return np.flatnonzero(np.append(True, ~short))


def without_bursts(t_ns: Times, report: ImportReport) -> Times:
    """Times of samples as measured [ns], (N,): those of a burst share the time since the last one.

    Args:
        t_ns: Stamps in order, without copies [ns], (N,).
        report: Receives the count ``imu_in_bursts``.
    """
    first = first_of_bursts(t_ns)
    if first is None:
        return t_ns
    counts = np.diff(np.append(first, len(t_ns)))
    between_ns = np.diff(t_ns[first])
    since_ns = between_ns / counts[1:]
    usual_ns = float(np.median(since_ns))
    step_ns = np.append(usual_ns, np.minimum(since_ns, BURSTS.pause * usual_ns))
    before_end = np.repeat(first + counts - 1, counts) - np.arange(len(t_ns))
    report.count("imu_in_bursts", int(counts[counts > 1].sum()))
    digit_ns = np.gcd.reduce(between_ns)
    # Stamps with too few digits are those of the first sample of a burst, others of the last one.
    later_ns = digit_ns - usual_ns if digit_ns == np.median(between_ns) else 0.0
    shift_ns = later_ns - before_end * np.repeat(step_ns, counts)
    return np.asarray(np.repeat(t_ns[first], counts) + np.rint(shift_ns).astype(np.int64))
