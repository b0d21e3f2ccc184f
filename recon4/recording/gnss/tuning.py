"""Limits of files of GNSS receivers and of their post-processing."""

from __future__ import annotations

from msgspec import Struct


class GnssFileTuning(Struct, frozen=True, kw_only=True):
    """How much of a file is read, and what tells it."""

    head_bytes: int = 64 * 1024
    """Of a file, which tell its format."""
    text_bytes: int = 1 << 30
    """Of a solution as text: a day at 20 Hz has 250 MB."""
    log_bytes: int = 512 << 20
    """Of the log of a receiver, with raw measurements."""
    sbet_bytes: int = 1 << 30
    """Of a trajectory with 17 numbers a row: ten hours at 200 Hz."""
    most_damaged: int = 20_000
    """Messages of a log with a wrong checksum: it is something else then."""
    most_damaged_head: int = 500
    """The same where a file is recognized."""
    longest_message: int = 8192
    """Of a UBX message [bytes]: raw measurements of 120 signals have half of it."""
    least_messages: int = 2
    """Whole messages that tell a log."""
    week_s: int = 604_800
    same_deg: float = 1e-6
    """A place and the same with more digits differ by less [deg]."""
    latest_ns: int = 9_000_000_000_000_000_000
    """Later times are none [ns]: they must fit into 64 bits with the hours of a time zone."""
    earliest_ns: int = 300_000_000_000_000_000
    """Earlier ones are not, either: GPS began in 1980."""
    most_weeks: int = 8000
    """Of GPS: the year 2133."""
    least_radius_m: float = 5.0e6
    """Earth-centered coordinates are longer than this [m]."""
    judged_rows: int = 200
    """Rows from which a binary trajectory is recognized."""
    longest_step_s: float = 60.0
    """Between two of these [s]."""
    fixed_m: float = 0.1
    float_m: float = 1.0
    """Horizontal standard deviations [m] below which a trajectory that states no kind of fix
    counts as fixed, and as float."""
    rms_gap_s: float = 2.0
    """Stated accuracies of a trajectory hold for this time [s]."""


GNSS_FILES = GnssFileTuning()
