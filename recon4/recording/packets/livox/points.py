"""Livox packets to points: coordinates, returns, tags, time of each shot."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from recon4.kernels import livox as kernel
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.livox.models import LivoxModel, PointLayout, header_of
from recon4.recording.packets.livox.tuning import LIVOX_PACKETS
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings

_COUNTS = ("points_no_return", "points_near", "points_far", "points_noise")


@dataclass(frozen=True, slots=True)
class LivoxSource:
    """The sensor that sent packets."""

    sensor_row: int
    """Row in ``Rig.sensors``."""
    model: LivoxModel
    layout: PointLayout
    settings: IngestSettings
    """Limits of the range."""


def decode_points(
    t_ns: Times, payloads: Payloads, source: LivoxSource, *, report: ImportReport
) -> Shots:
    """Points of sound packets in firing order.

    Counts ``points``, ``points_no_return`` (shots at the origin), ``points_noise`` (by tag),
    ``points_near`` and ``points_far``. A return equal to one before it of the same shot is left
    out, as for all sensors.

    Args:
        t_ns: Time of the first shot of each packet [ns], (P,).
        payloads: Packets of ``source.layout``, (P, size).
        source: The sensor that sent them.
        report: Receives the counts.
    """
    layout, settings = source.layout, source.settings
    assert payloads.shape == (len(t_ns), layout.size)
    limits_m = (
        settings.min_range_m - LIVOX_PACKETS.rounding_m,
        settings.max_range_m + LIVOX_PACKETS.rounding_m,
    )
    found = kernel.decode(
        np.ascontiguousarray(payloads),
        np.ascontiguousarray(t_ns, np.int64),
        shot_steps_ns(payloads, source),
        _plan(layout, source.model),
        np.array([*limits_m, layout.unit_m], np.float32),
        kernel.COS,
        kernel.SIN,
    )
    shots = Shots(source.sensor_row, *found[:5])
    for name, count in zip(_COUNTS, found[5].tolist(), strict=True):
        report.count(name, count)
    report.count("points", len(shots))
    return shots


def shot_steps_ns(payloads: Payloads, source: LivoxSource) -> NDArray[np.float64]:
    """Time from one shot to the next in each packet [ns], (P,).

    Packets of SDK2 tell how long their shots take; SDK1 has the rate of the model.
    """
    layout = source.layout
    step_ns = np.full(len(payloads), 1e9 * source.model.shot_s)
    if layout.sdk == 1:
        return step_ns
    taken_ns = header_of(payloads, 2)["interval"].astype(np.float64) * 100.0
    return np.where(taken_ns > 0, taken_ns / layout.shots, step_ns)


@cache
def _plan(layout: PointLayout, model: LivoxModel) -> NDArray[np.int64]:
    """Where the fields of a shot are, as `kernel.decode` wants it, (12,)."""
    record, one = layout.record, layout.record["returns"].base
    numbers = kernel.NUMBERS.depths if layout.is_spherical else kernel.NUMBERS.words
    if not layout.is_spherical and one["xyz"].base.itemsize == 2:
        numbers = kernel.NUMBERS.halves
    at = {name: int(found[1]) for name, found in (record.fields or {}).items()}
    inside = {name: int(found[1]) for name, found in (one.fields or {}).items()}
    fields = [
        layout.header.itemsize,
        layout.shots,
        record.itemsize,
        layout.returns,
        at["returns"],
        one.itemsize,
    ]
    fields += [inside["reflectivity"], inside.get("tag", -1), numbers, at.get("theta", 0)]
    return np.array([*fields, model.lines, model.names_noise], np.int64)
