"""Packets of other Velodynes on the walk, and of a VLP-16 in dual return mode."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.simulation import make_rays
from recon4.model.trajectory import Times
from recon4.recording.packets.velodyne.encode import PacketBlocks, encode_packets
from recon4.recording.packets.velodyne.models import BLOCKS, CHANNELS, DUAL, MODELS, VelodyneModel
from recon4.recording.packets.velodyne.sound_packets import as_packets
from recon4.simulation.lidar import RESOLUTION_M, LidarModel, RaysAndHits, hit_noise, measure_hits
from recon4.simulation.setup import SimulationSetup
from tests.variants.walk import TURN_NS, RecordedWalk

_LATENCY_NS = 100_000
_SECOND_RETURNS = 0.05
"""Part of the shots that see a second surface."""


@dataclass(frozen=True, slots=True, eq=False)
class Packets:
    """Data packets of one sensor."""

    t_ns: Times
    """Times of arrival [ns], (P,)."""
    payloads: NDArray[np.uint8]
    """(P, 1206)."""


@cache
def packets_of(walk: RecordedWalk, sensor: str) -> Packets:
    """Packets of one of ``VLP-16``, ``VLP-16 dual``, ``HDL-32E`` and ``VLP-32C``."""
    if sensor == "VLP-16":
        return Packets(walk.packet_ns, walk.packets)
    if sensor == "VLP-16 dual":
        return _dual(packets_of(walk, "VLP-16"))
    return _measured(walk, MODELS[sensor])


def _measured(walk: RecordedWalk, model: VelodyneModel) -> Packets:
    """Cast the rays of a sensor of 32 beams, second by second."""
    seconds = len(walk.clouds) * TURN_NS * 1e-9
    count = int(seconds / model.packet_s(0))
    first_s = (walk.clouds[0].t_ns - walk.setup.epoch_ns) * 1e-9
    t_s = first_s + np.arange(count) * model.packet_s(0)
    rng = np.random.default_rng(32)
    parts = [
        _fire(walk.setup, model, t_s[rows], rng)
        for rows in np.array_split(np.arange(count), int(np.ceil(seconds)))
    ]
    t_ns = walk.setup.epoch_ns + np.rint(1e9 * t_s).astype(np.int64)
    blocks = PacketBlocks(
        *(
            np.concatenate([getattr(part, name) for part in parts])
            for name in PacketBlocks.__slots__
        )
    )
    arrival_ns = t_ns + round(1e9 * model.packet_s(0)) + _LATENCY_NS
    return Packets(arrival_ns, encode_packets(t_ns // 1000, blocks, model=model))


def _fire(
    setup: SimulationSetup, model: VelodyneModel, t_s: NDArray[np.float64], rng: np.random.Generator
) -> PacketBlocks:
    """Measure the shots of packets that begin at some times since the start of the walk [s]."""
    t_shot_s = (t_s[:, None, None] + model.firing_time_s()).ravel()
    count, tile = len(t_shot_s), len(t_shot_s) // model.lasers
    offset_rad = np.deg2rad(0.01 * model.azimuth_offset_cdeg)
    shot = np.zeros((count, 7))
    shot[:, 0] = 2.0 * np.pi * 1e9 / TURN_NS * t_shot_s + np.tile(offset_rad, tile)
    shot[:, 1] = np.tile(model.elevation_rad, tile)
    shot[:, 2] = np.tile(model.height_m, tile)
    mount = setup.rig.sensors[0].T_body_sensor
    rays = np.empty((2 * count, 6), np.float32)
    make_rays(setup.walk.state(t_shot_s), mount.R, mount.t, shot, rays)
    hits = setup.surroundings.cast(rays, setup.walk, np.tile(t_shot_s, 2))
    found = measure_hits(
        RaysAndHits(rays, hits, np.zeros(count, np.bool_), hit_noise(count, rng)),
        np.ones(count),
        surroundings=setup.surroundings,
        model=LidarModel(),
    )
    shape = (len(t_s), BLOCKS, CHANNELS)
    per_unit = model.distance_unit_m / RESOLUTION_M
    block_s = t_s[:, None] + model.block_s * np.arange(BLOCKS)
    return PacketBlocks(
        np.rint(36000.0 * 1e9 / TURN_NS * block_s).astype(np.int64),
        np.rint(found.distance / per_unit).astype(np.int64).reshape(shape),
        found.intensity.reshape(shape),
    )


def _dual(single: Packets) -> Packets:
    """The same shots in pairs of blocks: the last and the strongest return."""
    model, rng = MODELS["VLP-16"], np.random.default_rng(39)
    packets = as_packets(single.payloads)
    blocks = packets["blocks"].reshape(-1, BLOCKS // 2)
    pairs = np.repeat(blocks, 2, axis=1)
    seen = blocks["returns"]["distance"]
    second = (rng.random(seen.shape) < _SECOND_RETURNS) & (seen > 0)
    pairs["returns"]["distance"][:, ::2] += np.where(second, 400, 0).astype(np.uint16)
    half_us = round(1e6 * model.packet_s(DUAL))
    payloads = encode_packets(
        np.repeat(packets["time_us"], 2) + np.tile([0, half_us], len(packets)),
        PacketBlocks(
            pairs["azimuth_cdeg"], pairs["returns"]["distance"], pairs["returns"]["intensity"]
        ),
        model=model,
        return_mode=DUAL,
    )
    t_ns = np.repeat(single.t_ns, 2) - np.tile([1000 * half_us, 0], len(packets))
    return Packets(t_ns, payloads)
