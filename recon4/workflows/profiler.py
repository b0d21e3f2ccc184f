"""A walk with a profiler: 2-D SLAM joined with the IMU, turns of the head, every line scan.

Its stages have the names of those of LiDARs: readers find the trajectory of a walk in ``odometry``
and its graph in ``graph``, whatever made it. Their keys differ, because they read other settings.
"""

from __future__ import annotations

from pathlib import Path

from recon4.model.figures import GraphFigures, RefineFigures
from recon4.model.odometry_figures import OdometryFigures
from recon4.model.trajectory import Trajectory
from recon4.settings.reads import LineGraphReads, LineOdometryReads, LineRefineReads
from recon4.store.stage import Stage, StageContext
from recon4.workflows.make_map import TO_MAP, make_map, map_results
from recon4.workflows.stages import AUDIT, CALIBRATION, FRAMES, LEVEL, REVIEW, VERIFICATION
from recon4.workflows.workflow import Run, Workflow


def before_review(run: Run) -> None:
    """The first trajectory, and the graph of the turns of the head."""
    run.runner.skip(CALIBRATION)
    run.stage(LINE_ODOMETRY, frames="frames")
    run.stage(TURN_GRAPH, frames="frames", odometry="odometry")
    run.stage(VERIFICATION, graph="graph")


def from_review(run: Run) -> None:
    """Trajectory and map, as of LiDARs."""
    to_trajectory(run)
    make_map(run, to_trajectory, frames="frames")


def to_trajectory(run: Run) -> None:
    """Every line scan is moved; then the trajectory is leveled."""
    inputs = {"frames": "frames", "odometry": "odometry"}
    run.stage(LINE_REFINE, **inputs, nodes=run.nodes)
    leveled = {"refined": "refine", "graph": run.graph, "audit": None}
    run.stage(LEVEL, **inputs, **leveled, **run.control, **run.undecided(to_trajectory))


def _line_odometry(context: StageContext[LineOdometryReads], *, frames: Path) -> OdometryFigures:
    from recon4.profiler.stage_odometry import run_line_odometry
    from recon4.store.frames import FrameStore

    return run_line_odometry(
        FrameStore.open(frames), context.out, settings=context.settings, progress=context.progress
    )


def _sweep_graph(
    context: StageContext[LineGraphReads], *, frames: Path, odometry: Path
) -> GraphFigures:
    from recon4.profiler.sweep_graph import build_sweep_graph
    from recon4.store.frames import FrameStore

    store = FrameStore.open(frames)
    return build_sweep_graph(
        store, odometry, context.out, settings=context.settings, progress=context.progress
    )


def _refine_lines(
    context: StageContext[LineRefineReads], *, frames: Path, odometry: Path, nodes: Trajectory
) -> RefineFigures:
    from recon4.profiler.line_refine import refine_lines
    from recon4.store.frames import FrameStore

    store = FrameStore.open(frames)
    found = refine_lines(
        store, odometry, nodes, settings=context.settings, progress=context.progress
    )
    return found.save(context.out)


LINE_ODOMETRY = Stage("odometry", 7, LineOdometryReads, _line_odometry, OdometryFigures)
TURN_GRAPH = Stage(
    "graph",
    4,
    LineGraphReads,
    _sweep_graph,
    GraphFigures,
)
LINE_REFINE = Stage("refine", 6, LineRefineReads, _refine_lines, RefineFigures)
PROFILER = Workflow(
    "profiler",
    imports=FRAMES,
    before_review=before_review,
    from_review=from_review,
    kept=(FRAMES, LINE_ODOMETRY, TURN_GRAPH, VERIFICATION),
    remade=(REVIEW, LINE_REFINE, LEVEL, *TO_MAP),
    audit=AUDIT,
    results=map_results,
)
