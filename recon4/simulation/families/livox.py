"""Livox LiDARs: patterns that do not repeat, and their built-in IMUs."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, partial

import numpy as np

from recon4.model.lidars import lidar_model
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.livox.encode import ShotReturns, encode_imu, encode_points
from recon4.recording.packets.livox.models import LAYOUTS, MODELS, LivoxModel, PointLayout
from recon4.simulation.families.family import BuiltInImu
from recon4.simulation.lidar import Firings, Lidar
from recon4.simulation.patterns import BeamMotion, FiringPattern, even_shots
from recon4.simulation.rosette import Prisms, SwingingMirror


def _layout(model: LivoxModel) -> PointLayout:
    """Cartesian, single return: what the models send if nothing else is set."""
    data_type = 1 if model.sdk == 2 else 0 if model.lines == 1 else 2
    return next(one for one in LAYOUTS if (one.sdk, one.data_type) == (model.sdk, data_type))


def _motion(model: LivoxModel) -> BeamMotion:
    facts = lidar_model(model.name)
    lowest, highest = np.deg2rad(facts.elevation_deg).tolist()
    if facts.azimuth_deg == 360.0:
        return SwingingMirror(
            lowest_rad=lowest,
            highest_rad=highest,
            lines=model.lines,
        )
    return Prisms(
        half_azimuth_rad=float(np.deg2rad(0.5 * facts.azimuth_deg)),
        half_elevation_rad=0.5 * (highest - lowest),
        lines=model.lines,
    )


@cache
def _pattern(name: str) -> FiringPattern:
    model = MODELS[name]
    layout, shot_ns = _layout(model), 1e9 * model.shot_s
    return FiringPattern(
        model=name,
        packet_ns=round(layout.shots * shot_ns),
        offset_ns=even_shots(
            sequences=layout.shots // model.lines,
            sequence_ns=model.lines * shot_ns,
            laser_ns=shot_ns * np.arange(model.lines),
            lasers=model.lines,
        ),
        ring=np.arange(model.lines, dtype=np.uint8),
        motion=_motion(model),
        unit_m=layout.unit_m,
        most_units=2**31 - 1,
    )


def _imu_packets(samples: ImuSamples, sdk: int) -> Payloads:
    return encode_imu(samples.t_ns, samples.gyro_rad_s, samples.accel_m_s2, sdk=sdk)


class SimulatedLivox:
    """Single return, clock by PTP."""

    name = "Livox"

    def pattern(self, model: str) -> FiringPattern | None:
        """The outline of the data sheet, filled by an equation."""
        return _pattern(model) if model in MODELS else None

    def imu(self, model: str) -> BuiltInImu | None:
        """Of the models whose manual tells where it is."""
        if not any(lidar_model(model).p_sensor_imu_m):
            return None
        return BuiltInImu(packets=partial(_imu_packets, sdk=MODELS[model].sdk))

    def data_packets(self, lidar: Lidar, firings: Firings, t_ns: Times) -> Payloads:
        """Points; the frame is that of the sensor."""
        model = MODELS[lidar.pattern.model]
        layout = _layout(model)
        xyz_m = lidar.points(firings) * (firings.distance > 0)[..., None]
        shape = (len(t_ns), layout.shots, 1)
        shots = ShotReturns(xyz_m.reshape(*shape, 3), firings.intensity.reshape(shape))
        return encode_points(t_ns, shots, layout=layout, model=model)

    def companions(self, lidar: Lidar) -> Mapping[str, bytes]:
        """None: the packets have coordinates."""
        return {}


LIVOX = SimulatedLivox()
