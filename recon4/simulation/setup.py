"""Everything one simulated recording needs, drawn from one seed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.raycast import Scene
from recon4.model.rig import Rig, load_rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.simulation.crowd import ALONE, Crowd
from recon4.simulation.degradation import BEAM_ANGLE
from recon4.simulation.gait import plan_walk
from recon4.simulation.gnss import GnssModel, simulate_gnss
from recon4.simulation.imu import ImuModel, simulate_imu
from recon4.simulation.lidar import Lidar, LidarModel, Surroundings
from recon4.simulation.walk import Walk
from recon4.simulation.world import World
from recon4.simulation.worlds import build_world

EPOCH_NS = 1_780_308_000_000_000_000
"""Start of every simulated walk: 2026-06-01T10:00:00Z."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Models:
    """Error models of the sensors."""

    lidar: LidarModel = field(default_factory=LidarModel)
    imu: ImuModel = field(default_factory=ImuModel)
    gnss: GnssModel = field(default_factory=GnssModel)

    @staticmethod
    def perfect() -> Models:
        """Sensors without errors."""
        return Models(lidar=LidarModel.perfect(), imu=ImuModel.perfect(), gnss=GnssModel.perfect())


def models_with(degradations: Mapping[str, float]) -> Models:
    """Error models of real sensors, with the errors of their beams that change the rays."""
    sd_rad = float(np.deg2rad(degradations.get(BEAM_ANGLE, 0.0)))
    return Models(lidar=replace(LidarModel(), beam_angle_sd_rad=sd_rad))


@dataclass(frozen=True, slots=True, eq=False)
class SimulationSetup:
    """A person with a rig in a world."""

    world: World
    walk: Walk
    rig: Rig
    models: Models
    lidars: tuple[Lidar, ...]
    surroundings: Surroundings
    seed: int
    epoch_ns: int
    """UTC of the start [ns]."""

    def rng(self, *purpose: int) -> np.random.Generator:
        """A generator of its own for each purpose, so that parts can be left out or reordered."""
        return np.random.default_rng([self.seed, *purpose])


def prepare(
    world: str | World,
    *,
    seconds: float,
    seed: int,
    rig: Rig | None = None,
    models: Models | None = None,
    crowd: Crowd = ALONE,
) -> SimulationSetup:
    """Build a world, plan the walk and mount the sensors.

    Args:
        world: One of `recon4.simulation.worlds.WORLDS`, or one of your own.
        seconds: Length of the walk, at least 5; rounded to 20 ms.
        seed: Draws the walk and all noise.
        rig: VLP-16s and their mounting; None = 4RECON. Addresses and topics that are
            missing are filled in.
        models: Errors of the sensors; None = those of the real ones.
        crowd: People and vehicles that move around the carrier and hide part of the view.

    Raises:
        ConfigError: If there is no such world, the walk is shorter than 5 s, the seed is
            negative or the rig has a sensor other than a VLP-16.
    """
    if not 5.0 <= seconds < 1e6:
        raise ConfigError(f"a walk takes 5 s to 1e6 s, got {seconds}")
    if seed < 0:
        raise ConfigError(f"the seed must not be negative, got {seed}")
    crowd.check()
    used, errors = _addressed(rig or load_rig("4recon")), models or Models()
    for sensor in used.sensors:
        if sensor.model != "VLP-16":
            raise ConfigError(f"only VLP-16 can be simulated, got {sensor.model} ({sensor.name})")
    place = build_world(world) if isinstance(world, str) else world
    lidars = tuple(
        Lidar.drawn(sensor, errors.lidar, np.random.default_rng([seed, 1, row]))
        for row, sensor in enumerate(used.sensors)
    )
    companions, vehicles = crowd.drawn(seed)
    return SimulationSetup(
        place,
        plan_walk(place, seconds=seconds, rng=np.random.default_rng([seed, 0])),
        used,
        errors,
        lidars,
        Surroundings(place.mesh, Scene(place.mesh), companions, place.car, vehicles),
        seed,
        EPOCH_NS,
    )


def imu_samples(setup: SimulationSetup) -> ImuSamples:
    """What the IMU measures on the walk."""
    return simulate_imu(
        setup.walk, setup.rig, setup.models.imu, epoch_ns=setup.epoch_ns, rng=setup.rng(2)
    )


def gnss_samples(setup: SimulationSetup) -> GnssSamples | None:
    """What the GNSS receiver measures on the walk; None = indoors."""
    if not setup.world.outdoors:
        return None
    samples = simulate_gnss(
        setup.walk, setup.rig, setup.models.gnss, origin=setup.world.origin, rng=setup.rng(5)
    )
    return replace(samples, t_ns=setup.epoch_ns + samples.t_ns)


def _addressed(rig: Rig) -> Rig:
    """The rig with unique addresses and topics for all sensors, and beams as in the data sheet."""
    sensors = tuple(
        replace(
            sensor,
            address=sensor.address or f"192.168.1.{201 + row}",
            topic=sensor.topic or f"/{sensor.name}/velodyne_packets",
            beams=None,
        )
        for row, sensor in enumerate(rig.sensors)
    )
    return replace(rig, sensors=sensors)
