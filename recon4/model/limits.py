"""What a rig file may hold: whatever is beyond is a slip or an attack, and is refused by name."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class RigLimits:
    """Largest values of a rig file."""

    file_bytes: int = 128 * 1024
    """A rig file has some hundred bytes per sensor."""
    text: int = 1000
    """Characters of a text."""
    dots: int = 100
    """Parts of a dotted key."""
    number: float = 4e9
    """Clocks differ by seconds since 1970 at most; nanoseconds must fit into 64 bits."""
    sensors: int = 64
    place_m: float = 20.0
    """From the origin of the body, as for the transforms of a bag; more is another unit."""
    right_angle_rad: float = 1e-4
    """Degrees this near to a quarter or half turn in radians are radians; 1.5708 is."""
    head_deg_s: float = 3600.0
    """Rate of the head of a profiler."""
    clock_ppm: float = 10_000.0
    """Rate of a clock: quartzes are within 100, and what is beyond 1 % counts another unit."""
    baud: int = 10_000_000
    """Of a serial receiver."""
    time_terms: int = 3
    """Columns that are added to a time."""
    beams: int = 128
    """Rings are numbered in 8 bits; no LiDAR that spins has more beams."""
    beam_m: float = 0.2
    beam_deg: float = 2.0
    """Larger corrections are no errors of a beam."""


RIG_LIMITS = RigLimits()
