"""Rig files that are far off, and walks that do not show everything.

    python -m tests.benchmarks.calibration FOLDER --seconds 40     # makes the walks
    python -m tests.benchmarks.calibration_limits FOLDER/hall-107 [--calibrate] [NAME …]
    python -m tests.benchmarks.calibration_limits --motions

With a walk: the rig file is set far from the truth, the odometry runs with it, and what is left
after the audit (or, with ``--calibrate``, the calibration) is printed. With ``--motions``: walks in
a small room, on a plane, on a circle and straight on; each parameter before and after.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from recon4.calibration.parameters import Parameters
from recon4.calibration.stage import run_calibration
from recon4.geometry.se3 import SE3, Array
from recon4.model.rig import Rig
from recon4.progress import Silent
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.store.arrays import load_arrays
from recon4.store.frames import FrameStore
from tests import scanned_room
from tests.benchmarks.calibration import SETTINGS, row, true_rig
from tests.said import outcome_text, rig_texts
from tests.unit.calibration.conftest import (
    AUTO,
    COLUMNS,
    circle,
    imu_mounted,
    mounted,
    planar,
    store,
    straight,
)

UPSIDE_DOWN = np.diag([1.0, -1.0, -1.0])
EXCHANGED = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
OBLIQUE = np.array([1.0, -1.0, 1.0]) / np.sqrt(3.0)
ASIDE = np.array([1.0, 1.0, -1.0]) / np.sqrt(3.0)


def main() -> None:
    """Print a row for each rig file, or for each motion."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("walk", type=Path, nargs="?")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--calibrate", action="store_true")
    parser.add_argument("--motions", action="store_true")
    args = parser.parse_args()
    if args.motions:
        for name in [args.walk.name] if args.walk else MOTIONS:
            moving(name, MOTIONS[name])
        return
    frames = FrameStore.open(args.walk / "frames")
    true = true_rig(args.walk / "walk")
    for name in args.names or RIG_FILES:
        wrong = RIG_FILES[name](with_clocks_of(true, frames.rig))
        far_off(name, frames.with_rig(wrong), true, calibrate=args.calibrate)


def far_off(name: str, frames: FrameStore, true: Rig, *, calibrate: bool) -> None:
    """What is left of the errors of one rig file."""
    mode = "auto" if calibrate else "audit"
    settings = replace(SETTINGS, calibration=replace(SETTINGS.calibration, mode=mode))
    with tempfile.TemporaryDirectory() as folder:
        odometry = Path(folder)
        run_odometry(WalkInputs(frames, settings, Silent()), odometry)
        lost = int(load_arrays(odometry / "steps.npz", ["lost"])["lost"].sum())
        began = time.process_time()
        found = run_calibration(frames, odometry, settings=settings, progress=Silent())
    cpu_s = time.process_time() - began
    rig = found.rig or found.begin
    left = "" if rig is None else f"{apart(rig, true)}; "
    print(
        f"{name}: {lost} lost; {left}{outcome_text(found.figures)}, {cpu_s:.0f} s; "
        f"{len(rig_texts(found.figures))} warnings",
        flush=True,
    )


def apart(rig: Rig, true: Rig) -> str:
    """Mount of the last LiDAR in the frame of the first one, and rotation of the IMU."""
    first, last = ((r.sensors[0].T_body_sensor, r.sensors[-1].T_body_sensor) for r in (rig, true))
    found, wanted = first[0].inverse() @ first[1], last[0].inverse() @ last[1]
    of_imu = [r.sensors[0].T_body_sensor.R.T @ r.T_body_imu.R for r in (rig, true)]
    turn = SE3(of_imu[0].T @ of_imu[1], np.zeros(3)).angle()
    return (
        f"LiDAR {np.rad2deg((found.inverse() @ wanted).angle()):.3f}° "
        f"{1e3 * np.linalg.norm(found.t - wanted.t):.1f} mm, IMU {np.rad2deg(turn):.3f}°"
    )


