"""Livox LiDARs: patterns that do not repeat, and their built-in IMUs.

The makers publish the fields of view and the rates of the shots, and figures of the patterns, but
no equations. Those here have the published outlines and repeat only after minutes:

- two wedge prisms that turn against each other (Brazeal et al. 2021, "A Rigorous Observation Model
  for the Risley Prism-Based Livox Mid-40 Lidar Sensor", section 2, in the approximation of thin
  prisms): each deflects by half of the opening, and the sum of two turning vectors is a rosette;
- a mirror that turns about z while it swings (Mid-360): azimuth grows evenly, elevation is a sine.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.lidars import lidar_model
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.livox.encode import ShotReturns, encode_imu, encode_points
from recon4.recording.packets.livox.models import LAYOUTS, MODELS, LivoxModel, PointLayout
from recon4.simulation.families.family import BuiltInImu
from recon4.simulation.lidar import Firings, Lidar
from recon4.simulation.patterns import BeamMotion, Directions, FiringPattern, even_shots


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


@dataclass(frozen=True, slots=True, kw_only=True)
class Prisms:
    """Two prisms: a rosette around x, wider or higher than a circle by a scale of each axis."""

    half_azimuth_rad: float
    half_elevation_rad: float
    """Half of the field of view [rad]."""
    lines: int
    """Lasers, side by side."""
    line_rad: float = 0.007
    """From one laser to the next, in azimuth and elevation alike [rad]."""
    turns: tuple[float, float] = (12.1567, -7.7733)
    """Of both prisms in a turn of the motor of 0.1 s: those of a Mid-40, 7294 and -4664 rpm
    (Brazeal et al. 2021, section 2)."""

    def directions(self, turn_rad: Array, laser: NDArray[np.int64]) -> Directions:
        """Sum of the deflections by both prisms."""
        first, second = (turn_rad * turns for turns in self.turns)
        spread = self.line_rad * (laser - 0.5 * (self.lines - 1))
        margin = 0.5 * self.line_rad * (self.lines - 1)
        across = 0.5 * (self.half_azimuth_rad - margin)
        upward = 0.5 * (self.half_elevation_rad - margin)
        azimuth = across * (np.cos(first) + np.cos(second)) + spread
        elevation = upward * (np.sin(first) + np.sin(second)) + spread
        return Directions(azimuth, elevation, np.zeros((len(laser), 3)))


@dataclass(frozen=True, slots=True, kw_only=True)
class SwingingMirror:
    """A mirror that turns all around and swings; the lasers look up and down by a part of it."""

    lowest_rad: float
    highest_rad: float
    """Elevations [rad]."""
    lines: int
    """Lasers, above each other."""
    line_rad: float = 0.065
    """From one laser to the next [rad]."""
    turns: float = 2.1703
    swings: float = 17.3117
    """In a turn of the motor of 0.1 s. Their ratio is no ratio of small numbers, and the web is as
    dense as that in the user manual of the Mid-360."""

    def directions(self, turn_rad: Array, laser: NDArray[np.int64]) -> Directions:
        """Azimuth grows evenly, elevation is a sine."""
        middle = 0.5 * (self.lowest_rad + self.highest_rad)
        margin = self.line_rad * (self.lines - 1)
        reach = 0.5 * (self.highest_rad - self.lowest_rad - margin)
        swing = reach * np.sin(turn_rad * self.swings)
        elevation = middle + swing + self.line_rad * (laser - 0.5 * (self.lines - 1))
        return Directions(turn_rad * self.turns, elevation, np.zeros((len(laser), 3)))
