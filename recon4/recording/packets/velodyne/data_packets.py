"""Points of Velodyne data packets."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.spinning import (
    SpinningTables,
    beams,
    block_roles,
    distances,
    spinning_points,
    variants,
)
from recon4.recording.packets.velodyne.models import (
    BLOCKS,
    DUAL,
    LAYOUT,
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
    tables = _tables(source.model, source.settings)
    variant = dual.astype(np.uint8)
    columns = spinning_points(t_ns, payloads, variant, tables=tables, report=report)
    return Shots(source.sensor_row, *columns)


@cache
def _tables(model: VelodyneModel, settings: IngestSettings) -> SpinningTables:
    """Variant 0 = one return, 1 = dual: blocks 2k (last) and 2k + 1 (strongest, or second strongest
    if the last is the strongest) are of the same shots; both are equal if there was one return.
    """
    single, dual = (1e9 * model.firing_time_s(mode) for mode in (STRONGEST, DUAL))
    tile = model.sequences_per_block
    return SpinningTables(
        layout=LAYOUT,
        roles=variants(
            block_roles(BLOCKS, time_ns=single),
            block_roles(BLOCKS, time_ns=dual[::2], twins=(0, 1)),
        ),
        channels=beams(
            np.tile(model.elevation_rad, tile),
            azimuth_cdeg=np.tile(model.azimuth_offset_cdeg, tile),
            origin_m=(0.0, 0.0, np.tile(model.height_m, tile)),
            fraction=model.channel_time_s / model.block_s,
        ),
        distances=distances(model.distance_unit_m, settings),
    )
