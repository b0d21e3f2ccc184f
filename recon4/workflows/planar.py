"""A walk with a 2-D laser alone: scans, 2-D SLAM, occupancy grid."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from recon4.model.figures import (
    AuditFigures,
    GraphFigures,
    Map2dFigures,
    Odometry2dFigures,
    Scan2dFigures,
)
from recon4.model.finding_kinds import AUDIT_VERSION
from recon4.model.rig import Rig, Sensor
from recon4.settings.reads import (
    Graph2dReads,
    ImportReads,
    Map2dReads,
    Odometry2dReads,
    ReadsNothing,
)
from recon4.store.hashing import hash_json
from recon4.store.stage import Input, Stage, StageContext
from recon4.workflows.stages import REVIEW, VERIFICATION
from recon4.workflows.workflow import Run, Workflow

if TYPE_CHECKING:
    from recon4.workflows.publish import Results


def before_review(run: Run) -> None:
    """Odometry and verified graph."""
    run.stage(ODOMETRY_2D, scans="scans_2d")
    run.stage(GRAPH_2D, scans="scans_2d", odometry="odometry_2d")
    run.stage(VERIFICATION, graph="graph_2d")


def from_review(run: Run) -> None:
    """The map."""
    run.stage(MAP_2D, scans="scans_2d", odometry="odometry_2d", graph=run.graph)


def _results() -> Results[Any]:
    from recon4.workflows.planar_results import PLANAR_RESULTS

    return PLANAR_RESULTS


def _scans(
    context: StageContext[ImportReads], *, recordings: tuple[Path, ...], laser: Sensor | None
) -> Scan2dFigures:
    from recon4.slam2d.stage import import_scans

    return import_scans(
        recordings,
        context.out,
        settings=context.settings.ingest,
        laser=laser,
        progress=context.progress,
    )


def laser_input(rig: Rig | None) -> Input | None:
    """The 2-D laser of a rig file, an input of `SCANS_2D`; None = there is none."""
    row = None if rig is None else rig.row_of("laser2d")
    if rig is None or row is None:
        return None
    laser = rig.sensors[row]
    return Input(hash_json([laser.T_body_sensor.matrix().tolist(), laser.topic]), laser)


def _odometry(context: StageContext[Odometry2dReads], *, scans: Path) -> Odometry2dFigures:
    from recon4.slam2d.stage import run_odometry

    return run_odometry(scans, context.out, settings=context.settings, progress=context.progress)


def _graph(context: StageContext[Graph2dReads], *, scans: Path, odometry: Path) -> GraphFigures:
    from recon4.slam2d.stage import build_graph

    return build_graph(
        scans, odometry, context.out, settings=context.settings, progress=context.progress
    )


def _map(
    context: StageContext[Map2dReads], *, scans: Path, odometry: Path, graph: Path
) -> Map2dFigures:
    from recon4.slam2d.stage import build_map

    artifacts = {"scans": scans, "odometry": odometry, "graph": graph}
    return build_map(artifacts, context.out, settings=context.settings, progress=context.progress)


def _audit(context: StageContext[ReadsNothing], **artifacts: Path) -> AuditFigures:
    from recon4.findings.audit import save_findings
    from recon4.findings.planar_walk import read_planar
    from recon4.findings.witnesses.planar import check_planar

    return save_findings(context.out, check_planar(read_planar(artifacts)))


SCANS_2D = Stage("scans_2d", 14, ImportReads, _scans, Scan2dFigures)
ODOMETRY_2D = Stage("odometry_2d", 1, Odometry2dReads, _odometry, Odometry2dFigures)
GRAPH_2D = Stage("graph_2d", 2, Graph2dReads, _graph, GraphFigures)
MAP_2D = Stage("map_2d", 2, Map2dReads, _map, Map2dFigures)
AUDIT_2D = Stage("audit", AUDIT_VERSION, ReadsNothing, _audit, AuditFigures)
PLANAR = Workflow(
    "planar",
    imports=SCANS_2D,
    before_review=before_review,
    from_review=from_review,
    kept=(SCANS_2D, ODOMETRY_2D, GRAPH_2D, VERIFICATION),
    remade=(REVIEW, MAP_2D),
    audit=AUDIT_2D,
    results=_results,
)
