"""Tuning of audits of the GNSS receiver: antenna and clocks."""

from __future__ import annotations

from msgspec import Struct


class AntennaAuditTuning(Struct, frozen=True, kw_only=True):
    """Lever arm and clock against the trajectory."""

    drift_m: float = 0.01
    """Random walk of the drift [m/sqrt(s)]: of the trajectory and of the slow error of GNSS."""
    drift_rad: float = 5e-4
    """The same of attitudes [rad/sqrt(s)]."""
    min_sd_m: float = 0.008
    """No fix has a smaller white error [m]."""
    sd_rad: float = 7e-4
    """White error of the attitudes of an INS [rad]; residuals that are larger raise it."""
    max_sd_m: float = 0.1
    """Fixes with a larger stated standard deviation are not used [m]."""
    speed_ns: int = 50_000_000
    """Rates are measured over this time before and after a fix [ns]."""
    credible_s: float = 1.0
    """A larger error of the clock than the shape of the walk shows is one of the trajectory:
    nothing can be compared [s]."""
    relinearized: int = 3
    """How many times the fixes are shifted by the clock: a body sways within 100 ms."""
    min_fixes: int = 50
    """Fewer fixes are not compared."""
    sigmas: float = 4.5
    """An estimate that differs by fewer standard deviations agrees with the rig file."""
    sd_factor: float = 1.5
    """True errors of the estimate against the stated ones, on 32 walks with a drift of 5
    mm/sqrt(s)."""
    unknown_m: float = 0.05
    """With a larger standard deviation the walk says nothing of a lever arm [m]."""
    lever_arm_m: float = 0.05
    clock_s: float = 0.02
    """Smaller errors are not announced."""


ANTENNA_AUDIT = AntennaAuditTuning()


class AntennaCalibrationTuning(Struct, frozen=True, kw_only=True):
    """Calibration of the antenna, checked on fixes that were not used."""

    block_ns: int = 8_000_000_000
    """Every second stretch of this length is not used by the first estimate, but checks it [ns]."""
    tolerance: tuple[float, ...] = (0.02, 0.02, 0.02, 0.002)
    """Smaller changes of lever arm [m] and clock [s] are no reason to calibrate, (4,)."""
    observable_sd: tuple[float, ...] = (0.01, 0.01, 0.01, 0.001)
    """With a larger standard deviation a parameter counts as not observable, (4,)."""
    known_error: tuple[float, ...] = (0.05, -0.05, 0.05, 0.02)
    """Wrong values that are put in on purpose; an estimate that does not find them proves
    nothing."""
    better: float = 0.99
    """Ratio of what is not explained, after against before."""
    sigmas: float = 3.0
    certain_sigmas: float = 4.5
    """A change of fewer standard deviations may be noise, and one of fewer than this is not
    certain."""


ANTENNA_CALIBRATION = AntennaCalibrationTuning()


class DriftFitTuning(Struct, frozen=True, kw_only=True):
    """A constant and a clock hidden by a slow drift."""

    knot_s: float = 2.0
    """The drift is linear between knots this far apart [s]."""
    cauchy_sd: float = 3.0
    """Residual in standard deviations at which a measurement has half its weight."""
    rounds: int = 8
    """Number of solutions with new weights."""
    lags: int = 30
    """Longest lag of the residuals' correlation, in measurements."""
    prior: float = 1e-6
    """Information of every unknown, so that all are determined."""


DRIFT_FIT = DriftFitTuning()


class FixClockTuning(Struct, frozen=True, kw_only=True):
    """A clock of the fixes that is wrong by seconds."""

    step_ns: int = 500_000_000
    """Displacements over this time are compared [ns]."""
    gap_ns: int = 1_500_000_000
    """Displacements across longer gaps between fixes are not compared: the path there is
    unknown."""
    least_s: float = 0.5
    """Smaller errors are left to the audit [s]."""
    gross: float = 2.0
    """Larger displacements than this multiple of the 95th percentile are gross errors of a fix."""
    clearly: float = 0.25
    """The tracks at the clock that is found differ by less than this ratio of those at the
    stamps."""
    largest_s: float = 30.0
    grid_s: float = 0.25
    """Largest error that is searched for, and the step of the search [s]."""
    min_steps: int = 30
    min_overlap: float = 0.5
    """Displacements that both tracks must have: their number, and their ratio of all."""


FIX_CLOCK = FixClockTuning()


class ReceiverClockTuning(Struct, frozen=True, kw_only=True):
    """The clock of a GNSS/INS against that of the IMU."""

    largest_s: float = 0.5
    """Largest error that is searched for [s]."""
    grid_s: float = 0.005
    """Step of the search [s]."""
    least_s: float = 0.03
    """A smaller error of the clock does not bend the odometry, and the IMU has one, too."""
    max_gap_ns: int = 300_000_000
    """Turns between attitudes farther apart are not compared [ns]."""
    clearly: float = 0.5
    """The turns at the clock that is found differ by less than this ratio of those at the
    stamps."""
    min_turns: int = 50
    max_turns: int = 3000
    """Smallest and largest number of turns that are compared."""


RECEIVER_CLOCK = ReceiverClockTuning()
