"""A finished project with 120 loops to be decided about.

Two rounds through the scanned room; every point is computed by arithmetic, odometry drifts, two
loops are wrong. From verification on the stages are the real ones.
"""

from __future__ import annotations

import json
import logging
import sys
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.figures import FrameFigures, GraphFigures
from recon4.model.odometry_figures import OdometryFigures
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Reason, Verdict, known_history
from recon4.model.trajectory import Trajectory
from recon4.pipeline import remake
from recon4.pose_graph.files import save_graph
from recon4.progress import Progress, Silent
from recon4.review.journal import read_decided
from recon4.settings import MapSettings, RefineSettings, Settings
from recon4.settings.reads import ReadsNothing
from recon4.store.arrays import save_trajectory
from recon4.store.atomic import write_json
from recon4.store.frames import FrameStore, FrameWriter
from recon4.store.project import SUMMARY, Project, ProjectDescription
from recon4.store.seal import changing
from recon4.store.stage import Input, Stage, StageContext, StageRunner
from recon4.workflows import stages
from recon4.workflows.lidar import LIDAR
from recon4.workflows.publish import publish
from recon4.workflows.summary import About
from recon4.workflows.workflow import Run
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.worker import main
from tests.room_walks import FRAME_NS, T0_NS
from tests.scanned_room import RIG, scan

NODES = 120
SETTINGS = Settings(map=MapSettings(voxel_m=0.05), refine=RefineSettings(rounds=1))
WRONG = {(20, 90): (0.6, 0.0, 0.0), (41, 70): (0.0, 0.5, 0.0)}
"""Loop closures with wrong relative poses."""
LOST = "Tracking was lost in 70 of 120 multiframes (58 %), first 2.0 s after the start."


def rounds(t_s):
    """Two rounds of six seconds on an ellipse, looking ahead: ``T_map_body``."""
    s = np.asarray(t_s) * (2.0 * np.pi / 6.0)
    zero = np.zeros_like(s)
    t_m = np.stack([0.3 + 1.1 * np.cos(s), 0.3 + 0.8 * np.sin(s), zero], axis=-1)
    return SE3(so3_exp(np.stack([zero, zero, s + np.pi / 2.0], axis=-1)), t_m)


def drifting(t_s):
    """The same as odometry has it: ``T_odom_body``."""
    T = rounds(t_s)
    match_ratio = (np.asarray(t_s) / 12.0)[..., None]
    return SE3(T.R, T.t + match_ratio * np.array([0.12, -0.08, 0.02]))


def make(root: Path, *, graph_only: bool = False, progress: Progress | None = None) -> None:
    """Make the project, or make it again with the decisions in its journal."""
    with Project.open(root) as project:
        project.describe(preset="indoor", rig="test", inputs=[])
        runner = StageRunner(project, SETTINGS, progress or Silent())
        walk = Input("two rounds", None)
        frames = runner.run(Stage("frames", 1, ReadsNothing, _frames, FrameFigures), walk=walk)
        runner.run(Stage("odometry", 1, ReadsNothing, _odometry, OdometryFigures), frames=frames)
        searched = runner.run(Stage("graph", 1, ReadsNothing, _graph, GraphFigures), frames=frames)
        runner.run(stages.VERIFICATION, graph=searched)
        run = Run(runner, read_decided(root))
        if graph_only:
            run.review()
            return
        LIDAR.run_from_review(run)
        about = About(ProjectDescription.read(root), SETTINGS)
        watcher = progress or Silent()
        publish(root, LIDAR.results(), runner.runs, about=about, progress=watcher)


def judge(root: Path, **verdict: object) -> None:
    """Give the finished map another verdict, as a run of format 2 would have written it."""
    path = root / SUMMARY
    with changing(root, SUMMARY, compared=False):
        record = json.loads(path.read_text("utf-8")) | {"verdict": verdict}
        record.pop("findings", None)
        path.unlink()
        write_json(path, record)


