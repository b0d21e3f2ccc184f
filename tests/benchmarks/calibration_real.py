"""Mounts of three LiDARs on a car from one static scene each, compared between two scenes.

    python -m tests.benchmarks.calibration_real

The registration of the method ``maps`` on the OpenCalib scenes: no motion, so each cloud is the map
of its LiDAR. The drawings of the mounts are 45° off; the roll is searched. Both scenes share a rig:
their mounts must agree. small_gicp, started where the search ends, is the reference.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.recording.formats.cloud_files import read_cloud
from recon4.registration.result import Registration
from recon4.registration.scans import Scan, make_scan, register_scans
from recon4.settings import ScanSettings

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("RECON4_DATA", ROOT.parent / "shared" / "data")) / "calibration"
DRAWN = {
    "left": (90.0, (-0.06763169358385032, 0.6257701373941718, -0.35145357319239473)),
    "right": (-90.0, (-0.0001307057033816915, -0.4632752877792159, -0.46602840121078765)),
}
"""Yaw [°] and position [m] in the frame of the top LiDAR, from ``initial_extrinsic.txt``."""
REACH_M = 60.0
GRID_DEG = np.arange(-60.0, 61.0, 15.0)
SETTINGS = ScanSettings()


def main() -> None:
    """Print each mount, how far the scenes differ, and how far small_gicp is."""
    for name in DRAWN:
        mounts = []
        for scene in ("0001", "0002"):
            began = time.process_time()
            top, other = (cloud(scene, lidar) for lidar in ("top", name))
            found = mount(make_scan(top, SETTINGS), make_scan(other, SETTINGS), name)
            T = found.T_target_source
            mounts.append(T)
            cpu_s = time.process_time() - began
            reference = by_gicp(top, other, T)
            print(
                f"{scene} {name}: rpy {np.round(np.rad2deg(T.rpy()), 3)}°, "
                f"{np.round(100 * T.t, 2)} cm, converged {found.converged}, {cpu_s:.1f} s; "
                f"small_gicp {apart(reference, T)} away",
                flush=True,
            )
        print(f"{name}: the two scenes differ by {apart(*mounts)}", flush=True)


def cloud(scene: str, name: str) -> Array:
    """Points of one LiDAR [m], (N, 3)."""
    (path,) = (DATA / scene).glob(f"{name}*.pcd")
    table = read_cloud(path)
    p = np.stack([np.asarray(table[axis], np.float64) for axis in "xyz"], axis=1)
    length = np.linalg.norm(p, axis=1)
    return np.asarray(p[np.isfinite(p).all(axis=1) & (length > 1.5) & (length < REACH_M)])


def mount(top: Scan, other: Scan, name: str) -> Registration:
    """The best of the registrations that begin at several rolls and pitches."""
    yaw_deg, t = DRAWN[name]
    starts = [
        SE3.from_rpy(np.deg2rad(roll), np.deg2rad(pitch), np.deg2rad(yaw_deg), t=list(t))
        for roll in GRID_DEG
        for pitch in (-15.0, 0.0, 15.0)
    ]
    found = [register_scans(top, other, initial=start, settings=SETTINGS) for start in starts]
    return max(found, key=lambda one: (one.converged, one.match_ratio, -one.error_m))


def by_gicp(target: Array, source: Array, initial: SE3) -> SE3:
    """The same by small_gicp."""
    import small_gicp

    T = np.eye(4)
    T[:3, :3], T[:3, 3] = initial.R, initial.t
    found = small_gicp.align(
        target, source, init_T_target_source=T, registration_type="GICP",
        downsampling_resolution=0.15, max_correspondence_distance=0.5,
    )  # fmt: skip
    M = np.asarray(found.T_target_source)
    return SE3(M[:3, :3], M[:3, 3])


def apart(a: SE3, b: SE3) -> str:
    """Angle and distance between two mounts."""
    T = a.inverse() @ b
    return f"{np.rad2deg(T.angle()):.3f}° {100 * np.linalg.norm(a.t - b.t):.1f} cm"


if __name__ == "__main__":
    main()
