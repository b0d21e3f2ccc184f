"""The data flow of 2-D maps on one screen: from the scans of a 2-D laser to a project folder."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4 import stages, stages_2d
from recon4.errors import ConfigError
from recon4.progress import Progress
from recon4.recording.laser2d import is_laser2d
from recon4.recording.line_tables import is_line_table
from recon4.recording.sources import Sources
from recon4.results_2d import Summary2d, publish_2d
from recon4.review.decisions import Decided
from recon4.review.journal import read_decided
from recon4.run_summary import About
from recon4.settings import Settings
from recon4.store.hashing import size_of
from recon4.store.inputs import input_files
from recon4.store.project import Project, ProjectDescription, read_artifacts
from recon4.store.recipes import settings_to_repeat
from recon4.store.stage import Artifact, Input, Stage, StageRunner

BEFORE_REVIEW_2D: tuple[Stage[Any], ...] = (
    stages_2d.SCANS_2D,
    stages_2d.ODOMETRY_2D,
    stages_2d.GRAPH_2D,
    stages.VERIFICATION,
)
"""What decisions of people do not change."""


@dataclass(frozen=True, slots=True)
class Planar:
    """Artifacts that decisions of people do not change."""

    scans: Artifact
    odometry: Artifact
    graph: Artifact
    """Verified."""


def is_2d(sources: Sources) -> bool:
    """Whether recordings are of a 2-D laser alone.

    Raises:
        RecordingError: If it cannot be read.
    """
    if sources.rig is not None and sources.rig.row_of("profiler") is not None:
        return False  # only the rig file may know which topic is of the profiler
    first, *others = sources.recordings
    # The tables of a walk with a profiler may come in any order.
    return is_laser2d(first) and not any(map(is_line_table, others))


def process_2d(
    sources: Sources, out: Path, *, settings: Settings, preset: str, progress: Progress
) -> Summary2d:
    """Make a 2-D map of recordings, or continue where an earlier call stopped.

    Args:
        sources: A CARMEN log, bags or captures of one walk; without CSV files, and without a rig
            except one of a 2-D laser alone.
        out: Project folder; made when missing.
        settings: All settings.
        preset: Name of the preset they started from.
        progress: Who watches.

    Raises:
        ConfigError: If a rig or CSV files are given.
        RecordingError: If a recording cannot be read.
        StoreError: If ``out`` is in use, damaged or cannot be written.
        Recon4Error: Whatever else stops a stage.
        Cancelled: If the watcher requested to stop; the next call continues from there.
    """
    _check_sources(sources)
    with Project.open(out) as project:
        recordings = input_files(sources.recordings, project.ledger, progress)
        inputs = [
            {"name": path.name, "bytes": size_of(path), "sha256": recordings.key}
            for path in sources.recordings
        ]
        project.describe(preset=preset, rig="", inputs=inputs)
        runner = StageRunner(project, settings, progress)
        laser = stages_2d.laser_input(sources.rig)
        run_stages_2d(runner, recordings, laser=laser, decided=read_decided(out))
        about = About(ProjectDescription.read(out), settings)
        return publish_2d(out, runner.runs, about, progress=progress)


def remake_2d(out: Path, *, progress: Progress) -> Summary2d:
    """Make the 2-D map of a project again with the current decisions, without its recording.

    Args:
        out: A project that was processed to its end.
        progress: Who watches.

    Raises:
        StoreError: If a stage is missing or damaged, the project is in use or cannot be written.
        Recon4Error: Whatever else stops a stage.
        Cancelled: If the watcher requested to stop; the next call continues from there.
    """
    made = read_artifacts(out)
    settings = settings_to_repeat(made, BEFORE_REVIEW_2D)
    with Project.open(out) as project:
        runner = StageRunner(project, settings, progress)
        scans, odometry, _, graph = (runner.keep(stage) for stage in BEFORE_REVIEW_2D)
        run_from_review_2d(runner, Planar(scans, odometry, graph), read_decided(out))
        about = About(ProjectDescription.read(out), settings)
        return publish_2d(out, runner.runs, about, progress=progress)


def audit_2d(out: Path, *, progress: Progress) -> Summary2d:
    """Work out the findings of a finished 2-D map again, and write its results.

    Args:
        out: A project that was processed to its end.
        progress: Who watches.

    Raises:
        StoreError: If a stage is missing or damaged, the project is in use or cannot be written.
    """
    made = read_artifacts(out)
    kept = [
        stage
        for stage in (*BEFORE_REVIEW_2D, stages.REVIEW, stages_2d.MAP_2D)
        if stage.name in made
    ]
    settings = settings_to_repeat(made, kept)
    with Project.open(out) as project:
        runner = StageRunner(project, settings, progress)
        for stage in kept:
            runner.keep(stage)
        run_audit_2d(runner)
        about = About(ProjectDescription.read(out), settings)
        return publish_2d(out, runner.runs, about, progress=progress)


def run_audit_2d(runner: StageRunner) -> None:
    """The findings of a run, from the artifacts of all its stages."""
    runner.run(stages_2d.AUDIT_2D, **{name: run.artifact for name, run in runner.runs.items()})


def run_stages_2d(
    runner: StageRunner, recordings: Input, *, laser: Input | None, decided: Decided
) -> None:
    """Every stage in order; each is skipped when its artifact is there."""
    run = runner.run
    scans = run(stages_2d.SCANS_2D, recordings=recordings, laser=laser)
    odometry = run(stages_2d.ODOMETRY_2D, scans=scans)
    searched = run(stages_2d.GRAPH_2D, scans=scans, odometry=odometry)
    graph = run(stages.VERIFICATION, graph=searched)
    run_from_review_2d(runner, Planar(scans, odometry, graph), decided)


def run_from_review_2d(runner: StageRunner, made: Planar, decided: Decided) -> None:
    """The stages that depend on decisions of people, as `recon4.pipeline.run_from_review`."""
    graph = stages.reviewed(runner, made.graph, decided)
    runner.run(stages_2d.MAP_2D, scans=made.scans, odometry=made.odometry, graph=graph)
    run_audit_2d(runner)


def _check_sources(sources: Sources) -> None:
    rig = sources.rig
    if rig is not None and all(sensor.kind == "laser2d" for sensor in rig.sensors):
        rig = None  # it says how the laser is mounted, and its port in a live capture
    given = {"a rig": rig, "IMU samples": sources.imu, "GNSS samples": sources.gnss}
    unused = [name for name, value in given.items() if value is not None]
    if unused:
        raise ConfigError(
            f"{sources.recordings[0].name} is a recording of a 2-D laser: it is processed without "
            f"{' and '.join(unused)}"
        )
