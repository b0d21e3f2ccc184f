"""Tuning of the packets and files of Livox."""

from __future__ import annotations

from msgspec import Struct


class LivoxPacketTuning(Struct, frozen=True, kw_only=True):
    """What no packet exceeds, and what files leave out."""

    longest_interval: int = 100_000
    """A packet is filled within 10 ms [0.1 µs]; usual are 0.2 to 0.5 ms."""
    rounding_m: float = 1e-5
    """So that a limit of 100 m keeps 100000 mm."""
    imu_interval: int = 50_000
    """Of packets that are written: 200 Hz [0.1 µs]."""


LIVOX_PACKETS = LivoxPacketTuning()


class LivoxModelTuning(Struct, frozen=True, kw_only=True):
    """Models that shoot alike differ by half of their view (`recognition.py`)."""

    alike: float = 0.15
    """Intervals of one model differ by less than this ratio; those of two by more."""
    wide_deg: float = 37.0
    high_deg: float = 14.0
    tele_deg: float = 9.5
    """A Horizon sees 40.9° to the sides and 12.6° up, an Avia 35.2° and 38.6°, a Tele-15 7.3° and
    8.1°."""
    mid_40_deg: float = 21.0
    hap_deg: float = 43.0
    """A Mid-40 sees 19.2° around its axis, a Mid-70 35.2°; a HAP 60° to the sides."""
    enough_points: int = 20_000
    """From which the view is known: 0.1 s."""


LIVOX_VIEWS = LivoxModelTuning()


class LvxTuning(Struct, frozen=True, kw_only=True):
    """Clocks of the devices in a file of Livox Viewer."""

    same_clock_ns: int = 1_000_000_000
    """Devices whose stamps agree within this time share a clock."""
    longest_pause_ns: int = 60_000_000_000
    """Stamps that leap farther are those of another clock."""


LVX = LvxTuning()
