"""The data flow on one screen: from recordings to a finished project folder.

What happens between import and results is the *workflow* of the walk: `recon4.workflows.lidar`,
`recon4.workflows.profiler` or `recon4.workflows.planar`. Read these three next.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from recon4.errors import ConfigError, RecordingError, StoreError
from recon4.locales.coded import CodedText
from recon4.model.calibration_figures import CalibrationFigures
from recon4.model.events import Warned
from recon4.model.rig import Rig, load_rig
from recon4.progress import Progress, Silent
from recon4.recording.kinds import located_sources
from recon4.recording.sources import Sources
from recon4.review.journal import read_decided
from recon4.sandbox.freed_memory import return_freed_memory
from recon4.settings import Settings
from recon4.settings import preset as settings_of
from recon4.store.frames import CALIBRATED_RIG
from recon4.store.hashing import size_of
from recon4.store.inputs import input_file
from recon4.store.project import (
    Project,
    ProjectDescription,
    discard_unbegun,
    is_project,
    read_artifacts,
)
from recon4.store.stage import Stage, StageRunner
from recon4.store.stage_settings import retired_settings, settings_to_repeat
from recon4.workflows.choice import (
    check_planar,
    has_map,
    import_inputs,
    is_planar,
    of_frames,
    of_project,
)
from recon4.workflows.lidar import ODOMETRY
from recon4.workflows.planar import PLANAR
from recon4.workflows.profiler import LINE_ODOMETRY
from recon4.workflows.publish import publish
from recon4.workflows.stages import CALIBRATION, FRAMES
from recon4.workflows.summary import About, RunSummary
from recon4.workflows.workflow import Run, Workflow


def process(
    sources: Sources,
    out: Path,
    *,
    settings: Settings | None = None,
    preset: str = "indoor",
    progress: Progress | None = None,
) -> RunSummary:
    """Make a map of recordings, or continue where an earlier call stopped.

    Args:
        sources: The recordings of one walk, its rig, and CSV files in place of their samples.
        out: Project folder; made when missing. See ``docs/explanation/stages.md``.
        settings: All settings; None = those of the preset.
        preset: Name of the preset they started from.
        progress: Who watches.

    Returns:
        Figures, timings and hashes, as in ``summary.json``.

    Raises:
        RecordingError: If a recording cannot be read.
        ConfigError: If rig or CSV files are given with a recording of a 2-D laser alone.
        StoreError: If ``out`` is in use, damaged or cannot be written (`NoSpace`: disk full).
        Recon4Error: Whatever else stops a stage.
        Cancelled: If the watcher requested to stop; the next call continues from there.

    A new project that the recording or the rig keeps from its first stage is removed again.
    """
    sources = located_sources(sources)
    progress, settings = progress or Silent(), settings or settings_of(preset)
    is_new = not is_project(out)
    try:
        return _process(sources, out, settings=settings, preset=preset, progress=progress)
    except (RecordingError, ConfigError):
        if is_new:
            discard_unbegun(out)
        raise


def _process(
    sources: Sources, out: Path, *, settings: Settings, preset: str, progress: Progress
) -> RunSummary:
    planar = is_planar(sources)
    if planar:
        check_planar(sources)
    with Project.open(out) as project:
        _describe(project, sources, preset=preset, progress=progress)
        run = Run(StageRunner(project, settings, progress), read_decided(out))
        inputs = import_inputs(sources, project.ledger, progress, planar=planar)
        run.stage(PLANAR.imports if planar else FRAMES, **inputs)
        frames = run.runner.runs[FRAMES.name].artifact.folder if not planar else None
        workflow = PLANAR if frames is None else of_frames(frames)
        workflow.run(run)
        return _publish(out, workflow, run, settings=settings, progress=progress)


def remake(out: Path, *, progress: Progress | None = None) -> RunSummary:
    """Make the map of a project again with the current decisions.

    The stages before them are kept as they are, so no recording is needed; the others run with the
    settings the map was made with.

    Args:
        out: A project that was processed to its end.
        progress: Who watches.

    Raises:
        StoreError: If a stage is missing or damaged, the project is in use or cannot be written.
        Recon4Error: Whatever else stops a stage.
        Cancelled: If the watcher requested to stop; the next call continues from there.
    """
    progress = progress or Silent()
    workflow = _finished(out)
    with _continued(out, workflow, kept=workflow.kept, progress=progress) as (run, settings):
        workflow.run_from_review(run)
        return _publish(out, workflow, run, settings=settings, progress=progress)


def audit(out: Path, *, progress: Progress | None = None) -> RunSummary:
    """Work out the findings of a finished project again, and write its results.

    No other stage runs. New witnesses and new wordings reach a map this way that was made before.

    Args:
        out: A project that was processed to its end.
        progress: Who watches.

    Raises:
        StoreError: If a stage is missing or damaged, the project is in use or cannot be written.
        Recon4Error: Whatever else stops a stage.
    """
    progress = progress or Silent()
    workflow = _finished(out)
    kept = (*workflow.kept, *workflow.remade)
    with _continued(out, workflow, kept=kept, progress=progress) as (run, settings):
        workflow.run_audit(run)
        return _publish(out, workflow, run, settings=settings, progress=progress)


def calibrate_recording(
    sources: Sources, out: Path, *, settings: Settings, progress: Progress
) -> tuple[CalibrationFigures, Rig | None]:
    """Run the stages up to the calibration, without a map.

    Args:
        sources: The recording and its rig.
        out: Project folder; made when missing.
        settings: All settings; `calibration` says what is done.
        progress: Who watches.

    Returns:
        What was found, and the calibrated rig if it may be used.

    Raises:
        Recon4Error: Whatever stops a stage.
    """
    with _imported(sources, out, settings=settings, progress=progress) as run:
        run.stage(ODOMETRY, frames="frames")
        run.stage(CALIBRATION, frames="frames", odometry="odometry")
        done = run.runner.runs[CALIBRATION.name]
        rig = done.artifact.folder / CALIBRATED_RIG
        return done.figures, load_rig(rig) if done.figures.applied else None


def track_lines(sources: Sources, out: Path, *, settings: Settings, progress: Progress) -> None:
    """Run the stages up to the first trajectory of a rig with a profiler.

    Args:
        sources: The recording and its rig.
        out: Project folder; made when missing.
        settings: All settings.
        progress: Who watches.

    Raises:
        Recon4Error: Whatever stops a stage.
    """
    with _imported(sources, out, settings=settings, progress=progress) as run:
        run.stage(LINE_ODOMETRY, frames="frames")


@contextmanager
def _imported(
    sources: Sources, out: Path, *, settings: Settings, progress: Progress
) -> Iterator[Run]:
    """A run with the recording imported as multiframes."""
    sources = located_sources(sources)
    with Project.open(out) as project:
        run = Run(StageRunner(project, settings, progress))
        run.stage(FRAMES, **import_inputs(sources, project.ledger, progress, planar=False))
        yield run


def _describe(project: Project, sources: Sources, *, preset: str, progress: Progress) -> None:
    paths, rig = sources.paths, sources.rig
    keys = {path: input_file(path, project.ledger, progress).key for path in paths}
    project.describe(
        preset=preset,
        rig=rig.name if rig else "",
        inputs=[{"name": p.name, "bytes": size_of(p), "sha256": keys[p]} for p in paths],
    )


def _finished(out: Path) -> Workflow:
    made = read_artifacts(out)
    if not has_map(made):
        raise StoreError(CodedText("map-not-yet", out=out.name))
    return of_project(made)


@contextmanager
def _continued(
    out: Path, workflow: Workflow, *, kept: tuple[Stage[Any, Any], ...], progress: Progress
) -> Iterator[tuple[Run, Settings]]:
    """A run that begins with the artifacts of some stages, and the settings to go on with."""
    made = read_artifacts(out)
    there = [stage for stage in kept if stage.name in made]
    required = {stage.name for stage in workflow.kept} - {CALIBRATION.name}
    settings = settings_to_repeat(made, there)
    for text in retired_settings(made.values()):
        progress.event(Warned(text=text))
    with Project.open(out) as project:
        run = Run(StageRunner(project, settings, progress), read_decided(out))
        for stage in kept:
            if stage.name in made or stage.name in required:
                run.runner.keep(stage)
        yield run, settings


def _publish(
    out: Path, workflow: Workflow, run: Run, *, settings: Settings, progress: Progress
) -> RunSummary:
    about = About(ProjectDescription.read(out), settings)
    return_freed_memory()
    return publish(out, workflow.results(), run.runner.runs, about=about, progress=progress)
