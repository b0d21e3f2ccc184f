"""A walk through the live map: followed, lost, and found again."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from recon4.geometry.se3 import so3_exp
from recon4.live.live_map import LiveMap
from recon4.model.multiframe import COLUMNS, Multiframe
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.ingest import ingest
from recon4.recording.poses import read_tum
from recon4.settings import preset
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


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    folder = tmp_path_factory.mktemp("office")
    simulate("office", folder / "sim", seconds=16.0, seed=1, bag=False, progress=Silent())
    ingest(
        [folder / "sim" / "recording.pcap"],
        folder / "frames",
        rig=load_rig(folder / "sim" / "rig.toml"),
        imu=folder / "sim" / "imu.csv",
        gnss=None,
        settings=preset("indoor").ingest,
        progress=Silent(),
    )
    return Walk(FrameStore.open(folder / "frames"), read_tum(folder / "sim" / "truth.tum"))


class Follower:
    """A live map, and how far its poses are from the truth."""

    def __init__(self, walk):
        self.walk = walk
        self.map = LiveMap(walk.store.rig, preset("indoor"))
        self.start = None

    def push(self, row, shift_ns=0, *, noise=False):
        """The pose told, and its error in plan [m]."""
        before_ns = 0 if self.start else 2_000_000_000
        self.map.extend_imu(self.walk.imu(row, shift_ns, before_ns=before_ns))
        pose = self.map.push(self.walk.frame(row, shift_ns, noise=noise))[0]
        told_m, truth = np.array(pose["p"]), self.walk.at(row)
        if self.start is None:
            turn = pose["yaw"] - np.arctan2(truth.R[1, 0], truth.R[0, 0])
            self.start = so3_exp([0.0, 0.0, turn]), truth.t, told_m
        R, truth_m, start_m = self.start
        off_m = R @ (truth.t - truth_m) - (told_m - start_m)
        return pose, float(np.linalg.norm(off_m[:2]))


def test_who_is_lost_and_carried_elsewhere_is_found_again(walk):
    follower = Follower(walk)
    errors = [follower.push(row)[1] for row in range(130)]
    points_before = follower.map.everything()[1]["count"]
    for row in range(130, 142):
        pose, _ = follower.push(row, noise=True)
    points_lost = follower.map.everything()[1]["count"]
    back = walk.store[142].t_ns - walk.store[60].t_ns
    told = [follower.push(row, back) for row in range(60, 142)]

    assert max(errors) < 0.08
    assert pose["lost"]
    assert points_lost == points_before
    found = [error for pose, error in told if not pose["lost"]]
    assert told[-1][0]["relocated"] == 1
    assert len(found) > 10
    assert max(found) < 0.10


def test_a_few_bad_multiframes_are_no_reason_to_search(walk):
    follower = Follower(walk)
    for row in range(40):
        follower.push(row)
    lost = [follower.push(row, noise=True)[0]["lost"] for row in range(40, 43)]
    pose, error_m = [follower.push(row) for row in range(43, 60)][-1]

    assert lost == [True] * 3
    assert not pose["lost"]
    assert pose["relocated"] == 0
    assert error_m < 0.05
