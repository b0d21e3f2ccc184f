"""Odometry of a simulated walk with less than it has: without the IMU, or with one LiDAR.

    python -m tests.benchmarks.walks RECORDING [--frames N] [--no-imu] [--only SENSOR --after K]

RECORDING is a folder written by ``recon4 simulate``. ``--only`` takes the other LiDARs away from
multiframe K on. Error of position after alignment [cm], drift from first to last pose, lost.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.geometry.se3 import SE3
from recon4.model.rig import load_rig
from recon4.model.trajectory import Trajectory
from recon4.recording.formats.poses import read_tum
from recon4.registration.odometry import Odometry
from recon4.settings import Settings
from tests.benchmarks.ablation import read_frames


def main() -> None:
    """Run one walk."""
    parser = argparse.ArgumentParser()
    parser.add_argument("recording", type=Path)
    parser.add_argument("--frames", type=int)
    parser.add_argument("--no-imu", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--after", type=int, default=0)
    a = parser.parse_args()
    rig, truth = load_rig(a.recording / "rig.toml"), read_tum(a.recording / "truth.tum")
    row = next((k for k, sensor in enumerate(rig.sensors) if sensor.name == a.only), None)
    with tempfile.TemporaryDirectory() as folder:
        frames = read_frames(a.recording, Path(folder) / "frames", rig)
        odometry = Odometry(rig, Settings(), None if a.no_imu else frames.imu)
        steps = []
        for k in range(min(a.frames or len(frames), len(frames))):
            alone = row is not None and k >= a.after
            steps.append(odometry.push(frames[k].of_sensor(row) if alone else frames[k]))
    T = SE3.stack(step.T_odom_body for step in steps)
    found = Trajectory(np.array([step.t_mid_ns for step in steps], np.int64), T)
    true = truth.at(found.t_ns)
    error = absolute_error(pair_poses(found, truth)).position_m
    drift = (true[0].inverse() @ true[-1]).inverse() @ (T[0].inverse() @ T[-1])
    length_m = float(np.linalg.norm(np.diff(true.t, axis=0), axis=1).sum())
    print(f"{a.recording.name} {length_m:.1f} m, {len(steps)} multiframes, "
          f"{sum(step.lost for step in steps)} lost: ATE {100 * error.rmse:.1f} cm, "
          f"drift {100 * np.linalg.norm(drift.t):.1f} cm")  # fmt: skip


if __name__ == "__main__":
    main()
