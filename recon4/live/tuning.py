"""Times and limits of a capture, and from which size on an operator is warned."""

from __future__ import annotations

from msgspec import Struct


class CaptureWarningTuning(Struct, frozen=True, kw_only=True):
    """From which size on an operator is warned."""

    turn_rad_s: float = 3.0
    """Faster turns [rad/s]."""
    late_s: float = 1.5
    """A map that is later [s]."""
    low_disk_s: int = 600
    """Less time until the disk is full [s]."""
    silent_s: float = 1.5
    """Sensors that are silent for longer [s]."""
    grace_s: float = 3.0
    """No sensor is reported as silent this soon after the start."""
    max_lost: float = 0.01
    """Ratio of lost datagrams."""
    degraded_match_ratio: float = 0.4
    degraded_error_m: float = 0.08
    degraded_offset_m: float = 0.25
    """Matches below this ratio, residuals [m] and offsets of LiDARs [m] above these."""
    taken_ratio: float = 0.2
    """A stream of another address is taken for a LiDAR if it has more than this ratio of the
    packets of the largest one, as `CAPTURE_STREAMS.foreign_ratio` of the reader."""


CAPTURE_WARNINGS = CaptureWarningTuning()


class HeadlessTuning(Struct, frozen=True, kw_only=True):
    """A capture without a server."""

    report_every_s: float = 2.0
    """Time between two lines of progress [s]."""
    mapper_starts: int = 3
    """How many times the mapper is started again."""


HEADLESS = HeadlessTuning()


class ReplayTuning(Struct, frozen=True, kw_only=True):
    """Replay of a recording."""

    between_ns: int = 1_000_000
    """Time between the last datagram of a round and the first of the next [ns]."""
    ahead_ns: int = 500_000
    """Datagrams that are due within this time are sent at once [ns]."""


REPLAY = ReplayTuning()


class ScanWarningTuning(Struct, frozen=True, kw_only=True):
    """Warnings about scans."""

    least: int = 20
    """Scans of the last seconds from which parts of them are reported."""
    part: float = 0.02
    """A larger part of them that is damaged or lost is reported."""


SCAN_WARNINGS = ScanWarningTuning()


class SoFarTuning(Struct, frozen=True, kw_only=True):
    """Problems of the walk so far."""

    longest_step_s: float = 1.0
    """A longer time between two poses is an interruption, not an observation [s]."""


SO_FAR = SoFarTuning()


class StretchTuning(Struct, frozen=True, kw_only=True):
    """Stretches that findings are about."""

    step_m: float = 0.5
    """Distance between stored positions of a stretch …"""
    most_positions: int = 200
    """… and the most of one; a longer stretch goes on as another."""
    most_stretches: int = 200
    """The first ones stay: a walk with more is broken all over."""


STRETCHES = StretchTuning()


class LineClientTuning(Struct, frozen=True, kw_only=True):
    """Recorder and mapper as child processes."""

    starts_within_s: float = 60.0
    """A process that is not ready after this much time of its own has failed [s]."""
    longest_line: int = 32 << 20
    """A whole preview of 400 k points is 4 MB."""


LINE_CLIENT = LineClientTuning()


class LineServerLimits(Struct, frozen=True, kw_only=True):
    """Messages between processes."""

    max_unread_bytes: int = 16 << 20
    """A complete preview and the path of an hour are 5 MB."""
    longest_line: int = 1 << 16
    """Longest request [bytes]."""


LINE_SERVER = LineServerLimits()


class MessageTuning(Struct, frozen=True, kw_only=True):
    """Messages of the mapper."""

    max_gaps: int = 50
    """Gaps that are named."""
    plan_bytes_per_s: int = 20_000
    """Data rate of plans; a large plan is sent less often."""


MESSAGES = MessageTuning()
