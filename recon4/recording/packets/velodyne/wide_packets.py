"""Packets of one VLS-128 or HDL-64E."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.distinct import distinct
from recon4.kernels.laser_corrections import correct
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.family import PacketSamples, PacketSensor, Payloads
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.spinning import (
    SpinningPackets,
    SpinningTables,
    beams,
    distances,
    points_of,
)
from recon4.recording.packets.velodyne.laser_calibration import (
    calibration_in_status,
    calibration_of,
    correction_table,
)
from recon4.recording.packets.velodyne.models import DATA_SIZE, DUAL, POSITION_SIZE
from recon4.recording.packets.velodyne.position_packets import PositionDecoder
from recon4.recording.packets.velodyne.sound_packets import as_packets
from recon4.recording.packets.velodyne.tuning import WIDE_PACKETS
from recon4.recording.packets.velodyne.wide_models import (
    VLS128,
    VLS128_PRODUCT,
    WideModel,
    hdl64_model,
    merged,
)
from recon4.recording.report import ImportReport
from recon4.units import HOUR_NS


def dual_packets(payloads: Payloads, model: WideModel) -> NDArray[np.bool_]:
    """Which packets have two returns, (N,): of a return mode, or blocks of the same azimuth."""
    packets = as_packets(payloads)
    if model.twins_beside:
        return np.asarray(packets["return_mode"] == DUAL)
    azimuth = packets["blocks"]["azimuth_cdeg"]
    pairs = azimuth[:, :: 2 * model.rows] == azimuth[:, model.rows :: 2 * model.rows]
    return np.asarray(pairs.all(axis=1))


def _by_returns(
    dual: NDArray[np.bool_],
) -> tuple[tuple[NDArray[np.bool_] | slice, bool], ...]:
    """Rows of packets with one return and with two; a slice, which copies nothing, if all are."""
    if dual.any() and not dual.all():
        return (~dual, False), (dual, True)
    return ((slice(None), bool(dual.any())),)


def sound_wide(payloads: Payloads, model: WideModel, report: ImportReport) -> NDArray[np.bool_]:
    """Which payloads are data packets of a model, (N,).

    Counts ``packets``, ``packets_wrong_flag`` (blocks without the flags of the model in their
    order) and ``packets_wrong_azimuth`` (above 360°).

    Args:
        payloads: Packets, (N, 1206).
        model: The sensor.
        report: Takes the counts.
    """
    report.count("packets", len(payloads))
    blocks = as_packets(payloads)["blocks"]
    dual = dual_packets(payloads, model)
    flagged, turned = np.zeros((2, len(payloads)), np.bool_)
    for rows, is_dual in _by_returns(dual):
        used = model.used_blocks(dual=is_dual)
        flags = blocks["flag"][rows, :used]
        flagged[rows] = (flags == model.wire_flags(dual=is_dual)).all(axis=1)
        turned[rows] = (blocks["azimuth_cdeg"][rows, :used] <= 36000).all(axis=1)
    report.count("packets_wrong_flag", int((~flagged).sum()))
    report.count("packets_wrong_azimuth", int((flagged & ~turned).sum()))
    return flagged & turned


class WideFormat:
    """The packets of one Velodyne whose firing takes several blocks.

    The frame of the points is that of `VelodyneFormat`.
    """

    size = DATA_SIZE
    sample_sizes = frozenset({POSITION_SIZE})
    stamps_past_hour = True

    def __init__(self, of: PacketSensor) -> None:
        """Prepare.

        Raises:
            ConfigError: If an HDL-64E has no calibration.
        """
        self._of, self._report = of.without_head(), of.report
        rows = np.flatnonzero(of.head.length == DATA_SIZE)
        head = of.head.payloads(rows, DATA_SIZE)
        self._model = VLS128 if of.sensor.model == VLS128.name else _hdl64(of, head)
        self._dual = False
        self._see(head)
        self._tables = _tables(self._model, of)
        self._lasers = _by_ring(self._model, self._tables)
        self._positions: PositionDecoder | None = None

    @property
    def packet_s(self) -> float:
        """Time from one data packet to the next [s]."""
        return self._model.packet_s(dual=self._dual)

    def sound(self, payloads: Payloads) -> NDArray[np.bool_]:
        """Data packets of this model."""
        sound = sound_wide(payloads, self._model, self._report)
        if self._model is VLS128:
            product = payloads[:, -1] == VLS128_PRODUCT
            self._report.count("packets_other_product", int((sound & ~product).sum()))
            sound &= product
        self._see(payloads if sound.all() else payloads[sound])
        return sound

    def stamps_ns(self, payloads: Payloads) -> Times:
        """Time of the first shot past the hour."""
        stamp_ns = as_packets(payloads)["time_us"].astype(np.int64) * 1000
        early_ns = self._model.early_ns
        return np.where(stamp_ns < HOUR_NS, (stamp_ns - early_ns) % HOUR_NS, stamp_ns)

    def azimuth_cdeg(self, payloads: Payloads) -> NDArray[np.int64]:
        """Of the first block of each packet."""
        return as_packets(payloads)["blocks"]["azimuth_cdeg"][:, 0].astype(np.int64)

    def decode(self, t_ns: Times, payloads: Payloads) -> Shots:
        """Points in firing order."""
        dual = dual_packets(payloads, self._model)
        turn_rad = self._turns(t_ns, payloads)
        parts = _by_returns(dual)
        if len(parts) == 1:
            blocks = merged(payloads, self._model, dual=parts[0][1])
        else:
            blocks = np.empty((len(payloads), self._width), np.uint8)
            for rows, is_dual in parts:
                blocks[rows] = merged(payloads[rows], self._model, dual=is_dual)
        packets = SpinningPackets(t_ns, blocks, dual.astype(np.uint8), turn_rad)
        columns = points_of(packets, tables=self._tables, report=self._report)
        if self._lasers is not None:
            _, xyz, intensity, ring, _ = columns
            correct(xyz, intensity, ring, self._lasers)
        return Shots(self._of.row, *columns)

    def likely_models(self, usual_s: float) -> tuple[str, ...]:
        """The flags tell the model."""
        del usual_s
        return ()

    def samples(self, datagrams: Datagrams, clock: SensorClock) -> PacketSamples | None:
        """Positions."""
        if self._positions is None:
            self._positions = PositionDecoder(self._of.sensor, clock=clock, report=self._report)
        rows = np.arange(len(datagrams))
        return self._positions.push(datagrams.t_ns, datagrams.payloads(rows, POSITION_SIZE))

    @property
    def _width(self) -> int:
        layout = self._tables.layout
        return layout.blocks * layout.block

    def _see(self, payloads: Payloads) -> None:
        if len(payloads):
            self._dual = bool(np.median(dual_packets(payloads, self._model)) > 0.5)

    def _turns(self, t_ns: Times, payloads: Payloads) -> NDArray[np.float32]:
        """Turn from a firing to the next [rad], (P,); empty = a packet has several firings.

        A VLS-128 of two returns has one firing a packet: the next packet tells.
        """
        if not (self._model.twins_beside and self._dual) or len(payloads) < 2:
            return np.zeros(0, np.float32)
        step = np.diff(self.azimuth_cdeg(payloads)) % 36000
        joined = (np.diff(t_ns) < 1.5e9 * self.packet_s) & (step <= WIDE_PACKETS.most_cdeg)
        usual = float(np.median(step[joined])) if joined.any() else 0.0
        turn = np.where(joined, step, usual)
        return np.deg2rad(0.01 * np.append(turn, usual)).astype(np.float32)


def _hdl64(of: PacketSensor, head: Payloads) -> WideModel:
    """The model of an HDL-64E: calibration of a file, else of its packets."""
    name = of.sensor.name
    calibration = calibration_of(of.companions) or calibration_in_status(head)
    if calibration is None:
        raise ConfigError(CodedText("hdl64-needs-calibration", name=name))
    stamps = distinct(as_packets(head)["time_us"]) if len(head) else np.zeros(0)
    step_us = float(np.median(np.diff(stamps))) if len(stamps) > 4 else 0.0
    dual = len(head) > 0 and bool(
        np.median(dual_packets(head, hdl64_model(calibration, s3=True))) > 0.5
    )
    s3 = step_us * (2 if dual else 1) > WIDE_PACKETS.s3_least_us
    kind = "S3" if s3 else "S2"
    of.report.derive(
        DerivedKind.HDL64_CALIBRATION, sensor=name, model=kind, source=calibration.source
    )
    return hdl64_model(calibration, s3=s3)


def _tables(model: WideModel, of: PacketSensor) -> SpinningTables:
    channels = beams(
        model.elevation_rad,
        azimuth_cdeg=model.azimuth_cdeg,
        origin_m=model.origin_m,
        range_m=model.range_m,
        fraction=model.laser_time_s / model.sequence_s,
    )
    order = np.argsort(np.argsort(model.elevation_rad, kind="stable"))
    return SpinningTables(
        layout=model.layout,
        roles=model.roles(),
        channels=channels._replace(ring=order.astype(np.uint8)[None]),
        distances=distances(model.distance_unit_m, of.settings),
    )


def _by_ring(model: WideModel, tables: SpinningTables) -> NDArray[np.float32] | None:
    """What points of each ring are corrected by besides; None = nothing."""
    if model.calibration is None:
        return None
    return correction_table(model.calibration)[np.argsort(tables.channels.ring[0])]
