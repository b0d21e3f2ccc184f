"""The data flow on one screen: from recordings to a finished project folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4 import stages, stages_2d
from recon4.errors import ConfigError, RecordingError, StoreError
from recon4.model.calibration_figures import CalibrationFigures
from recon4.model.rig import Rig, format_rig, load_rig
from recon4.pipeline_2d import audit_2d, is_2d, process_2d, remake_2d
from recon4.progress import Progress, Silent
from recon4.recording.kinds import located_sources
from recon4.recording.sources import Sources
from recon4.results import Summary, publish
from recon4.results_2d import Summary2d
from recon4.review.decisions import NOTHING_DECIDED, Decided
from recon4.review.journal import read_decided
from recon4.run_summary import About
from recon4.settings import Settings
from recon4.settings import preset as settings_of
from recon4.store.frames import CALIBRATED_RIG
from recon4.store.hashing import hash_json, size_of
from recon4.store.inputs import input_file, input_files
from recon4.store.project import (
    Project,
    ProjectDescription,
    discard_unbegun,
    is_project,
    read_artifacts,
)
from recon4.store.recipes import settings_to_repeat
from recon4.store.stage import Artifact, Input, Stage, StageRunner, figures_of

BEFORE_REVIEW: tuple[Stage[Any], ...] = (
    stages.FRAMES,
    stages.ODOMETRY,
    stages.GRAPH,
    stages.VERIFICATION,
)
"""What decisions of people do not change."""


@dataclass(frozen=True, slots=True)
class Measurements:
    """The multiframes, and the rig they are placed with."""

    frames: Artifact
    calibration: Artifact | None
    """None = the rig of the recording is used."""
    audit: Artifact | None = None
    """What contradicts the rig that is used; None = it was not compared, or is calibrated."""

    @property
    def inputs(self) -> dict[str, Artifact]:
        """Inputs of a stage that places points; a calibration only where one is used."""
        found = {"frames": self.frames}
        return found | ({"calibration": self.calibration} if self.calibration else {})


def process(
    sources: Sources,
    out: Path,
    *,
    settings: Settings | None = None,
    preset: str = "indoor",
    progress: Progress | None = None,
) -> Summary | Summary2d:
    """Make a map of recordings, or continue where an earlier call stopped.

    Recordings of a 2-D laser alone become a 2-D map (`recon4.pipeline_2d`).

    Args:
        sources: The recordings of one walk, its rig, and CSV files in place of their samples.
        out: Project folder; made when missing. Results end up in it (see ``docs/stages.md``).
        settings: All settings; None = those of the preset.
        preset: Name of the preset they started from.
        progress: Who watches.

    Returns:
        Figures, timings and hashes, as in ``summary.json``.

    Raises:
        RecordingError: If a recording cannot be read.
        StoreError: If ``out`` is in use, damaged or cannot be written (`NoSpace`: disk full).
        Recon4Error: Whatever else stops a stage.
        Cancelled: If the watcher requested to stop; the next call continues from there.

    A new project that the recording or the rig keeps from its first stage is removed again.
    """
    sources = located_sources(sources)
    progress = progress or Silent()
    settings = settings or settings_of(preset)
    is_new = not is_project(out)
    run = process_2d if is_2d(sources) else _process
    try:
        return run(sources, out, settings=settings, preset=preset, progress=progress)
    except (RecordingError, ConfigError):
        if is_new:
            discard_unbegun(out)
        raise


def _process(
    sources: Sources, out: Path, *, settings: Settings, preset: str, progress: Progress
) -> Summary:
    paths, rig = sources.paths, sources.rig
    with Project.open(out) as project:
        keys = {path: input_file(path, project.ledger, progress).key for path in paths}
        project.describe(
            preset=preset,
            rig=rig.name if rig else "",
            inputs=[{"name": p.name, "bytes": size_of(p), "sha256": keys[p]} for p in paths],
        )
        runner = StageRunner(project, settings, progress)
        inputs = _inputs(project, sources, progress)
        run_stages(runner, inputs, decided=read_decided(out))
        about = About(ProjectDescription.read(out), settings)
        return publish(out, runner.runs, about, progress=progress)


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
    sources = located_sources(sources)
    with Project.open(out) as project:
        runner = StageRunner(project, settings, progress)
        inputs = _inputs(project, sources, progress)
        frames = runner.run(stages.FRAMES, **inputs)
        odometry = runner.run(stages.ODOMETRY, frames=frames)
        calibration = runner.run(stages.CALIBRATION, frames=frames, odometry=odometry)
        figures = figures_of(runner.runs, stages.CALIBRATION)
        return figures, load_rig(calibration.folder / CALIBRATED_RIG) if figures.applied else None


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
    sources = located_sources(sources)
    with Project.open(out) as project:
        runner = StageRunner(project, settings, progress)
        frames = runner.run(stages.FRAMES, **_inputs(project, sources, progress))
        runner.run(stages.LINE_ODOMETRY, frames=frames)


def _inputs(project: Project, sources: Sources, progress: Progress) -> dict[str, Input | None]:
    """Inputs of the stage `frames`."""
    rig, imu, gnss = sources.rig, sources.imu, sources.gnss
    ledger = project.ledger
    return {
        "recordings": input_files(sources.recordings, ledger, progress),
        "rig": Input(hash_json(format_rig(rig)), rig) if rig else None,
        "imu": Input(input_file(imu, ledger, progress).key, imu) if imu else None,
        "gnss": Input(input_file(gnss, ledger, progress).key, gnss) if gnss else None,
    }


def remake(out: Path, *, progress: Progress | None = None) -> Summary | Summary2d:
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
    made = read_artifacts(out)
    if stages_2d.MAP_2D.name in made:
        return remake_2d(out, progress=progress)
    if "map" not in made:
        raise StoreError(f"{out.name} has no map yet: process its recording to the end first")
    settings = settings_to_repeat(made, BEFORE_REVIEW)
    with Project.open(out) as project:
        runner = StageRunner(project, settings, progress)
        frames, odometry, _, graph = (runner.keep(stage) for stage in BEFORE_REVIEW)
        calibration = runner.keep(stages.CALIBRATION) if stages.CALIBRATION.name in made else None
        measurements = _measured(runner, frames, calibration)
        run_from_review(
            runner, measurements, odometry=odometry, graph=graph, decided=read_decided(out)
        )
        about = About(ProjectDescription.read(out), settings)
        return publish(out, runner.runs, about, progress=progress)


def audit(out: Path, *, progress: Progress | None = None) -> Summary | Summary2d:
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
    made = read_artifacts(out)
    if stages_2d.MAP_2D.name in made:
        return audit_2d(out, progress=progress)
    if "map" not in made:
        raise StoreError(f"{out.name} has no map yet: process its recording to the end first")
    kept = [stage for stage in stages.OF_A_MAP if stage.name in made]
    settings = settings_to_repeat(made, kept)
    with Project.open(out) as project:
        runner = StageRunner(project, settings, progress)
        for stage in kept:
            runner.keep(stage)
        run_audit(runner)
        return publish(
            out, runner.runs, About(ProjectDescription.read(out), settings), progress=progress
        )


def run_stages(
    runner: StageRunner,
    inputs: Mapping[str, Input | None],
    *,
    decided: Decided = NOTHING_DECIDED,
) -> None:
    """Every stage in order; each is skipped when its artifact is there."""
    measurements, odometry, graph = run_before_review(runner, inputs)
    run_from_review(runner, measurements, odometry=odometry, graph=graph, decided=decided)


def run_before_review(
    runner: StageRunner, inputs: Mapping[str, Input | None]
) -> tuple[Measurements, Artifact, Artifact]:
    """The stages that decisions of people do not change: odometry and verified graph.

    If the rig is calibrated, the odometry runs again with the calibrated rig.

    Args:
        runner: Runs them.
        inputs: ``recordings``, ``rig``, ``imu`` and ``gnss``; None = there is none.
    """
    run = runner.run
    frames = run(stages.FRAMES, **inputs)
    if stages.has_profiler(frames.folder):
        return _lines_before_review(runner, frames)
    odometry = run(stages.ODOMETRY, frames=frames)
    calibration = run(stages.CALIBRATION, frames=frames, odometry=odometry)
    measurements = _measured(runner, frames, calibration)
    if measurements.calibration:
        odometry = run(stages.ODOMETRY, **measurements.inputs)
    searched = run(stages.GRAPH, **measurements.inputs, odometry=odometry)
    return measurements, odometry, run(stages.VERIFICATION, graph=searched)


def _lines_before_review(
    runner: StageRunner, frames: Artifact
) -> tuple[Measurements, Artifact, Artifact]:
    """The same of a rig with a profiler: 2-D SLAM with the IMU, then the turns of the head."""
    runner.skip(stages.CALIBRATION)
    odometry = runner.run(stages.LINE_ODOMETRY, frames=frames)
    searched = runner.run(stages.TURN_GRAPH, frames=frames, odometry=odometry)
    verified = runner.run(stages.VERIFICATION, graph=searched)
    return Measurements(frames, None), odometry, verified


def _measured(runner: StageRunner, frames: Artifact, calibration: Artifact | None) -> Measurements:
    """The calibrated rig from here on if there is one, else what its audit found."""
    if calibration is None:
        return Measurements(frames, None)
    if figures_of(runner.runs, stages.CALIBRATION).applied:
        return Measurements(frames, calibration)
    return Measurements(frames, None, audit=calibration)


def run_from_review(
    runner: StageRunner,
    measurements: Measurements,
    *,
    odometry: Artifact,
    graph: Artifact,
    decided: Decided,
) -> None:
    """The stages that depend on decisions of people."""
    run = runner.run
    graph = stages.reviewed(runner, graph, decided)
    level = run_trajectory(runner, measurements, odometry=odometry, graph=graph)
    points = measurements.inputs | {"odometry": odometry, "level": level}
    run(stages.MAP, **points, intensity=run(stages.INTENSITY, **points))
    run_audit(runner)


def run_audit(runner: StageRunner) -> None:
    """The findings of a run, from the artifacts of all stages that have something to say."""
    artifacts = {name: run.artifact for name, run in runner.runs.items() if name in stages.AUDITED}
    runner.run(stages.AUDIT, **artifacts)


def run_trajectory(
    runner: StageRunner, measurements: Measurements, *, odometry: Artifact, graph: Artifact
) -> Artifact:
    """From the graph to the final trajectory: refined, leveled, georeferenced."""
    lines = stages.has_profiler(measurements.frames.folder)
    refine = stages.LINE_REFINE if lines else stages.REFINE
    refined = runner.run(refine, **measurements.inputs, odometry=odometry, graph=graph)
    inputs = measurements.inputs | {"refined": refined, "graph": graph, "odometry": odometry}
    return runner.run(stages.LEVEL, **inputs, audit=measurements.audit)
