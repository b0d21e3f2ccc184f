"""Tuning of the packets of Velodyne."""

from __future__ import annotations

from msgspec import Struct

from recon4.units import SECOND_NS


class PositionTuning(Struct, frozen=True, kw_only=True):
    """Position packets."""

    longest_age_ns: int = 5 * SECOND_NS // 2
    """A sentence tells the last full second and stays in the packets until the next one comes."""
    judged: int = 100
    """Position packets whose majority decides whether GPS drives a clock: single ones are
    damaged."""


POSITIONS = PositionTuning()


class WidePacketTuning(Struct, frozen=True, kw_only=True):
    """Packets of VLS-128 and HDL-64E."""

    most_cdeg: int = 1000
    """A block that turned by more since the last one belongs to another revolution."""
    s3_least_us: float = 316.8
    """Packets of an S2 come every 288 µs, of an S3 every 345.6 µs; of two returns in half of it."""


WIDE_PACKETS = WidePacketTuning()
