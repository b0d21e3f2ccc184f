"""Velodynes by the tables of their packets."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np

from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.velodyne.encode import PacketBlocks, encode_packets
from recon4.recording.packets.velodyne.models import BLOCKS, CHANNELS, MODELS
from recon4.recording.packets.velodyne.wide_encode import encode_wide
from recon4.recording.packets.velodyne.wide_models import VLS128, WideModel
from recon4.simulation.families.family import BuiltInImu, encoder_cdeg
from recon4.simulation.lidar import Firings, Lidar
from recon4.simulation.patterns import FiringPattern, Spin, even_shots, rings


@cache
def _wide_pattern(model: WideModel) -> FiringPattern:
    """Of a model whose firing takes several blocks."""
    firings, sequence_ns = BLOCKS // model.rows, 1e9 * model.sequence_s
    return FiringPattern(
        model=model.name,
        packet_ns=round(firings * sequence_ns),
        offset_ns=even_shots(
            sequences=firings,
            sequence_ns=sequence_ns,
            laser_ns=1e9 * model.laser_time_s,
            lasers=model.lasers,
        ),
        ring=rings(model.elevation_rad),
        motion=Spin(
            elevation_rad=model.elevation_rad,
            azimuth_rad=np.deg2rad(0.01 * model.azimuth_cdeg),
            origin_m=np.stack(model.origin_m),
        ),
        unit_m=model.distance_unit_m,
    )


@cache
def _pattern(name: str) -> FiringPattern:
    model = MODELS[name]
    sequences, sequence_ns = BLOCKS * model.sequences_per_block, round(1e9 * model.sequence_s)
    laser_ns = np.rint(1e9 * model.laser_time_s)
    none = np.zeros(model.lasers)
    return FiringPattern(
        model=name,
        packet_ns=sequences * sequence_ns,
        offset_ns=even_shots(
            sequences=sequences, sequence_ns=sequence_ns, laser_ns=laser_ns, lasers=model.lasers
        ),
        ring=model.ring,
        motion=Spin(
            elevation_rad=model.elevation_rad,
            azimuth_rad=np.deg2rad(0.01 * model.azimuth_offset_cdeg),
            origin_m=np.stack([none, none, model.height_m]),
        ),
        unit_m=model.distance_unit_m,
    )


class SimulatedVelodynes:
    """Single return mode; GPS drives the clock."""

    name = "Velodyne"

    def pattern(self, model: str) -> FiringPattern | None:
        """By the tables of the decoder; not HDL-64E, each of which has a calibration of its own."""
        if model == VLS128.name:
            return _wide_pattern(VLS128)
        return _pattern(model) if model in MODELS else None

    def imu(self, model: str) -> BuiltInImu | None:
        """None: those in the position packets of an HDL-32E are too coarse for odometry."""
        return None

    def data_packets(self, lidar: Lidar, firings: Firings, t_ns: Times) -> Payloads:
        """Packets of 12 blocks."""
        if lidar.pattern.model == VLS128.name:
            returns = np.stack([firings.distance, firings.intensity], axis=-1)
            azimuth, stamp_ns = encoder_cdeg(lidar, firings), t_ns + VLS128.early_ns
            return encode_wide(stamp_ns // 1000, azimuth, returns, model=VLS128)
        model = MODELS[lidar.pattern.model]
        shape = (len(t_ns), BLOCKS, CHANNELS)
        blocks = PacketBlocks(
            encoder_cdeg(lidar, firings)[:, :: model.sequences_per_block],
            firings.distance.reshape(shape),
            firings.intensity.reshape(shape),
        )
        return encode_packets(t_ns // 1000, blocks, model=model)

    def companions(self, lidar: Lidar) -> Mapping[str, bytes]:
        """None: all sensors of a model are taken as alike."""
        return {}


VELODYNES = SimulatedVelodynes()
