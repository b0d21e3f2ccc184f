"""A small walk in a room, made by arithmetic: every point is known beforehand."""

from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig, Sensor
from recon4.model.trajectory import Trajectory

T0_NS = 1_700_000_000_000_000_000
FRAME_NS = 100_000_000


def rig_of(*T_body_sensor, enabled=None):
    sensors = tuple(
        Sensor(
            name=f"s{k}",
            model="generic",
            T_body_sensor=T,
            enabled=enabled is None or enabled[k],
        )
        for k, T in enumerate(T_body_sensor)
    )
    return Rig(
        name="test",
        sensors=sensors,
        T_body_imu=SE3.identity(),
        imu_time_offset_s=0.0,
        p_body_antenna=np.zeros(3),
        gnss_time_offset_s=0.0,
    )


@dataclass
class Walk:
    """Multiframes in memory, with the interface of a frame store."""

    frames: list
    rig: Rig
    trajectory: Trajectory

    def __len__(self):
        return len(self.frames)

    def __getitem__(self, k):
        return self.frames[k]

    @property
    def t_mid_ns(self):
        """Middle of each multiframe."""
        return np.array([frame.t_mid_ns for frame in self.frames])

    def repeated(self, frames):
        """The same steps over and over: a longer walk in the same place."""
        rows = np.arange(-1, frames + 2)
        made = [
            replace(self.frames[k % len(self)], frame_id=k, t_ns=T0_NS + k * FRAME_NS)
            for k in range(frames)
        ]
        T_map_body = self.trajectory.T_a_b[rows % len(self) + 1]
        return Walk(made, self.rig, Trajectory(T0_NS + rows * FRAME_NS, T_map_body))


def straight(frames):
    """One meter a second along x, standing upright."""
    t_ns = T0_NS + np.arange(-1, frames + 2) * FRAME_NS
    t_m = np.zeros((len(t_ns), 3))
    t_m[:, 0] = (t_ns - T0_NS) / 1e9
    return Trajectory(t_ns, SE3(np.broadcast_to(np.eye(3), (len(t_ns), 3, 3)).copy(), t_m))


def room_walk(frames=20, points=3000, *, seed=1, noise_m=0.01, intensity=None, enabled=None):
    """Points on the walls of a room 8 x 6 x 3 m around the start, seen by two sensors.

    ``intensity(p_map, sensor, ring, incidence_rad, range_m, rng)`` returns their intensity.
    """
    rig = rig_of(
        SE3.from_rpy(0, 0, 0, t=[0, 0, 0.2]),
        SE3.from_rpy(np.pi / 2, 0, 0, t=[0, 0.1, 0]),
        enabled=enabled,
    )
    trajectory = straight(frames)
    rng = np.random.default_rng(seed)
    made = []
    for k in range(frames):
        low, size = np.array([-3.0, -3.0, -1.4]), np.array([8.0, 6.0, 3.0])
        p_map = low + rng.uniform(0, 1, (points, 3)) * size
        axis, side = rng.integers(0, 3, points), rng.integers(0, 2, points)
        rows = np.arange(points)
        p_map[rows, axis] = low[axis] + side * size[axis]
        normal = np.eye(3)[axis]
        p_map += normal * rng.normal(0, noise_m, (points, 1))
        sensor = rng.integers(0, 2, points).astype(np.uint8)
        ring = rng.integers(0, 16, points).astype(np.uint8)
        dt_ns = rng.integers(0, FRAME_NS, points).astype(np.int32)
        T_map_sensor = (
            trajectory.at(T0_NS + k * FRAME_NS + dt_ns.astype(np.int64)) @ rig.T_body_sensor[sensor]
        )
        xyz = T_map_sensor.inverse() @ p_map
        range_m = np.linalg.norm(xyz, axis=1)
        beam = (T_map_sensor.t - p_map) / range_m[:, None]
        incidence = np.arccos(np.clip(np.abs(np.sum(beam * normal, axis=1)), 0, 1))
        bright = (
            rng.integers(0, 256, points)
            if intensity is None
            else intensity(p_map, sensor, ring, incidence, range_m, rng)
        )
        made.append(
            Multiframe(
                k,
                T0_NS + k * FRAME_NS,
                FRAME_NS,
                xyz.astype(np.float32),
                np.asarray(bright).astype(np.uint16),
                ring,
                sensor,
                (rng.uniform(size=points) < 0.1).astype(np.uint8),
                dt_ns,
            )
        )
    return Walk(made, rig, trajectory)
