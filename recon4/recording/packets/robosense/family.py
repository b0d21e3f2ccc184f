"""The family of RoboSense LiDARs: what their packets look like, and the decoder of one sensor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.distinct import distinct
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
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
)
from recon4.recording.packets.robosense.angles import (
    DeviceData,
    device_data,
    fitting_table,
    is_device,
    laser_angles,
)
from recon4.recording.packets.robosense.imu_packets import imu_samples, is_imu
from recon4.recording.packets.robosense.messages import MESSAGES
from recon4.recording.packets.robosense.models import (
    AIRY_INSTALLED,
    AIRY_UNKNOWN_VARIANT,
    AIRY_VARIANT,
    BPEARL_V4_TYPE,
    IMU_PACKET,
    IMU_SIZE,
    MODELS,
    OLD_TYPE_AT,
    OLD_TYPES,
    SIZE,
    TYPE_AT,
    RoboSenseModel,
    of_two_returns,
)
from recon4.recording.packets.robosense.packets import (
    PacketReturns,
    azimuths_cdeg,
    has_id,
    packet_s,
    sound_packets,
    spinning_tables,
    split_blocks,
    stamp_bytes,
    stamps,
    stamps_of,
    variants_of,
    with_stamp_unit,
)
from recon4.recording.packets.robosense.solid import (
    SOLID_MODELS,
    SOLID_STAMP_AT,
    SolidModel,
    decode_solid,
    solid_stamps,
    sound_solid,
)
from recon4.recording.packets.robosense.tuning import ROBOSENSE_ANGLES
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.spinning import spinning_points
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS

NAME = "RoboSense"


def restamped(payloads: Payloads, *, shift_ns: int) -> Payloads | None:
    """Packets of one size, later by ``shift_ns``; unsound ones as they are.

    Args:
        payloads: Points, or samples of an inertial unit, (N, size).
        shift_ns: Added to the stamps [ns].

    Returns:
        The packets, (N, size); None = most are of no model.
    """
    size = payloads.shape[1]
    if size == IMU_SIZE:
        assert IMU_PACKET.fields is not None
        at, sound = IMU_PACKET.fields["stamp"][1], is_imu(payloads)
        t_ns = stamps_of(np.ascontiguousarray(payloads[:, at : at + 10]), ns=False)[0]
        return _written(payloads, sound, t_ns + shift_ns, at=at, kind="us")
    if any(size == solid.size for solid in SOLID_MODELS.values()):
        sound, t_ns = sound_solid(payloads, ImportReport()), solid_stamps(payloads)[0]
        return _written(payloads, sound, t_ns + shift_ns, at=SOLID_STAMP_AT, kind="us")
    for model in MODELS.values() if size == SIZE else ():
        sound = sound_packets(payloads, model, ImportReport())
        if 2 * sound.sum() > len(payloads):
            t_ns = stamps(payloads, model)[0] + shift_ns
            return _written(payloads, sound, t_ns, at=model.stamp_at, kind=model.stamp)
    return None


def _written(
    payloads: Payloads, sound: NDArray[np.bool_], t_ns: Times, *, at: int, kind: str
) -> Payloads | None:
    """Sound packets with other times; None = most are not sound."""
    if 2 * sound.sum() <= len(payloads):
        return None
    rows = np.flatnonzero(sound & (t_ns >= 0))
    out = payloads.copy()
    out[rows, at : at + 10] = stamp_bytes(t_ns[rows], kind)
    return out


class SpinningFormat:
    """The packets of one RoboSense that spins.

    Points are in the frame of the maker's driver: x forward (azimuth 0), y left, z up, azimuth
    clockwise seen from above; the origin is on the axis.
    """

    stamps_past_hour = False
    size = SIZE
    sample_sizes = frozenset({SIZE, IMU_SIZE})

    def __init__(self, of: PacketSensor, model: RoboSenseModel) -> None:
        """Prepare.

        Raises:
            ConfigError: If the angles of its lasers are nowhere.
        """
        self._of, self._report = of.without_head(), of.report
        head = _of_size(of.head, SIZE)
        self._model = with_stamp_unit(model, head[has_id(head, model)])
        self._device = _device(of.head, model) or _device(of.beside, model)
        self._dual = False
        self._use_angles()
        self._see(head)

    @property
    def packet_s(self) -> float:
        """Usual time from one data packet to the next [s]."""
        return packet_s(self._layout, dual=self._returns_two)

    def sound(self, payloads: Payloads) -> NDArray[np.bool_]:
        """Data packets; device packets among them are read and are no fault."""
        device = is_device(payloads)
        if device.any():
            self._learn(payloads[device])
            sound = np.zeros(len(payloads), np.bool_)
            sound[~device] = sound_packets(payloads[~device], self._model, self._report)
        else:
            sound = sound_packets(payloads, self._model, self._report)
        self._see(payloads[np.flatnonzero(sound)[:1]])
        return sound

    def stamps_ns(self, payloads: Payloads) -> Times:
        """Seconds and µs, or ns, or a date of the packets."""
        return stamps(payloads, self._model)[0]

    def azimuth_cdeg(self, payloads: Payloads) -> NDArray[np.int64]:
        """Of the first block of each packet."""
        return azimuths_cdeg(payloads, self._model)[:, 0]

    def decode(self, t_ns: Times, payloads: Payloads) -> Shots:
        """Points in firing order."""
        variant = variants_of(payloads, self._model)
        if self._halves:
            payloads, variant = split_blocks(payloads, self._model), np.ones_like(variant)
        columns = spinning_points(t_ns, payloads, variant, tables=self._tables, report=self._report)
        return Shots(self._of.row, *columns)

    def likely_models(self, usual_s: float) -> tuple[str, ...]:
        """Of models with the same layout, those whose packets come at this interval."""
        alike = [model for model in MODELS.values() if _same_bytes(model, self._model)]
        return tuple(m.name for m in alike if _fits(m, usual_s, dual=self._returns_two))

    def samples(self, datagrams: Datagrams, clock: SensorClock) -> PacketSamples | None:
        """Angles from device packets; samples of the inertial unit of an Airy."""
        whole = np.flatnonzero(datagrams.length == SIZE)
        if len(whole):
            self._learn(datagrams.payloads(whole, SIZE))
        rows = np.flatnonzero(datagrams.length == IMU_SIZE)
        payloads = datagrams.payloads(rows, IMU_SIZE)
        imu = imu_samples(payloads, datagrams.t_ns[rows], clock=clock, report=self._report)
        return PacketSamples(imu=imu) if imu is not None else None

    @property
    def _returns_two(self) -> bool:
        return self._dual or self._halves

    def _see(self, payloads: Payloads) -> None:
        """Note whether packets have two returns."""
        of_model = payloads[has_id(payloads, self._model)]
        if len(of_model):
            self._dual = bool(np.median(variants_of(of_model, self._model)) != PacketReturns.SINGLE)

    def _learn(self, payloads: Payloads) -> None:
        """Read device packets: the first one with angles counts."""
        if self._device is None:
            self._device = device_data(payloads, self._model)
            if self._device is not None:
                self._use_angles()

    def _use_angles(self) -> None:
        device, model = self._device, self._model
        if model.name == "Airy" and device is not None:
            model = AIRY_INSTALLED.get(device.installed, model)
        self._halves = model.lasers == 16 and device is not None and device.dual
        self._layout = of_two_returns(model) if self._halves else model
        angles = laser_angles(model, device, self._of.companions)
        name = self._of.sensor.name
        self._report.derive(
            DerivedKind.ANGLES_FOUND, sensor=name, of="lasers", source=angles.source
        )
        if not angles.measured:
            self._report.warn(FindingKind.ANGLES_TYPICAL, sensor=name, model=model.name, difop=True)
        self._tables = spinning_tables(self._layout, angles, self._of.settings)


class SolidFormat:
    """The packets of one M1 or E1; x forward, y left, z up."""

    stamps_past_hour = False
    sample_sizes: frozenset[int] = frozenset()

    def __init__(self, of: PacketSensor, model: SolidModel) -> None:
        """Prepare."""
        self._of, self._model = of.without_head(), model
        self.size, self.packet_s = model.size, model.packet_s

    def sound(self, payloads: Payloads) -> NDArray[np.bool_]:
        """Which payloads are data packets of this sensor, (N,)."""
        return sound_solid(payloads, self._of.report)

    def stamps_ns(self, payloads: Payloads) -> Times:
        """Time of each packet [ns], (N,)."""
        return solid_stamps(payloads)[0]

    def azimuth_cdeg(self, payloads: Payloads) -> None:
        """None: it does not spin."""

    def decode(self, t_ns: Times, payloads: Payloads) -> Shots:
        """Points in firing order."""
        return decode_solid(t_ns, payloads, self._model, of=self._of)

    def likely_models(self, usual_s: float) -> tuple[str, ...]:
        """The size of the packets tells the model."""
        del usual_s
        return ()

    def samples(self, datagrams: Datagrams, clock: SensorClock) -> None:
        """None: there are no other packets."""


class RoboSenseFamily:
    """RoboSense LiDARs with the protocols MSOP and DIFOP."""

    name = NAME
    messages: Mapping[str, MessagePackets] = MESSAGES

    def describes(self, companion: Companion) -> bool:
        """A table of the angles of the lasers of a model."""
        return any(fitting_table(companion, model) is not None for model in MODELS.values())

    def recognize(self, head: Datagrams, companions: Sequence[Companion]) -> Recognized | None:
        """What the datagrams of one sender to one port are; None = not of this family."""
        del companions
        for solid in SOLID_MODELS.values():
            payloads = _of_size(head, solid.size)
            if 2 * int(sound_solid(payloads, ImportReport()).sum()) > len(head):
                return Recognized(
                    family=NAME,
                    kind="data",
                    model=solid.name,
                    packet_s=solid.packet_s,
                    size=solid.size,
                    readable_as=(solid.name,),
                )
        payloads = _of_size(head, SIZE)
        device = is_device(payloads)
        data = payloads[~device]
        if 2 * len(data) > len(head) and (found := _recognized_data(head, data)) is not None:
            return found
        others = int(device.sum()) + int(is_imu(_of_size(head, IMU_SIZE)).sum())
        return Recognized(family=NAME, kind="samples") if 2 * others > len(head) else None

    def open(self, sensor: PacketSensor) -> PacketFormat:
        """The packets of one sensor.

        Raises:
            ConfigError: If its model is not decoded, or the angles of its lasers are nowhere.
        """
        name = sensor.sensor.model
        if name in SOLID_MODELS:
            return SolidFormat(sensor, SOLID_MODELS[name])
        if name in MODELS:
            _warn_of_old_type(sensor, MODELS[name])
            return SpinningFormat(sensor, MODELS[name])
        known = ", ".join([*MODELS, *SOLID_MODELS])
        raise ConfigError(CodedText("robosense-no-decoder", name=name, known=known))

    def restamped(
        self, payloads: Payloads, shift_ns: int, companions: Sequence[Companion]
    ) -> Payloads | None:
        """Points and inertial samples, later; None = of no model."""
        del companions
        return restamped(payloads, shift_ns=shift_ns)


FAMILY: PacketFamily = RoboSenseFamily()


def _of_size(head: Datagrams, size: int) -> Payloads:
    return head.payloads(np.flatnonzero(head.length == size), size)


def _device(datagrams: Datagrams, model: RoboSenseModel) -> DeviceData | None:
    return device_data(_of_size(datagrams, SIZE), model)


def _same_bytes(one: RoboSenseModel, other: RoboSenseModel) -> bool:
    return (one.layout, one.data_id, one.flag) == (other.layout, other.data_id, other.flag)


def _fits(model: RoboSenseModel, usual_s: float, *, dual: bool) -> bool:
    return abs(usual_s / packet_s(model, dual=dual) - 1) < 0.03


def _recognized_data(head: Datagrams, payloads: Payloads) -> Recognized | None:
    for model in MODELS.values():
        sound = sound_packets(payloads, model, ImportReport())
        if 2 * int(sound.sum()) <= len(payloads):
            continue
        packets = payloads[sound]
        dual = bool(np.median(variants_of(packets, model)) != PacketReturns.SINGLE)
        found = Recognized(
            family=NAME,
            kind="data",
            model=model.name,
            mode="dual" if dual else "",
            packet_s=packet_s(model, dual=dual),
            size=SIZE,
            readable_as=tuple(m.name for m in MODELS.values() if _same_bytes(m, model)),
        )
        return _refined(found, head, packets)
    return None


def _refined(found: Recognized, head: Datagrams, packets: Payloads) -> Recognized:
    """The model among those with the same bytes."""
    kinds = packets[:, TYPE_AT : TYPE_AT + 2]
    kind = tuple(np.median(kinds, axis=0).astype(int).tolist())
    if found.model == "Bpearl":
        return _of_old_id(found, packets, kind)
    if found.model == "Airy" and kind[1] not in (AIRY_VARIANT, AIRY_UNKNOWN_VARIANT):
        reason = CodedText("refused-airy", variant=kind[1])
        return replace(found, kind="other", refused=reason)
    if found.model != "Helios 32":
        return found
    device = _device(head, MODELS["Helios 32"])
    steps = np.diff(distinct(stamps(packets, MODELS["Helios 32"])[0]))
    usual_s = float(np.median(steps)) / SECOND_NS if len(steps) > 4 else float("nan")
    lasers = 32 if device is None else len(device.angles_cdeg)
    if lasers == 16 or _fits(MODELS["Helios 16P"], usual_s, dual=False):
        return replace(found, model="Helios 16P", packet_s=usual_s)
    low = device is None or float(device.angles_cdeg[:, 0].min()) < ROBOSENSE_ANGLES.low_cdeg
    return replace(found, model="Helios 5515" if low else "Helios 32")


def _warn_of_old_type(of: PacketSensor, model: RoboSenseModel) -> None:
    """Warn if the header names another one of the oldest models, whose packets are alike."""
    head = _of_size(of.head, SIZE)
    types = head[has_id(head, model), OLD_TYPE_AT]
    says = OLD_TYPES.get(int(np.median(types)), "") if len(types) else ""
    if says not in ("", model.name) and _same_bytes(model, MODELS[says]):
        about = {"sensor": of.sensor.name, "says": says, "model": model.name}
        of.report.warn(FindingKind.MODEL_CONTRADICTED, **about)


def _of_old_id(found: Recognized, packets: Payloads, kind: tuple[int, ...]) -> Recognized:
    """RS-16, RS-32 or Bpearl by the types in the header."""
    if kind == BPEARL_V4_TYPE:
        return replace(found, model="Bpearl V4")
    name = OLD_TYPES.get(int(np.median(packets[:, OLD_TYPE_AT])), "")
    if not name:
        return found
    usual_s = packet_s(MODELS[name], dual=found.mode == "dual")
    return replace(found, model=name, packet_s=usual_s)
