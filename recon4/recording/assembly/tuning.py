"""Tuning of the assembly of multiframes."""

from __future__ import annotations

from msgspec import Struct


class AssemblyTuning(Struct, frozen=True, kw_only=True):
    """Where frames are cut (`assembler.py`)."""

    slack_ns: int = 20_000_000
    """Margin after which a sensor has passed a time, because messages of one sensor may overlap."""
    clocks_ns: int = 10_000_000_000
    """First points of two LiDARs that are farther apart are of two clocks [ns]."""
    kept_ratio: float = 0.2
    """A frame below this ratio of the usual number of points and of its time is left out, a first
    one by its number of points alone."""
    fallback_hz: float = 10.0
    """Without a rotation frames are cut this often."""
    head_points: int = 1_500_000
    short_head_ns: int = 500_000_000
    """With as many points the first frame is cut at once if the packets say how fast all LiDARs
    turn, else after this time [ns]: it is enough for a rotation by points, and a second of two
    OS1-128 with two returns takes 170 MB."""
    wait_s: float = 10.0
    """Readers may deliver several seconds of one sensor at a time."""


ASSEMBLY = AssemblyTuning()


class EvenGapTuning(Struct, frozen=True, kw_only=True):
    """Gaps that are one statement (`even_gaps.py`)."""

    least: int = 5
    uneven: float = 0.2
    """Starts and lengths differ by less than this part of the time from one to the next."""
    ends: float = 2.0
    """The first and the last are nearer than this many steps to the ends of the recording."""


EVEN_GAPS = EvenGapTuning()


class RotationTuning(Struct, frozen=True, kw_only=True):
    """How fast a LiDAR turns, by the azimuths of its points (`rotation_rate.py`)."""

    slowest_hz: float = 2.0
    fastest_hz: float = 30.0
    """Rates that are searched."""
    points: int = 3000
    """Points that are looked at."""
    longest_ns: int = 2_000_000_000
    """Points whose times are farther from the median are not of the same turns [ns]."""
    clear: float = 0.6
    """Length of the mean phasor above which the azimuth follows a rotation."""
    snap: float = 0.005
    """A rate this near to whole turns a second is that."""


ROTATION = RotationTuning()
