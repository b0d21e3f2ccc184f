"""Times and limits of live captures."""

from __future__ import annotations

from msgspec import Struct


class CaptureLimits(Struct, frozen=True, kw_only=True):
    """Live captures."""

    mapper_starts: int = 5
    """Starts of a mapper that keeps dying; then only the recording continues."""


CAPTURES = CaptureLimits()


class MarkLimits(Struct, frozen=True, kw_only=True):
    """Marks of a capture."""

    max_marks_bytes: int = 16 << 20
    """Largest file of marks."""


MARKS = MarkLimits()


class PhoneStreamTuning(Struct, frozen=True, kw_only=True):
    """The stream to a phone."""

    shown_every_s: float = 0.05
    """Shortest time between two messages to a phone …"""
    still_here_s: float = 2.0
    """… and the longest."""
    stalled_s: float = 30.0
    """A phone that receives nothing for this long is disconnected; it reconnects by itself."""
    bytes_a_second: int = 220_000
    """Data rate per phone, 1.8 Mbit/s: the newest messages go first, points get the rest …"""
    bytes_at_first: int = 420_000
    """… after an initial burst of 60 000 points."""


PHONE_STREAM = PhoneStreamTuning()


class PowerTuning(Struct, frozen=True, kw_only=True):
    """The battery of the machine."""

    read_every_s: float = 15.0
    """It is read this often [s]."""
    low_s: float = 900.0
    low_charge: float = 0.15
    """Below this remaining time [s] or charge a person is warned."""
    critical_s: float = 300.0
    critical_charge: float = 0.06
    """Below this remaining time [s] or charge the warning is an error."""


POWER = PowerTuning()


class LiveRigLimits(Struct, frozen=True, kw_only=True):
    """Rigs that are offered."""

    max_files: int = 100
    """Most files …"""
    largest_bytes: int = 1 << 17
    """… and the largest of them."""


LIVE_RIGS = LiveRigLimits()


class StreamTuning(Struct, frozen=True, kw_only=True):
    """What a stream sends."""

    points_at_once: int = 20_000
    """Points per message: 140 kB, so that the map grows steadily on a slow phone."""
    bytes_a_point: int = 7
    """Bytes of a point."""
    located_within_ns: int = 10_000_000_000
    """A mark appears without a position if the mapping does not reach its time within this."""
    path_step_m: float = 0.25
    """Distance between stored points of the path; an hour's walk has a few thousand."""
    track: int = 6000
    """Poses kept to locate marks: ten minutes, longer than typing a note takes."""


STREAM = StreamTuning()
