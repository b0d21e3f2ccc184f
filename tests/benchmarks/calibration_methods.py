"""Error and time of every method of calibration on the same simulated walks.

    python -m tests.benchmarks.calibration FOLDER --seconds 40     # makes the walks
    python -m tests.benchmarks.calibration_methods [--only maps,pairs] FOLDER/hall-107 …

The rig file is 1.5° and 2 cm off, see `tests.benchmarks.calibration`. Of the joint method the table
has the same parameters: rotation and position of the last LiDAR.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from recon4.calibration.entropy import calibrate_by_entropy
from recon4.calibration.floors import find_inclinations
from recon4.calibration.gravity_alignment import align_gravity
from recon4.calibration.map_alignment import align_maps
from recon4.calibration.parameters import Parameters
from recon4.calibration.pose_pairs import MarkerPosePairs, average_pairs
from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.stage import run_calibration
from recon4.calibration.tuning import EntropyTuning
from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.store.frames import FrameStore
from tests.benchmarks.calibration import SETTINGS, true_rig
from tests.said import outcome_text

STOPS, POSE_SD_RAD, POSE_SD_M = 20, float(np.deg2rad(0.1)), 0.005
"""Pairs of poses, and the errors drawn for each of the two."""
Method = Callable[[RecordedWalk, Path], str]


def main() -> None:
    """A row for each walk and method."""
    chosen = sys.argv[2].split(",") if sys.argv[1] == "--only" else METHODS
    for folder in map(Path, sys.argv[1 if chosen is METHODS else 3 :]):
        for name in chosen:
            method = METHODS[name]
            began = time.process_time()
            text = method(recorded(folder), folder)
            print(f"{folder.name} {name}: {text}, {time.process_time() - began:.0f} s", flush=True)


def recorded(folder: Path) -> RecordedWalk:
    """A walk that `tests.benchmarks.calibration` made."""
    frames = FrameStore.open(folder / "frames")
    return RecordedWalk.of(frames, folder / "odometry", SETTINGS.odometry)


def error(found: SE3, folder: Path) -> str:
    """Angle and distance of the mount of the last LiDAR from the true one."""
    true = true_rig(folder / "walk").sensors[-1].T_body_sensor
    T = true.inverse() @ found
    return f"{np.rad2deg(T.angle()):.3f}° {1e3 * np.linalg.norm(found.t - true.t):.1f} mm"


def rig_file(walk: RecordedWalk, folder: Path) -> str:
    """What is to be corrected."""
    return error(walk.frames.rig.sensors[-1].T_body_sensor, folder)


def joint(walk: RecordedWalk, folder: Path) -> str:
    """The product's own."""
    found = run_calibration(walk.frames, folder / "odometry", settings=SETTINGS, progress=Silent())
    if found.rig is None:
        return outcome_text(found.figures)
    return error(found.rig.sensors[-1].T_body_sensor, folder)


def maps(walk: RecordedWalk, folder: Path) -> str:
    """V-CAL-1."""
    found = align_maps(walk, walk.frames.rig, 1, reference=0, settings=SETTINGS)
    if found is None:
        return "no map registers"
    scatter = f"windows scatter {np.rad2deg(found.scatter_rad):.2f}° {100 * found.scatter_m:.0f} cm"
    agrees = "" if found.agrees else ", refused"
    return f"{error(found.T_body_sensor, folder)} ({scatter}{agrees})"


def entropy(walk: RecordedWalk, folder: Path) -> str:
    """L-CAL-1."""
    s = SETTINGS.calibration
    parameters = Parameters.of(walk.frames.rig, reference=0, lidars=(1,), imu=False)
    windows = walk.windows(s.audit_windows, s.audit_window_s)
    found = calibrate_by_entropy(
        windows, walk.frames.rig, parameters, settings=EntropyTuning(), progress=lambda: None
    )
    return error(found.rig.sensors[-1].T_body_sensor, folder)


def gravity(walk: RecordedWalk, folder: Path) -> str:
    """V-CAL-2: the rotation of the IMU."""
    pairs = find_inclinations(walk.frames, walk.frames.rig)
    if len(pairs) < 2:
        return f"{len(pairs)} inclinations at rest, two are needed"
    found = align_gravity(pairs.normal_body, pairs.force_imu)
    true = load_rig(folder / "walk" / "rig_true.toml").T_body_imu
    off = SE3(true.R.T @ found.R_body_imu, np.zeros(3)).angle()
    seen = "" if found.heading_observable else " (rotation about gravity not observable)"
    return f"IMU {np.rad2deg(off):.2f}° from {len(pairs)} inclinations{seen}"


def pairs(walk: RecordedWalk, folder: Path) -> str:
    """L-CAL-2: poses of the walk as a tracking system and control points would give them."""
    true = true_rig(folder / "walk").sensors[-1].T_body_sensor
    rows = np.linspace(0, len(walk.frames.t_mid_ns) - 1, STOPS + 2).astype(int)[1:-1]
    T_world_body = read_tum(folder / "walk" / "truth.tum").at(walk.frames.t_mid_ns[rows])
    rng = np.random.default_rng(1)
    tracked, sensed = (T @ _noise(rng) for T in (T_world_body, T_world_body @ true))
    found = average_pairs(MarkerPosePairs(tracked, sensed))
    return f"{error(found.T_marker_sensor, folder)} from {STOPS} drawn pairs"


def _noise(rng: np.random.Generator) -> SE3:
    turn = rng.normal(0.0, POSE_SD_RAD, (STOPS, 3))
    return SE3(so3_exp(turn), rng.normal(0.0, POSE_SD_M, (STOPS, 3)))


METHODS: dict[str, Method] = {
    "rig file": rig_file,
    "joint": joint,
    "maps": maps,
    "gravity": gravity,
    "entropy": entropy,
    "pairs": pairs,
}


if __name__ == "__main__":
    main()
