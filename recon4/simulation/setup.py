"""Everything one simulated recording needs, drawn from one seed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.model.rig import Rig
from recon4.simulation.gait import plan_walk
from recon4.simulation.imu import ImuModel
from recon4.simulation.lidar import Lidar, LidarModel, Surroundings
from recon4.simulation.raycast import Scene
from recon4.simulation.walk import Walk
from recon4.simulation.world import World
from recon4.simulation.worlds import build_world

EPOCH_NS = 1_780_308_000_000_000_000
"""Start of every simulated walk: 2026-06-01T10:00:00Z."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Models:
    """How imperfect the sensors are."""

    lidar: LidarModel = LidarModel()
    imu: ImuModel = ImuModel()

    @staticmethod
    def perfect() -> Models:
        """Sensors without errors."""
        return Models(lidar=LidarModel.perfect(), imu=ImuModel.perfect())


@dataclass(frozen=True, slots=True, eq=False)
class Setup:
    """A person with a rig in a world."""

    world: World
    walk: Walk
    rig: Rig
    models: Models
    lidars: tuple[Lidar, ...]
    surroundings: Surroundings
    seed: int

    def rng(self, *purpose: int) -> np.random.Generator:
        """A generator of its own for each purpose, so that parts can be left out or reordered."""
        return np.random.default_rng([self.seed, *purpose])


def prepare(world: str, *, seconds: float, seed: int, rig: Rig, models: Models) -> Setup:
    """Build a world, plan the walk and mount the sensors.

    Raises:
        ConfigError: If there is no such world, the walk is shorter than 5 s or the rig has a
            sensor other than a VLP-16.
    """
    if seconds < 5.0:
        raise ConfigError(f"a walk takes at least 5 s, got {seconds}")
    if seed < 0:
        raise ConfigError(f"the seed must not be negative, got {seed}")
    for sensor in rig.sensors:
        if sensor.model != "VLP-16":
            raise ConfigError(f"only VLP-16 can be simulated, got {sensor.model} ({sensor.name})")
    place = build_world(world)
    walk = plan_walk(place, seconds=seconds, rng=np.random.default_rng([seed, 0]))
    lidars = tuple(
        Lidar.drawn(sensor, models.lidar, np.random.default_rng([seed, 1, row]))
        for row, sensor in enumerate(rig.sensors)
    )
    surroundings = Surroundings(place.mesh, Scene(place.mesh))
    return Setup(place, walk, rig, models, lidars, surroundings, seed)
