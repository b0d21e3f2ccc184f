"""Real sequences without an IMU as finished runs, beside three odometries, in the same run.

    python -m tests.benchmarks.real_maps OUT [nclt] [corridor] [muehlburg] [durlacher]

Each sequence is written as a folder of PCD files with its times, as a user has it, and mapped by
`process` with the settings a user would choose. KISS-ICP, small_gicp and GenZ-ICP (if installed:
``pip install genz-icp``) get the multiframes of that project, one thread each.

ATE and drift need a truth (NCLT); length, entropy and plane thickness do not: smaller
entropy and thinner planes are a crisper map of the same multiframes.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.evaluation.kitti import official_drift
from recon4.evaluation.sharpness import draw_places, sharpness
from recon4.evaluation.table import number, text_table
from recon4.geometry.se3 import Array
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.trajectory import Trajectory
from recon4.pipeline import process
from recon4.recording.formats.poses import read_tum
from recon4.recording.sources import Sources
from recon4.settings import preset
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts
from tests.benchmarks.loaders import (
    durlacher,
    muehlburg,
    nclt,
    nclt_truth,
    one_sensor,
)
from tests.benchmarks.peers import PeerRun, genz_icp, kiss_icp, run, vgicp
from tests.benchmarks.real_sequences import DATA, corridor, placed
from tests.builders import write_pcd

_DRIFT_M = (5.0, 10.0, 20.0, 40.0)
_CRISP_FRAMES = 60
_LEAST_STEP_S = 0.1
_LONGEST_GAP_NS = 10**10


@dataclass(frozen=True)
class Sequence:
    """A set of real scans, and how a user would map it."""

    load: Callable[[Path], Iterator[Multiframe] | list[Multiframe]]
    rig: Rig
    truth: Callable[[Path], Trajectory] | None
    preset: str
    deskewed: bool
    """Scans without times."""
    voxel_m: float
    """Of KISS-ICP."""
    period_s: float = 0.0
    """Between scans without times [s]: they were kept every 0.6 m or so of a walk …"""
    pace_m_s: float = 0.0
    """… or, with a truth, the speed of the carrier: key scans have gaps of several meters."""


SEQUENCES = {
    "nclt-hdl32": Sequence(
        nclt, one_sensor("HDL-32E"), nclt_truth, "outdoor", True, 0.6, pace_m_s=1.2
    ),
    "vlp16-corridor": Sequence(
        corridor, one_sensor("VLP-16"), None, "indoor", True, 0.25, period_s=0.5
    ),
    "hdl64-muehlburg": Sequence(muehlburg, one_sensor("HDL-64E"), None, "outdoor", False, 0.6),
    "hdl64-durlacher": Sequence(durlacher, one_sensor("HDL-64E"), None, "outdoor", False, 0.6),
}


def write_scans(sequence: Sequence, name: str, folder: Path) -> None:
    """A folder of PCD files with ring, times of the points and of the scans."""
    folder.mkdir(parents=True)
    t_ns = []
    for k, frame in enumerate(sequence.load(DATA / name)):
        table = {axis: frame.xyz[:, i] for i, axis in enumerate("xyz")} | {"ring": frame.ring}
        if not sequence.deskewed:
            table["t"] = frame.dt_ns.astype(np.float32) * np.float32(1e-9)
        write_pcd(folder / f"{k:06d}.pcd", table)
        t_ns.append(frame.t_ns)
    t_s = (np.array(t_ns) - t_ns[0]) / 1e9
    if sequence.pace_m_s and sequence.truth:
        t_s = times_of_carrier(sequence.truth(DATA / name), sequence.pace_m_s)
    elif sequence.deskewed:
        t_s = np.arange(len(t_ns)) * sequence.period_s
    lines = [f"{stamp:.9f}\n" for stamp in t_s]
    (folder / "times.txt").write_text("".join(lines))


def times_of_carrier(truth: Trajectory, pace_m_s: float) -> Array:
    """Times at which a carrier of constant speed is at the true poses, 0.1 s apart or more [s]."""
    steps_m = np.linalg.norm(np.diff(truth.T_a_b.t, axis=0), axis=1)
    return np.append(0.0, np.cumsum(np.maximum(steps_m / pace_m_s, _LEAST_STEP_S)))


def finished(name: str, sequence: Sequence, out: Path) -> tuple[list[PeerRun], FrameStore, str]:
    """Our odometry and final trajectory, the multiframes, and the verdict in words."""
    scans, project = out / name / "scans", out / name / "project"
    if not scans.exists():
        write_scans(sequence, name, scans)
    settings = preset(sequence.preset)
    settings = replace(settings, ingest=replace(settings.ingest, deskewed=sequence.deskewed))
    summary = process(Sources((scans,), sequence.rig), project, settings=settings)
    frames = FrameStore.open(read_artifacts(project)["frames"])
    (odometry,) = (stage for stage in summary.stages if stage.stage == "odometry")
    per_frame_s = odometry.seconds / len(frames)
    runs = [
        PeerRun(title, read_tum(project / file), np.full(1, seconds), np.zeros(1))
        for title, file, seconds in (
            ("recon4, odometry", "odometry.tum", per_frame_s),
            ("recon4, final", "trajectory.tum", float("nan")),
        )
    ]
    said = "; ".join(summary.verdict.reasons)
    return runs, frames, f"{summary.lost} of {summary.multiframes} lost; {said}"


def peers(sequence: Sequence, frames: FrameStore) -> Iterator[PeerRun]:
    """The other programs on the same multiframes."""
    deskew = not sequence.deskewed
    rig = frames.rig
    ways = [
        (
            f"KISS-ICP {sequence.voxel_m:g} m",
            lambda: kiss_icp(deskew=deskew, voxel_m=sequence.voxel_m),
        ),
        ("KISS-ICP 1 m", lambda: kiss_icp(deskew=deskew, voxel_m=1.0)),
        ("small_gicp VGICP 0.5 m", vgicp),
        ("small_gicp VGICP 1 m", lambda: vgicp(voxel_m=1.0)),
        ("GenZ-ICP", lambda: genz_icp(deskew=deskew)),
    ]
    for name, make in ways:
        try:
            register = make()
        except ImportError as error:
            print(f"{name}: not installed ({error.name})")
            continue
        yield run(name, register, frames, rig)


def row(one: PeerRun, frames: FrameStore, truth: Trajectory | None) -> tuple[str, ...]:
    """Figures of one trajectory."""
    t_m = one.trajectory.T_a_b.t
    length_m = float(np.linalg.norm(np.diff(t_m, axis=0), axis=1).sum())
    ate = drift = float("nan")
    if truth is not None:
        at = Trajectory(truth.t_ns, one.trajectory.at(truth.t_ns))
        pairs = pair_poses(at, truth, max_gap_ns=_LONGEST_GAP_NS)
        ate = absolute_error(pairs).position_m.rmse
        drift = official_drift(pairs, lengths_m=_DRIFT_M).translation
    last = [frames[k] for k in range(max(0, len(frames) - _CRISP_FRAMES), len(frames) - 1)]
    clouds = placed(last, one.trajectory, frames.rig)
    crisp = sharpness(
        np.concatenate(clouds), places=draw_places(clouds, rng=np.random.default_rng(1))
    )
    return (
        one.name,
        number(length_m, 2),
        number(100 * ate, 1),
        number(100 * drift, 2),
        number(crisp.entropy, 3),
        number(1e3 * crisp.plane_thickness_m, 1),
        number(1e3 * float(np.median(one.register_s)), 0),
    )


def table(name: str, out: Path) -> str:
    """All programs on one sequence."""
    sequence = SEQUENCES[name]
    runs, frames, said = finished(name, sequence, out)
    truth = sequence.truth(DATA / name) if sequence.truth else None
    if truth is not None:
        truth = on_clock(truth, frames)
    header = ("", "path m", "ATE cm", "drift %", "entropy", "planes mm", "ms")
    rows = [row(one, frames, truth) for one in (*runs, *peers(sequence, frames))]
    return f"{name}: {said}\n{text_table(header, rows)}"


def on_clock(truth: Trajectory, frames: FrameStore) -> Trajectory:
    """The truth, one pose a multiframe, at the times of the project."""
    if len(truth.t_ns) != len(frames):
        raise ValueError(f"{len(truth.t_ns)} true poses for {len(frames)} multiframes")
    t_ns = np.array([frame.t_mid_ns for frame in frames], np.int64)
    return Trajectory(t_ns, truth.T_a_b)


def main() -> None:
    """Map the sequences named, or all."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    out, *wanted = sys.argv[1:]
    for name in SEQUENCES:
        if not wanted or any(word in name for word in wanted):
            print(table(name, Path(out)), flush=True)


if __name__ == "__main__":
    main()
