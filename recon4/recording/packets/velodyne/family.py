"""Velodyne as a family of LiDARs: heads of streams, and the packets of one sensor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.distinct import distinct
from recon4.locales.coded import CodedText
from recon4.model.finding import Finding
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.family import (
    Companion,
    MessagePackets,
    PacketFamily,
    PacketFormat,
    PacketSamples,
    PacketSensor,
    Payloads,
    Recognized,
    no_sender,
)
from recon4.recording.packets.rotation_rate import Rotation
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.tuning import CLOCKS
from recon4.recording.packets.velodyne.data_packets import PacketSource, decode_packets
from recon4.recording.packets.velodyne.laser_calibration import calibration_of_file
from recon4.recording.packets.velodyne.models import (
    BLOCK_FLAG,
    DATA_PACKET,
    DATA_SIZE,
    LOWER_BLOCK_FLAG,
    MODELS,
    POSITION_SIZE,
    PRODUCTS,
    RETURN_MODES,
    STRONGEST,
    likely_model,
    models_of_interval,
    product_text,
    velodyne_model,
)
from recon4.recording.packets.velodyne.position_packets import PositionDecoder, utc_offset_ns
from recon4.recording.packets.velodyne.sound_packets import as_packets, sound_packets
from recon4.recording.packets.velodyne.wide_models import VLS128, VLS128_PRODUCT
from recon4.recording.packets.velodyne.wide_packets import WideFormat, dual_packets, sound_wide
from recon4.recording.report import ImportReport, warning
from recon4.units import HOUR_US, SECOND_NS

NAME = "Velodyne"
HDL64 = "HDL-64E"
SCAN = "velodyne_msgs/msg/VelodyneScan"


class VelodyneFamily:
    """Packets of 1206 bytes with 12 blocks, and of 512 bytes with positions."""

    name = NAME
    messages: Mapping[str, MessagePackets] = MappingProxyType(
        {
            SCAN: MessagePackets(
                definitions={
                    SCAN: "std_msgs/Header header\nvelodyne_msgs/VelodynePacket[] packets\n",
                    "velodyne_msgs/msg/VelodynePacket": (
                        "builtin_interfaces/Time stamp\nuint8[1206] data\n"
                    ),
                },
                packets=lambda scan: [_packet(packet) for packet in scan.packets],
                senders=lambda payloads: senders(payloads),
            )
        }
    )

    def describes(self, companion: Companion) -> bool:
        """The calibration of an HDL-64E; for the other models the data sheets are enough."""
        return calibration_of_file(companion) is not None

    def recognize(self, head: Datagrams, companions: Sequence[Companion]) -> Recognized | None:
        """Data packets or position packets of a Velodyne; None = neither."""
        usual = int(np.median(head.length)) if len(head) else 0
        if usual not in (DATA_SIZE, POSITION_SIZE):
            return None
        rows = np.flatnonzero(head.length == usual)
        if 2 * len(rows) <= len(head):
            return None
        payloads = head.payloads(rows, usual)
        if usual == POSITION_SIZE:
            return Recognized(
                family=NAME, kind="samples", utc_offset_ns=utc_offset_ns(head.t_ns[rows], payloads)
            )
        return _recognized_data(payloads)

    def open(self, sensor: PacketSensor) -> PacketFormat:
        """The packets of one sensor.

        Raises:
            ConfigError: If those of its model are not decoded.
        """
        wide = sensor.sensor.model in (HDL64, VLS128.name)
        return WideFormat(sensor) if wide else VelodyneFormat(sensor)

    def restamped(
        self, payloads: Payloads, shift_ns: int, companions: Sequence[Companion]
    ) -> Payloads | None:
        """Data and position packets, later; None = of another size."""
        del companions
        return restamped(payloads, shift_ns=shift_ns)


FAMILY: PacketFamily = VelodyneFamily()


def senders(payloads: Payloads) -> list[str]:
    """The models that send packets, by their product bytes; an HDL-64E has none."""
    if payloads.shape[1] != DATA_SIZE:
        return no_sender(payloads)
    flags = as_packets(payloads)["blocks"]["flag"]
    lower = flags == LOWER_BLOCK_FLAG
    hdl64 = lower.any(axis=1) & (lower | (flags == BLOCK_FLAG)).all(axis=1)
    known = {**PRODUCTS, VLS128_PRODUCT: VLS128.name}
    models = [known.get(product, f"{product:#04x}") for product in payloads[:, -1].tolist()]
    return [HDL64 if is_hdl64 else name for name, is_hdl64 in zip(models, hdl64, strict=True)]


def _packet(packet: Any) -> tuple[int, bytes]:
    return int(packet.stamp.sec) * SECOND_NS + int(packet.stamp.nanosec), packet.data.tobytes()


class _Position:
    """The packet with positions."""

    STAMP_AT = 198
    """Offset of its time [bytes]."""


def restamped(payloads: Payloads, *, shift_ns: int) -> Payloads | None:
    """Packets of one size, later by ``shift_ns``; None = of another size than Velodyne's.

    Stamps that run on past the full hour, as without GPS, stay as they are. So do the sentences of
    position packets: a shift by no whole hours takes their proof of GPS time away.
    """
    assert DATA_PACKET.fields is not None
    stamp_at = {DATA_SIZE: DATA_PACKET.fields["time_us"][1], POSITION_SIZE: _Position.STAMP_AT}
    at = stamp_at.get(payloads.shape[1])
    if at is None:
        return None
    out = payloads.copy()
    stamp_us = np.ascontiguousarray(out[:, at : at + 4]).view("<u4")[:, 0].astype(np.int64)
    later_us = np.where(stamp_us < HOUR_US, (stamp_us + shift_ns // 1000) % HOUR_US, stamp_us)
    out[:, at : at + 4] = later_us.astype("<u4").view(np.uint8).reshape(-1, 4)
    return out


class VelodyneFormat:
    """The packets of one Velodyne.

    The frame of the points is that of the sensor: x forward (azimuth 0), y left, z up, as in
    ``velodyne-decoder`` and the ROS driver. Azimuth grows clockwise seen from above.
    """

    size = DATA_SIZE
    sample_sizes = frozenset({POSITION_SIZE})
    stamps_past_hour = True

    def __init__(self, of: PacketSensor) -> None:
        """Prepare.

        Raises:
            ConfigError: If packets of its model are not decoded.
        """
        self._of, self._report = of.without_head(), of.report
        self._model = velodyne_model(of.sensor.model)
        self._mode = _first_mode(of.head)
        self._product: int | None = None
        self._positions: PositionDecoder | None = None

    @property
    def packet_s(self) -> float:
        """Time from one data packet to the next [s]."""
        return self._model.packet_s(self._mode)

    def sound(self, payloads: Payloads) -> NDArray[np.bool_]:
        """Data packets with the product byte of the first ones."""
        kept = sound_packets(payloads, self._report)
        rows = np.flatnonzero(kept)
        if not len(rows):
            return kept
        products = payloads[rows, -1]
        self._mode = int(payloads[rows[0], -2])
        if self._product is None:
            self._product = int(np.bincount(products).argmax())
            self._compare(int(np.bincount(payloads[rows, -2]).argmax()))
        same = products == self._product
        self._report.count("packets_other_product", int((~same).sum()))
        kept[rows[~same]] = False
        return kept

    def stamps_ns(self, payloads: Payloads) -> Times:
        """Microseconds past the hour, as ns."""
        return as_packets(payloads)["time_us"].astype(np.int64) * 1000

    def azimuth_cdeg(self, payloads: Payloads) -> NDArray[np.int64]:
        """Of the first block of each packet."""
        return as_packets(payloads)["blocks"]["azimuth_cdeg"][:, 0].astype(np.int64)

    def decode(self, t_ns: Times, payloads: Payloads) -> Shots:
        """Points in firing order."""
        source = PacketSource(self._of.row, self._model, self._of.settings)
        return decode_packets(t_ns, payloads, source, report=self._report)

    def likely_models(self, usual_s: float) -> tuple[str, ...]:
        """The firing sequence sets the interval."""
        return models_of_interval(usual_s, self._mode)

    def samples(self, datagrams: Datagrams, clock: SensorClock) -> PacketSamples | None:
        """Positions, and the inertial unit of an HDL-32E."""
        if self._positions is None:
            self._positions = PositionDecoder(self._of.sensor, clock=clock, report=self._report)
        rows = np.arange(len(datagrams))
        return self._positions.push(datagrams.t_ns, datagrams.payloads(rows, POSITION_SIZE))

    def _compare(self, return_mode: int) -> None:
        name = self._of.sensor.name
        if return_mode not in RETURN_MODES:
            self._report.warn(FindingKind.RETURN_MODE, sensor=name, mode=return_mode)
        if self._product is not None and self._product != self._model.product:
            self._report.warn(
                FindingKind.MODEL_CONTRADICTED,
                sensor=name,
                says=product_text(self._product),
                model=self._model.name,
            )


def _first_mode(head: Datagrams) -> int:
    rows = np.flatnonzero(head.length == DATA_SIZE)[:1]
    return int(head.payloads(rows, DATA_SIZE)[0, -2]) if len(rows) else STRONGEST


def _recognized_data(payloads: Payloads) -> Recognized | None:
    found = Recognized(family=NAME, kind="data", size=DATA_SIZE)
    if (wide := _recognized_wide(payloads)) is not None:
        return wide
    report = ImportReport()
    rows = np.flatnonzero(sound_packets(payloads, report))
    if len(rows) < len(payloads) // 2 or not len(rows):
        most = report.losses()[0]
        of = {"number": most.number, "total": len(payloads)}
        reason = CodedText("refused-count", **of, what=CodedText(f"count-{most.name}"))
        return replace(found, kind="other", refused=reason)
    packets = as_packets(payloads[rows])
    packets = packets[_longest_run(packets["time_us"].astype(np.int64) * 1000)]
    product = int(np.bincount(packets["product"]).argmax())
    return_mode = int(np.bincount(packets["return_mode"]).argmax())
    stamp_ns = packets["time_us"].astype(np.int64) * 1000
    model, findings = _model(product, return_mode, _usual_step_s(stamp_ns))
    rotation, packet_s = Rotation(), float("nan")
    if model in MODELS:
        packet_s = MODELS[model].packet_s(return_mode)
        sorted_ns, place = np.unique(stamp_ns, return_index=True)
        azimuth = packets["blocks"]["azimuth_cdeg"][place, 0].astype(np.int64)
        rotation.push(sorted_ns, azimuth, packet_s)
    return replace(
        found,
        model=model,
        mode=RETURN_MODES.get(return_mode, f"return mode {return_mode:#04x}"),
        packet_s=packet_s,
        rotation_hz=rotation.hz,
        findings=findings,
        readable_as=tuple(MODELS),
    )


def _recognized_wide(payloads: Payloads) -> Recognized | None:
    """A model whose firing takes several blocks, by the flags of most packets."""
    flags = as_packets(payloads)["blocks"]["flag"]
    if ((flags == LOWER_BLOCK_FLAG).any(axis=1) & (flags == BLOCK_FLAG).any(axis=1)).mean() <= 0.3:
        return None
    found = Recognized(family=NAME, kind="data", size=DATA_SIZE, model=HDL64, readable_as=(HDL64,))
    sound = payloads[sound_wide(payloads, VLS128, ImportReport())]
    if 2 * len(sound) <= len(payloads):
        return found
    dual = bool(np.median(dual_packets(sound, VLS128)) > 0.5)
    return replace(
        found,
        model=VLS128.name,
        mode=RETURN_MODES.get(int(sound[0, -2]), ""),
        packet_s=VLS128.packet_s(dual=dual),
        readable_as=(VLS128.name,),
    )


def _longest_run(stamp_ns: Times) -> slice:
    """The most packets in a row whose clock was not set back: later ones have the same stamps."""
    back = np.flatnonzero(np.diff(stamp_ns) < -CLOCKS.step_ns) + 1
    ends = [0, *back.tolist(), len(stamp_ns)]
    longest = int(np.argmax(np.diff(ends)))
    return slice(ends[longest], ends[longest + 1])


def _usual_step_s(stamp_ns: Times) -> float:
    steps = np.diff(distinct(stamp_ns))
    return float(np.median(steps)) / SECOND_NS if len(steps) > 4 else float("nan")


def _model(product: int, return_mode: int, interval_s: float) -> tuple[str, tuple[Finding, ...]]:
    """Name of the model and warnings; the firing pattern overrules the product byte."""
    model = likely_model(product, interval_s, return_mode)
    stated = PRODUCTS.get(product)
    found = []
    if return_mode not in RETURN_MODES:
        found.append(warning(FindingKind.RETURN_MODE, mode=return_mode))
    if model and stated != model:
        found.append(
            warning(
                FindingKind.MODEL_BY_INTERVAL,
                says=product_text(product),
                interval_ms=1e3 * interval_s,
                model=model,
            )
        )
    elif not model:
        found.append(warning(FindingKind.MODEL_UNKNOWN, product=product))
    return model or "", tuple(found)
