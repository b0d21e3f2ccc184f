"""A LiDAR on a walking body: time, direction and measurement of each shot."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.mesh import WorldMesh
from recon4.geometry.raycast import Hits, Scene
from recon4.geometry.se3 import Array
from recon4.geometry.tuning import SURFACES
from recon4.kernels.carrier import carrier_range
from recon4.kernels.simulation import hits_carrier, make_rays, measure
from recon4.model.lidars import lidar_model
from recon4.model.rig import Sensor
from recon4.model.trajectory import Times
from recon4.simulation.companions import Companions
from recon4.simulation.materials import MATERIAL
from recon4.simulation.mirrors import follow
from recon4.simulation.patterns import Directions, FiringPattern
from recon4.simulation.person import TORSO
from recon4.simulation.rides import CarScene, ElevatorCar
from recon4.simulation.vehicles import Vehicles
from recon4.simulation.walk import Walk

RESOLUTION_M = 0.002
"""Of ranges of profilers and 2-D lasers, and of the LiDAR whose errors `LidarModel` has [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LidarModel:
    """Errors of a sensor; zeros make it perfect. The values are those of a VLP-16."""

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
    carrier_returns: bool = False
    """Beams return from the person, as far as a LiDAR measures so near."""

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

    def of(self, pattern: FiringPattern) -> LidarModel:
        """The errors of another sensor: as the data sheets of both relate."""
        own, other = lidar_model("VLP-16"), lidar_model(pattern.model)
        reach = other.range_m / own.range_m
        return replace(
            self,
            range_sd_m=self.range_sd_m * (other.range_sd_m / own.range_sd_m),
            min_range_m=self.min_range_m * (other.min_range_m / own.min_range_m),
            max_range_m=min(self.max_range_m * reach, pattern.unit_m * pattern.most_units),
            weakest_signal=self.weakest_signal / reach**2,
            divergence_rad=self.divergence_rad * (other.divergence_rad / own.divergence_rad),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Firings:
    """Some packets of one sensor before they are packed. P packets, S sequences, L lasers."""

    t_ns: Times
    """Time of each shot since the start of the walk [ns], (P, S, L)."""
    turn_rad: Array
    """How far the motor has turned at each shot, not modulo 2π, (P, S, L)."""
    distance: NDArray[np.uint32]
    """In units of the pattern, 0 = no return, (P, S, L)."""
    intensity: NDArray[np.uint8]
    """0..255, (P, S, L)."""
    reflectivity: NDArray[np.uint8]
    """Hundred times the true one, 0 = no return, (P, S, L)."""


@dataclass(frozen=True, slots=True, eq=False)
class Lidar:
    """One sensor with its own clock phase, motor phase and beam gains."""

    sensor: Sensor
    pattern: FiringPattern
    model: LidarModel
    first_packet_ns: int
    """Time of its first shot since the start of the walk [ns]."""
    azimuth_rad: float
    """Of its motor at the start of the walk."""
    turn_rate_hz: float
    """Near that of the pattern; two sensors are not phase locked."""
    gain: Array
    """Gain of each laser, (L,)."""
    beam_angle_error_rad: Array
    """By which the elevation (upwards) and azimuth (clockwise) of each laser differ from the data
    sheet, (2, L)."""

    @staticmethod
    def drawn(
        sensor: Sensor, pattern: FiringPattern, *, model: LidarModel, rng: np.random.Generator
    ) -> Lidar:
        """A sensor with phases and gains drawn at random; its errors are `LidarModel.of`."""
        errors = model.of(pattern)
        first_ns = int(rng.integers(0, pattern.packet_ns))
        azimuth_rad = float(rng.uniform(0.0, 2.0 * np.pi))
        rate_hz = pattern.turn_hz * float(1.0 + 5e-4 * rng.uniform(-1.0, 1.0))
        if pattern.steps:  # packets begin at whole steps of the encoder
            rate_hz = pattern.turn_hz
            step = int(azimuth_rad / (2.0 * np.pi) * pattern.steps)
            azimuth_rad = 2.0 * np.pi * (step / pattern.steps - rate_hz * 1e-9 * first_ns)
        return Lidar(
            sensor,
            pattern,
            errors,
            first_ns,
            azimuth_rad,
            rate_hz,
            1.0 + errors.gain_spread * rng.uniform(-1.0, 1.0, pattern.lasers),
            errors.beam_angle_sd_rad * rng.standard_normal((2, pattern.lasers)),
        )

    def packets_before(self, t_ns: int) -> int:
        """Number of packets complete at a time since the start of the walk [ns]."""
        return max(0, (t_ns - self.first_packet_ns) // self.pattern.packet_ns)

    def fire(
        self, packets: range, walk: Walk, surroundings: Surroundings, *, rng: np.random.Generator
    ) -> Firings:
        """Measure from a walking body, every shot from its own pose."""
        pattern = self.pattern
        t_ns = (
            self.first_packet_ns
            + pattern.packet_ns
            * np.arange(packets.start, packets.stop, dtype=np.int64)[:, None, None]
            + pattern.offset_ns
        )
        count = t_ns.size
        t_s = np.asarray(1e-9 * t_ns.ravel(), np.float64)
        turn = self._turn_rad(t_s)
        shot, laser = self._shots(turn)
        half = 0.5 * self.model.divergence_rad
        shot[:, 3:5] = rng.uniform(-half, half, (count, 2))
        mount = self.sensor.T_body_sensor
        rays = np.empty((2 * count, 6), dtype=np.float32)
        make_rays(walk.state(t_s), mount.R, mount.t, shot, rays)
        blocked = np.zeros(count, dtype=np.bool_)
        if self.model.carrier:
            hits_carrier(shot, mount.R, mount.t, TORSO.row(), blocked)
        hits = surroundings.cast(rays, walk, np.tile(t_s, 2))
        noise, unit = hit_noise(count, rng), RangeUnit(pattern.unit_m, pattern.added_m)
        found = measure_hits(
            RaysAndHits(rays, hits, blocked, noise),
            self.gain[laser],
            surroundings=surroundings,
            model=self.model,
            unit=unit,
        )
        if self.model.carrier and self.model.carrier_returns:
            self._add_carrier(found, shot, hits.range_m[:count], noise=noise, unit=unit)
        return Firings(
            t_ns,
            turn.reshape(t_ns.shape),
            found.distance.reshape(t_ns.shape),
            found.intensity.reshape(t_ns.shape),
            found.reflectivity.reshape(t_ns.shape),
        )

    def _add_carrier(
        self,
        found: MeasuredHits,
        shot: Array,
        free_m: NDArray[np.float32],
        *,
        noise: NDArray[np.float32],
        unit: RangeUnit,
    ) -> None:
        """Add the returns from the person; nothing else is nearer along these shots."""
        mount = self.sensor.T_body_sensor
        person_m = np.empty(len(shot))
        carrier_range(shot, mount.R, mount.t, TORSO.row(), person_m)
        met = (person_m > self.model.min_range_m) & (person_m < free_m)
        measured = person_m[met] + self.model.range_sd_m * noise[met, 0]
        found.distance[met] = np.round((measured + unit.added_m) / unit.unit_m)
        found.intensity[met] = found.reflectivity[met] = round(100.0 * MATERIAL.people)

    def points(self, firings: Firings) -> Array:
        """Where its shots ended by what the sensor states, in its own frame [m], (P, S, L, 3).

        Angles are those of the data sheet; a shot without a return ends somewhere.
        """
        directions, _ = self._directions(firings.turn_rad.ravel())
        azimuth, elevation = directions.azimuth_rad, directions.elevation_rad
        range_m = self.pattern.unit_m * firings.distance.ravel() - self.pattern.added_m
        flat = range_m * np.cos(elevation)
        ends = [flat * np.cos(azimuth), -flat * np.sin(azimuth), range_m * np.sin(elevation)]
        xyz = np.stack(ends, axis=1) + directions.origin_m
        return xyz.reshape(*firings.distance.shape, 3)

    def _turn_rad(self, t_s: NDArray[np.floating]) -> Array:
        """How far the motor has turned at times since the start of the walk [s], (N,)."""
        return np.asarray(self.azimuth_rad + 2.0 * np.pi * self.turn_rate_hz * t_s, np.float64)

    def _directions(self, turn_rad: Array) -> tuple[Directions, NDArray[np.int64]]:
        """Of shots in the order of firing, by the data sheet; the laser of each, (N,)."""
        laser = np.arange(len(turn_rad)) % self.pattern.lasers
        return self.pattern.motion.directions(turn_rad, laser), laser

    def _shots(self, turn_rad: Array) -> tuple[Array, NDArray[np.int64]]:
        """True directions for `make_rays`, without the second rays, (N, 7); laser of each, (N,)."""
        directions, laser = self._directions(turn_rad)
        elevation_error, azimuth_error = self.beam_angle_error_rad[:, laser]
        shot = np.zeros((len(turn_rad), 7))
        shot[:, 0] = directions.azimuth_rad + azimuth_error
        shot[:, 1] = directions.elevation_rad + elevation_error
        shot[:, [5, 6, 2]] = directions.origin_m
        return shot, laser


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
        moving = np.array([MATERIAL.people, MATERIAL.vehicle], np.float32)
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

    distance: NDArray[np.uint32]
    """In units of the range, 0 = no return, (N,)."""
    intensity: NDArray[np.uint8]
    """0..255, (N,)."""
    reflectivity: NDArray[np.uint8]
    """Hundred times the true one, 0 = no return, (N,)."""


@dataclass(frozen=True, slots=True)
class RangeUnit:
    """How a sensor states a range."""

    unit_m: float = RESOLUTION_M
    """Of a distance [m]."""
    added_m: float = 0.0
    """It states a range longer by this [m]."""


def hit_noise(count: int, rng: np.random.Generator) -> NDArray[np.float32]:
    """Random numbers of each shot: two normal, two uniform, (N, 4)."""
    noise = np.empty((count, 4), dtype=np.float32)
    noise[:, :2] = rng.standard_normal((count, 2), dtype=np.float32)
    noise[:, 2:] = rng.random((count, 2), dtype=np.float32)
    return noise


def measure_hits(
    given: RaysAndHits,
    gain: Array,
    *,
    surroundings: Surroundings,
    model: LidarModel,
    unit: RangeUnit = RangeUnit(),
) -> MeasuredHits:
    """Measure hits with the errors of a model.

    Args:
        given: Rays and hits.
        gain: Of the laser of each shot, (N,).
        surroundings: What was hit.
        model: Errors.
        unit: Of the distances.
    """
    count, hits = len(gain), given.hits
    found = MeasuredHits(
        np.empty(count, np.uint32), np.empty(count, np.uint8), np.empty(count, np.uint8)
    )
    rules = np.array(
        [
            model.range_sd_m, model.min_range_m, model.max_range_m, model.weakest_signal,
            model.mixed_step_m, model.loss, model.intensity_sd, model.intensity_sd_counts,
            SURFACES.glass, unit.unit_m, unit.added_m,
        ]
    )  # fmt: skip
    measure(
        hits.range_m, hits.triangle, hits.normal, given.rays, surroundings.reflectivity,
        given.blocked, gain, given.noise, rules, found.distance, found.intensity,
        found.reflectivity,
    )  # fmt: skip
    return found
