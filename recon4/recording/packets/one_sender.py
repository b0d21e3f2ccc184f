"""Whether packets that are taken for those of one sensor are of two that nothing tells apart.

Two sensors of one model in one topic, or behind one address, would give one cloud with each thing
twice. Three things show it, none of which needs a clock that the two share.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.recording.clocks.stamps import strays
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.family import PacketFormat, PacketSensor, Payloads
from recon4.recording.packets.tuning import MIXED_SENDERS


@dataclass(frozen=True, slots=True, eq=False)
class _Arrivals:
    """The first packets of a sensor in the order of their arrival."""

    layout: PacketFormat
    payloads: Payloads
    stamps_ns: NDArray[np.int64]
    """Of each packet [ns], (N,)."""

    @property
    def steps_ns(self) -> NDArray[np.int64]:
        """From the stamp of each packet to that of the next [ns], (N - 1,)."""
        return np.diff(self.stamps_ns)


def require_one_sender(layout: PacketFormat, of: PacketSensor) -> None:
    """Check the first packets of a sensor.

    Args:
        layout: Of the sensor; takes no part in reading.
        of: The sensor.

    Raises:
        ConfigError: If they are of two sensors.
    """
    head = _head(layout, of.head)
    if head is None:
        return
    why = _goes_back(head) or _turns_to_and_fro(head) or _comes_too_often(head)
    if why:
        raise ConfigError(
            CodedText("packets-mixed", source=of.sensor.topic or of.sensor.name, why=why)
        )


def _head(layout: PacketFormat, datagrams: Datagrams) -> _Arrivals | None:
    rows = np.flatnonzero(datagrams.length == layout.size)
    payloads = _without_copies(datagrams.payloads(rows, layout.size))
    payloads = payloads[layout.sound(payloads)]
    if len(payloads) < MIXED_SENDERS.fewest:
        return None
    stamps_ns = layout.stamps_ns(payloads)
    kept = ~strays(stamps_ns)  # a damaged stamp is not that of another sensor
    return _Arrivals(layout, payloads[kept], stamps_ns[kept])


def _without_copies(payloads: Payloads) -> Payloads:
    """Packets that were recorded twice, as in bags that were merged, once."""
    whole = np.ascontiguousarray(payloads).view(f"V{payloads.shape[1]}")[:, 0]
    first = {one: row for row, one in reversed(list(enumerate(whole.tolist())))}
    return payloads[sorted(first.values())]


def _goes_back(head: _Arrivals) -> str:
    """Two sensors in turns: each message begins before the one ahead of it ends."""
    steps_ns = head.steps_ns
    usual_ns = max(1.0, float(np.median(np.abs(steps_ns))))
    back = int((steps_ns < -MIXED_SENDERS.back_steps * usual_ns).sum())
    return f"their times go back {back} times" if back >= MIXED_SENDERS.times_back else ""


def _turns_to_and_fro(head: _Arrivals) -> str:
    """Two sensors packet by packet: from each direction to that of the other.

    One sensor turns evenly in the order of arrival, or in that of its times where a network
    delivers its packets in another.
    """
    azimuth_cdeg = head.layout.azimuth_cdeg(head.payloads)
    if azimuth_cdeg is None:
        return ""
    stamps_ns = head.stamps_ns
    in_time = np.argsort(stamps_ns, kind="stable")
    orders = (np.arange(len(in_time)), in_time)
    even = max(_evenness(azimuth_cdeg[order], stamps_ns[order]) for order in orders)
    return "their directions jump to and fro" if even < MIXED_SENDERS.even else ""


def _evenness(azimuth_cdeg: NDArray[np.int64], stamps_ns: NDArray[np.int64]) -> float:
    """Part of the steps from packet to packet that turn as far as their time says.

    A step over lost packets turns as many times as far, and is even as well.
    """
    steps_cdeg, steps_ns = np.diff(azimuth_cdeg) % 36000, np.diff(stamps_ns)
    usual_cdeg, usual_ns = float(np.median(steps_cdeg)), float(np.median(steps_ns))
    times = steps_ns / usual_ns if usual_ns > 0.0 else np.ones(len(steps_ns))
    off_cdeg = (steps_cdeg - times * usual_cdeg + 18000.0) % 36000.0 - 18000.0
    most_cdeg = max(MIXED_SENDERS.even_ratio * usual_cdeg, MIXED_SENDERS.even_cdeg)
    return float(np.mean(np.abs(off_cdeg) <= most_cdeg))


def _comes_too_often(head: _Arrivals) -> str:
    """More packets than one sensor sends, at an interval of no model."""
    steps_ns = head.steps_ns
    forward = steps_ns[steps_ns > 0]
    if 2 * len(forward) < len(steps_ns):
        return ""
    usual = forward[forward < MIXED_SENDERS.gap * np.median(forward)]
    mean_s = 1e-9 * float(usual.sum()) / len(steps_ns)
    often = head.layout.packet_s / mean_s if mean_s > 0 else 0.0
    if not often > MIXED_SENDERS.often or head.layout.likely_models(mean_s):
        return ""
    return f"they come {often:.1f} times as often as those of one"
