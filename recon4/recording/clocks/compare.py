"""Compares the clocks of IMU, GNSS and LiDARs by when their messages were recorded.

A bag and a capture hold two times of a message: its stamp, and when it was recorded. Where the
stamps of two sensors lag behind by different amounts, their clocks differ.
"""

from __future__ import annotations

import numpy as np

from recon4.model.count_meanings import FREE_CLOCK
from recon4.model.finding_kinds import FindingKind
from recon4.recording.clocks.names import known_offset_s, offset_values
from recon4.recording.clocks.tuning import CLOCK_COMPARE
from recon4.recording.report import ImportReport

LIDAR, IMU_CLOCK, GNSS_CLOCK, JOINT = "LiDAR", "IMU", "GNSS", "joint"


def clock_offset_s(what: str, report: ImportReport) -> float:
    """How far the stamps of IMU or GNSS are ahead of the LiDARs' [s]; NaN = not known."""
    lags_s = [np.array(report.lags_ns.get(name, ())) * 1e-9 for name in (LIDAR, what)]
    least, steady_s = CLOCK_COMPARE.least, CLOCK_COMPARE.steady_s
    if any(len(lag) < least or _spread(lag) > steady_s for lag in lags_s):
        return float("nan")
    return float(np.median(lags_s[0]) - np.median(lags_s[1]))


def is_same_clock(what: str, rig_offset_s: float, report: ImportReport) -> bool:
    """Whether samples are on the clock of the LiDARs; if not, a warning says the remedy.

    Args:
        what: `IMU_CLOCK` or `GNSS_CLOCK`.
        rig_offset_s: What the rig file adds to their times [s].
        report: Has the lags, and receives the warning.
    """
    measured_s = clock_offset_s(what, report)
    ahead_s = measured_s + rig_offset_s
    if not abs(ahead_s) > CLOCK_COMPARE.other_s:
        return True
    exact_s = known_offset_s(measured_s)
    report.warn(
        FindingKind.CLOCK_FOREIGN,
        what=what,
        table=what.lower(),
        offset_s=-exact_s,
        exact=exact_s != measured_s,
        measured=exact_s == measured_s,
        **offset_values(ahead_s),
    )
    return False


def warn_of_free_clocks(report: ImportReport, *, imu_file: bool) -> None:
    """Warn of a LiDAR without GPS if its IMU may be on another clock; call if there is an IMU.

    Times of such a LiDAR are those of arrival at the recorder. An IMU of its own, or one whose
    stamps lag behind like the LiDAR's, is on the same clock.

    Args:
        report: Has the lags and the count `FREE_CLOCK`, and receives the warning.
        imu_file: Whether the samples are those of a file, which has no times of recording.
    """
    free = [name.removeprefix(FREE_CLOCK) for name in report.counts if name.startswith(FREE_CLOCK)]
    if not free or (not imu_file and IMU_CLOCK not in report.lags_ns):
        return
    offset_s = float("nan") if imu_file else clock_offset_s(IMU_CLOCK, report)
    if abs(offset_s) < CLOCK_COMPARE.travel_s:
        return
    report.warn(
        FindingKind.CLOCK_FREE_IMU,
        sensors=", ".join(free),
        unknown=bool(np.isnan(offset_s)),
        **offset_values(offset_s),
    )


def note_lidar_lag(sensor: str, lag_ns: int, report: ImportReport) -> None:
    """Remember how long after its last point a message of a LiDAR was recorded [ns]."""
    report.note_lag(LIDAR, lag_ns)
    report.note_lag(f"{LIDAR} {sensor}", lag_ns)


def warn_of_lidar_clocks(report: ImportReport) -> None:
    """Warn of LiDARs of one recording whose clocks differ; call once the lags are known.

    Args:
        report: Has the lags, and receives the warning.
    """
    first, *others = [what for what in report.lags_ns if what.startswith(f"{LIDAR} ")] or [""]
    for what in others:
        lags_s = [np.array(report.lags_ns[name]) * 1e-9 for name in (first, what)]
        ahead_s = float(np.median(lags_s[0]) - np.median(lags_s[1]))
        least_s = max(CLOCK_COMPARE.lidars_s, 2.0 * max(map(_spread, lags_s)))
        if min(map(len, lags_s)) >= CLOCK_COMPARE.least and abs(ahead_s) > least_s:
            report.warn(
                FindingKind.CLOCK_LIDARS,
                sensor=what.removeprefix(f"{LIDAR} "),
                other=first.removeprefix(f"{LIDAR} "),
                offset_s=-known_offset_s(ahead_s),
                **offset_values(ahead_s),
            )


def warn_of_other_joint_clock(joint: str, report: ImportReport) -> None:
    """Warn of a joint whose poses are not on the clock of the sensor that it moves.

    Args:
        joint: What moves, for people.
        report: Has the lags, and receives the warning.
    """
    ahead_s = clock_offset_s(JOINT, report)
    if abs(ahead_s) > CLOCK_COMPARE.joint_s:
        report.warn(FindingKind.JOINT_CLOCK, joint=joint, **offset_values(ahead_s))


def _spread(lag_s: np.ndarray) -> float:
    low, high = np.percentile(lag_s, [10.0, 90.0])
    return float(high - low)
