"""Error and time of every method of calibration on the same simulated walks.

    python -m tests.benchmarks.calibration FOLDER --seconds 40     # makes the walks
    python -m tests.benchmarks.calibration_methods FOLDER/hall-107 …

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
from recon4.calibration.stage import run_calibration
from recon4.calibration.walk import RecordedWalk
from recon4.geometry.se3 import SE3
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.settings import EntropySettings
from recon4.store.arrays import load_arrays, load_trajectory
from recon4.store.frames import FrameStore
from tests.benchmarks.calibration import SETTINGS, true_rig

Method = Callable[[RecordedWalk, Path], str]


def main() -> None:
    """A row for each walk and method."""
    for folder in map(Path, sys.argv[1:]):
        for name, method in METHODS.items():
            began = time.process_time()
            text = method(recorded(folder), folder)
            print(f"{folder.name} {name}: {text}, {time.process_time() - began:.0f} s", flush=True)


def recorded(folder: Path) -> RecordedWalk:
    """A walk that `tests.benchmarks.calibration` made."""
    odometry = folder / "odometry"
    lost = load_arrays(odometry / "steps.npz", ["lost"])["lost"].astype(bool)
    return RecordedWalk(
        FrameStore.open(folder / "frames"), load_trajectory(odometry / "trajectory.npz"), lost
    )


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
        return found.figures.outcome
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
        windows, walk.frames.rig, parameters, settings=EntropySettings(), progress=lambda: None
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


METHODS: dict[str, Method] = {
    "rig file": rig_file,
    "joint": joint,
    "maps": maps,
    "gravity": gravity,
    "entropy": entropy,
}


if __name__ == "__main__":
    main()
