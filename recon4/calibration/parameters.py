"""The parameters of a calibration: their columns, units and priors, and how they change a rig."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.tuning_joint import PARAMETERS
from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, proper, so3_exp
from recon4.model.beams import BeamCorrections
from recon4.model.calibration_figures import IMU
from recon4.model.rig import Rig, Sensor

Unit = Literal["rad", "m", "s"]

_PRIOR_SD: dict[Unit, float] = {"rad": 0.2, "m": 0.3, "s": 0.1}
"""Standard deviation of each parameter before the walk is looked at: hardly any knowledge."""
_BEAM_PRIOR_SD: dict[Unit, float] = {"rad": float(np.deg2rad(0.05)), "m": 0.03}
"""The same of a beam: assemblies are exact to some hundredths of a degree."""
_AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number that is estimated."""

    sensor: str
    """Name of the LiDAR in the rig, or ``imu``."""
    quantity: Literal[
        "rotation", "position", "clock", "beam range", "beam elevation", "beam azimuth"
    ]
    axis: str
    """``x``, ``y`` or ``z`` of the body; empty for a clock; the ring of a beam."""
    unit: Unit

    @property
    def of_beam(self) -> bool:
        """Whether it belongs to a single beam."""
        return self.quantity.startswith("beam")

    @property
    def name(self) -> str:
        """For tables and messages, as ``vertical rotation y``."""
        return " ".join(part for part in (self.sensor, self.quantity, self.axis) if part)


