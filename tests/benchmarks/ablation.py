"""Accuracy by mode (V Table 3.2) and with one LiDAR instead of two (V §3.4).

    python -m tests.benchmarks.ablation RECORDING [--sensors | --preset thesis]

RECORDING is a folder written by ``recon4 simulate``. The same points (every tenth multiframe) are
placed by the trajectory of each mode and by the true one, and compared with the true model in the
eight slices of `recon4.evaluation`; so only the poses differ.
"""

from __future__ import annotations

import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.evaluation.floor import ErrorFloor, relative_error_floor
from recon4.evaluation.reference_mesh import read_mesh
from recon4.model.rig import Rig, load_rig
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph, save_graph
from recon4.pose_graph.search import SearchMeans, build_graph
from recon4.pose_graph.verification import verify
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.registration.stage import run_odometry
from recon4.registration.tracked_walk import WalkInputs
from recon4.semi_rigid.refine import refine
from recon4.settings import Settings, override, preset
from recon4.store.arrays import load_arrays, load_trajectory
from recon4.store.frames import FrameStore

MODES = ("10", "overlap", "verification", "beyond")


def read_frames(recording: Path, folder: Path, rig: Rig) -> FrameStore:
    folder.mkdir()
    sources = Sources((recording / "recording.pcap",), rig, recording / "imu.csv")
    ingest(sources, folder, settings=preset("indoor").ingest, progress=Silent())
    return FrameStore.open(folder)


def solve(
    frames: FrameStore, odometry: Path, work: Path, settings: Settings
) -> tuple[Trajectory, float]:
    """Trajectory of one mode, and the seconds after odometry."""
    searched, verified, refined = (work / name for name in ("graph", "verified", "refined"))
    for folder in (searched, verified, refined):
        folder.mkdir(parents=True)
    start = time.perf_counter()
    build_graph(frames, odometry, SearchMeans(searched), settings=settings, progress=Silent())
    graph = load_graph(searched)
    if settings.graph.mode in ("verification", "beyond"):
        graph = verify(graph, settings=settings.verification, progress=Silent()).graph
    save_graph(verified, graph)
    refine(frames, odometry, graph.nodes, settings=settings, progress=Silent()).save(refined)
    seconds = time.perf_counter() - start
    return load_trajectory(refined / "trajectory.npz"), seconds


def judge(
    frames: FrameStore, found: Trajectory, truth: Trajectory, model: Path
) -> tuple[ErrorFloor, float]:
    some = [frames[k] for k in range(0, len(frames), 10)]
    floor = relative_error_floor(some, frames.rig, read_mesh(model), estimate=found, truth=truth)
    at = Trajectory(frames.t_mid_ns[1:-1], found.at(frames.t_mid_ns[1:-1]))
    return floor, absolute_error(pair_poses(at, truth)).position_m.rmse


def row(name: str, floor: ErrorFloor, ate_m: float, *, lost: int, seconds: float) -> str:
    slices = " ".join(f"{100 * s.mean_m:5.2f}" for s in floor.estimated.slices)
    e, true = floor.estimated.point_weighted, floor.true.point_weighted
    return (
        f"{name:<22} {slices} | {100 * e.mean_m:5.2f} {100 * floor.estimated.plain_mean_m:5.2f} "
        f"{100 * e.ratio_within_2cm:5.1f} % {100 * e.ratio_within_5cm:5.1f} % | "
        f"true {100 * true.mean_m:5.2f} ratio {floor.ratio:5.3f} | "
        f"ATE {100 * ate_m:6.2f} cm, {lost} lost, {seconds:5.1f} s"
    )


def modes(
    recording: Path, rig: Rig, names: tuple[str, ...], label: str = "", *, base: str = "indoor"
) -> None:
    truth = read_tum(recording / "truth.tum")
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        frames = read_frames(recording, work / "frames", rig)
        odometry = work / "odometry"
        odometry.mkdir()
        start = time.perf_counter()
        run_odometry(WalkInputs(frames, preset(base), Silent()), odometry)
        seconds = time.perf_counter() - start
        lost = int(np.sum(load_arrays(odometry / "steps.npz", ["lost"])["lost"]))
        found = load_trajectory(odometry / "trajectory.npz")
        judged = judge(frames, found, truth, recording / "model.ply")
        print(row(f"{label}odometry", *judged, lost=lost, seconds=seconds), flush=True)
        for mode in names:
            settings = override(preset(base), [f"graph.mode={mode}"])
            found, seconds = solve(frames, odometry, work / mode, settings)
            judged = judge(frames, found, truth, recording / "model.ply")
            print(row(f"{label}{mode}", *judged, lost=lost, seconds=seconds), flush=True)


def only(rig: Rig, name: str) -> Rig:
    """The rig with one LiDAR switched on."""
    return replace(rig, sensors=tuple(replace(s, enabled=s.name == name) for s in rig.sensors))


def main(recording: Path, *, sensors: bool, base: str) -> None:
    rig = load_rig(recording / "rig.toml")
    print(f"{recording.name}: e_r in 8 slices [cm] | mean, plain mean, < 2 cm, < 5 cm | …")
    if not sensors:
        modes(recording, rig, MODES[:3] if base == "thesis" else MODES, base=base)
        return
    for sensor in rig.sensors:
        modes(recording, only(rig, sensor.name), ("beyond",), f"{sensor.name} ")
    modes(recording, rig, ("beyond",), "both ")


if __name__ == "__main__":
    main(
        Path(sys.argv[1]),
        sensors="--sensors" in sys.argv,
        base=sys.argv[sys.argv.index("--preset") + 1] if "--preset" in sys.argv else "indoor",
    )
