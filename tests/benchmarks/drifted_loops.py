"""Loop closures after a drift of 10 m and 10 degrees, with and without place recognition.

    python -m tests.benchmarks.drifted_loops OUT [WORLD/SEED/SECONDS …] [--drift-m M]

Every walk is simulated and its odometry computed once (kept in OUT). The odometry edges of the
graph then get a drift that grows evenly with the path, with a covariance whose two standard
deviations are that drift. Pairs of neighbors are not registered: they would remove it again.
A node counts as a revisit if the true path was within 2 m of it 15 m of path before, and as found
if a loop closure of the verified graph ends within two nodes of it. A loop closure is false if it
is off the truth by more than 30 cm or 3 degrees.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.evaluation.table import number, text_table
from recon4.geometry.se3 import SE3, Array, align_points, so3_exp
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Reason
from recon4.model.rig import load_rig
from recon4.pose_graph.search import (
    OdometryTrack,
    SearchMeans,
    close_loops,
    make_registrar,
    start_graph,
)
from recon4.pose_graph.tuning import graph_tuning
from recon4.pose_graph.verification import verify
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.registration.submap import TrackedFrames
from recon4.settings import Settings, preset
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import record
from recon4.store.frames import FrameStore
from recon4.store.project import Project
from recon4.store.stage import StageRunner
from recon4.workflows import stages
from recon4.workflows.lidar import ODOMETRY
from tests.benchmarks.proving_ground import simulated_inputs

WALKS = ("office/12/100", "garage/1/60", "garage:1/2/80", "storeys/1/60", "staircase/3/60")
_FALSE_M, _FALSE_RAD = 0.3, np.deg2rad(3.0)
_NEAR_M, _APART_M, _BESIDE = 2.0, 15.0, 2


@dataclass(frozen=True, slots=True, eq=False)
class DriftedWalk:
    """A walk with its odometry and the truth."""

    frames: FrameStore
    odometry: OdometryTrack
    recording: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopsFound:
    """What the search found in a drifted walk."""

    revisits: int
    found: int
    """Revisits that a loop closure ends at."""
    loops: int
    """Loop closures in the verified graph."""
    false: int
    """Those that are off the truth."""
    ambiguous: int
    """Edges that wait for a decision."""
    ate_m: float
    cpu_s: float

    def row(self) -> tuple[str, ...]:
        """Its columns of the table."""
        return (
            f"{self.found} of {self.revisits}", str(self.loops), str(self.false),
            str(self.ambiguous), number(100.0 * self.ate_m, 1), number(self.cpu_s, 0),
        )  # fmt: skip


def prepared(spec: str, out: Path) -> DriftedWalk:
    """Simulate a walk ``WORLD/SEED/SECONDS`` and run its odometry, or find both in ``out``."""
    world, seed, seconds = spec.split("/")
    folder = out / spec.replace("/", "_").replace(":", "v")
    recording = folder / "recording"
    if not recording.exists():
        folder.mkdir(parents=True, exist_ok=True)
        setup = prepare(world, seconds=float(seconds), seed=int(seed))
        record(setup, {recording: {}}, bag=False, progress=Silent())
    rig = load_rig(recording / "rig.toml")
    with Project.open(folder / "project") as project:
        project.describe(preset="indoor", rig=rig.name, inputs=[])
        runner = StageRunner(project, preset("indoor"), Silent())
        frames = runner.run(stages.FRAMES, **simulated_inputs(recording, rig, project))
        odometry = runner.run(ODOMETRY, frames=frames)
    return DriftedWalk(
        FrameStore.open(frames.folder), OdometryTrack.load(odometry.folder), recording
    )


def drifted(graph: PoseGraph, *, drift_m: float, drift_rad: float) -> PoseGraph:
    """The start graph with a horizontal drift and a turn that grow evenly with the path."""
    T = graph.T_map_body
    steps = np.linalg.norm(np.diff(T.t, axis=0), axis=1)
    part = steps / steps.sum()
    edges: list[Edge] = []
    poses = [T[0]]
    for k, edge in enumerate(graph.edges):
        shift = T.R[k].T @ (drift_m * part[k] * np.array([0.8, 0.6, 0.0]))
        turn = so3_exp([0.0, 0.0, drift_rad * part[k]])
        T_i_j = SE3(edge.T_i_j.R @ turn, edge.T_i_j.t + shift)
        sd = 0.5 * part[k] * np.array([0.0, 0.0, drift_rad, drift_m, drift_m, 0.0])
        information = np.linalg.inv(np.linalg.inv(edge.information) + np.diag(sd**2))
        edges.append(edge.evolve(T_i_j=T_i_j, information=0.5 * (information + information.T)))
        poses.append(poses[-1] @ T_i_j)
    return graph.with_edges(tuple(edges)).with_poses(SE3.stack(poses))


def without_neighbors(*, recognition: bool) -> Settings:
    """Settings of the search, with or without recognition."""
    settings = preset("indoor")
    return replace(
        settings,
        graph=replace(graph_tuning(settings.graph), neighbors=0, workers=1),
        recognition=replace(settings.recognition, enabled=recognition),
    )


def off_truth(edge: Edge, truth: SE3) -> tuple[float, float]:
    """How far an edge is off the true relative pose [m], [rad]."""
    apart = (truth[edge.i].inverse() @ truth[edge.j]).inverse() @ edge.T_i_j
    return float(np.linalg.norm(apart.t)), float(apart.angle())


def revisits(t_m: Array) -> list[int]:
    """Nodes where the true path was near before."""
    path_m = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(t_m, axis=0), axis=1))])
    found = []
    for j in range(len(t_m)):
        before = path_m[j] - path_m[:j] >= _APART_M
        if (np.linalg.norm(t_m[:j][before] - t_m[j], axis=1) < _NEAR_M).any():
            found.append(j)
    return found


def loops_found(walk: DriftedWalk, *, drift_m: float, recognition: bool) -> LoopsFound:
    """Search for loop closures in a walk with a drift of that many meters and degrees."""
    settings = without_neighbors(recognition=recognition)
    start = start_graph(walk.frames, walk.odometry, settings=settings.graph)
    start = drifted(start, drift_m=drift_m, drift_rad=np.deg2rad(drift_m))
    begun = time.process_time()
    with tempfile.TemporaryDirectory() as scratch:
        rows = start.frame_ids.astype(np.intp)
        tracked = TrackedFrames(walk.frames, walk.odometry.trajectory, walk.odometry.lost)
        graph = close_loops(
            start,
            make_registrar(tracked, rows, settings=settings, means=SearchMeans(Path(scratch))),
            pieces=walk.odometry.piece[rows],
            leveled=walk.frames.imu is not None,
            progress=Silent(),
        )
    found = verify(graph, settings=settings.verification).graph
    cpu_s = time.process_time() - begun
    trajectory = read_tum(walk.recording / "truth.tum")
    truth = trajectory.at(np.clip(found.t_ns, trajectory.t_ns[0], trajectory.t_ns[-1]))
    loops = [e for e in found.edges if e.kind is EdgeKind.LOOP and e.in_graph]
    false = sum(m > _FALSE_M or rad > _FALSE_RAD for m, rad in (off_truth(e, truth) for e in loops))
    again = revisits(truth.t)
    closed = {node for e in loops for node in range(e.j - _BESIDE, e.j + _BESIDE + 1)}
    error_m = (align_points(truth.t, found.T_map_body.t) @ found.T_map_body.t) - truth.t
    return LoopsFound(
        revisits=len(again),
        found=sum(k in closed for k in again),
        loops=len(loops),
        false=false,
        ambiguous=sum(e.reason is Reason.AMBIGUOUS for e in found.edges),
        ate_m=float(np.sqrt((error_m**2).sum(axis=1).mean())),
        cpu_s=cpu_s,
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=Path)
    parser.add_argument("walks", nargs="*", default=WALKS)
    parser.add_argument("--drift-m", type=float, default=10.0, help="and as many degrees")
    a = parser.parse_args()
    rows = []
    for spec in a.walks:
        walk = prepared(spec, a.out)
        for recognition in (False, True):
            found = loops_found(walk, drift_m=a.drift_m, recognition=recognition)
            rows.append((spec, "yes" if recognition else "no", *found.row()))
            print(*rows[-1], flush=True)
    header = ("walk", "recognition", "revisits found", "loops", "false", "ambiguous", "ATE cm",
              "cpu s")  # fmt: skip
    print(text_table(header, rows))


if __name__ == "__main__":
    main()
