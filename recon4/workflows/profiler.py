"""A walk with a profiler: 2-D SLAM joined with the IMU, turns of the head, every line scan."""

from __future__ import annotations

from recon4.workflows.line_stages import LINE_ODOMETRY, LINE_REFINE, TURN_GRAPH
from recon4.workflows.make_map import make_map
from recon4.workflows.map_results import MAP_RESULTS
from recon4.workflows.stages import (
    AUDIT,
    CALIBRATION,
    CLASSES,
    FRAMES,
    INTENSITY,
    LEVEL,
    MAP,
    REVIEW,
    VERIFICATION,
)
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


PROFILER = Workflow(
    "profiler",
    imports=FRAMES,
    before_review=before_review,
    from_review=from_review,
    kept=(FRAMES, LINE_ODOMETRY, TURN_GRAPH, VERIFICATION),
    remade=(REVIEW, LINE_REFINE, LEVEL, INTENSITY, CLASSES, MAP),
    audit=AUDIT,
    results=MAP_RESULTS,
)
