"""The stages that several workflows share: what each reads, and its version.

Those of one kind of walk stand beside their order, in the module of its workflow.

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
    FrameFigures,
    LevelFigures,
    ReviewFigures,
    VerificationFigures,
)
from recon4.model.finding_kinds import AUDIT_VERSION
from recon4.model.import_notes import import_notes
from recon4.model.rig import Rig
from recon4.model.site_control import SiteControl
from recon4.review.decisions import Standing
from recon4.settings.reads import (
    AuditReads,
    CalibrationReads,
    ImportReads,
    LevelReads,
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


def _calibration(
    context: StageContext[CalibrationReads], *, frames: Path, odometry: Path
) -> CalibrationFigures:
    from recon4.calibration.stage import run_calibration
    from recon4.store.frames import open_frames

    store = open_frames(frames, None, odometry)
    return run_calibration(
        store, odometry, settings=context.settings, progress=context.progress
    ).save(context.out)


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


def _audit(context: StageContext[AuditReads], **artifacts: Path) -> AuditFigures:
    from recon4.findings.audit import check_walk, save_findings
    from recon4.findings.walk_record import read_walk

    return save_findings(context.out, check_walk(read_walk(artifacts, context.settings)))


FRAMES = Stage("frames", 58, ImportReads, _frames, FrameFigures, percent=9.0)
CALIBRATION = Stage(
    "calibration", 17, CalibrationReads, _calibration, CalibrationFigures, percent=3.0
)
VERIFICATION = Stage(
    "verification", 4, VerificationReads, _verification, VerificationFigures, percent=2.0
)
REVIEW = Stage("review", 6, VerificationReads, _review, ReviewFigures)
LEVEL = Stage("level", 41, LevelReads, _level, LevelFigures, percent=1.0)
AUDIT = Stage("audit", AUDIT_VERSION, AuditReads, _audit, AuditFigures, percent=1.0)
