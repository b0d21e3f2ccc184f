"""Firings as packets in a capture file, with what a receiver of time adds to them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.model.lidars import lidar_model
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.velodyne.encode import (
    PcapWriter,
    encode_position,
    rmc_sentence,
)
from recon4.simulation.degradation import Degradation
from recon4.simulation.families.families import family_of
from recon4.simulation.families.velodyne import VELODYNES
from recon4.simulation.gnss import geodetic
from recon4.simulation.lidar import Firings
from recon4.simulation.setup import SimulationSetup, built_in_imu
from recon4.units import SECOND_NS


@dataclass(frozen=True, slots=True, kw_only=True)
class Delivery:
    """How long packets take to the recorder after their last shot or sample."""

    latency_ns: int = 100_000
    jitter_ns: int = 150_000
    """Data packets take up to this much longer."""


DELIVERY = Delivery()


@dataclass(frozen=True, slots=True, eq=False)
class Packets:
    """Datagrams of one sensor."""

    row: int
    """Of the sensor in the rig."""
    t_arrival_ns: Times
    """When they reach the recorder [ns], (N,)."""
    payloads: NDArray[np.uint8]
    """(N, size)."""
    port: int
    """UDP port they go to."""


def pack(
    firings: Firings,
    row: int,
    setup: SimulationSetup,
    *,
    degradation: Degradation,
    rng: np.random.Generator,
) -> Packets:
    """Data packets, which arrive a tenth of a millisecond after their last shot."""
    lidar, sensor = setup.lidars[row], setup.rig.sensors[row]
    sensor_epoch_ns = setup.epoch_ns - round(1e9 * sensor.time_offset_s)
    count = len(firings.t_ns)
    start_ns = firings.t_ns[:, 0, 0] - lidar.pattern.offset_ns[0, 0]
    t_ns = degradation.stamps(row, start_ns, sensors=len(setup.lidars))
    payloads = family_of(sensor.model).data_packets(lidar, firings, sensor_epoch_ns + t_ns)
    last_ns = firings.t_ns.max(axis=(1, 2))
    delay = DELIVERY.latency_ns + rng.integers(0, DELIVERY.jitter_ns, count)
    return Packets(row, sensor_epoch_ns + last_ns + delay, payloads, sensor.port)


def put_imu(
    data: Packets, samples: ImuSamples, setup: SimulationSetup, *, degradation: Degradation
) -> None:
    """Put samples of the IMU in a LiDAR into its data packets, if that is where they belong."""
    within = built_in_imu(setup.rig.sensors[data.row]).within
    if within is not None and len(data.payloads) and len(samples):
        within(data.payloads, stamped(samples, data.row, setup, degradation=degradation))


def pack_imu(
    samples: ImuSamples, row: int, setup: SimulationSetup, *, degradation: Degradation
) -> Packets | None:
    """Packets of the IMU in a LiDAR, which arrive a tenth of a millisecond after their sample.

    None = it has none of its own.
    """
    sensor = setup.rig.sensors[row]
    made = built_in_imu(sensor).packets
    if made is None:
        return None
    facts = lidar_model(sensor.model)
    # The last one is that of samples: the first one of an Airy is that of its device data.
    port = facts.sample_ports[-1] if facts.sample_ports else sensor.port
    payloads = made(stamped(samples, row, setup, degradation=degradation))
    arrival_ns = samples.t_ns - round(1e9 * sensor.time_offset_s) + DELIVERY.latency_ns
    return Packets(row, arrival_ns, payloads, port)


def stamped(
    samples: ImuSamples, row: int, setup: SimulationSetup, *, degradation: Degradation
) -> ImuSamples:
    """Samples of the IMU in a LiDAR, on the clock of that LiDAR."""
    stamps = degradation.stamps(row, samples.t_ns - setup.epoch_ns, sensors=len(setup.lidars))
    offset_ns = round(1e9 * setup.rig.sensors[row].time_offset_s)
    return replace(samples, t_ns=setup.epoch_ns - offset_ns + stamps)


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
            part.t_arrival_ns[rows], part.payloads[rows], source=sensor.address, port=part.port
        )


def write_position_packets(file: PcapWriter, second: int, setup: SimulationSetup) -> None:
    """Append the position packets of Velodynes, of a second: time always, a position outdoors.

    The position is that of a plain receiver, some meters off; RTK is in ``gnss.csv``.
    """
    t_ns = setup.epoch_ns + second * SECOND_NS
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
        if family_of(sensor.model) is not VELODYNES:
            continue
        (port,) = lidar_model(sensor.model).sample_ports
        stamp_ns = t_ns + 30_000_000 - round(1e9 * sensor.time_offset_s)
        payload = encode_position(stamp_ns // 1000, sentence)
        arrival = np.array([stamp_ns + DELIVERY.latency_ns], dtype=np.int64)
        file.write(arrival, payload[None, :], source=sensor.address, port=port)
