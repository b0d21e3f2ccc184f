"""A profiler and a 2-D laser on a walking body."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.rig import Sensor
from recon4.model.trajectory import Times
from recon4.simulation.beams import BeamShots, shoot
from recon4.simulation.lidar import LidarModel, Surroundings
from recon4.simulation.walk import Walk


def _profiler_errors() -> LidarModel:
    return LidarModel(
        range_sd_m=0.005,
        min_range_m=0.3,
        max_range_m=120.0,
        divergence_rad=0.00035,
        mixed_step_m=0.5,
        gain_spread=0.0,
    )


def _laser2d_errors() -> LidarModel:
    return LidarModel(
        range_sd_m=0.012,
        min_range_m=0.3,
        max_range_m=20.0,
        weakest_signal=3e-4,
        divergence_rad=0.015,
        mixed_step_m=0.5,
        gain_spread=0.0,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class HeadModel:
    """How the head turns (requirements A1, L-HW: 6 s a sweep, 90° behind the person skipped)."""

    sweep_rad: float = float(np.deg2rad(270.0))
    """From one reversal to the next [rad]."""
    sweep_s: float = 6.0
    """Duration of a sweep [s]."""
    reversal_s: float = 0.3
    """Duration of braking, and of starting again, at either end [s]."""
    encoder_sd_rad: float = float(np.deg2rad(0.002))
    """Standard deviation of a reported angle [rad]."""

    def angle_rad(self, t_s: Array) -> Array:
        """True angle of the head, from - sweep / 2 to sweep / 2 and back, (N,) -> (N,)."""
        phase = np.mod(t_s, 2.0 * self.sweep_s)
        since = np.where(phase < self.sweep_s, phase, 2.0 * self.sweep_s - phase)
        braking = self.reversal_s
        speed = self.sweep_rad / (self.sweep_s - braking)
        left = self.sweep_s - since
        travelled = speed * (since - 0.5 * braking)
        travelled = np.where(since < braking, speed * since**2 / (2.0 * braking), travelled)
        at_end = self.sweep_rad - speed * left**2 / (2.0 * braking)
        return np.asarray(np.where(left < braking, at_end, travelled) - 0.5 * self.sweep_rad)


@dataclass(frozen=True, slots=True, kw_only=True)
class ProfilerModel:
    """Line scans of a profiler such as the Riegl VZ-400 (requirements A1, L-HW)."""

    lines_hz: float = 103.0
    """Line scans per second."""
    shots: int = 735
    """Shots of a line."""
    lowest_rad: float = float(np.deg2rad(-40.0))
    highest_rad: float = float(np.deg2rad(60.0))
    """Elevation of the first and the last shot of a line [rad]."""
    active: float = 0.8
    """Part of a line's time in which it measures; then the mirror comes to its next facet."""
    head: HeadModel = field(default_factory=HeadModel)
    errors: LidarModel = field(default_factory=_profiler_errors)


@dataclass(frozen=True, slots=True, kw_only=True)
class Laser2dModel:
    """A 2-D laser such as the SICK LMS100."""

    scans_hz: float = 25.0
    """25 with 0.25°, or 50 with 0.5°."""
    beams: int = 1081
    angle_min_rad: float = float(np.deg2rad(-135.0))
    angle_step_rad: float = float(np.deg2rad(0.25))
    upside_down: bool = False
    """Whether it is mounted with its z axis down, which its angles do not say."""
    errors: LidarModel = field(default_factory=_laser2d_errors)


@dataclass(frozen=True, slots=True, eq=False)
class SimulatedLines:
    """Some line scans. L lines of S shots."""

    t_ns: Times
    """Time of the first shot of each since the start of the walk [ns], (L,)."""
    head_rad: Array
    """Angle of the head at that time, as its encoder says [rad], (L,)."""
    range_m: NDArray[np.float32]
    """NaN = no return, (L, S)."""
    intensity: NDArray[np.uint8]
    """(L, S)."""