@dataclass(frozen=True, slots=True, eq=False)
class Parameters:
    """Seven parameters for each LiDAR but the reference and for the IMU: rotation, position, clock.
    On request also three for each beam of any LiDAR: range, elevation, azimuth.

    The mount of the reference LiDAR defines the body, and its clock defines the time.
    """

    reference: int
    """Row of the reference LiDAR in ``Rig.sensors``."""
    lidars: tuple[int, ...]
    """Rows of the other LiDARs that are calibrated."""
    imu: bool
    """Whether the IMU is calibrated."""
    listed: tuple[Parameter, ...]
    prior_sd: Array
    """Standard deviation of each before the walk is looked at, (P,)."""
    beams: tuple[tuple[int, int], ...] = ()
    """LiDARs whose beams are calibrated: row and number of beams."""

    @staticmethod
    def none() -> Parameters:
        """Nothing is estimated."""
        return Parameters(0, (), False, (), np.empty(0))

    @staticmethod
    def of(rig: Rig, *, reference: int, lidars: tuple[int, ...], imu: bool) -> Parameters:
        """All parameters of some LiDARs and the IMU of a rig."""
        names = [rig.sensors[row].name for row in lidars] + ([IMU] if imu else [])
        listed = tuple(parameter for name in names for parameter in _seven(name))
        prior_sd = np.array([_PRIOR_SD[parameter.unit] for parameter in listed])
        return Parameters(reference, lidars, imu, listed, prior_sd)

    def with_beams(self, rig: Rig, counts: Mapping[int, int]) -> Parameters:
        """The same parameters and those of the beams of some LiDARs.

        Args:
            rig: Names of the sensors.
            counts: Number of beams by row of the LiDAR.
        """
        added = [
            parameter
            for row, count in counts.items()
            for parameter in _of_beams(rig.sensors[row].name, count)
        ]
        sd = [_BEAM_PRIOR_SD[parameter.unit] for parameter in added]
        return replace(
            self,
            listed=(*self.listed, *added),
            prior_sd=np.concatenate([self.prior_sd, sd]),
            beams=tuple(counts.items()),
        )

    def __len__(self) -> int:
        return len(self.listed)

    @property
    def prior(self) -> Array:
        """Information before the walk is looked at, (P, P).

        An azimuth that all beams of a LiDAR share is the yaw of its mount: their mean stays. A
        range bias that all beams share is observed, because it moves a wall less that is seen
        obliquely; in a single room it changes little but the size of the room.
        """
        information = np.diag(self.prior_sd**-2.0)
        ranges = np.zeros(len(self))
        for row, count in self.beams:
            ranges[self.of_beams(row)][:count] = 1.0
            azimuth = np.zeros(len(self))
            azimuth[self.of_beams(row)][2 * count :] = 1.0 / count
            information += np.outer(azimuth, azimuth) / PARAMETERS.mean_azimuth_sd_rad**2
        mean = ranges / max(ranges.sum(), 1.0)
        return np.asarray(information + np.outer(mean, mean) / PARAMETERS.mean_range_sd_m**2)

    def of_beams(self, row: int) -> slice:
        """Columns of the beams of a LiDAR: all ranges, elevations, azimuths."""
        first = 7 * (len(self.lidars) + self.imu)
        for other, count in self.beams:
            if other == row:
                return slice(first, first + 3 * count)
            first += 3 * count
        raise KeyError(row)

    def of_lidar(self, row: int) -> slice:
        """Columns of a LiDAR: rotation, position, clock."""
        first = 7 * self.lidars.index(row)
        return slice(first, first + 7)

    @property
    def of_imu(self) -> slice:
        """Columns of the IMU: rotation, position, clock."""
        first = 7 * len(self.lidars)
        return slice(first, first + 7)

    @property
    def fixed(self) -> NDArray[np.bool_]:
        """Parameters that keep their values, (P,)."""
        return np.asarray(self.prior_sd <= PARAMETERS.known_sd)

    def fixing(self, known: NDArray[np.bool_]) -> Parameters:
        """The same parameters, of which some, (P,) bool, keep their values."""
        return replace(self, prior_sd=np.where(known, PARAMETERS.known_sd, self.prior_sd))

    def keeping(self, known: NDArray[np.bool_], recorded: Rig, found: Rig) -> Rig:
        """The rig that was found, but with the recorded values of some parameters, (P,) bool."""
        return self.changed(recorded, np.where(known, 0.0, self.between(recorded, found)))

    def changed(self, rig: Rig, delta: Array) -> Rig:
        """A rig after a small change of the parameters, (P,).

        Rotations are about axes of the body through the sensor's own origin.
        """
        sensors = list(rig.sensors)
        for row in self.lidars:
            step = delta[self.of_lidar(row)]
            sensors[row] = replace(
                sensors[row],
                T_body_sensor=_moved(sensors[row].T_body_sensor, step),
                time_offset_s=sensors[row].time_offset_s + float(step[6]),
            )
        for row, count in self.beams:
            rows = delta[self.of_beams(row)].reshape(3, count) + _beam_rows(sensors[row], count)
            sensors[row] = replace(sensors[row], beams=BeamCorrections.of(rows))
        step = delta[self.of_imu] if self.imu else np.zeros(7)
        T_body_imu = _moved(rig.T_body_imu, step) if self.imu else rig.T_body_imu
        moved = replace(rig, sensors=tuple(sensors), T_body_imu=T_body_imu)
        # The clock of the LiDAR that it is in may have changed, too: both are of the recording.
        since_s = moved.imu_clock_offset_s - rig.imu_clock_offset_s
        return replace(moved, imu_time_offset_s=rig.imu_time_offset_s + float(step[6]) - since_s)

    def between(self, before: Rig, after: Rig) -> Array:
        """The change of the parameters that leads from one rig to another, (P,)."""
        rows = [
            (before.sensors[row].T_body_sensor, after.sensors[row].T_body_sensor,
             after.sensors[row].time_offset_s - before.sensors[row].time_offset_s)
            for row in self.lidars
        ]  # fmt: skip
        if self.imu:
            clock_s = after.imu_clock_offset_s - before.imu_clock_offset_s
            rows.append((before.T_body_imu, after.T_body_imu, clock_s))
        beams = [
            _beam_rows(after.sensors[row], count) - _beam_rows(before.sensors[row], count)
            for row, count in self.beams
        ]
        return np.concatenate(
            [np.empty(0), *(_change(*row) for row in rows), *(change.ravel() for change in beams)]
        )


def _seven(name: str) -> list[Parameter]:
    return [
        *(Parameter(name, "rotation", axis, "rad") for axis in _AXES),
        *(Parameter(name, "position", axis, "m") for axis in _AXES),
        Parameter(name, "clock", "", "s"),
    ]


def _of_beams(name: str, count: int) -> list[Parameter]:
    rings = [str(ring) for ring in range(count)]
    return [
        *(Parameter(name, "beam range", ring, "m") for ring in rings),
        *(Parameter(name, "beam elevation", ring, "rad") for ring in rings),
        *(Parameter(name, "beam azimuth", ring, "rad") for ring in rings),
    ]


def _beam_rows(sensor: Sensor, count: int) -> Array:
    """Range, elevation and azimuth of the first beams, (3, count)."""
    rows = np.zeros((3, count))
    if sensor.beams is not None:
        used = min(count, len(sensor.beams))
        rows[:, :used] = sensor.beams.rows[:, :used]
    return rows


def _moved(T_body_sensor: SE3, step: Array) -> SE3:
    R = proper(so3_exp(step[ROTATION]) @ T_body_sensor.R)
    return SE3(R, T_body_sensor.t + step[TRANSLATION])


def _change(before: SE3, after: SE3, clock_s: float) -> Array:
    turn = SE3(after.R @ before.R.T, np.zeros(3)).log()[ROTATION]
    return np.concatenate([turn, after.t - before.t, [clock_s]])
