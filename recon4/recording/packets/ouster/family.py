"""Ouster: OS0, OS1, OS2 and OSDome."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from msgspec.structs import replace as replace_fields
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.distinct import distinct
from recon4.locales.coded import CodedText, joined
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Finding
from recon4.model.finding_kinds import FindingKind
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.family import (
    Companion,
    MessagePackets,
    PacketFamily,
    PacketFormat,
    PacketSensor,
    Payloads,
    Recognized,
    stamp_ns,
)
from recon4.recording.packets.ouster.columns import column_step_ns, columns_of, sound_columns
from recon4.recording.packets.ouster.data_packets import OusterPackets, checksums, turning_of
from recon4.recording.packets.ouster.imu_packets import imu_samples_in, is_known_packet, sound_imu
from recon4.recording.packets.ouster.layouts import (
    CHECKSUM_BYTES,
    HEADER_BYTES,
    IMU_SAMPLE,
    LEGACY_IMU,
    NMEA_BYTES,
    USUAL_LAYOUTS,
    PacketLayout,
)
from recon4.recording.packets.ouster.metadata import is_metadata
from recon4.recording.packets.ouster.metadata_choice import (
    ChosenMetadata,
    MetadataFiles,
    choose,
    find_metadata,
    header_serials,
    layout_fits,
    missing_text,
    parts_by_sensor,
    sound_head,
    usual_serial,
)
from recon4.recording.packets.tuning import HEAD
from recon4.recording.report import warning

_NAME = "Ouster"
UNKNOWN = _NAME
"""Model of a sensor of which nothing states what it is."""


def restamped(
    payloads: Payloads, companions: Sequence[Companion], *, shift_ns: int
) -> Payloads | None:
    """Packets of one size, later by ``shift_ns``; unsound ones as they are.

    Args:
        payloads: Points or inertial samples, (N, size).
        companions: Files beside the recording; usual layouts need no metadata.
        shift_ns: Added to all times that are set [ns].

    Returns:
        The packets, (N, size); None = most are not of an Ouster.
    """
    if imu_samples_in(payloads.shape[1]):
        return _samples(payloads, shift_ns)
    known = [found.layout for found in find_metadata(companions).metadata]
    for layout in (*known, *USUAL_LAYOUTS):
        if layout.size == payloads.shape[1]:
            sound = sound_columns(layout, payloads)
            if 2 * sound.sum() > len(payloads):
                return _columns(layout, payloads, sound, shift_ns=shift_ns)
    return None


def _columns(
    layout: PacketLayout, payloads: Payloads, sound: NDArray[np.bool_], *, shift_ns: int
) -> Payloads:
    later = np.ascontiguousarray(payloads[sound])
    stamp_ns = layout.records(later)["columns"]["stamp_ns"]
    _shift(stamp_ns, shift_ns)
    return _with_sums(payloads, sound, later, summed=layout.profile.has_header)


def _samples(payloads: Payloads, shift_ns: int) -> Payloads | None:
    sound = sound_imu(payloads)
    if 2 * sound.sum() <= len(payloads):
        return None
    later = np.ascontiguousarray(payloads[sound])
    is_legacy = payloads.shape[1] == LEGACY_IMU.itemsize
    if is_legacy:
        packets = later.view(LEGACY_IMU)[:, 0]
        for name in ("sent_ns", "accel_ns", "gyro_ns"):
            _shift(packets[name], shift_ns)
    else:
        inner = later[:, HEADER_BYTES + NMEA_BYTES : -HEADER_BYTES]
        samples = np.ascontiguousarray(inner).view(IMU_SAMPLE)
        _shift(samples["t_ns"], shift_ns)
        inner[:] = samples.view(np.uint8).reshape(inner.shape)
    return _with_sums(payloads, sound, later, summed=not is_legacy)


def _shift(t_ns: NDArray[np.uint64], shift_ns: int) -> None:
    """Shift times in place; zeros, which are no times, and what would be before zero stay."""
    later = t_ns.astype(np.int64) + shift_ns
    t_ns[...] = np.where((t_ns == 0) | (later < 0), t_ns, later.astype(np.uint64))


def _with_sums(
    payloads: Payloads, sound: NDArray[np.bool_], later: Payloads, *, summed: bool
) -> Payloads:
    """All packets; the changed ones have a right sum if they had one."""
    out = payloads.copy()
    if summed:
        stated = np.ascontiguousarray(later[:, -CHECKSUM_BYTES:]).view("<u8")[:, 0]
        right = stated == checksums(payloads[sound])
        total = checksums(later[right]).astype("<u8").view(np.uint8)
        later[right, -CHECKSUM_BYTES:] = total.reshape(-1, CHECKSUM_BYTES)
    out[sound] = later
    return out


_SIZES_WITHOUT_HEADER = frozenset(one.size for one in USUAL_LAYOUTS if not one.profile.has_header)


def packets_of_message(message: Any) -> list[tuple[int, bytes]]:
    """The packet in a message; LEGACY drivers send one spare byte, and all sizes are even."""
    packet = bytes(message.buf)
    header = getattr(message, "header", None)
    t_ns = stamp_ns(header) if header is not None else 0
    return [(t_ns, packet[: len(packet) & ~1])]


def senders(payloads: Payloads) -> list[str]:
    """The serial numbers in the headers; of packets without one, their size tells sensors apart."""
    size = payloads.shape[1]
    if size in _SIZES_WITHOUT_HEADER:
        return [f"{size} bytes"] * len(payloads)
    return [str(number) if number > 0 else "" for number in header_serials(payloads).tolist()]


_PACKAGES = ("ouster_ros", "ouster_msgs", "ouster_sensor_msgs")
"""Of the drivers for ROS 1, early and later ROS 2."""
_MESSAGES = {
    name: MessagePackets(
        {name: "uint8[] buf\n"},
        packets_of_message,
        senders=senders,
        versions=({name: "std_msgs/Header header\nuint8[] buf\n"},),
    )
    for name in (f"{package}/msg/PacketMsg" for package in _PACKAGES)
}


class OusterFamily:
    """Packets that need the metadata of their sensor."""

    name = _NAME
    messages: Mapping[str, MessagePackets] = _MESSAGES

    def recognize(self, head: Datagrams, companions: Sequence[Companion]) -> Recognized | None:
        """What the datagrams of one sender to one port are; None = not of an Ouster."""
        parts = parts_by_sensor(head)
        found = [_recognized_part(head.take(rows), companions) for rows in parts]
        if len(parts) > 1 and all(one is not None and one.kind == "data" for one in found):
            several = [
                replace(one, rows=rows) for one, rows in zip(found, parts, strict=True) if one
            ]
            return replace(several[0], others=tuple(several[1:]))
        return _recognized_part(head, companions)

    def describes(self, companion: Companion) -> bool:
        """Whether a file is the metadata of a sensor, sound or not."""
        return is_metadata(companion)

    def open(self, sensor: PacketSensor) -> PacketFormat:
        """Prepare to decode the packets of one sensor.

        Raises:
            ConfigError: If no metadata file fits, or several do.
        """
        found = find_metadata(sensor.companions)
        fit = choose(sensor.head, found, sensor.sensor)
        if fit is None:
            raise ConfigError(missing_text(sensor.head, found, sensor.sensor))
        turning = turning_of(fit.metadata, sensor.head)
        if not turning.columns:
            raise ConfigError(CodedText("ouster-columns-unknown", metadata=fit.metadata.name))
        _say(sensor, fit, found, columns=turning.columns)
        return OusterPackets(sensor, fit.metadata, turning)

    def restamped(
        self, payloads: Payloads, shift_ns: int, companions: Sequence[Companion]
    ) -> Payloads | None:
        """Points and inertial samples, later; None = most are neither."""
        return restamped(payloads, companions, shift_ns=shift_ns)


def _recognized_part(head: Datagrams, companions: Sequence[Companion]) -> Recognized | None:
    """What the datagrams of one sensor are."""
    if not len(head):
        return None
    found = find_metadata(companions)
    try:
        fit = choose(head, found)
    except ConfigError as error:
        return _unknown(head, warning(FindingKind.METADATA_NEEDED, error=error))
    if fit is not None and _most_are_known(head, fit.metadata.layout.size):
        return _recognized(head, fit)
    damaged = joined(found.damaged)
    return _unknown(head, warning(FindingKind.METADATA_NEEDED, absent=True, error=damaged))


def _recognized(head: Datagrams, fit: ChosenMetadata) -> Recognized:
    metadata = fit.metadata
    turning = turning_of(metadata, head)
    payloads = sound_head(head, metadata.layout)
    return Recognized(
        family=_NAME,
        kind="data",
        model=metadata.model or UNKNOWN,
        mode="dual" if len(metadata.layout.profile.echoes) == 2 else "single",
        packet_s=metadata.layout.columns * turning.column_s,
        rotation_hz=turning.rotation_hz,
        serial=usual_serial(metadata.layout, payloads) or metadata.serial,
        size=metadata.layout.size,
        findings=fit.doubts,
    )


def _unknown(head: Datagrams, why: Finding) -> Recognized | None:
    """Packets of a sensor whose metadata is not there, or other packets of an Ouster."""
    for layout in USUAL_LAYOUTS:
        if layout_fits(head, layout) and _most_are_known(head, layout.size):
            payloads = sound_head(head, layout)
            step_s = 1e-9 * column_step_ns(columns_of(layout, payloads))
            return Recognized(
                family=_NAME,
                kind="data",
                model=UNKNOWN,
                packet_s=layout.columns * step_s,
                serial=usual_serial(layout, payloads),
                size=layout.size,
                findings=(why,),
            )
    return Recognized(family=_NAME, kind="samples") if _most_are_known(head, 0) else None


def _most_are_known(head: Datagrams, size: int) -> bool:
    """Whether more than half of the first datagrams are packets of an Ouster.

    Args:
        head: First datagrams.
        size: Bytes of those that have been found to be data packets; 0 = none were.
    """
    length = head.length[: HEAD.packets]
    known = int((length == size).sum())
    for other in distinct(length[length != size]).tolist():
        rows = np.flatnonzero(length == other)
        known += int(is_known_packet(head.payloads(rows, other)).sum())
    return 2 * known > len(length)


def _say(sensor: PacketSensor, fit: ChosenMetadata, found: MetadataFiles, *, columns: int) -> None:
    """Report what the files say and what contradicts it."""
    name, metadata, report = sensor.sensor.name, fit.metadata, sensor.report
    for doubt in fit.doubts:
        report.add(replace_fields(doubt, sensor=name))
    for error in found.damaged:
        report.warn(FindingKind.METADATA_UNREADABLE, sensor=name, error=error)
    if metadata.columns_per_turn not in (0, columns):
        report.warn(
            FindingKind.METADATA_COLUMNS,
            sensor=name,
            name=metadata.name,
            stated=metadata.columns_per_turn,
            columns=columns,
        )
    if metadata.model and sensor.sensor.model not in (UNKNOWN, metadata.model):
        report.warn(
            FindingKind.METADATA_MODEL,
            sensor=name,
            model=sensor.sensor.model,
            name=metadata.name,
            product=metadata.product,
        )
    if fit.passed_over:
        report.derive(
            DerivedKind.METADATA_BY_NAME, sensor=name, name=metadata.name, others=fit.passed_over
        )
    if metadata.assumed:
        report.derive(
            DerivedKind.METADATA_ASSUMED,
            sensor=name,
            name=metadata.name,
            fields=", ".join(metadata.assumed),
        )


FAMILY: PacketFamily = OusterFamily()
