"""The family of Livox LiDARs: what their packets look like, and the decoder of one sensor."""

from __future__ import annotations

import zlib
from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.family import (
    Companion,
    MessagePackets,
    PacketFamily,
    PacketSamples,
    PacketSensor,
    Payloads,
    Recognized,
)
from recon4.recording.packets.livox.models import (
    CRC_FROM,
    IMU_SAMPLE,
    LAYOUTS,
    MODELS,
    SDK1_HEADER,
    SDK1_IMU_SIZE,
    SDK1_IMU_TYPE,
    SDK2_HEADER,
    SDK2_IMU_SIZE,
    SDK2_IMU_TYPE,
    UTC_TIME_TYPE,
    LivoxModel,
    PointLayout,
    header_of,
    layout_of,
)
from recon4.recording.packets.livox.points import LivoxSource, decode_points
from recon4.recording.packets.livox.recognition import likely_model, likely_models
from recon4.recording.packets.livox.sound import (
    date_stamps,
    has_crc,
    has_header,
    has_stamp,
    sound_points,
    stamps_ns,
)
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.tuning import HEAD
from recon4.recording.report import ImportReport, warning
from recon4.units import STANDARD_GRAVITY_M_S2

_MODES = {1: "single", 2: "dual", 3: "triple"}


class LivoxFormat:
    """The packets of one Livox.

    Points are in the frame of Livox's drivers: x forward, y left, z up, origin as in the manual.
    """

    stamps_past_hour = False

    def __init__(self, sensor: PacketSensor, layout: PointLayout, model: LivoxModel) -> None:
        """Prepare.

        Args:
            sensor: What is known of it.
            layout: Of its data packets.
            model: Its lines and the rate of its shots.
        """
        self.size = layout.size
        self.sample_sizes = frozenset({SDK1_IMU_SIZE if layout.sdk == 1 else SDK2_IMU_SIZE})
        self.packet_s = layout.shots * model.shot_s
        self._layout, self._report = layout, sensor.report
        self._source = LivoxSource(sensor.row, model, layout, sensor.settings)
        self._name = sensor.sensor.name
        self._by_crc = layout.sdk == 2 and self._sums_are_right(sensor.head)

    def sound(self, payloads: Payloads) -> NDArray[np.bool_]:
        """Which payloads are data packets of this sensor, (N,); counted."""
        return sound_points(payloads, self._layout, self._report, by_crc=self._by_crc)

    def stamps_ns(self, payloads: Payloads) -> Times:
        """Time of the first shot of each packet on the clock of the sensor [ns], (N,)."""
        return stamps_ns(payloads, self._layout.sdk)

    def azimuth_cdeg(self, payloads: Payloads) -> None:
        """None: its pattern does not repeat."""

    def decode(self, t_ns: Times, payloads: Payloads) -> Shots:
        """Points of sound packets, see `decode_points`."""
        return decode_points(t_ns, payloads, self._source, report=self._report)

    def likely_models(self, usual_s: float) -> tuple[str, ...]:
        """Models whose packets of this layout come at this interval [s]."""
        return likely_models(self._layout, usual_s)

    def samples(self, datagrams: Datagrams, clock: SensorClock) -> PacketSamples | None:
        """Samples of the IMU, in the axes of the points; None if there are none."""
        payloads, arrival_ns = imu_packets(datagrams, self._layout.sdk)
        t_ns, timed = clock.at_ns(arrival_ns, stamps_ns(payloads, self._layout.sdk))
        gyro, accel = imu_values(payloads, self._layout.sdk)
        kept = timed & np.isfinite(gyro).all(axis=1) & np.isfinite(accel).all(axis=1)
        self._report.count("imu_samples", int(np.count_nonzero(kept)))
        if not kept.any():
            return None
        return PacketSamples(imu=ImuSamples(t_ns[kept], gyro[kept], accel[kept]))

    def _sums_are_right(self, head: Datagrams) -> bool:
        """Whether most packets at the head carry the CRC that the protocol describes."""
        rows = np.flatnonzero(head.length == self.size)[: HEAD.packets]
        payloads = head.payloads(rows, self.size)
        if not header_of(payloads, 2)["crc"].any():
            return False  # files of the maker keep no sums
        right = has_crc(payloads)
        if 2 * np.count_nonzero(right) <= len(right):
            self._report.derive(DerivedKind.CHECKSUM_FOREIGN, sensor=self._name)
        return bool(2 * np.count_nonzero(right) > len(right))


