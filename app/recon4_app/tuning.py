"""Times and limits of log, sweeps, figures and copies of the server."""

from __future__ import annotations

from msgspec import Struct


class LogLimits(Struct, frozen=True, kw_only=True):
    """The log of the server."""

    max_log_bytes: int = 50_000_000
    """A longer log is rotated."""
    kept_logs: int = 10
    """A log is at most this many files of `max_log_bytes`."""
    repeats_a_minute: int = 20
    """Records of one kind written within a minute; the others are counted."""
    records_a_minute: int = 200
    """Records of one logger written within a minute, of whatever kind."""
    max_message_chars: int = 4000
    """Longest message."""
    max_kinds: int = 1000
    """Kinds of records that are remembered; beyond that the least recently used are forgotten."""


LOGS = LogLimits()


class MaintenanceTimes(Struct, frozen=True, kw_only=True):
    """Sweeps and rotation."""

    maintenance_interval_s: float = 3600.0
    """Time between two sweeps [s]."""
    log_rotation_interval_s: float = 20.0
    """Interval of checking the logs of workers, viewers and captures [s]."""


MAINTENANCE = MaintenanceTimes()


class MetricsTuning(Struct, frozen=True, kw_only=True):
    """Figures for Prometheus."""

    buckets_s: tuple[float, ...] = (
        0.005,
        0.01,
        0.025,
        0.05,
        0.1,
        0.25,
        0.5,
        1.0,
        2.5,
        5.0,
        10.0,
        30.0,
    )
    """Upper ends of the buckets of durations [s]."""


METRICS = MetricsTuning()


class MetricsTokenTuning(Struct, frozen=True, kw_only=True):
    """The key to the figures."""

    token_bytes: int = 32
    """Random bytes of a key."""


METRICS_TOKEN = MetricsTokenTuning()


class RigFileTimes(Struct, frozen=True, kw_only=True):
    """Rig files of users."""

    limit_s: float = 20.0
    """A rig file that takes longer to parse is rejected [s]; it has at most 128 KiB."""


RIG_FILE_TIMES = RigFileTimes()


class RoomTuning(Struct, frozen=True, kw_only=True):
    """Space on the disk."""

    little_room: float = 0.1
    """Free fraction of the disk below which a notice is shown."""


ROOM = RoomTuning()


class StateCopyLimits(Struct, frozen=True, kw_only=True):
    """Copies of the state of the server."""

    max_copies: int = 7
    """Copies that are kept."""


STATE_COPIES = StateCopyLimits()
