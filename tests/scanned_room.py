"""Two turning LiDARs carried through a room with boxes in it: every ray computed by arithmetic."""

from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.se3 import SE3, so3_exp, so3_log
from recon4.model.multiframe import Multiframe
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.registration.aiding import GnssAiding
from recon4.units import STANDARD_GRAVITY_M_S2
from tests.room_walks import FRAME_NS, T0_NS, rig_of

LOW_M, HIGH_M = np.array([-4.0, -3.0, -1.2]), np.array([5.0, 3.5, 1.7])
BOXES_M = (
    (np.array([2.0, 1.5, -1.2]), np.array([2.8, 2.2, 1.0])),
    (np.array([-2.5, -2.4, -1.2]), np.array([-1.6, -1.7, 1.7])),
    (np.array([3.0, -2.0, -1.2]), np.array([4.2, -1.2, -0.4])),
)
ELEVATION_RAD = np.deg2rad(np.arange(-15.0, 16.0, 2.0))
RIG = rig_of(
    SE3.from_rpy(0.0, 0.0, 0.0, t=[0.0, 0.0, 0.3]),
    SE3.from_rpy(np.pi / 2, 0.0, 0.0, t=[0.0, 0.1, 0.0]),
)


@dataclass
class ScannedWalk:
    """Multiframes in memory, with the interface of a frame store."""

    frames: list
    rig: object
    truth: Trajectory
    imu: ImuSamples | None

    def __len__(self):
        return len(self.frames)

    def __getitem__(self, k):
        return self.frames[k]

    def __iter__(self):
        return iter(self.frames)

    @property
    def index(self):
        rows = [(f.t_ns, f.duration_ns) for f in self.frames]
        return np.array(rows, dtype=[("t_ns", "<i8"), ("duration_ns", "<i8")])

    @property
    def t_mid_ns(self):
        return np.array([f.t_mid_ns for f in self.frames], np.int64)

    def true_poses(self):
        return self.truth.at(self.t_mid_ns)


def standing(t_s):
    """No motion at all."""
    return SE3.identity(len(t_s))


def strolling(t_s):
    """0.5 m/s along x, 20°/s to the left."""
    t = np.asarray(t_s)
    zero = np.zeros_like(t)
    turn = np.stack([zero, zero, np.deg2rad(20.0) * t], axis=1)
    return SE3(so3_exp(turn), np.stack([0.5 * t, 0.1 * t, zero], axis=1))


def strolling_fixes(frames, *, first_s=-0.05):
    """Fixes of who strolls, ten a second, from a time on until after that many multiframes."""
    t_s = np.arange(first_s, 0.1 * frames + 0.3, 0.1)
    T = strolling(t_s)
    return GnssAiding(
        t_ns=T0_NS + np.rint(1e9 * t_s).astype(np.int64),
        p_enu=T.t,
        sd_m=np.full((len(t_s), 3), 0.1),
        R_enu_body=T.R,
        attitude_sd_rad=0.01,
        p_body_antenna=np.zeros(3),
    )


def ranges_m(p, d):
    """Distance from points inside the room along unit directions to what they hit, (N,)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        wall = np.where(d > 0, (HIGH_M - p) / d, (LOW_M - p) / d)
        nearest = np.where(np.isfinite(wall), wall, np.inf).min(axis=1)
        for low, high in BOXES_M:
            a, b = (low - p) / d, (high - p) / d
            enter, leave = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
            hit = (enter < leave) & (enter > 0)
            nearest = np.where(hit, np.minimum(nearest, enter), nearest)
    return nearest


def scan(pose, t_ns, *, columns=600, noise_m=0.005, rig=RIG, frame_id=0, seed=0):
    """One multiframe; ``pose(t_s)`` is ``T_map_body`` at seconds after T0_NS."""
    rng = np.random.default_rng([seed, frame_id])
    dt_ns = np.repeat(np.arange(columns) * FRAME_NS // columns, len(ELEVATION_RAD))
    azimuth = -2 * np.pi * dt_ns / FRAME_NS
    ring = np.tile(np.arange(len(ELEVATION_RAD)), columns)
    up = ELEVATION_RAD[ring]
    d = np.stack([np.cos(up) * np.cos(azimuth), np.cos(up) * np.sin(azimuth), np.sin(up)], axis=1)
    T_map_body = pose((t_ns - T0_NS + dt_ns) * 1e-9)
    xyz = []
    for sensor in rig.sensors:
        T = T_map_body @ sensor.T_body_sensor
        d_map = np.einsum("nij,nj->ni", T.R, d)
        measured = ranges_m(T.t, d_map) + noise_m * rng.standard_normal(len(d))
        xyz.append(d * measured[:, None])
    count, sensors = len(d), len(rig.sensors)
    return Multiframe(
        frame_id,
        t_ns,
        FRAME_NS,
        np.concatenate(xyz).astype(np.float32),
        np.full(count * sensors, 50, np.uint16),
        np.tile(ring, sensors).astype(np.uint8),
        np.repeat(np.arange(sensors), count).astype(np.uint8),
        np.zeros(count * sensors, np.uint8),
        np.tile(dt_ns, sensors).astype(np.int32),
    )


def imu_of(pose, seconds, *, rate_hz=200.0, before_s=1.0):
    """A perfect IMU at the body's origin; it starts a second before the first frame."""
    t_s = np.arange(-before_s, seconds + 0.2, 1.0 / rate_hz)
    h = 1e-3
    here, back, forth = pose(t_s), pose(t_s - h), pose(t_s + h)
    gyro = so3_log(np.swapaxes(back.R, 1, 2) @ forth.R) / (2 * h)
    accel_map = (forth.t - 2 * here.t + back.t) / h**2 + [0.0, 0.0, STANDARD_GRAVITY_M_S2]
    accel = np.einsum("nji,nj->ni", here.R, accel_map)
    return ImuSamples(T0_NS + np.rint(t_s * 1e9).astype(np.int64), gyro, accel)


def walk(pose, frames, *, with_imu=True, **options):
    """A recording of this many multiframes."""
    seconds = frames * FRAME_NS * 1e-9
    made = [scan(pose, T0_NS + k * FRAME_NS, frame_id=k, **options) for k in range(frames)]
    t_s = np.arange(-0.1, seconds + 0.15, 0.01)
    truth = Trajectory(T0_NS + np.rint(t_s * 1e9).astype(np.int64), pose(t_s))
    imu = imu_of(pose, seconds) if with_imu else None
    return ScannedWalk(made, options.get("rig", RIG), truth, imu)


def without_points(frame):
    """The frame with nothing in it."""
    return frame.take(slice(0, 0))


def noise_frame(frame, *, seed=9):
    """The frame with points anywhere instead of where they were measured."""
    rng = np.random.default_rng(seed)
    anywhere = rng.uniform(-8.0, 8.0, frame.xyz.shape).astype(np.float32)
    return replace(frame, xyz=anywhere)
