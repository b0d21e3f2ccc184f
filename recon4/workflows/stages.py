"""The stages of LiDARs, and those that all workflows share: what each reads, and its version.

A version goes up whenever the same inputs give another result than before.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from shutil import rmtree

import msgspec

from recon4.errors import UnknownFormat
from recon4.model.calibration_figures import CalibrationFigures
from recon4.model.figures import (
    AuditFigures,
    ClassFigures,
    Figures,
    FrameFigures,
    GraphFigures,
    LevelFigures,
    MapFigures,
    RefineFigures,
    ReviewFigures,
    VerificationFigures,
)
from recon4.model.finding_kinds import AUDIT_VERSION
from recon4.model.import_notes import import_notes
from recon4.model.odometry_figures import OdometryFigures
from recon4.model.rig import Rig
from recon4.model.site_control import SiteControl
from recon4.review.decisions import Standing, StandingCorrection
from recon4.semi_rigid.graph_nodes import GraphNodes
from recon4.settings.reads import (
    AuditReads,
    CalibrationReads,
    GraphReads,
    ImportReads,
    IntensityReads,
    LevelReads,
    MapReads,
    OdometryReads,
    ReadsNothing,
    RefineReads,
    VerificationReads,
)
from recon4.store.stage import Stage, StageContext


def _frames(
    context: StageContext[ImportReads],
    *,
    recordings: tuple[Path, ...],
    rig: Rig | None,
    imu: Path | None,
    gnss: Path | None,
) -> FrameFigures:
    from recon4.recording.ingest import ingest
    from recon4.recording.sources import Sources
    from recon4.registration.clock_jumps import clock_jumps
    from recon4.registration.placed_clouds import placed_text, view_moves_on
    from recon4.sandbox.freed_memory import return_freed_memory
    from recon4.sandbox.tuning import CONFINEMENT
    from recon4.store.frames import FrameStore

    return_freed_memory(above=CONFINEMENT.returned_packet_bytes)
    sources = Sources(recordings, rig, imu, gnss)
    ingest(sources, context.out, settings=context.settings.ingest, progress=context.progress)
    store = FrameStore.open(context.out)
    as_measured = context.settings.ingest.as_measured
    if moves_m := 0.0 if as_measured else view_moves_on(store):
        raise UnknownFormat(placed_text(recordings[0].name, moves_m))
    jumps = clock_jumps(store, store.index["t_ns"])
    if jumps:  # read once more, because a revolution may go on across a jump
        sources = replace(sources, jumps=tuple(jumps))
        rmtree(context.out)
        ingest(sources, context.out, settings=context.settings.ingest, progress=context.progress)
    return frames_figures(context.out)


def frames_figures(folder: Path) -> FrameFigures:
    """Figures of the stage ``frames``; a live capture has made its artifact by itself."""
    from recon4.store.frames import FrameStore

    store = FrameStore.open(folder)
    notes = import_notes(store.report)
    return FrameFigures(
        multiframes=len(store),
        points=store.points,
        rig=store.rig.name,
        imu=store.imu is not None,
        gnss=store.gnss is not None,
        outcome=notes.outcome,
    )


def _odometry(
    context: StageContext[OdometryReads],
    *,
    frames: Path,
    calibration: Path | None = None,
    earlier: Path | None = None,
) -> OdometryFigures:
    from recon4.georeference.gnss_aiding import make_gnss_aiding
    from recon4.registration.stage import earlier_walks, run_odometry
    from recon4.registration.walk import WalkInputs
    from recon4.store.frames import open_frames

    store = open_frames(frames, calibration)
    aiding = make_gnss_aiding(store.gnss, store.rig, context.settings.odometry, imu=store.imu)
    recording = WalkInputs(
        store,
        context.settings,
        context.progress,
        aiding,
        earlier_walks(earlier) if earlier else None,
    )
    return run_odometry(recording, context.out)


def _calibration(
    context: StageContext[CalibrationReads], *, frames: Path, odometry: Path
) -> CalibrationFigures:
    from recon4.calibration.stage import run_calibration
    from recon4.store.frames import open_frames

    store = open_frames(frames, None, odometry)
    return run_calibration(
        store, odometry, settings=context.settings, progress=context.progress
    ).save(context.out)


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


def _verification(context: StageContext[VerificationReads], *, graph: Path) -> VerificationFigures:
    from recon4.pose_graph.files import load_graph, save_graph
    from recon4.pose_graph.verification import verify
    from recon4.store.atomic import write_json

    # V Table 3.2: these modes stop before verification.
    if context.settings.graph.mode in ("10", "overlap"):
        save_graph(context.out, load_graph(graph))
        return VerificationFigures()
    found = verify(
        load_graph(graph), settings=context.settings.verification, progress=context.progress
    )
    save_graph(context.out, found.graph)
    record = found.to_json()
    write_json(context.out / "verification.json", record)
    return VerificationFigures(
        edges=found.graph.verdict_counts(),
        chi2_before=found.chi2_before,
        chi2_after=found.chi2_after,
    )


def _review(
    context: StageContext[VerificationReads], *, graph: Path, decisions: tuple[Standing, ...]
) -> ReviewFigures:
    from recon4.review.solve import run_review

    return run_review(
        graph, decisions, context.out, settings=context.settings, progress=context.progress
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


def _level(
    context: StageContext[LevelReads],
    *,
    frames: Path,
    refined: Path,
    graph: Path,
    calibration: Path | None = None,
    **others: Path | SiteControl | None,
) -> LevelFigures:
    from recon4.georeference.hold import hold, moved_by_decisions
    from recon4.georeference.stage import RefinedWalk, level_and_georeference
    from recon4.pose_graph.files import load_graph
    from recon4.pose_graph.known_errors import load_known_errors
    from recon4.store.arrays import load_trajectory
    from recon4.store.frames import open_frames

    control, undecided = (others.pop(name, None) for name in ("control", "undecided"))
    doubts = {name: one for name, one in others.items() if not isinstance(one, SiteControl)}
    odometry = doubts.get("odometry")
    leveled = level_and_georeference(
        open_frames(frames, calibration, odometry, with_moving=True),
        RefinedWalk(
            trajectory=load_trajectory(refined / "trajectory.npz"),
            graph=load_graph(graph),
            known=load_known_errors(**doubts),
            control=control if isinstance(control, SiteControl) else None,
        ),
        settings=context.settings,
        progress=context.progress,
    )
    if not isinstance(undecided, Path):
        return leveled.save(context.out)
    moved = moved_by_decisions(leveled, undecided)
    held = hold(leveled, undecided, context.out, moved=moved)
    if held is not None:
        return held
    return msgspec.structs.replace(leveled.save(context.out), moved=moved)


def _intensity(
    context: StageContext[IntensityReads],
    *,
    frames: Path,
    odometry: Path,
    level: Path,
    calibration: Path | None = None,
) -> None:
    from recon4.intensity.normalize import write_intensity
    from recon4.intensity.tuning import IntensityTuning
    from recon4.settings.tuning import tuned
    from recon4.store.arrays import load_trajectory
    from recon4.store.frames import open_frames

    write_intensity(
        open_frames(frames, calibration, odometry),
        load_trajectory(level / "trajectory.npz"),
        context.out,
        settings=tuned(IntensityTuning, context.settings.intensity),
        progress=context.progress,
    )


def _classes(
    context: StageContext[ReadsNothing],
    *,
    frames: Path,
    odometry: Path,
    level: Path,
    calibration: Path | None = None,
) -> ClassFigures:
    from recon4.classes.class_parts import ClassedWalk, OrderedClasses
    from recon4.classes.stage import classify, write_classes
    from recon4.mapping.mirrors import load_mirrors
    from recon4.orders.confined import workers_of_this_process
    from recon4.store.arrays import load_trajectory
    from recon4.store.frame_folders import FrameFolders

    folders = FrameFolders.of(frames, odometry, calibration)
    walk = ClassedWalk(folders=folders, level=str(level.absolute()))
    found = classify(
        folders.open(),
        load_trajectory(level / "trajectory.npz"),
        mirrors=load_mirrors(level / "mirrors.npz"),
        progress=context.progress,
        ordered=OrderedClasses.of(workers_of_this_process(), walk),
    )
    return write_classes(found, context.out)


def _map(
    context: StageContext[MapReads],
    *,
    frames: Path,
    odometry: Path,
    level: Path,
    intensity: Path,
    classes: Path,
    calibration: Path | None = None,
    corrections: tuple[StandingCorrection, ...] = (),
) -> MapFigures:
    from recon4.mapping.build import MapInputs, MapMeans, build_map
    from recon4.orders.confined import workers_of_this_process
    from recon4.sandbox.freed_memory import return_freed_memory
    from recon4.store.arrays import load_intensity_table, load_trajectory
    from recon4.store.classes import StoredClasses
    from recon4.store.frames import open_frames
    from recon4.workflows.corrected_classes import corrections_in
    from recon4.workflows.map_figures import map_figures, write_map_laz
    from recon4.workflows.result_files import covariances_of

    store = open_frames(frames, calibration, odometry)
    covariances_at = covariances_of(level)
    trajectory = load_trajectory(level / "trajectory.npz")
    placed = corrections_in(corrections, trajectory)
    inputs = MapInputs(
        store,
        trajectory,
        load_intensity_table(intensity / "table.npz"),
        covariances=covariances_at and covariances_at(store.t_mid_ns),
        classes=StoredClasses.open(classes),
        corrections=placed.volumes,
    )
    tiles = build_map(
        inputs,
        context.out,
        settings=context.settings.map,
        progress=context.progress,
        means=MapMeans(workers_of_this_process()),
    )
    return_freed_memory()
    write_map_laz(context.out, level, progress=context.progress)
    return map_figures(tiles, placed)


def _audit(context: StageContext[AuditReads], **artifacts: Path) -> AuditFigures:
    from recon4.findings.audit import check_walk, save_findings
    from recon4.findings.walk import read_walk

    return save_findings(context.out, check_walk(read_walk(artifacts, context.settings)))


FRAMES = Stage("frames", 39, ImportReads, _frames, FrameFigures)
ODOMETRY = Stage(
    "odometry",
    51,
    OdometryReads,
    _odometry,
    OdometryFigures,
)
CALIBRATION = Stage(
    "calibration",
    15,
    CalibrationReads,
    _calibration,
    CalibrationFigures,
)
GRAPH = Stage("graph", 11, GraphReads, _graph, GraphFigures)
VERIFICATION = Stage("verification", 3, VerificationReads, _verification, VerificationFigures)
REVIEW = Stage("review", 5, VerificationReads, _review, ReviewFigures)
REFINE = Stage("refine", 4, RefineReads, _refine, RefineFigures)
LEVEL = Stage("level", 35, LevelReads, _level, LevelFigures)
AUDIT = Stage("audit", AUDIT_VERSION, AuditReads, _audit, AuditFigures)
INTENSITY: Stage[IntensityReads, Figures] = Stage("intensity", 2, IntensityReads, _intensity)
CLASSES = Stage("classes", 4, ReadsNothing, _classes, ClassFigures)
MAP = Stage("map", 17, MapReads, _map, MapFigures)
