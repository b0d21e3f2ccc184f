"""Tuning of the packets of LiDARs: what is looked at, clocks, order, losses."""

from __future__ import annotations

from msgspec import Struct

from recon4.units import SECOND_NS


class PacketHeadTuning(Struct, frozen=True, kw_only=True):
    """How much at the beginning of a sensor's packets tells what they are."""

    packets: int = 200
    """Packets that are compared with the layouts and sums of a family."""
    bytes: int = 8 << 20
    """Of the first packets of a sensor, which its family looks at to prepare the decoder: more than
    a second of most LiDARs, in which some send all that packets say of their lasers."""
    scanned_bytes: int = 64 << 20
    """Of a file, in which the senders are looked for."""
    timed: int = 1000
    """Datagrams from which the times of a file are estimated."""
    samples: int = 20
    """Datagrams of a sender that may be those of an IMU or a GNSS receiver."""


HEAD = PacketHeadTuning()


class CaptureTuning(Struct, frozen=True, kw_only=True):
    """Sensors of one capture file."""

    wait_s: float = 1.0
    """A sensor that is silent for this time no longer delays the others' frames: datagrams are read
    in the order of arrival, one slot at a time (`in_slots`)."""
    foreign_ratio: float = 0.2
    """A stream with fewer packets than this ratio of the largest one belongs to no sensor of the
    rig, unless its port (and address) matches one."""


CAPTURE_STREAMS = CaptureTuning()


class ClockTuning(Struct, frozen=True, kw_only=True):
    """The clock of a sensor against that of the recorder (`sensor_clock.py`)."""

    same_clock_ns: int = SECOND_NS // 2
    """A sensor that is this near to the recorder's clock is synchronized with it."""
    jump_ns: int = SECOND_NS
    """Clocks that move against each other by more than this have jumped."""
    step_ns: int = 100_000_000
    """Stamps that step by more than this while packets arrive evenly are a jump, too [ns]; a
    network delivers packets with less delay, a receiver that finds its PPS sets any time."""
    even_ns: int = 20_000_000
    late_ns: int = 3 * SECOND_NS
    back_ns: int = 200_000_000
    """Packets that are early or late by one amount, within the first, for the second show a jump
    of the recorder's clock by more than a step; for the third if they arrived before earlier ones
    [ns]."""
    first: int = 500
    """Packets of the first batch from which the offset of the clocks is measured."""
    confirm: int = 8
    """Packets that must agree on a jump; fewer count as damaged packets and are dropped."""
    block: int = 64
    """Packets between two comparisons of the clocks, however the packets arrive."""
    pause_ns: int = 60 * SECOND_NS
    """A packet that comes within this time, but is off by whole hours, shows a jump [ns]."""
    track_ns: int = 10 * SECOND_NS
    """The rate of the clocks is measured over this time [ns]."""
    max_rate: float = 2e-4
    """Two free-running quartz clocks differ by less than this."""
    counter_us: int = 1 << 32
    """Where a counter that does not start again at the full hour does so [µs]: after 4294.97 s."""


CLOCKS = ClockTuning()


class PacketOrderTuning(Struct, frozen=True, kw_only=True):
    """Packets that come late (`packet_order.py`)."""

    set_back_ns: int = 1_000_000_000
    """Packets so far behind the ones before are not late: the clocks were set back together."""
    stragglers: int = 8
    """Fewer packets in a row are late all the same."""
    together_ns: int = 250_000_000
    """That many which arrive this much earlier than the one before, as their times say, are not
    late: it is beyond the window in which late ones are sorted [ns]."""


PACKET_ORDER = PacketOrderTuning()


class PacketHoleTuning(Struct, frozen=True, kw_only=True):
    """Packets that never came, and fields of view (`packet_holes.py`)."""

    probed: int = 100
    """Steps whose median is the usual one."""
    longest_s: float = 1.0
    """A longer pause is a gap in the data, which is said elsewhere [s]."""
    revolution_ns: tuple[int, int] = (40_000_000, 450_000_000)
    """Time between two holes of one field of view: sensors turn 5 to 20 times a second [ns]."""
    least_packets: int = 3
    """Single packets get lost; a field of view leaves out more."""
    same_cdeg: int = 1200
    same_packets: int = 2
    """A packet covers up to 10 degrees: the edge of the view lies somewhere inside of it."""
    confirm: int = 3
    """Holes in a row that must be alike."""


HOLES = PacketHoleTuning()


class SlotTuning(Struct, frozen=True, kw_only=True):
    """Datagrams that are decoded at once (`slots.py`)."""

    slot_ns: int = 100_000_000
    """Of the recorder's clock."""
    part_ns: int = 25_000_000
    """Of a slot, whose points are made at once: they wait until all are in a frame."""
    first_ns: int = 1_000_000_000
    """The first slot is longer, because the clocks of the sensors are compared in it."""
    bytes: int = 24 << 20
    """Of a slot, at most; the first second of two VLP-16 has 2 MB, that of an OS1-128 with 2048
    columns and two returns 42 MB."""
    set_back_ns: int = 2_000_000_000
    """A datagram this far before the end of its slot means that the clock was set back."""


SLOTS = SlotTuning()


class MixedSenderTuning(Struct, frozen=True, kw_only=True):
    """When packets are taken for those of two sensors (`one_sender.py`).

    Of 16 real recordings of one sensor none goes back, at least 98.9 % of the steps are even, and
    packets come 0.99 to 1.01 times as often as they should.
    """

    fewest: int = 100
    """Fewer packets show nothing."""
    back_steps: float = 10.0
    """Steps back by this many usual steps; packets that the network has swapped go back less."""
    times_back: int = 2
    """As often; a clock that is set goes back once, as does one that starts again at the hour."""
    even_ratio: float = 0.5
    even_cdeg: float = 30.0
    """Steps of the azimuth are even within this ratio of the usual one, or this angle [0.01°]."""
    even: float = 0.7
    """Part of the steps of one sensor that is even, at least: half of those of two are."""
    often: float = 1.6
    """Packets come as many times as often as those of one sensor."""
    gap: float = 5.0
    """Longer steps than this many usual ones are gaps."""


MIXED_SENDERS = MixedSenderTuning()
