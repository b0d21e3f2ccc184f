"""Mounts of three LiDARs on a car from one static scene each, compared between two scenes.

    python -m tests.benchmarks.calibration_real

The registration of the method ``maps`` on the OpenCalib scenes: no motion, so each cloud is the map
of its LiDAR. The drawings of the mounts are 45° off; the roll is searched. Both scenes share a rig:
their mounts must agree. small_gicp, started where the search ends, is the reference.

LiDAR and INS of another car: the published poses of the LiDAR are those of the INS, moved by the
extrinsics that were calibrated (the published file is the drawing). `hand_eye` must not claim what
a car does not show; the floor of the five published scans tells the tilt.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from recon4.calibration.pose_pairs import MarkerPosePairs, hand_eye
from recon4.errors import CalibrationError
from recon4.geometry.se3 import SE3, Array, proper, so3_log
from recon4.recording.formats.cloud_files import read_cloud
from recon4.registration.result import Registration
from recon4.registration.scan_registration import Scan, make_scan, register_scans
from recon4.registration.tuning import ScanTuning

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("RECON4_DATA", ROOT.parent / "shared" / "data")) / "calibration"
DRAWN = {
    "left": (90.0, (-0.06763169358385032, 0.6257701373941718, -0.35145357319239473)),
    "right": (-90.0, (-0.0001307057033816915, -0.4632752877792159, -0.46602840121078765)),
}
"""Yaw [°] and position [m] in the frame of the top LiDAR, from ``initial_extrinsic.txt``."""
INS = DATA.parent / "gnss" / "lidar2imu"
INS_DRAWN = SE3.from_rpy(0.0, 0.0, np.deg2rad(90.0), t=[0.0, 1.0, 1.3])
"""The LiDAR in the frame of the INS: inverse of ``gnss-to-top_center_lidar-extrinsic.json``."""
LAG = 50
"""Poses from the beginning to the end of a motion: 5 s."""
FLOOR_M = (2.0, 12.0)
REACH_M = 60.0
GRID_DEG = np.arange(-60.0, 61.0, 15.0)
SETTINGS = ScanTuning()


def main() -> None:
    """Print the mounts of both cars."""
    lidar_lidar()
    lidar_ins()


def lidar_ins() -> None:
    """The LiDAR on the INS: by its poses, and its tilt by the floor."""
    ins, lidar = (
        poses(f"{name}.txt") for name in ("NovAtel-pose-lidar-time", "top_center_lidar-pose")
    )
    reference, residual_m = moved_by(ins, lidar)
    print(
        f"LiDAR-INS reference: rpy {np.round(np.rad2deg(reference.rpy()), 3)}°, "
        f"{np.round(100 * reference.t, 1)} cm, residual {1e3 * residual_m:.3f} mm; "
        f"the drawing is {apart(reference, INS_DRAWN)} away"
    )
    try:
        found = hand_eye(MarkerPosePairs(ins, lidar), before_m=INS_DRAWN.t)
        print(f"hand-eye: {apart(reference, found.T_marker_sensor)}")
    except CalibrationError as refused:
        print(f"hand-eye refuses: {refused}")
    up = poses("top_center_lidar-enu.txt").R[:, 2]
    tilts = [
        tilt_deg(up[k], path) for k, path in enumerate(sorted((INS / "top_center_lidar").iterdir()))
    ]
    print(f"floor: {min(tilts):.2f} to {max(tilts):.2f}° from the reference, road included")


def poses(name: str) -> SE3:
    """Poses of a file with twelve numbers a line after the time."""
    table = np.loadtxt(INS / name, usecols=range(1, 13)).reshape(-1, 3, 4)
    return SE3(np.stack([proper(R) for R in table[:, :, :3]]), table[:, :, 3])


def moved_by(ins: SE3, lidar: SE3) -> tuple[SE3, float]:
    """The extrinsics by which the poses of the LiDAR were made from those of the INS."""
    a, b = (T[:-LAG].inverse() @ T[LAG:] for T in (ins, lidar))

    def residuals(step: Array) -> Array:
        T = INS_DRAWN @ SE3.exp(step)
        difference = (a @ T).inverse() @ (T @ b)
        return np.concatenate([so3_log(difference.R).ravel(), 0.1 * difference.t.ravel()])

    found = least_squares(residuals, np.zeros(6))
    return INS_DRAWN @ SE3.exp(found.x), float(10.0 * np.sqrt(np.mean(found.fun**2)))


def tilt_deg(up_lidar: Array, path: Path) -> float:
    """Angle between the normal of the floor and what the INS calls up, in the LiDAR's frame."""
    p = points_of(path)
    p = p[
        (np.linalg.norm(p[:, :2], axis=1) > FLOOR_M[0])
        & (np.linalg.norm(p[:, :2], axis=1) < FLOOR_M[1])
    ]
    p = p[p[:, 2] < np.median(p[:, 2]) + 0.1]
    for gate_m in (0.3, 0.1, 0.05, 0.05):
        center = np.median(p, axis=0) if gate_m > 0.2 else p.mean(axis=0)
        normal = np.linalg.svd(p - p.mean(axis=0), full_matrices=False)[2][2]
        p = p[np.abs((p - center) @ normal) < gate_m]
    return float(np.rad2deg(np.arccos(abs(normal @ up_lidar))))


def lidar_lidar() -> None:
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
    return points_of(path)


def points_of(path: Path) -> Array:
    """Points of a cloud that are neither the car nor far away [m], (N, 3)."""
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
