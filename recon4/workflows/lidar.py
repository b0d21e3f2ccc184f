"""A walk with LiDARs, in stages: multiframes, odometry, rig, pose graph, refinement, map."""

from __future__ import annotations

from recon4.workflows.make_map import make_map
from recon4.workflows.map_results import MAP_RESULTS
from recon4.workflows.stages import (
    AUDIT,
    CALIBRATION,
    CLASSES,
    FRAMES,
    GRAPH,
    INTENSITY,
    LEVEL,
    MAP,
    ODOMETRY,
    REFINE,
    REVIEW,
    VERIFICATION,
)
from recon4.workflows.workflow import Run, Workflow


def before_review(run: Run) -> None:
    """Odometry and verified graph; a rig that is calibrated repeats the odometry."""
    run.stage(ODOMETRY, frames="frames")
    run.stage(CALIBRATION, frames="frames", odometry="odometry")
    if "calibration" in run.measurements:
        run.stage(ODOMETRY, **run.measurements, earlier="odometry")
    run.stage(GRAPH, **run.measurements, odometry="odometry")
    run.stage(VERIFICATION, graph="graph")


def refined(run: Run) -> None:
    """The refined trajectory, or that without decisions carried along with the nodes."""
    inputs = run.measurements | {"odometry": "odometry"}
    run.stage(REFINE, **inputs, nodes=run.nodes_to_refine(refined))


def to_trajectory(run: Run) -> None:
    """The final trajectory: refined, leveled, georeferenced."""
    refined(run)
    inputs = run.measurements | {"odometry": "odometry"}
    leveled = {"refined": "refine", "graph": run.graph, "audit": run.rig_audit}
    run.stage(LEVEL, **inputs, **leveled, **run.control, **run.undecided(to_trajectory))


def from_review(run: Run) -> None:
    """Trajectory and map."""
    to_trajectory(run)
    make_map(run, to_trajectory, **run.measurements)


LIDAR = Workflow(
    "lidar",
    imports=FRAMES,
    before_review=before_review,
    from_review=from_review,
    kept=(FRAMES, ODOMETRY, CALIBRATION, GRAPH, VERIFICATION),
    remade=(REVIEW, REFINE, LEVEL, INTENSITY, CLASSES, MAP),
    audit=AUDIT,
    results=MAP_RESULTS,
)
