"""Firings as Velodyne packets in a capture file, with what a receiver of time adds to them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.packets.velodyne.encode import (
    PacketBlocks,
    PcapWriter,
    encode_position,
    encode_vlp16,
    rmc_sentence,
)
from recon4.recording.packets.velodyne.models import BLOCKS, CHANNELS
from recon4.simulation.degradation import Degradation
from recon4.simulation.gnss import geodetic
from recon4.simulation.lidar import Firings
from recon4.simulation.setup import SimulationSetup

POSITION_PORT = 8308
_LATENCY_NS = 100_000
_JITTER_NS = 150_000
_SECOND_NS = 1_000_000_000


@dataclass(frozen=True, slots=True, eq=False)
class Packets:
    """Datagrams of one sensor."""

    row: int
    """Of the sensor in the rig."""
    t_arrival_ns: Times
    """When they reach the recorder [ns], (N,)."""
    payloads: NDArray[np.uint8]
    """(N, 1206)."""


def pack(
    firings: Firings,
    row: int,
    setup: SimulationSetup,
    *,
    degradation: Degradation,
    rng: np.random.Generator,
) -> Packets:
    """Data packets, which arrive a tenth of a millisecond after their last shot."""
    sensor_epoch_ns = setup.epoch_ns - round(1e9 * setup.rig.sensors[row].time_offset_s)
    count = len(firings.t_ns)
    azimuth = firings.azimuth_rad[:, ::2, 0]
    t_ns = degradation.stamps(row, firings.t_ns[:, 0, 0], sensors=len(setup.lidars))
    payloads = encode_vlp16(
        (sensor_epoch_ns + t_ns) // 1000,
        PacketBlocks(
            np.rint(np.rad2deg(azimuth) * 100.0).astype(np.int64),
            firings.distance.reshape(count, BLOCKS, CHANNELS),
            firings.intensity.reshape(count, BLOCKS, CHANNELS),
        ),
    )
    delay = _LATENCY_NS + rng.integers(0, _JITTER_NS, count)
    return Packets(row, sensor_epoch_ns + firings.t_ns[:, -1, -1] + delay, payloads)


def write_packets(file: PcapWriter, parts: list[Packets], setup: SimulationSetup) -> None:
    """Append packets of all sensors in order of arrival."""
    t_ns = np.concatenate([part.t_arrival_ns for part in parts])
    owner = np.repeat(np.arange(len(parts)), [len(part.t_arrival_ns) for part in parts])
    place = np.concatenate([np.arange(len(part.t_arrival_ns)) for part in parts])
    order = np.argsort(t_ns, kind="stable")
    if not len(order):  # a second before the recording began, or all packets of it are lost
        return
    # Runs of one sensor are written at once.
    breaks = np.flatnonzero(np.diff(owner[order])) + 1
    for run in np.split(order, breaks):
        part, rows = parts[owner[run[0]]], place[run]
        sensor = setup.rig.sensors[part.row]
        file.write(
            part.t_arrival_ns[rows], part.payloads[rows], source=sensor.address, port=sensor.port
        )


def write_position_packets(file: PcapWriter, second: int, setup: SimulationSetup) -> None:
    """Append the position packets of a whole second: time always, a position outdoors.

    The position is that of a plain receiver, some meters off; RTK is in ``gnss.csv``.
    """
    t_ns = setup.epoch_ns + second * _SECOND_NS
    here = setup.walk.state([float(second)])[:, :3]
    drift = 1.5 * np.sin(0.01 * second + np.array([0.3, 1.9, 4.0]))
    lat_rad, lon_rad, _ = geodetic(here + drift, setup.world.origin)
    sentence = rmc_sentence(
        t_ns,
        lat_deg=float(np.rad2deg(lat_rad[0])),
        lon_deg=float(np.rad2deg(lon_rad[0])),
        valid=setup.world.outdoors,
    )
    for sensor in setup.rig.sensors:
        stamp_ns = t_ns + 30_000_000 - round(1e9 * sensor.time_offset_s)
        payload = encode_position(stamp_ns // 1000, sentence)
        arrival = np.array([stamp_ns + _LATENCY_NS], dtype=np.int64)
        file.write(arrival, payload[None, :], source=sensor.address, port=POSITION_PORT)
