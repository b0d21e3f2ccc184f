"""RoboSense LiDARs that spin, by the tables of their packets."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.lidars import lidar_model
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.robosense.encode import SpinningBlocks, encode_imu, encode_spinning
from recon4.recording.packets.robosense.models import MODELS, RoboSenseModel
from recon4.simulation.families.family import BuiltInImu, encoder_cdeg
from recon4.simulation.lidar import Firings, Lidar
from recon4.simulation.patterns import FiringPattern, Spin, rings


def _angles_cdeg(model: RoboSenseModel) -> Array:
    """Elevation and azimuth of each laser [0.01°], (L, 2): of the factory, or evenly spread."""
    if model.factory_cdeg is not None:
        return model.factory_cdeg.astype(np.float64)
    lowest, highest = lidar_model(model.name).elevation_deg
    middles = (np.arange(model.lasers) + 0.5) / model.lasers
    elevation = np.round(100.0 * (lowest + (highest - lowest) * middles))
    return np.column_stack([elevation, np.zeros(model.lasers)])


@cache
def _pattern(name: str) -> FiringPattern:
    model = MODELS[name]
    firings = model.layout.blocks // model.rows
    start_us = model.firing_us * np.arange(firings)
    offset_us = start_us[:, None] + model.time_us.ravel()
    elevation_rad, azimuth_rad = np.deg2rad(0.01 * _angles_cdeg(model)).T
    return FiringPattern(
        model=name,
        packet_ns=round(1e3 * model.firing_us * firings),
        offset_ns=np.rint(1e3 * offset_us).astype(np.int64).reshape(-1, model.lasers),
        ring=rings(elevation_rad),
        motion=Spin(
            elevation_rad=elevation_rad,
            azimuth_rad=azimuth_rad,
            origin_m=np.array([[model.along_m], [0.0], [model.up_m]]),
        ),
        unit_m=model.unit_m,
        most_units=model.layout.distance_mask,
    )


class SimulatedRoboSense:
    """Single return mode, clock by PTP."""

    name = "RoboSense"

    def pattern(self, model: str) -> FiringPattern | None:
        """Of models that spin."""
        return _pattern(model) if model in MODELS else None

    def imu(self, model: str) -> BuiltInImu | None:
        """Of an Airy."""
        return BuiltInImu(packets=encode_imu) if model == "Airy" else None

    def data_packets(self, lidar: Lidar, firings: Firings, t_ns: Times) -> Payloads:
        """Packets of blocks; the blocks of one firing have its azimuth."""
        model = MODELS[lidar.pattern.model]
        layout, packets = model.layout, len(t_ns)
        sequences = lidar.pattern.shape[0] // (layout.blocks // model.rows)
        azimuth = encoder_cdeg(lidar, firings)[:, ::sequences]
        shape = (packets, layout.blocks, layout.channels)
        blocks = SpinningBlocks(
            np.repeat(azimuth, model.rows, axis=1),
            firings.distance.reshape(shape),
            firings.intensity.reshape(shape),
        )
        return encode_spinning(t_ns, blocks, model)

    def companions(self, lidar: Lidar) -> Mapping[str, bytes]:
        """The angles of the lasers."""
        model = MODELS[lidar.pattern.model]
        rows = [f"{e / 100:.2f},{a / 100:.2f}" for e, a in _angles_cdeg(model).tolist()]
        name = model.name.replace(" ", "_").lower()
        return {f"{name}_angles.csv": ("\n".join(rows) + "\n").encode()}


ROBOSENSE = SimulatedRoboSense()
