"""Points of Velodyne data packets."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.kernels import velodyne as kernel
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.velodyne.models import (
    DUAL,
    STRONGEST,
    VelodyneModel,
)
from recon4.recording.packets.velodyne.sound_packets import as_packets
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings


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
