"""A Velodyne VLP-16 on a walking body: time, direction and measurement of each shot."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.mesh import GLASS, WorldMesh
from recon4.geometry.raycast import Hits, Scene
from recon4.geometry.se3 import Array
from recon4.kernels.simulation import hits_carrier, make_rays, measure
from recon4.model.rig import Sensor
from recon4.model.trajectory import Times
from recon4.recording.packets.velodyne.models import BLOCKS, MODELS
from recon4.simulation.companions import REFLECTIVITY as OF_PEOPLE
from recon4.simulation.companions import Companions
from recon4.simulation.mirrors import follow
from recon4.simulation.rides import CarScene, ElevatorCar
from recon4.simulation.vehicles import REFLECTIVITY as OF_VEHICLES
from recon4.simulation.vehicles import Vehicles
from recon4.simulation.walk import Walk

_VLP16 = MODELS["VLP-16"]
LASER_NS = round(1e9 * _VLP16.laser_time_s[1])
"""From one laser of a firing sequence to the next [ns]."""
SEQUENCE_NS = round(1e9 * _VLP16.sequence_s)
"""From one firing sequence to the next [ns]."""
SEQUENCES = BLOCKS * _VLP16.sequences_per_block
"""Firing sequences in a packet."""
PACKET_NS = SEQUENCES * SEQUENCE_NS
LASERS = _VLP16.lasers
RESOLUTION_M = _VLP16.distance_unit_m
CARRIER = np.array([0.24, 0.0, 0.21, -1.5, 0.12])
"""The person: x, y, radius, bottom and top of an upright cylinder in the body [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LidarModel:
    """Errors of a sensor; zeros make it perfect."""

    range_sd_m: float = 0.015
    """Standard deviation of a range [m]."""
    min_range_m: float = 0.4
    max_range_m: float = 110.0
    weakest_signal: float = 4e-5
    """reflectivity x cos(incidence) / range² at which half of the shots return [1/m²]:
    10 % reflectivity at 50 m."""
    loss: float = 0.003
    """Ratio of shots lost at random."""
    divergence_rad: float = 0.003
    """Full opening of a beam."""
    mixed_step_m: float = 0.8
    """Surfaces in one beam nearer to each other than this give one mixed range [m]."""
    intensity_sd: float = 0.06
    """Relative noise of the intensity."""
    intensity_sd_counts: float = 1.5
    """Absolute noise of the intensity."""
    gain_spread: float = 0.25
    """Largest relative deviation of the gain of a laser."""
    beam_angle_sd_rad: float = 0.0
    """Standard deviation of the elevation and azimuth of a laser against the data sheet."""
    carrier: bool = True
    """The person hides what is behind."""

    @staticmethod
    def perfect() -> LidarModel:
        """No noise, no losses: for tests of exactness."""
        return LidarModel(
            range_sd_m=0.0,
            weakest_signal=0.0,
            loss=0.0,
            divergence_rad=0.0,
            intensity_sd=0.0,
            intensity_sd_counts=0.0,
            gain_spread=0.0,
            carrier=False,
        )


@dataclass(frozen=True, slots=True, eq=False)
class Firings:
    """Some packets of one sensor before they are packed. P packets, 24 sequences, 16 lasers."""

    t_ns: Times
    """Time of each shot since the start of the walk [ns], (P, 24, 16)."""
    azimuth_rad: Array
    """Azimuth of each shot by the encoder, clockwise seen from above, (P, 24, 16)."""
    distance: NDArray[np.uint16]
    """In units of 2 mm, 0 = no return, (P, 24, 16)."""
    intensity: NDArray[np.uint8]
    """0..255, (P, 24, 16)."""
    reflectivity: NDArray[np.uint8]
    """Hundred times the true one, 0 = no return, (P, 24, 16)."""


@dataclass(frozen=True, slots=True, eq=False)
class Lidar:
    """One sensor with its own clock phase, motor phase and beam gains."""

    sensor: Sensor
    model: LidarModel
    first_packet_ns: int
    """Time of its first shot since the start of the walk [ns]."""
    azimuth_rad: float
    """Azimuth at the start of the walk."""
    turn_rate_hz: float
    """Near 10 Hz; two sensors are not phase locked."""
    gain: Array
    """Gain of each laser, (16,)."""
    beam_angle_error_rad: Array
    """By which the elevation (upwards) and azimuth (clockwise) of each laser differ from the data
    sheet, (2, 16)."""

    @staticmethod
    def drawn(sensor: Sensor, model: LidarModel, rng: np.random.Generator) -> Lidar:
        """A sensor with phases and gains drawn at random."""
        return Lidar(
            sensor,
            model,
            int(rng.integers(0, PACKET_NS)),
            float(rng.uniform(0.0, 2.0 * np.pi)),
            10.0 * float(1.0 + 5e-4 * rng.uniform(-1.0, 1.0)),
            1.0 + model.gain_spread * rng.uniform(-1.0, 1.0, LASERS),
            model.beam_angle_sd_rad * rng.standard_normal((2, LASERS)),
        )

    def packets_before(self, t_ns: int) -> int:
        """Number of packets complete at a time since the start of the walk [ns]."""
        return max(0, (t_ns - self.first_packet_ns) // PACKET_NS)

    def fire(
        self, packets: range, walk: Walk, surroundings: Surroundings, *, rng: np.random.Generator
    ) -> Firings:
        """Measure from a walking body, every shot from its own pose."""
        t_ns = self.first_packet_ns + (
            PACKET_NS * np.arange(packets.start, packets.stop, dtype=np.int64)[:, None, None]
            + SEQUENCE_NS * np.arange(SEQUENCES)[:, None]
            + LASER_NS * np.arange(LASERS)
        )
        count = t_ns.size
        t_s = 1e-9 * t_ns.ravel()
        shot = np.empty((count, 5))
        stated = self.azimuth_rad + 2.0 * np.pi * self.turn_rate_hz * t_s
        nominal_rad = np.stack([_VLP16.elevation_rad, np.zeros(LASERS)])
        elevation, azimuth = nominal_rad + self.beam_angle_error_rad
        shot[:, 0] = stated + np.tile(azimuth, count // LASERS)
        shot[:, 1] = np.tile(elevation, count // LASERS)
        shot[:, 2] = np.tile(_VLP16.height_m, count // LASERS)
        half = 0.5 * self.model.divergence_rad
        shot[:, 3:] = rng.uniform(-half, half, (count, 2))
        mount = self.sensor.T_body_sensor
        rays = np.empty((2 * count, 6), dtype=np.float32)
        make_rays(walk.state(t_s), mount.R, mount.t, shot, rays)
        blocked = np.zeros(count, dtype=np.bool_)
        if self.model.carrier:
            hits_carrier(shot, mount.R, mount.t, CARRIER, blocked)
        hits = surroundings.cast(rays, walk, np.tile(t_s, 2))
        found = measure_hits(
            RaysAndHits(rays, hits, blocked, hit_noise(count, rng)),
            np.tile(self.gain, count // LASERS),
            surroundings=surroundings,
            model=self.model,
        )
        columns = (found.distance, found.intensity, found.reflectivity)
        encoder = np.mod(stated, 2.0 * np.pi).reshape(t_ns.shape)
        return Firings(t_ns, encoder, *(column.reshape(t_ns.shape) for column in columns))


@dataclass(frozen=True, eq=False)
class Surroundings:
    """A mesh with its ray caster, people and vehicles that move, the car of an elevator."""

    mesh: WorldMesh
    scene: Scene
    companions: Companions | None = None
    car: ElevatorCar | None = None
    vehicles: Vehicles | None = None

    @cached_property
    def reflectivity(self) -> NDArray[np.float32]:
        """Of all triangles: mesh, car of an elevator, then one of people and one of vehicles."""
        car = [self.car.reflectivity] if self.car else []
        moving = np.array([OF_PEOPLE, OF_VEHICLES], np.float32)
        return np.concatenate([self.mesh.reflectivity, *car, moving])

    @cached_property
    def _car_scene(self) -> CarScene:
        assert self.car is not None
        return CarScene(self.car)

    def cast(self, rays: NDArray[np.float32], walk: Walk, t_s: Array) -> Hits:
        """First hits of rays (N, 6) at their times [s], (N,)."""
        hits = follow(
            self.scene.cast(rays), rays, scene=self.scene, reflectivity=self.mesh.reflectivity
        )
        if self.car is not None and walk.ride is not None:
            first = len(self.mesh.reflectivity)
            hits = self._car_scene.hide(hits, rays, ride=walk.ride, t_s=t_s, surface=first)
        last = len(self.reflectivity) - 1
        for moving, surface in ((self.companions, last - 1), (self.vehicles, last)):
            if moving is not None:
                hits = moving.hide(hits, rays, walk=walk, t_s=t_s, surface=surface)
        return hits


@dataclass(frozen=True, slots=True, eq=False)
class RaysAndHits:
    """Two rays per shot, and what they hit. N shots."""

    rays: NDArray[np.float32]
    """Origin and direction in the world, (2 N, 6)."""
    hits: Hits
    blocked: NDArray[np.bool_]
    """The person hides what is behind, (N,)."""
    noise: NDArray[np.float32]
    """Of `hit_noise`, (N, 4)."""


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredHits:
    """What a sensor makes of hits."""

    distance: NDArray[np.uint16]
    """In units of 2 mm, 0 = no return, (N,)."""
    intensity: NDArray[np.uint8]
    """0..255, (N,)."""
    reflectivity: NDArray[np.uint8]
    """Hundred times the true one, 0 = no return, (N,)."""


def hit_noise(count: int, rng: np.random.Generator) -> NDArray[np.float32]:
    """Random numbers of each shot: two normal, two uniform, (N, 4)."""
    noise = np.empty((count, 4), dtype=np.float32)
    noise[:, :2] = rng.standard_normal((count, 2), dtype=np.float32)
    noise[:, 2:] = rng.random((count, 2), dtype=np.float32)
    return noise


def measure_hits(
    given: RaysAndHits, gain: Array, *, surroundings: Surroundings, model: LidarModel
) -> MeasuredHits:
    """Measure hits with the errors of a model.

    Args:
        given: Rays and hits.
        gain: Of the laser of each shot, (N,).
        surroundings: What was hit.
        model: Errors.
    """
    count, hits = len(gain), given.hits
    found = MeasuredHits(
        np.empty(count, np.uint16), np.empty(count, np.uint8), np.empty(count, np.uint8)
    )
    rules = np.array(
        [
            model.range_sd_m, model.min_range_m, model.max_range_m, model.weakest_signal,
            model.mixed_step_m, model.loss, model.intensity_sd, model.intensity_sd_counts,
            GLASS, RESOLUTION_M,
        ]
    )  # fmt: skip
    measure(
        hits.range_m, hits.triangle, hits.normal, given.rays, surroundings.reflectivity,
        given.blocked, gain, given.noise, rules, found.distance, found.intensity,
        found.reflectivity,
    )  # fmt: skip
    return found
