"""How well a rig is calibrated from simulated walks: errors against the truth, stated sigmas.

    python -m tests.benchmarks.calibration FOLDER [--seeds 10] [--seconds 60]

The rig file is 1.5° and 2 cm off (last LiDAR), the IMU 1.5°, both clocks 5 ms; rotation axes are
drawn by the seed. Each walk is calibrated as ``recon4 process --calibrate auto`` does.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.calibration.parameters import Parameters
from recon4.calibration.stage import run_calibration
from recon4.model.rig import Rig, load_rig
from recon4.progress import Silent
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.settings import CalibrationSettings, preset
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.store.frames import FrameStore

LATE_S = 0.005
DEGRADED = {
    "extrinsics": 1.5, "mount-shift": 0.02, "lidar-clock": LATE_S,
    "imu-rotation": 1.5, "imu-clock": LATE_S,
}  # fmt: skip
SETTINGS = replace(preset("indoor"), calibration=CalibrationSettings(mode="auto"))


def main() -> None:
    """Simulate, calibrate, print a row a walk and the table of all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--worlds", nargs="*", default=["office", "staircase"])
    args = parser.parse_args()
    errors, within, applied = [], [], 0
    for seed in range(100, 100 + args.seeds):
        world = args.worlds[seed % len(args.worlds)]
        folder = args.folder / f"{world}-{seed}"
        error, sigmas, cpu_s, was_applied = one(world, folder, seed, args.seconds)
        applied += was_applied
        errors.append(error)
        within.append(np.abs(error) < 2.0 * sigmas)
        print(f"{world}-{seed}: {row(error)}  applied {was_applied}  cpu {cpu_s:.0f} s", flush=True)
    print(f"largest: {row(np.max(np.abs(errors), axis=0))}")
    print(f"rms:     {row(np.sqrt(np.mean(np.square(errors), axis=0)))}")
    print(f"within 2 sigma: {100 * np.mean(within):.0f} %; applied {applied} of {args.seeds}")


def one(
    world: str, folder: Path, seed: int, seconds: float
) -> tuple[np.ndarray, np.ndarray, float, bool]:
    """Errors and standard deviations of all parameters of one walk."""
    recording, frames, odometry = (folder / name for name in ("walk", "frames", "odometry"))
    folder.mkdir(parents=True, exist_ok=True)
    if not recording.exists():
        setup = prepare(world, seconds=seconds, seed=seed)
        simulate(setup, recording, bag=False, degradations=DEGRADED, progress=Silent())
    if not (odometry / "steps.npz").exists():
        sources = Sources(
            (recording / "recording.pcap",), load_rig(recording / "rig.toml"),
            recording / "imu.csv", None,
        )  # fmt: skip
        ingest(sources, frames, settings=SETTINGS.ingest, progress=Silent())
        odometry.mkdir()
        run_odometry(WalkInputs(FrameStore.open(frames), SETTINGS, Silent()), odometry)
    began = time.process_time()
    store = FrameStore.open(frames)
    found = run_calibration(store, odometry, settings=SETTINGS, progress=Silent())
    cpu_s = time.process_time() - began
    rows = found.figures.parameters
    parameters = Parameters.of(store.rig, reference=0, lidars=(1,), imu=True)
    wanted = parameters.between(store.rig, true_rig(recording))
    error = np.array([row.change for row in rows]) - wanted
    sd = np.array([np.inf if row.sd is None else row.sd for row in rows])
    return error, sd, cpu_s, found.figures.applied


def true_rig(recording: Path) -> Rig:
    """The rig that was simulated, with the clocks that are ahead."""
    rig = load_rig(recording / "rig_true.toml")
    sensors = (*rig.sensors[:-1], replace(rig.sensors[-1], time_offset_s=-LATE_S))
    return replace(rig, sensors=sensors, imu_time_offset_s=-LATE_S)


def row(values: np.ndarray) -> str:
    """Degrees, millimeters and milliseconds of both sensors."""
    texts = []
    for name, part in (("LiDAR", values[:7]), ("IMU", values[7:])):
        turn = " ".join(f"{v:.3f}" for v in np.rad2deg(part[:3]))
        place = " ".join(f"{v:.1f}" for v in 1e3 * part[3:6])
        texts.append(f"{name} {turn}° {place} mm {1e3 * part[6]:.2f} ms")
    return ", ".join(texts)


if __name__ == "__main__":
    main()
