"""Faults that no degradation of the simulator makes, put into recordings of the proving ground.

    python -m tests.benchmarks.recorded_faults OUT [--walks W,…] [--faults F,…] [--seconds S]

Each walk is simulated without any error, copied with each fault, and judged by its odometry: a
line of ``OUT/runs.jsonl``, which ``tests.benchmarks.precision`` counts. The files of the recording
are changed, not the program. ``frames`` is the same walk as a folder of clouds with ``times.txt``,
without any fault.
"""

from __future__ import annotations

import argparse
import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.findings.audit import check_walk
from recon4.findings.verdict import verdict_of
from recon4.findings.walk_record import read_walk
from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.rig import format_rig, load_rig
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings, preset
from recon4.settings.reads import AuditReads
from recon4.store.frames import FrameStore
from recon4.store.project import Project
from recon4.store.stage import StageRunner
from recon4.workflows.lidar import LIDAR, ODOMETRY
from recon4.workflows.workflow import Run as WorkflowRun
from tests.benchmarks.proving_errors import BASE_M, PER_METER
from tests.benchmarks.proving_ground import read_lines, simulate_walk, simulated_inputs
from tests.builders import write_pcd

WALKS = (
    "rooms:44/8542/XT32", "showroom/8692/VLP-16", "office/8041/VLP-16", "corridor:5/8042/VLP-16",
    "mirrors:42/8043/VLP-16", "storeys:3/8044/VLP-16", "plaza:6/8045/XT32", "garage:2/8046/VLP-16",
)  # fmt: skip
"""Of one LiDAR, with an IMU in a file."""
Fault = Callable[[Path, np.random.Generator], None]
LEVER_ARM_M, CLOCK_S, SET_S, FRAMES_SET_S = 0.5, 0.02, 0.1, 0.08
"""How far off the IMU is; how far its clock is; how far clocks are set back halfway."""


def lever_arm(folder: Path, rng: np.random.Generator) -> None:
    """The rig file has the IMU somewhere else."""
    rig, way = load_rig(folder / "rig.toml"), rng.standard_normal(3)
    off_m = LEVER_ARM_M * way / np.linalg.norm(way)
    T = SE3(rig.T_body_imu.R, rig.T_body_imu.t + off_m)
    (folder / "rig.toml").write_text(format_rig(replace(rig, T_body_imu=T)), "utf-8")


def mounted(rotation_rad: tuple[float, float, float]) -> Fault:
    """The rig file has the IMU rotated."""

    def put(folder: Path, rng: np.random.Generator) -> None:
        rig = load_rig(folder / "rig.toml")
        T = SE3(rig.T_body_imu.R @ so3_exp(np.array(rotation_rad)), rig.T_body_imu.t)
        (folder / "rig.toml").write_text(format_rig(replace(rig, T_body_imu=T)), "utf-8")

    return put


def signs(gyro: tuple[int, int, int], accel: tuple[int, int, int]) -> Fault:
    """The driver of the IMU turns signs round."""

    def put(folder: Path, rng: np.random.Generator) -> None:
        path = folder / "imu.csv"
        head = path.read_text("utf-8").split("\n", 1)[0]
        rows = np.loadtxt(path, delimiter=",", skiprows=1, dtype=str)
        changed = rows[:, 1:].astype(np.float64) * [*gyro, *accel]
        path.unlink()
        lines = (
            f"{t_ns}," + ",".join(f"{x:.9f}" for x in row)
            for t_ns, row in zip(rows[:, 0], changed, strict=True)
        )
        path.write_text("\n".join([head, *lines]) + "\n", "utf-8")

    return put


def imu_clock(folder: Path, rng: np.random.Generator) -> None:
    """The clock of the IMU is ahead or behind."""
    ahead_ns = round(1e9 * CLOCK_S) * int(rng.choice((-1, 1)))
    _stamped(folder / "imu.csv", lambda row, of: ahead_ns)


def imu_set(folder: Path, rng: np.random.Generator) -> None:
    """The clock of the IMU is set back somewhere in the middle."""
    at = rng.uniform(0.3, 0.7)
    _stamped(folder / "imu.csv", lambda row, of: -round(1e9 * SET_S) if row > at * of else 0)


def recorder_set(folder: Path, rng: np.random.Generator) -> None:
    """The clock of the computer that writes the packets is set back somewhere in the middle."""
    path, at = folder / "recording.pcap", rng.uniform(0.3, 0.7)
    data = bytearray(path.read_bytes())
    unit = 1 if data[:4] == b"\x4d\x3c\xb2\xa1" else 1000  # nanoseconds or microseconds
    place, whole = 24, len(data)
    while place < whole:
        head = np.frombuffer(data, "<u4", 4, place).astype(np.int64)
        if place > at * whole:
            t_ns = head[0] * 10**9 + head[1] * unit - round(1e9 * 10 * SET_S)
            head[:2] = t_ns // 10**9, t_ns % 10**9 // unit
            data[place : place + 8] = head[:2].astype("<u4").tobytes()
        place += 16 + int(head[2])
    path.unlink()
    path.write_bytes(data)