class LivoxFamily:
    """Livox LiDARs with the protocols SDK1 and SDK2."""

    name = "Livox"
    messages: Mapping[str, MessagePackets] = {}
    """Livox's drivers publish points, no packets."""

    def describes(self, companion: Companion) -> bool:
        """None does: the data sheets are enough."""
        del companion
        return False

    def recognize(self, head: Datagrams, companions: Sequence[Companion]) -> Recognized | None:
        """What the datagrams of one sender to one port are; None = not of this family."""
        del companions
        layout = _usual_layout(head)
        if layout is None:
            return Recognized(family=self.name, kind="samples") if _are_imu(head) else None
        rows = np.flatnonzero(head.length == layout.size)
        payloads = head.payloads(rows, layout.size)
        sound = sound_points(payloads, layout, ImportReport(), by_crc=False)
        if 2 * np.count_nonzero(sound) <= len(head):
            return None
        model, is_known = likely_model(layout, payloads[sound])
        return Recognized(
            family=self.name,
            kind="data",
            model=model.name,
            mode=_MODES[layout.returns],
            packet_s=layout.shots * model.shot_s,
            size=layout.size,
            findings=() if is_known else (warning(FindingKind.MODEL_UNKNOWN, model=model.name),),
        )

    def open(self, sensor: PacketSensor) -> LivoxFormat:
        """Prepare to decode the packets of one sensor.

        Raises:
            ConfigError: If the model is none of Livox, or its data type is not known.
        """
        name = sensor.sensor.model
        layout = _usual_layout(sensor.head)
        if layout is None:
            raise ConfigError(CodedText("livox-no-packet", sensor=sensor.sensor.name))
        if name not in MODELS:
            raise ConfigError(CodedText("livox-no-decoder", name=name, models=", ".join(MODELS)))
        model = MODELS[name]
        if model.sdk != layout.sdk:
            sent = ", ".join(one.name for one in MODELS.values() if one.sdk == layout.sdk)
            raise ConfigError(
                CodedText(
                    "livox-sdk", sensor=sensor.sensor.name, sdk=layout.sdk, sent=sent, name=name
                )
            )
        return LivoxFormat(sensor, layout, model)

    def restamped(
        self, payloads: Payloads, shift_ns: int, companions: Sequence[Companion]
    ) -> Payloads | None:
        """Points and inertial samples, later; None = most are neither."""
        del companions
        for sdk in (1, 2):
            sound = _sound(payloads, sdk)
            if 2 * sound.sum() > len(payloads):
                return restamped(payloads, sound, sdk, shift_ns=shift_ns)
        return None


def imu_packets(datagrams: Datagrams, sdk: int) -> tuple[Payloads, Times]:
    """The IMU packets among datagrams, (N, size), and when they arrived [ns], (N,)."""
    size, data_type = (SDK1_IMU_SIZE, SDK1_IMU_TYPE) if sdk == 1 else (SDK2_IMU_SIZE, SDK2_IMU_TYPE)
    rows = np.flatnonzero(datagrams.length == size)
    payloads = datagrams.payloads(rows, size)
    sound = has_header(payloads, sdk, data_type) & has_stamp(payloads, sdk)
    return payloads[sound], datagrams.t_ns[rows[sound]]


def imu_values(payloads: Payloads, sdk: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Angular rates [rad/s] and accelerations [m/s²] of IMU packets, (N, 3) each."""
    header = SDK1_HEADER if sdk == 1 else SDK2_HEADER
    body = np.ascontiguousarray(payloads[:, header.itemsize :]).view(IMU_SAMPLE)[:, 0]
    with np.errstate(invalid="ignore"):
        gyro, accel = body["gyro"].astype(np.float64), body["accel"].astype(np.float64)
    return gyro, accel * STANDARD_GRAVITY_M_S2


def _usual_layout(head: Datagrams) -> PointLayout | None:
    """The layout of most datagrams that have points; None = none has."""
    sizes = {layout.size for layout in LAYOUTS}
    found: Counter[PointLayout] = Counter()
    for size in sizes & set(head.length.tolist()):
        rows = np.flatnonzero(head.length == size)[: HEAD.packets]
        layouts = [layout_of(payload) for payload in head.payloads(rows, size)]
        found.update(layout for layout in layouts if layout is not None)
    return found.most_common(1)[0][0] if found else None


def _sound(payloads: Payloads, sdk: int) -> NDArray[np.bool_]:
    """Which payloads of one size are packets of a protocol: points or inertial samples, (N,)."""
    size, data_type = (SDK1_IMU_SIZE, SDK1_IMU_TYPE) if sdk == 1 else (SDK2_IMU_SIZE, SDK2_IMU_TYPE)
    kinds = [(one.size, one.data_type, one.shots) for one in LAYOUTS if one.sdk == sdk]
    sound = np.zeros(len(payloads), np.bool_)
    for its_size, its_type, points in (*kinds, (size, data_type, 1)):
        if payloads.shape[1] == its_size:
            sound |= has_header(payloads, sdk, its_type, points=points)
    return sound & has_stamp(payloads, sdk) if sound.any() else sound


def _are_imu(head: Datagrams) -> bool:
    """Whether more than half of the datagrams are IMU packets."""
    found = (len(imu_packets(head, sdk)[0]) for sdk in (1, 2))
    return 2 * max(found) > len(head)


FAMILY: PacketFamily = LivoxFamily()


def restamped(payloads: Payloads, sound: NDArray[np.bool_], sdk: int, *, shift_ns: int) -> Payloads:
    """Packets of one protocol, later by ``shift_ns``; unsound ones as they are, (N, size).

    Args:
        payloads: Points or inertial samples, (N, size).
        sound: Which have the header of a packet, and a time, (N,).
        sdk: 1 or 2.
        shift_ns: Added to the stamps [ns].
    """
    out = payloads.copy()
    header = SDK1_HEADER if sdk == 1 else SDK2_HEADER
    assert header.fields is not None
    at = header.fields["stamp"][1]
    timed = np.flatnonzero(sound)
    t_ns = stamps_ns(payloads[timed], sdk) + shift_ns
    timed, t_ns = timed[t_ns >= 0], t_ns[t_ns >= 0]
    out[timed, at : at + 8] = t_ns.astype("<u8").view(np.uint8).reshape(-1, 8)
    if sdk == 1:
        dated = payloads[timed, header.fields["time_type"][1]] == UTC_TIME_TYPE
        out[timed[dated], at : at + 8] = date_stamps(t_ns[dated])
    else:
        crc_at = header.fields["crc"][1]
        for row in timed[has_crc(payloads[timed])].tolist():
            total = zlib.crc32(out[row, CRC_FROM:].tobytes())
            out[row, crc_at : crc_at + 4] = np.frombuffer(total.to_bytes(4, "little"), np.uint8)
    return out