def _frames(context: StageContext, *, walk: None) -> FrameFigures:
    with FrameWriter(context.out, RIG) as writer:
        for k in range(NODES):
            writer.append(scan(rounds, T0_NS + k * FRAME_NS, frame_id=k, columns=240))
    points = FrameStore.open(context.out).points
    return FrameFigures(multiframes=NODES, points=points, rig=RIG.name, imu=False, gnss=False)


def _odometry(context: StageContext, *, frames: Path) -> OdometryFigures:
    store = FrameStore.open(frames)
    t_s = np.arange(-0.1, NODES * 0.1 + 0.15, 0.01)
    t_ns = T0_NS + np.rint(t_s * 1e9).astype(np.int64)
    save_trajectory(context.out / "trajectory.npz", Trajectory(t_ns, drifting(t_s)))
    mid = store.t_mid_ns
    T = drifting((mid - T0_NS) * 1e-9)
    nothing, one = np.zeros(NODES), np.ones(NODES)
    np.savez(
        context.out / "steps.npz",
        frame_id=np.arange(NODES), t_mid_ns=mid, quat_xyzw=T.quat_xyzw(), t_m=T.t,
        error_m=0.01 * one, match_ratio=one, rounds=one, converged=one > 0, degeneracy=0.1 * one,
        prediction_offset_m=nothing, lost=nothing > 0,
        motion_cov=np.tile(1e-6 * np.eye(6), (NODES, 1, 1)),
    )  # fmt: skip
    return OdometryFigures(multiframes=NODES, lost=0)


def _graph(context: StageContext, *, frames: Path) -> GraphFigures:
    mid = FrameStore.open(frames).t_mid_ns
    t_s = (mid - T0_NS) * 1e-9
    true, odom = rounds(t_s), drifting(t_s)
    rng = np.random.default_rng(5)
    edges = [_edge(odom, k, k + 1, EdgeKind.ODOMETRY, rng) for k in range(NODES - 1)]
    half = NODES // 2
    pairs = [(k, k + half + more) for k in range(half) for more in (0, 1)]
    pairs = sorted({(i, j) for i, j in pairs if j < NODES} | WRONG.keys())
    edges += [_edge(true, i, j, EdgeKind.LOOP, rng, WRONG.get((i, j))) for i, j in pairs]
    edges += [_apart(odom, k, k + 25) for k in range(0, 40, 8)]
    frame_ids = np.arange(NODES, dtype=np.int64)
    save_graph(context.out, PoseGraph(frame_ids, mid, odom, tuple(edges)))
    return GraphFigures(nodes=NODES, edges=len(edges), accepted=len(edges))


def _edge(T, i, j, kind, rng, off_m=None) -> Edge:
    noise = 0.002 if kind is EdgeKind.LOOP else 0.0005
    xi = noise * np.concatenate([0.2 * rng.standard_normal(3), rng.standard_normal(3)])
    T_i_j = T[i].inverse() @ T[j] @ SE3.exp(xi)
    if off_m is not None:
        T_i_j = SE3(T_i_j.R, T_i_j.t + np.array(off_m))
    sd = [0.002, 0.008] if kind is EdgeKind.LOOP else [0.001, 0.003]
    return Edge(
        i=i,
        j=j,
        T_i_j=T_i_j,
        kind=kind,
        overlap=0.8 - 0.003 * (i % 40),
        error_m=0.008 + 0.0003 * (i % 30),
        limit_m=0.07,
        degeneracy=0.09,
        iterations=8,
        information=np.diag(1.0 / np.repeat(sd, 3) ** 2),
        judgments=known_history(Verdict.ACCEPTED),
    )


def _apart(T, i, j) -> Edge:
    """A pair that sees too little of each other to be registered."""
    return Edge(
        i=i,
        j=j,
        T_i_j=T[i].inverse() @ T[j],
        kind=EdgeKind.LOOP,
        overlap=0.3,
        judgments=known_history(Verdict.REJECTED, Reason.OVERLAP),
    )


def work(folder: JobFolder, progress: Progress) -> None:
    """A job's work, for servers in tests: makes the project again."""
    request = folder.request()
    (remake if request.inputs.remake else make)(request.project, progress=progress)


if __name__ == "__main__":
    logging.getLogger().setLevel(logging.INFO)
    main(Path(sys.argv[1]), work)