@dataclass(frozen=True, slots=True, eq=False)
class SimulatedProfiler:
    """One profiler with the phases of its mirror and head."""

    sensor: Sensor
    model: ProfilerModel
    first_ns: int
    """Time of its first line since the start of the walk [ns]."""
    head_s: float
    """Phase of the head [s]."""

    @staticmethod
    def drawn(sensor: Sensor, model: ProfilerModel, rng: np.random.Generator) -> SimulatedProfiler:
        """A profiler with phases drawn at random."""
        return SimulatedProfiler(
            sensor,
            model,
            int(rng.integers(0, 10_000_000)),
            float(rng.uniform(0.0, 2.0 * model.head.sweep_s)),
        )

    @property
    def shot_s(self) -> float:
        """From one shot of a line to the next [s]."""
        return self.model.active / (self.model.lines_hz * self.model.shots)

    def lines_before(self, t_ns: int) -> int:
        """Number of lines complete at a time since the start of the walk [ns]."""
        return max(0, int((t_ns - self.first_ns) * 1e-9 * self.model.lines_hz))

    def measure(
        self, lines: range, walk: Walk, surroundings: Surroundings, *, rng: np.random.Generator
    ) -> SimulatedLines:
        """Measure some lines, from the lowest shot to the highest."""
        model = self.model
        number = np.arange(lines.start, lines.stop, dtype=np.int64)
        t_ns = self.first_ns + np.rint(number * (1e9 / model.lines_hz)).astype(np.int64)
        t_s = 1e-9 * t_ns[:, None] + self.shot_s * np.arange(model.shots)
        direction = np.empty((t_s.size, 2))
        direction[:, 0] = model.head.angle_rad(t_s.ravel() + self.head_s)
        direction[:, 1] = np.tile(
            np.linspace(model.lowest_rad, model.highest_rad, model.shots), len(t_ns)
        )
        returns = shoot(
            BeamShots(t_s.ravel(), direction, self.sensor.T_body_sensor),
            walk=walk, surroundings=surroundings, model=model.errors, rng=rng,
        )  # fmt: skip
        head = model.head.angle_rad(t_s[:, 0] + self.head_s)
        head = head + model.head.encoder_sd_rad * rng.standard_normal(len(head))
        shape = t_s.shape
        return SimulatedLines(
            t_ns, head, returns.range_m.reshape(shape), returns.intensity.reshape(shape)
        )


@dataclass(frozen=True, slots=True, eq=False)
class SimulatedLaser2d:
    """One 2-D laser with the phase of its motor."""

    sensor: Sensor
    model: Laser2dModel
    first_ns: int
    """Time of its first scan since the start of the walk [ns]."""

    @staticmethod
    def drawn(sensor: Sensor, model: Laser2dModel, rng: np.random.Generator) -> SimulatedLaser2d:
        """A 2-D laser with a phase drawn at random."""
        return SimulatedLaser2d(sensor, model, int(rng.integers(0, 20_000_000)))

    @property
    def beam_s(self) -> float:
        """From one beam to the next [s]: a full turn of the mirror takes one scan's time."""
        return self.model.angle_step_rad / (2.0 * np.pi * self.model.scans_hz)

    def scans_before(self, t_ns: int) -> int:
        """Number of scans complete at a time since the start of the walk [ns]."""
        return max(0, int((t_ns - self.first_ns) * 1e-9 * self.model.scans_hz))

    def measure(
        self, scans: range, walk: Walk, surroundings: Surroundings, *, rng: np.random.Generator
    ) -> LaserScans:
        """Measure some scans; times count from the start of the walk."""
        model = self.model
        number = np.arange(scans.start, scans.stop, dtype=np.int64)
        t_ns = self.first_ns + np.rint(number * (1e9 / model.scans_hz)).astype(np.int64)
        t_s = 1e-9 * t_ns[:, None] + self.beam_s * np.arange(model.beams)
        direction = np.zeros((t_s.size, 2))
        angles = model.angle_min_rad + model.angle_step_rad * np.arange(model.beams)
        direction[:, 0] = np.tile(-angles if model.upside_down else angles, len(t_ns))
        returns = shoot(
            BeamShots(t_s.ravel(), direction, self.sensor.T_body_sensor),
            walk=walk, surroundings=surroundings, model=model.errors, rng=rng,
        )  # fmt: skip
        return LaserScans.of_rows(
            t_ns,
            returns.range_m.reshape(t_s.shape),
            angles=(model.angle_min_rad, model.angle_step_rad),
            range_max_m=model.errors.max_range_m,
            time_step_s=self.beam_s,
        )
