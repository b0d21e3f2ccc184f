"""Tuning of 2-D lasers and profilers: ranges, beams, lines."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class LaserTuning(Struct, frozen=True, kw_only=True):
    """Scans of 2-D lasers in bags (`laser2d.py`, `laser_mount.py`, `profiler_rigs.py`)."""

    shortest_reach_m: float = 3.5
    """Reach of the weakest laser [m]: a shorter range is a measurement, however often it is
    there."""
    repeated: int = 20
    """The largest range stands for "no return" if at least this many beams have it."""
    mounting_sd: float = 1e-3
    """Spread of the pose of the laser on the robot [m, rad] that is only rounding."""
    tilted_rad: float = float(np.deg2rad(5.0))
    """A laser that leans less measures distances that are right to 0.4 % [rad]; one whose plane
    turns by less stays a 2-D laser."""
    different_rad: float = float(np.deg2rad(5.0))
    """Rig file and bag contradict each other if the axes of the laser differ by more."""
    gap_s: float = 1.0
    """Scans of a 2-D laser come irregularly; shorter times between them are no gap [s]."""


LASERS = LaserTuning()


class ScanBeamTuning(Struct, frozen=True, kw_only=True):
    """Ranges and angles of the beams of a scan (`scan_messages.py`, `laser_tables.py`)."""

    longest_m: float = 1e4
    """No laser measures farther [m]."""
    shortest_m: float = 1e-3
    """A shorter range stands for none [m]."""
    scans_at_once: int = 250
    """Delivered at a time."""
    grid_scans: int = 50
    """Scans from which the usual angles of the beams are found."""
    off_grid: float = 0.3
    """Part of the angle between two beams by which one may be off its place …"""
    shifted: float = 0.05
    """… and by which those of a scan may be off on average: lasers that interlace their scans shift
    all beams by a quarter of the angle between them."""
    finer: int = 8
    """Beams at irregular angles are placed on a grid of this part of the angle between them."""
    nearest: float = 0.51
    """The nearest place is never farther than half of a step."""
    usual_reach_m: float = 30.0
    """Reach of a laser that measured nothing farther [m]."""
    max_line_s: float = 10.0
    """A line or scan of longer duration has wrong times."""
    other_unit: float = 5.0
    """Half of the ranges beyond this multiple of the longest range: they are no meters."""
    narrowest_rad: float = 1e-3
    """No laser sees less: a step between beams that gives less is none."""
    angle_max_steps: float = 1.5
    """Some drivers state the end of the last beam's place as the last angle, not its middle."""
    max_angle_rad: float = 100.0
    """Angles of more than some turns are wrong [rad]; degrees are rejected with them."""


SCAN_BEAMS = ScanBeamTuning()


class RangeUnitTuning(Struct, frozen=True, kw_only=True):
    """Ranges that are no meters (`range_units.py`)."""

    far_m: float = 60.0
    """Median range of no 2-D laser [m]: longer ones are not in meters."""
    largest_cm: float = 10_000.0
    median_cm: float = 1500.0
    """Larger ranges, or half of the ranges larger, are millimeters: 100 m and 15 m as
    centimeters."""
    far_line_m: float = 150.0
    """Median range of the first lines of no profiler on a walking person: it sees the ground
    [m]."""
    near_cm: float = 800.0
    """The nearest surfaces are a step away; farther than this, they are millimeters."""


RANGE_UNITS = RangeUnitTuning()


class ProfilerLineTuning(Struct, frozen=True, kw_only=True):
    """Lines of profilers (`line_recording.py`, `line_info.py`, `sweeps.py`)."""

    gap_ns: int = 100_000_000
    """A longer time between two lines is a gap [ns]."""
    lines_at_once: int = 64
    """Delivered at a time."""
    missing_ratio: float = 0.02
    """A larger ratio of missing lines is said."""
    apart_ns: int = 100_000_000
    """A pause within a sweep is the end of it [ns]."""


LINES = ProfilerLineTuning()


class ScanDatagramTuning(Struct, frozen=True, kw_only=True):
    """Scans as datagrams, and their clocks (`scan_datagrams.py`, `scan_capture.py`)."""

    bytes: int = 65_000
    """Largest datagram that is stored with its headers in a capture file."""
    reserved_bytes: int = 400
    """Of them for what stands around the ranges."""
    jump_ns: int = 500_000_000
    """A step of a sensor's clock that differs by this from that of the recorder is a jump [ns]."""
    other_clock_ns: int = 1_000_000_000
    """A sensor whose times differ by more from those of the recorder has another clock [ns]."""


SCAN_DATAGRAMS = ScanDatagramTuning()
