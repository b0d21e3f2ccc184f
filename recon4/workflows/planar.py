"""A walk with a 2-D laser alone: scans, 2-D SLAM, occupancy grid."""

from __future__ import annotations

from recon4.workflows.planar_results import PLANAR_RESULTS
from recon4.workflows.planar_stages import AUDIT_2D, GRAPH_2D, MAP_2D, ODOMETRY_2D, SCANS_2D
from recon4.workflows.stages import REVIEW, VERIFICATION
from recon4.workflows.workflow import Run, Workflow


def before_review(run: Run) -> None:
    """Odometry and verified graph."""
    run.stage(ODOMETRY_2D, scans="scans_2d")
    run.stage(GRAPH_2D, scans="scans_2d", odometry="odometry_2d")
    run.stage(VERIFICATION, graph="graph_2d")


def from_review(run: Run) -> None:
    """The map."""
    run.stage(MAP_2D, scans="scans_2d", odometry="odometry_2d", graph=run.graph)


PLANAR = Workflow(
    "planar",
    imports=SCANS_2D,
    before_review=before_review,
    from_review=from_review,
    kept=(SCANS_2D, ODOMETRY_2D, GRAPH_2D, VERIFICATION),
    remade=(REVIEW, MAP_2D),
    audit=AUDIT_2D,
    results=PLANAR_RESULTS,
)
