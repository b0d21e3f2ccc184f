"""Everything one simulated recording needs, drawn from one seed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.raycast import Scene
from recon4.geometry.se3 import SE3
from recon4.locales.coded import CodedText
from recon4.model.imu_mounts import imu_mount
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig, Sensor, load_rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.simulation.crowd import ALONE, Crowd
from recon4.simulation.degradation import BEAM_ANGLE
from recon4.simulation.families.families import family_of, pattern_of
from recon4.simulation.families.family import BuiltInImu
from recon4.simulation.gait import plan_walk
from recon4.simulation.gnss import GnssModel, simulate_gnss
from recon4.simulation.imu import ImuModel, simulate_imu
from recon4.simulation.lidar import Lidar, LidarModel, Surroundings
from recon4.simulation.walk import Walk
from recon4.simulation.world import World
from recon4.simulation.worlds import build_world

EPOCH_NS = int(np.datetime64("2026-06-01T10:00:00", "ns").astype(np.int64))
"""Start of every simulated walk, UTC [ns]."""


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
    imu_row: int | None = None
    """Row of the LiDAR whose built-in IMU is that of the rig; None = it is a device of its own."""

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
        rig: LiDARs and their mounting; None = 4RECON. Addresses and topics that are
            missing are filled in.
        models: Errors of a VLP-16 and of the samples; those of other LiDARs are larger or smaller
            as the data sheets say. None = those of the real ones.
        crowd: People and vehicles that move around the carrier and hide part of the view.

    Raises:
        ConfigError: If there is no such world, the walk is shorter than 5 s, the seed is
            negative or the rig has a sensor that is not simulated.
    """
    if not 5.0 <= seconds < 1e6:
        raise ConfigError(CodedText("simulate-seconds", seconds=seconds))
    if seed < 0:
        raise ConfigError(CodedText("simulate-seed", seed=seed))
    crowd.check()
    used, errors = _addressed(rig or load_rig("4recon")), models or Models()
    row = imu_row(used)
    if row is not None:
        used = replace(used, T_body_imu=imu_mount(used.sensors[row], used.T_body_imu))
        rate_hz = built_in_imu(used.sensors[row]).rate_hz
        errors = replace(errors, imu=replace(errors.imu, rate_hz=rate_hz))
    place = build_world(world) if isinstance(world, str) else world
    lidars = _lidars(used, errors, seed)
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
        row,
    )


def rig_of_lidars(models: Sequence[str]) -> Rig:
    """A rig with one or two LiDARs, mounted as those of 4RECON; the first IMU in them is used.

    A second one that does not see all around looks back.

    Raises:
        ConfigError: If there are none or more than two, or one is not simulated.
    """
    mounts = load_rig("4recon")
    if not 1 <= len(models) <= len(mounts.sensors):
        raise ConfigError(CodedText("simulate-lidars", count=len(models)))
    used: set[int] = set()
    sensors: list[Sensor] = []
    for model, mount in zip(models, mounts.sensors, strict=False):
        family_of(model)
        facts = lidar_model(model)
        port = next(k for k in count(facts.port) if k not in used)
        used |= {port, *facts.sample_ports}
        if sensors and facts.azimuth_deg < 360.0:
            back = SE3.from_rpy(0.0, 0.0, np.pi, t=mount.T_body_sensor.t)
            mount = replace(mount, name="back", T_body_sensor=back)
        sensors.append(replace(mount, model=model, port=port))
    rig = replace(mounts, name=" and ".join(models), sensors=tuple(sensors))
    for sensor in sensors:
        if family_of(sensor.model).imu(sensor.model) is not None:
            # Named: a reader would take the first LiDAR that has one, simulated or not.
            place = imu_mount(sensor)
            return replace(rig, imu_sensor=sensor.name, T_body_imu=place, imu_time_offset_s=0.0)
    return rig


def imu_row(rig: Rig) -> int | None:
    """Row of the LiDAR in which the IMU of the rig is: named, or at this place; None = in none.

    Raises:
        ConfigError: If a LiDAR is not simulated, or the named one has no IMU that is.
    """
    for row, sensor in enumerate(rig.sensors):
        if sensor.name == rig.imu_sensor:
            if family_of(sensor.model).imu(sensor.model) is None:
                raise ConfigError(CodedText("simulate-imu", model=sensor.model, sensor=sensor.name))
            return row
        place = _place_of_imu(sensor)
        if place is not None:
            off = place.inverse() @ rig.T_body_imu
            if np.allclose(off.matrix(), np.eye(4), atol=1e-3):
                return row
    return None


def _place_of_imu(sensor: Sensor) -> SE3 | None:
    """Where the IMU in a LiDAR is, if it is simulated and the data sheet tells."""
    simulated = family_of(sensor.model).imu(sensor.model) is not None
    return imu_mount(sensor) if simulated and lidar_model(sensor.model).has_imu else None


def built_in_imu(sensor: Sensor) -> BuiltInImu:
    """The IMU in a LiDAR that has one."""
    found = family_of(sensor.model).imu(sensor.model)
    assert found is not None
    return found


def _lidars(rig: Rig, models: Models, seed: int) -> tuple[Lidar, ...]:
    """The LiDARs of a rig, each drawn by a generator of its own."""
    return tuple(
        Lidar.drawn(
            sensor,
            pattern_of(sensor.model),
            model=models.lidar,
            rng=np.random.default_rng([seed, 1, row]),
        )
        for row, sensor in enumerate(rig.sensors)
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
            topic=sensor.topic or f"/{sensor.name}/{family_of(sensor.model).name.lower()}_packets",
            beams=None,
        )
        for row, sensor in enumerate(rig.sensors)
    )
    return replace(rig, sensors=sensors)
