"""Velodyne data packets to points: filter, clock, order, decode."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.kernels import velodyne as kernel
from recon4.model.rig import Sensor
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.packet_holes import PacketHoles
from recon4.recording.packets.packet_order import PacketOrder
from recon4.recording.packets.sensor_clock import SECOND_NS, SensorClock
from recon4.recording.packets.velodyne.models import (
    DUAL,
    RETURN_MODES,
    STRONGEST,
    VelodyneModel,
    models_of_interval,
    product_text,
    velodyne_model,
)
from recon4.recording.packets.velodyne.sound_packets import as_packets, sound_packets
from recon4.recording.report import ImportReport
from recon4.recording.tuning import IngestTuning
from recon4.settings import IngestSettings
from recon4.settings.tuning import tuned


@dataclass(frozen=True, slots=True)
class PacketSource:
    """The sensor that sent packets."""

    sensor_row: int
    """Row in ``Rig.sensors``."""
    model: VelodyneModel
    """Beams and firing times."""
    settings: IngestSettings
    """Limits of the range."""


def decode_packets(
    t_ns: Times, payloads: Payloads, source: PacketSource, *, report: ImportReport
) -> Shots:
    """Points of packets that passed the filter and are in order.

    Counts ``points``, ``points_no_return`` (shots without an echo, no fault), ``points_near`` and
    ``points_far`` (outside the range limits) and ``azimuth_jumps``.

    Args:
        t_ns: Time of the first shot of each packet [ns], non-decreasing, (P,).
        payloads: Data packets, (P, 1206).
        source: The sensor that sent them.
        report: Takes the counts.
    """
    dual = as_packets(payloads)["return_mode"] == DUAL if len(payloads) else np.zeros(0, np.bool_)
    cuts = np.concatenate([[0], np.flatnonzero(np.diff(dual)) + 1, [len(dual)]])
    parts = []
    for start, stop in zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True):
        pair = 2 if stop > start and dual[start] else 1
        parts.append(_decode(t_ns[start:stop], payloads[start:stop], source, pair=pair))
    counts = np.sum([part[5] for part in parts], axis=0)
    columns = [
        part[0] if len(parts) == 1 else np.concatenate(part)
        for part in zip(*(part[:5] for part in parts), strict=True)
    ]
    shots = Shots(source.sensor_row, *columns)
    names = ("points_no_return", "points_near", "points_far", "azimuth_jumps")
    for name, count in zip(names, counts.tolist(), strict=True):
        report.count(name, count)
    report.count("points", len(shots))
    return shots


def _decode(
    t_ns: Times, payloads: Payloads, source: PacketSource, *, pair: int
) -> tuple[NDArray[np.generic], ...]:
    model, settings = source.model, source.settings
    unit = model.distance_unit_m
    rounding = np.array([-1e-6, 1e-6])  # so that a limit of 100 m keeps 50000 units of 2 mm
    limits = np.array([settings.min_range_m, settings.max_range_m]) / unit + rounding
    return kernel.decode(
        payloads,
        t_ns,
        pair,
        np.float32(unit),
        np.array([np.ceil(limits[0]), np.floor(limits[1])], dtype=np.int64),
        *_tables(model, pair),
    )


@cache
def _tables(model: VelodyneModel, pair: int) -> tuple[Any, ...]:
    """Arguments of the kernel from ``cos_el`` to ``sin``."""
    tile = model.sequences_per_block
    return (
        np.tile(np.cos(model.elevation_rad), tile).astype(np.float32),
        np.tile(np.sin(model.elevation_rad), tile).astype(np.float32),
        np.tile(model.height_m, tile).astype(np.float32),
        np.tile(model.azimuth_offset_cdeg, tile),
        (model.channel_time_s / model.block_s).astype(np.float32),
        np.rint(model.firing_time_s(DUAL if pair == 2 else STRONGEST) * 1e9).astype(np.int64),
        np.tile(model.ring, tile),
        kernel.COS,
        kernel.SIN,
    )


@dataclass(slots=True)
class Rotation:
    """Measures how fast a sensor spins, from packets that follow each other."""

    turned_cdeg: int = 0
    seconds: float = 0.0
    _last: tuple[int, int] = (0, -1)

    def push(self, t_ns: Times, payloads: Payloads, packet_s: float) -> None:
        """Add the turns between packets without a gap."""
        if not len(t_ns):
            return
        azimuth = as_packets(payloads)["blocks"]["azimuth_cdeg"][:, 0].astype(np.int64)
        if self._last[1] >= 0:
            t_ns, azimuth = np.append(self._last[0], t_ns), np.append(self._last[1], azimuth)
        self._last = int(t_ns[-1]), int(azimuth[-1])
        step_s = np.diff(t_ns) / SECOND_NS
        joined = step_s < 1.5 * packet_s
        self.seconds += float(step_s[joined].sum())
        self.turned_cdeg += int((np.diff(azimuth) % 36000)[joined].sum())

    @property
    def hz(self) -> float:
        """Revolutions a second; NaN before two packets have followed each other."""
        return self.turned_cdeg / 36000 / self.seconds if self.seconds > 0 else float("nan")


class PacketDecoder:
    """Turns the data packets of one sensor into shots; one object a sensor.

    The frame of the points is that of the sensor: x forward (azimuth 0), y left, z up, as in
    ``velodyne-decoder`` and the ROS driver. Azimuth grows clockwise seen from above.

    The model is that of the ``sensor``, whatever the packets say of themselves; a product byte or
    a contradicting packet interval gives a warning.
    """

    def __init__(
        self,
        sensor_row: int,
        sensor: Sensor,
        *,
        settings: IngestSettings,
        report: ImportReport,
        clock: SensorClock | None = None,
    ) -> None:
        """Start with nothing held back.

        Args:
            sensor_row: Row in ``Rig.sensors``.
            sensor: Its model pins the tables; its time offset is added.
            settings: Range limits and reorder window.
            report: Takes counts and warnings.
            clock: Shared with the decoder of its position packets; None = a new one.

        Raises:
            ConfigError: If packets of this model are not decoded.
        """
        self.model = velodyne_model(sensor.model)
        self.clock = clock or SensorClock(
            sensor.name, packet_s=self.model.packet_s(0), report=report
        )
        self.rotation = Rotation()
        self._row, self._sensor = sensor_row, sensor
        self._settings, self._report = settings, report
        window_s = tuned(IngestTuning, settings).reorder_window_s
        self._order = PacketOrder(round(window_s * SECOND_NS), report)
        self._offset_ns = round(sensor.time_offset_s * SECOND_NS)
        self._product: int | None = None
        self._holes = PacketHoles()

    def push(self, t_arrival_ns: Times, payloads: Payloads) -> Shots:
        """Take packets in, give out the shots that are certain to be in order.

        Counts, besides those of `sound_packets`, `PacketOrder` and `decode_packets`:
        ``packets_other_product`` (not the product byte of the rest) and ``packets_missing``, also
        as ``packets_missing_NAME``.

        Args:
            t_arrival_ns: When the host received each packet [ns], (N,).
            payloads: UDP payloads, (N, 1206) or any other width (then all are dropped, counted).

        Returns:
            Shots in firing order; after a hole, those of the last ``reorder_window_s`` are
            held back.
        """
        t_arrival_ns = np.asarray(t_arrival_ns, dtype=np.int64)
        for choose in (self._sound, self._same_product):
            kept = choose(payloads)
            if not kept.all():
                t_arrival_ns, payloads = t_arrival_ns[kept], payloads[kept]
        if not len(payloads):
            return self._shots(*self._order.push(t_arrival_ns, payloads))
        self._order.step_ns = round(self.model.packet_s(int(payloads[0, -2])) * SECOND_NS)
        t_ns, trusted = self.clock.push(t_arrival_ns, as_packets(payloads)["time_us"])
        if not trusted.all():
            t_ns, payloads = t_ns[trusted], payloads[trusted]
        return self._shots(*self._order.push(t_ns, payloads))

    def flush(self) -> Shots:
        """Give out what was held back."""
        shots = self._shots(*self._order.flush())
        self._count_missing(self._holes.rest())
        return shots

    @property
    def rotation_hz(self) -> float:
        """Measured rotation rate [Hz]; NaN before the first packets."""
        return self.rotation.hz

    def _sound(self, payloads: Payloads) -> NDArray[np.bool_]:
        return sound_packets(payloads, self._report)

    def _same_product(self, payloads: Payloads) -> NDArray[np.bool_]:
        """Packets with the product byte of the first ones; the report tells if it is another."""
        if not len(payloads):
            return np.zeros(0, dtype=np.bool_)
        products = payloads[:, -1]
        if self._product is None:
            self._product = int(np.bincount(products).argmax())
            self._compare_product(self._product, int(np.bincount(payloads[:, -2]).argmax()))
        same = products == self._product
        self._report.count("packets_other_product", int((~same).sum()))
        return same

    def _compare_product(self, product: int, return_mode: int) -> None:
        name, model = self._sensor.name, self.model
        if return_mode not in RETURN_MODES:
            self._report.warn(
                f"{name}: unknown return mode byte {return_mode:#04x}: read as single return"
            )
        if product != model.product:
            self._report.warn(
                f"{name}: its packets say {product_text(product)}; decoded as {model.name}"
            )

    def _shots(self, t_ns: Times, payloads: Payloads) -> Shots:
        self._check_interval(t_ns, payloads)
        return decode_packets(
            t_ns + self._offset_ns,
            payloads,
            PacketSource(self._row, self.model, self._settings),
            report=self._report,
        )

    def _check_interval(self, t_ns: Times, payloads: Payloads) -> None:
        """Count missing packets, measure rotation, and see whether the model can be true."""
        if not len(t_ns):
            return
        return_mode = int(payloads[0, -2])
        packet_s = self.model.packet_s(return_mode)
        azimuth_cdeg = as_packets(payloads)["blocks"]["azimuth_cdeg"][:, 0].astype(np.int64)
        self._count_missing(self._holes.missing(t_ns, azimuth_cdeg, packet_s))
        self.rotation.push(t_ns, payloads, packet_s)
        usual_s = self._holes.usual_s()
        fits = models_of_interval(usual_s, return_mode) if usual_s else ()
        if fits and self.model.name not in fits:
            self._report.warn(
                f"{self._sensor.name}: a packet every {1e3 * usual_s:.3f} ms is what a {fits[0]} "
                f"sends, but it is decoded as {self.model.name}"
            )

    def _count_missing(self, number: int) -> None:
        self._report.count("packets_missing", number)
        self._report.count(f"packets_missing_{self._sensor.name}", number)
