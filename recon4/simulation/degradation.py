"""Errors of a recording that its rig file does not know: ``recon4 simulate --degrade``.

Nothing here changes the walk, and only `PEOPLE`, `VEHICLES`, `BEAM_ANGLE` and `UPSIDE_DOWN` the
rays. A degradation changes what is written: what the rig file says, the clocks of the stamps, the
samples of the IMU, which shots and packets there are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.simulation.imu import ImuModel
from recon4.simulation.lidar import Firings
from recon4.simulation.patterns import FiringPattern
from recon4.units import STANDARD_GRAVITY_M_S2


@dataclass(frozen=True, slots=True, kw_only=True)
class DegradationCourse:
    """When and how what is degraded comes and goes."""

    burst_packets: int = 6
    """Packets are lost in runs of this length on average."""
    silent_from_s: float = 20.0
    """The head and the 2-D laser of the backpack are silent from this time of the walk on."""


COURSE = DegradationCourse()


@dataclass(frozen=True, slots=True)
class DegradationKind:
    """What one degradation means."""

    usual: float
    """Value without ``=VALUE``."""
    largest: float
    unit: str
    text: str

    @staticmethod
    def switch(text: str) -> DegradationKind:
        """One that is there or not."""
        return DegradationKind(1.0, 1, "", text)


_FROM = f"from {COURSE.silent_from_s:g} s on"
KINDS: Mapping[str, DegradationKind] = {
    "extrinsics": DegradationKind(1.4, 180, "°", "the last LiDAR is rotated against the rig file"),
    "mount-shift": DegradationKind(0.05, 5, "m", "the last LiDAR is not where the rig file says"),
    "swap-lidars": DegradationKind.switch("the mounts of two LiDARs are exchanged"),
    "wrong-model": DegradationKind.switch("the rig file calls the last LiDAR an HDL-32E"),
    "lidar-clock": DegradationKind(0.02, 100, "s", "the clock of the last LiDAR is ahead"),
    "lidar-drift": DegradationKind(300, 1e5, "ppm", "the clock of the last LiDAR is too fast"),
    "imu-clock": DegradationKind(0.02, 100, "s", "the clock of the IMU is ahead"),
    "imu-drift": DegradationKind(300, 1e5, "ppm", "the clock of the IMU is too fast"),
    "gnss-clock": DegradationKind(0.1, 100, "s", "the clock of the receiver is ahead"),
    "imu-rotation": DegradationKind(1.5, 180, "°", "the IMU is rotated against the rig file"),
    "imu-axes": DegradationKind.switch("x and y of the IMU are exchanged, z is turned"),
    "imu-grade": DegradationKind(5, 1e4, "", "noise and biases of the IMU are larger by this"),
    "imu-scale": DegradationKind(0.03, 10, "", "ratio by which the IMU measures too much"),
    "imu-unit": DegradationKind.switch("accelerations are in g in place of m/s²"),
    "no-imu": DegradationKind.switch("no IMU was recorded"),
    "no-gnss": DegradationKind.switch("no GNSS was recorded"),
    "lever-arm": DegradationKind(0.15, 10, "m", "the antenna is not where the rig file says"),
    "dead-beams": DegradationKind(6, 128, "", "number of lasers that return nothing"),
    "beam-bias": DegradationKind(0.03, 1, "m", "standard deviation of a range bias of each laser"),
    "beam-angle": DegradationKind(
        0.03, 1, "°", "standard deviation of the elevation and azimuth of each laser"
    ),
    "packet-loss": DegradationKind(0.25, 0.95, "", "ratio of packets or line scans lost, in runs"),
    "late-start": DegradationKind(
        3.0, 1e4, "s", "the recording begins this long after the walk, in motion"
    ),
    "people": DegradationKind(5, 12, "", "number of people who walk along and hide the view"),
    "vehicles": DegradationKind(
        3, 6, "", "number of vehicles that move: a car beside, a bus that drives off, a fast car"
    ),
    "no-head": DegradationKind.switch("the angles of the profiler's head are missing"),
    "head-stuck": DegradationKind.switch("the profiler reports one angle of its head"),
    "head-pause": DegradationKind(4.0, 1e4, "s", f"the head reports one angle {_FROM}"),
    "lines-cm": DegradationKind.switch("ranges of the profiler are in centimeters"),
    "laser2d-cm": DegradationKind.switch("ranges of the 2-D laser are in centimeters"),
    "laser2d-clock": DegradationKind(0.02, 1e6, "s", "the clock of the 2-D laser is ahead"),
    "laser2d-silent": DegradationKind(5.0, 1e4, "s", f"the 2-D laser is silent {_FROM}"),
    "laser2d-mirrored": DegradationKind.switch("the 2-D laser is mounted upside down"),
    "no-laser2d": DegradationKind.switch("no 2-D laser was recorded"),
}
PEOPLE = "people"
"""It changes the rays, see `recon4.simulation.companions`."""
VEHICLES = "vehicles"
"""Likewise, see `recon4.simulation.vehicles`."""
WRONG_MODEL = "wrong-model"
"""The two models must send the same packets."""
BEAM_ANGLE = "beam-angle"
"""See `recon4.simulation.lidar.LidarModel.beam_angle_sd_rad`."""
UPSIDE_DOWN = "laser2d-mirrored"
"""The beams of the 2-D laser sweep the other way."""
ONLY_PROFILER = frozenset(
    {"no-head", "head-stuck", "head-pause", "lines-cm", "laser2d-cm", "laser2d-clock"}
    | {"laser2d-silent", "laser2d-mirrored", "no-laser2d"}
)
"""Degradations of rigs with a profiler."""
NOT_PROFILER = frozenset(
    {"wrong-model", "dead-beams", "beam-bias", "swap-lidars", "late-start", BEAM_ANGLE, VEHICLES}
)
"""Degradations that a rig with a profiler cannot have."""


def parse_degradations(words: Sequence[str]) -> dict[str, float]:
    """Read ``NAME`` or ``NAME=VALUE``; without a value the usual one.

    Raises:
        ConfigError: If there is no such degradation, or the value is no number in its range.
    """
    found = {}
    for word in words:
        name, equals, text = word.partition("=")
        if name not in KINDS:
            raise ConfigError(
                CodedText("simulate-degradation", name=name[:80], kinds=", ".join(KINDS))
            )
        try:
            value = float(text) if equals else KINDS[name].usual
        except ValueError:
            raise ConfigError(
                CodedText("simulate-degradation-number", name=name, text=text[:80])
            ) from None
        found[name] = value
    check_degradations(found)
    return found


def check_degradations(values: Mapping[str, float]) -> None:
    """Check names and values.

    Raises:
        ConfigError: Naming the degradation, the expected and the found value.
    """
    for name, value in values.items():
        if name not in KINDS:
            raise ConfigError(
                CodedText("simulate-degradation", name=name[:80], kinds=", ".join(KINDS))
            )
        if not 0.0 < value <= KINDS[name].largest:
            largest = KINDS[name].largest
            raise ConfigError(
                CodedText("simulate-degradation-range", name=name, largest=largest, value=value)
            )


@dataclass(frozen=True, slots=True, eq=False)
class Degradation:
    """The degradations of one recording, with everything that is drawn at random."""

    values: Mapping[str, float]
    """Of `KINDS`; empty = a recording as it should be."""
    axis_lidar: Array
    """Unit vector of the rotation and shift of the last LiDAR, in the body, (3,)."""
    axis_imu: Array
    """Unit vector of the rotation of the IMU, in the body, (3,)."""
    direction_antenna: Array
    """Unit vector of the shift of the antenna, in the body, (3,)."""
    dead: Sequence[NDArray[np.int64]]
    """Lasers of each sensor that return nothing, in the order of firing, (K,) each."""
    range_bias_m: Sequence[Array]
    """Range bias of each laser of each sensor in the order of firing [m], (L,) each."""
    seed: int

    @staticmethod
    def drawn(values: Mapping[str, float], *, lasers: Sequence[int], seed: int) -> Degradation:
        """Draw what is random in some degradations.

        Args:
            values: By name.
            lasers: Number of lasers of each sensor.
            seed: Of the recording.

        Raises:
            ConfigError: If a name or a value is not allowed.
        """
        check_degradations(values)
        rng = np.random.default_rng([seed, 7])
        axes = rng.standard_normal((3, 3))
        axes /= np.linalg.norm(axes, axis=1, keepdims=True)
        count = int(values.get("dead-beams", 0))
        if count > min(lasers):
            raise ConfigError(CodedText("simulate-dead-beams", lasers=min(lasers), count=count))
        dead = [np.sort(rng.permutation(number)[:count]) for number in lasers]
        sd_m = values.get("beam-bias", 0.0)
        bias = [sd_m * rng.standard_normal(number) for number in lasers]
        return Degradation(dict(values), axes[0], axes[1], axes[2], dead, bias, seed)

    def nominal_rig(self, true: Rig) -> Rig:
        """What the rig file says of a rig."""
        sensors = list(true.sensors)
        last = sensors[-1]
        turned = _turned(last.T_body_sensor, self.axis_lidar, self._get("extrinsics"))
        shifted = SE3(turned.R, turned.t + self._get("mount-shift") * self.axis_lidar)
        model = "HDL-32E" if WRONG_MODEL in self.values else last.model
        sensors[-1] = replace(last, T_body_sensor=shifted, model=model)
        if "swap-lidars" in self.values and len(sensors) > 1:
            first, second = (sensor.T_body_sensor for sensor in sensors[:2])
            sensors[0] = replace(sensors[0], T_body_sensor=second)
            sensors[1] = replace(sensors[1], T_body_sensor=first)
        antenna = true.p_body_antenna + self._get("lever-arm") * self.direction_antenna
        T_body_imu = _turned(true.T_body_imu, self.axis_imu, self._get("imu-rotation"))
        return replace(true, sensors=tuple(sensors), T_body_imu=T_body_imu, p_body_antenna=antenna)

    def imu_model(self, model: ImuModel) -> ImuModel:
        """Errors of the IMU that was really mounted."""
        grade = self.values.get("imu-grade", 1.0)
        errors = [f.name for f in fields(model) if f.name != "rate_hz"]
        return replace(model, **{name: grade * getattr(model, name) for name in errors})

    def imu(self, samples: ImuSamples) -> ImuSamples:
        """Samples as they are written."""
        scale = 1.0 + self._get("imu-scale")
        unit = 1.0 / STANDARD_GRAVITY_M_S2 if "imu-unit" in self.values else 1.0
        gyro, accel = scale * samples.gyro_rad_s, scale * unit * samples.accel_m_s2
        if "imu-axes" in self.values:  # a rotation, so the axes stay right-handed
            gyro, accel = (v[:, [1, 0, 2]] * [1.0, 1.0, -1.0] for v in (gyro, accel))
        t_ns = self._stamps("imu", samples.t_ns, samples.t_ns[0])
        kept = self.recorded(samples.t_ns - samples.t_ns[0])
        return ImuSamples(t_ns[kept], gyro[kept], accel[kept])

    def gnss(self, samples: GnssSamples) -> GnssSamples:
        """Positions as they are written."""
        kept = self.recorded(samples.t_ns - samples.t_ns[0])
        stamped = replace(samples, t_ns=self._stamps("gnss", samples.t_ns, samples.t_ns[0]))
        return stamped.take(kept)

    def stamps(self, row: int, t_ns: Times, *, sensors: int) -> Times:
        """Times since the start of the walk by the clock of a LiDAR [ns], (N,)."""
        return self._stamps("lidar", t_ns, 0) if row == sensors - 1 else t_ns

    def degrade_firings(
        self, firings: Firings, row: int, second: int, *, pattern: FiringPattern
    ) -> Firings:
        """What is recorded of the firings of one sensor in one second."""
        distance, truth = firings.distance.copy(), firings.reflectivity.copy()
        distance[..., self.dead[row]] = 0
        truth[..., self.dead[row]] = 0
        if "beam-bias" in self.values:
            # Rounded at random, so that the mean is the bias and not a multiple of the resolution.
            rng = np.random.default_rng([self.seed, 9, row, second])
            units = self.range_bias_m[row] / pattern.unit_m + rng.uniform(-0.5, 0.5, distance.shape)
            biased = np.clip(np.rint(distance + units), 1, pattern.most_units)
            distance = np.where(distance > 0, biased, 0)
        kept = self._kept(len(distance), row, second) & self.recorded(firings.t_ns[:, 0, 0])
        return Firings(
            firings.t_ns[kept],
            firings.turn_rad[kept],
            distance[kept].astype(np.uint32),
            firings.intensity[kept],
            truth[kept],
        )

    def kept(self, count: int, row: int, second: int) -> NDArray[np.bool_]:
        """Packets or line scans of a second that are recorded, (N,) bool."""
        return self._kept(count, row, second)

    def recorded(self, t_ns: Times) -> NDArray[np.bool_]:
        """Which times since the start of the walk are in the recording, (N,) bool."""
        return t_ns >= round(1e9 * self._get("late-start"))

    def to_json(self) -> dict[str, object]:
        """What was degraded, with all that was drawn, for ``world.json``."""
        return {
            name: {"value": value, "unit": KINDS[name].unit, "text": KINDS[name].text}
            | self._drawn(name)
            for name, value in self.values.items()
        }

    def _drawn(self, name: str) -> dict[str, object]:
        drawn: dict[str, dict[str, object]] = {
            "extrinsics": {"axis_body": self.axis_lidar.tolist()},
            "mount-shift": {"direction_body": self.axis_lidar.tolist()},
            "imu-rotation": {"axis_body": self.axis_imu.tolist()},
            "lever-arm": {"direction_body": self.direction_antenna.tolist()},
            "dead-beams": {"lasers_by_sensor": [one.tolist() for one in self.dead]},
            "beam-bias": {"bias_m_by_sensor": [one.tolist() for one in self.range_bias_m]},
        }
        return drawn.get(name, {})

    def _get(self, name: str) -> float:
        return self.values.get(name, 0.0)

    def _stamps(self, clock: str, t_ns: Times, start_ns: int) -> Times:
        ahead_ns = round(1e9 * self._get(f"{clock}-clock"))
        drift = 1e-6 * self._get(f"{clock}-drift")
        return t_ns + ahead_ns + np.rint(drift * (t_ns - start_ns)).astype(np.int64)

    def _kept(self, count: int, row: int, second: int) -> NDArray[np.bool_]:
        """Packets that arrive: a chain of two states, lost and not lost, (N,) bool."""
        ratio = self._get("packet-loss")
        if not ratio:
            return np.ones(count, dtype=bool)
        rng = np.random.default_rng([self.seed, 8, row, second])
        back = 1.0 / COURSE.burst_packets
        away = back * ratio / (1.0 - ratio)
        lost = np.empty(count, dtype=bool)
        state = bool(rng.random() < ratio)
        for k, draw in enumerate(rng.random(count)):
            state = draw > back if state else draw < away
            lost[k] = state
        return ~lost


def _turned(T_body_x: SE3, axis_body: Array, angle_deg: float) -> SE3:
    """A mount turned about its own origin."""
    turn = SE3.exp(np.concatenate([np.deg2rad(angle_deg) * axis_body, np.zeros(3)]))
    return SE3(turn.R @ T_body_x.R, T_body_x.t)
