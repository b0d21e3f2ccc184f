"""A simulated walk that is pushed, multiframe by multiframe, into a live map."""

from __future__ import annotations

from copy import copy, deepcopy
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import so3_exp
from recon4.live.mapper.live_map import LiveMap
from recon4.live.mapper.place_index import SpillFile
from recon4.model.multiframe import COLUMNS, Multiframe
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import preset
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.store.frames import FrameStore


@dataclass
class Walk:
    """Multiframes of a simulated walk with its truth."""

    store: FrameStore
    truth: object
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(4))

    def at(self, row):
        t_ns = self.store[row].t_mid_ns
        return self.truth.T_a_b[int(np.argmin(np.abs(self.truth.t_ns - t_ns)))]

    def imu(self, row, shift_ns=0, *, before_ns=0):
        frame, imu = self.store[row], self.store.imu
        late_ns = 5_000_000
        end_ns = frame.t_ns + frame.duration_ns
        rows = (imu.t_ns > frame.t_ns + late_ns - before_ns) & (imu.t_ns <= end_ns + late_ns)
        return ImuSamples(imu.t_ns[rows] + shift_ns, imu.gyro_rad_s[rows], imu.accel_m_s2[rows])

    def frame(self, row, shift_ns=0, *, noise=False):
        frame = self.store[row]
        columns = {name: getattr(frame, name) for name in COLUMNS}
        if noise:
            columns["xyz"] = self.rng.uniform(-2, 2, frame.xyz.shape).astype(np.float32)
        return Multiframe(frame.frame_id, frame.t_ns + shift_ns, frame.duration_ns, **columns)


def simulated_walk(folder: Path, world="office", *, seconds=16.0, seed=1):
    """A walk with two VLP-16 and an IMU."""
    simulate(
        prepare(world, seconds=seconds, seed=seed), folder / "sim", bag=False, progress=Silent()
    )
    rig, imu = load_rig(folder / "sim" / "rig.toml"), folder / "sim" / "imu.csv"
    sources = Sources((folder / "sim" / "recording.pcap",), rig, imu)
    ingest(sources, folder / "frames", settings=preset("indoor").ingest, progress=Silent())
    return Walk(FrameStore.open(folder / "frames"), read_tum(folder / "sim" / "truth.tum"))


class Follower:
    """A live map, and how far its poses are from the truth."""

    def __init__(self, walk, imu_axes=(1.0, 1.0, 1.0), gyro_axes=None, *, with_imu=True):
        self.walk, self.axes = walk, np.array([gyro_axes or imu_axes, imu_axes])
        self.map = LiveMap(walk.store.rig, preset("indoor"))
        self.start, self.rate, self.with_imu = None, np.zeros(3), with_imu
        self.mount = np.eye(3)

    def copy(self):
        """Another follower that has been pushed the same; both go on by themselves."""
        spill, other = self.map._places._spill, copy(self)
        spilled = SpillFile()  # an open file is not copied
        spilled.put(spill.get(slice(0, spill._end)))
        other.map = deepcopy(self.map, {id(spill): spilled})
        other.axes = self.axes.copy()
        return other

    def push(self, row, shift_ns=0, *, noise=False):
        """The pose and its horizontal error [m]."""
        before_ns = 0 if self.start else 2_000_000_000
        imu = self.walk.imu(row, shift_ns, before_ns=before_ns)
        gyro, accel = imu.gyro_rad_s * self.axes[0] + self.rate, imu.accel_m_s2 * self.axes[1]
        gyro, accel = gyro @ self.mount, accel @ self.mount
        if self.with_imu:
            self.map.extend_imu(ImuSamples(imu.t_ns, gyro, accel))
        pose, _ = self.map.push(self.walk.frame(row, shift_ns, noise=noise))
        p_m, truth = np.array(pose.p), self.walk.at(row)
        if self.start is None:
            turn = pose.yaw - np.arctan2(truth.R[1, 0], truth.R[0, 0])
            self.start = so3_exp([0.0, 0.0, turn]), truth.t, p_m
        R, truth_m, start_m = self.start
        off_m = R @ (truth.t - truth_m) - (p_m - start_m)
        return pose, float(np.linalg.norm(off_m[:2]))