def with_clocks_of(true: Rig, recorded: Rig) -> Rig:
    """The true mounts with the clocks of the rig file."""
    pairs = zip(true.sensors, recorded.sensors, strict=True)
    sensors = tuple(replace(new, time_offset_s=old.time_offset_s) for new, old in pairs)
    return replace(true, sensors=sensors, imu_time_offset_s=recorded.imu_time_offset_s)


def last_turned(rig: Rig, R: Array) -> Rig:
    """The last LiDAR turned about its own origin by axes of its own."""
    T = rig.sensors[-1].T_body_sensor
    return replace(
        rig, sensors=(*rig.sensors[:-1], replace(rig.sensors[-1], T_body_sensor=SE3(T.R @ R, T.t)))
    )


def imu_turned(rig: Rig, R: Array) -> Rig:
    """The IMU turned by axes of the body."""
    return replace(rig, T_body_imu=SE3(R @ rig.T_body_imu.R, rig.T_body_imu.t))


def exchanged(rig: Rig) -> Rig:
    """The mounts of both LiDARs exchanged."""
    first, last = rig.sensors
    return replace(
        rig,
        sensors=(
            replace(first, T_body_sensor=last.T_body_sensor),
            replace(last, T_body_sensor=first.T_body_sensor),
        ),
    )


def oblique(degrees: float, shift_m: float) -> Callable[[Rig], Rig]:
    """The last LiDAR turned about one oblique axis and moved along another."""
    return lambda rig: mounted(rig, 1, turn_deg=degrees * OBLIQUE, shift_m=shift_m * ASIDE)


RIG_FILES: dict[str, Callable[[Rig], Rig]] = {
    "LiDAR 5° and 10 cm off": oblique(5.0, 0.1),
    "LiDAR 10° and 20 cm off": oblique(10.0, 0.2),
    "LiDAR upside down": lambda rig: last_turned(rig, UPSIDE_DOWN),
    "LiDAR with exchanged axes": lambda rig: last_turned(rig, EXCHANGED),
    "mounts exchanged": exchanged,
    "IMU upside down": lambda rig: imu_turned(rig, UPSIDE_DOWN),
    "IMU with exchanged axes": lambda rig: imu_turned(rig, EXCHANGED),
}


def moving(name: str, motion: Callable[[ArrayLike], SE3]) -> None:
    """Errors of the rig file, and what is left of them, after a walk that does not show all."""
    walk = scanned_room.walk(motion, 120, noise_m=0.01, columns=COLUMNS)
    wrong = mounted(walk.rig, 1, turn_deg=1.5 * OBLIQUE, shift_m=0.02 * OBLIQUE, late_s=0.005)
    wrong = imu_mounted(wrong, turn_deg=-1.5 * OBLIQUE, late_s=-0.005)
    for title, rig in (("right", walk.rig), ("wrong", wrong)):
        parameters = Parameters.of(rig, reference=0, lidars=(1,), imu=True)
        with tempfile.TemporaryDirectory() as folder:
            made = store(Path(folder), walk, rig, walk.imu)
            found = run_calibration(made.frames, made.odometry, settings=AUTO, progress=Silent())
        print(f"{name}, rig file {title}: {outcome_text(found.figures)}")
        print(f"  before: {row(parameters.between(walk.rig, rig))}")
        if found.rig is not None:
            print(f"  after:  {row(parameters.between(walk.rig, found.rig))}")
        unknown = [
            f"{one.sensor} {one.quantity} {one.axis}"
            for one in found.figures.parameters
            if one.status == "not observable"
        ]
        print(f"  not observable: {', '.join(unknown)}", *rig_texts(found.figures), sep="\n  ")


MOTIONS: dict[str, Callable[[ArrayLike], SE3]] = {
    "turns about the vertical": planar,
    "circle": circle,
    "straight": straight,
}


if __name__ == "__main__":
    main()
