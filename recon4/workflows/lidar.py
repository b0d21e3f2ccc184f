"""A walk with LiDARs, in stages: multiframes, odometry, rig, pose graph, refinement, map."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from recon4.model.figures import GraphFigures, RefineFigures
from recon4.model.odometry_figures import OdometryFigures
from recon4.semi_rigid.graph_nodes import GraphNodes
from recon4.settings.reads import GraphReads, OdometryReads, RefineReads
from recon4.store.stage import Stage, StageContext
from recon4.workflows.make_map import TO_MAP, make_map, map_results
from recon4.workflows.stages import AUDIT, CALIBRATION, FRAMES, LEVEL, REVIEW, VERIFICATION
from recon4.workflows.workflow import Run, Workflow

if TYPE_CHECKING:
    from recon4.model.frames import RecordedFrames
    from recon4.registration.imu_repairs import ImuRepairs
    from recon4.registration.tracked_walk import WalkInputs


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


def _odometry(
    context: StageContext[OdometryReads],
    *,
    frames: Path,
    calibration: Path | None = None,
    earlier: Path | None = None,
) -> OdometryFigures:
    from recon4.georeference.gnss_aiding import make_gnss_aiding
    from recon4.registration.imu_repairs import with_right_axes, with_right_forces
    from recon4.registration.stage import earlier_walks, run_odometry
    from recon4.registration.tracked_walk import WalkInputs
    from recon4.store.frames import open_frames

    store, settings = open_frames(frames, calibration), context.settings

    def inputs(right: RecordedFrames, repairs: ImuRepairs) -> WalkInputs:
        aiding = make_gnss_aiding(store.gnss, store.rig, settings.odometry, imu=right.imu)
        before = earlier_walks(earlier) if earlier else None
        return WalkInputs(right, settings, context.progress, aiding, before, repairs)

    def turned() -> WalkInputs | None:
        found = with_right_axes(store, settings)
        return inputs(*found) if found is not None else None

    recording = replace(inputs(*with_right_forces(store, settings)), with_right_axes=turned)
    return run_odometry(recording, context.out)


def _graph(
    context: StageContext[GraphReads],
    *,
    frames: Path,
    odometry: Path,
    calibration: Path | None = None,
) -> GraphFigures:
    from recon4.orders.confined import workers_of_this_process
    from recon4.pose_graph.ordered_pairs import OrderedPairs
    from recon4.pose_graph.pair_files import SearchInputs
    from recon4.pose_graph.search import SearchMeans, build_graph
    from recon4.store.frame_folders import FrameFolders

    folders = FrameFolders.of(frames, odometry, calibration)
    inputs = SearchInputs(folders=folders, settings=context.settings)
    ordered = OrderedPairs.of(workers_of_this_process(), inputs)
    return build_graph(
        folders.open(),
        odometry,
        SearchMeans(context.out, ordered),
        settings=context.settings,
        progress=context.progress,
    )


def _refine(
    context: StageContext[RefineReads],
    *,
    frames: Path,
    odometry: Path,
    nodes: GraphNodes,
    calibration: Path | None = None,
) -> RefineFigures:
    from recon4.semi_rigid.carry import carry
    from recon4.semi_rigid.refine import refine
    from recon4.store.frames import open_frames

    carried = carry(nodes, settings=context.settings)
    if carried is not None:
        return carried.save(context.out)
    store = open_frames(frames, calibration, odometry)
    found = refine(
        store, odometry, nodes.nodes, settings=context.settings, progress=context.progress
    )
    return found.save(context.out)


ODOMETRY = Stage("odometry", 65, OdometryReads, _odometry, OdometryFigures, percent=14.0)
GRAPH = Stage("graph", 15, GraphReads, _graph, GraphFigures, percent=25.0)
REFINE = Stage("refine", 5, RefineReads, _refine, RefineFigures, percent=8.0)
LIDAR = Workflow(
    "lidar",
    imports=FRAMES,
    before_review=before_review,
    from_review=from_review,
    kept=(FRAMES, ODOMETRY, CALIBRATION, GRAPH, VERIFICATION),
    remade=(REVIEW, REFINE, LEVEL, *TO_MAP),
    audit=AUDIT,
    results=map_results,
)