def frames(folder: Path, rng: np.random.Generator, *, back_s: float = 0.0) -> None:
    """The walk as a folder of clouds, whose times may be set back somewhere in the middle."""
    rig = load_rig(folder / "rig.toml")
    capture, scans, work = folder / "recording.pcap", folder / "scans", folder / "frames"
    sources = Sources.of(capture, rig=rig, imu=folder / "imu.csv")
    ingest(sources, work, settings=IngestSettings(), progress=Silent())
    scans.mkdir()
    store, times = FrameStore.open(work), []
    at = rng.uniform(0.3, 0.7) * len(store)
    for k in range(len(store)):
        frame = store[k]
        columns = {name: np.array(frame.xyz[:, axis]) for axis, name in enumerate("xyz")}
        columns["time"] = (1e-9 * frame.dt_ns).astype(np.float32)
        write_pcd(scans / f"{k:06d}.pcd", columns)
        times.append(f"{(frame.t_ns - (k > at) * round(1e9 * back_s)) / 1e9:.6f}")
    (scans / "times.txt").write_text("\n".join(times) + "\n", "utf-8")
    shutil.rmtree(work)
    capture.unlink()


def frames_set(folder: Path, rng: np.random.Generator) -> None:
    """The same, with times that are set back."""
    frames(folder, rng, back_s=FRAMES_SET_S)


FAULTS: dict[str, Fault] = {
    "imu-to-the-left": mounted((0.0, 0.0, np.pi / 2)),
    "imu-tilted": mounted((0.06, 0.06, 0.0)),
    "imu-left-handed": signs((1, -1, 1), (1, -1, 1)),
    "gyro-sign": signs((-1, -1, -1), (1, 1, 1)),
    "imu-lever-arm": lever_arm,
    "imu-clock": imu_clock,
    "imu-set": imu_set,
    "recorder-set": recorder_set,
    "frames": frames,
    "frames-set": frames_set,
}


def _stamped(path: Path, ahead_ns: Callable[[int, int], int]) -> None:
    head, *rows = path.read_text("utf-8").splitlines()
    lines = [head]
    for k, row in enumerate(rows):
        t_ns, rest = row.split(",", 1)
        lines.append(f"{int(t_ns) + ahead_ns(k, len(rows))},{rest}")
    path.unlink()
    path.write_text("\n".join(lines) + "\n", "utf-8")


def judge(recording: Path, work: Path, *, walk: str, fault: str) -> dict[str, Any]:
    """What is said of a recording once its odometry is there, and how wrong that is.

    Graph and map do not change what these findings say, and take twice the time.
    """
    outdoors = json.loads((recording / "world.json").read_text("utf-8"))["outdoors"]
    settings, rig = preset("outdoor" if outdoors else "indoor"), load_rig(recording / "rig.toml")
    shutil.rmtree(work, ignore_errors=True)
    with Project.open(work) as project:
        project.describe(preset="faults", rig=rig.name, inputs=[])
        runner = StageRunner(project, settings, Silent())
        run = WorkflowRun(runner)
        run.stage(LIDAR.imports, **simulated_inputs(recording, rig, project))
        run.stage(ODOMETRY, frames="frames")
        artifacts = {name: one.artifact.folder for name, one in runner.runs.items()}
        record = read_walk(artifacts, AuditReads())
        found = check_walk(record)
    assert record.odometry is not None and record.odometry_figures is not None
    truth = read_tum(recording / "truth.tum")
    pairs = pair_poses(record.odometry, truth)
    ate_m = absolute_error(pairs).position_m.rmse
    limit_m = BASE_M + PER_METER * float(
        np.linalg.norm(np.diff(truth.T_a_b.t, axis=0), axis=1).sum()
    )
    verdict = verdict_of(found)
    announced = "announced" if verdict.reasons else "SILENT"
    return {
        "walk": walk,
        "degradation": fault,
        "ate_m": ate_m,
        "lost": record.odometry_figures.lost,
        "verdict": str(verdict.usability),
        "outcome": "right" if ate_m <= limit_m else announced,
        "kinds": {str(one.kind): str(one.level) for one in reversed(found)},
    }


def main() -> None:
    """Run what is missing."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--walks", default=",".join(WALKS))
    parser.add_argument("--faults", default=",".join(["none", *FAULTS]))
    parser.add_argument("--seconds", type=float, default=10.0)
    a = parser.parse_args()
    path = a.out / "runs.jsonl"
    for row, walk in enumerate(a.walks.split(",")):
        done = {line["degradation"] for line in read_lines(path) if line["walk"] == walk}
        missing = [fault for fault in a.faults.split(",") if fault not in done]
        sound = a.out / "recordings" / walk.translate(str.maketrans("/:", "-v"))
        if missing and not sound.exists():
            simulate_walk(walk, {"none": sound}, seconds=a.seconds)
        for fault in missing:
            folder = a.out / "faulty"
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(sound, folder)
            if fault != "none":
                FAULTS[fault](folder, np.random.default_rng([row, len(fault)]))
            line = judge(folder, a.out / "project", walk=walk, fault=fault)
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(line) + "\n")
            print(line, flush=True)


if __name__ == "__main__":
    main()
