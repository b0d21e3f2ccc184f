"""The data flow of 2-D maps on one screen: from the scans of a 2-D laser to a project folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from recon4 import stages, stages_2d
from recon4.errors import ConfigError
from recon4.progress import Progress
from recon4.recording.laser2d import is_laser2d
from recon4.recording.sources import Sources
from recon4.results import About
from recon4.results_2d import Summary2d, publish_2d
from recon4.settings import Settings
from recon4.store.hashing import size_of
from recon4.store.inputs import input_files
from recon4.store.project import Project, read_description
from recon4.store.stage import Input, StageRunner


def is_2d(recordings: Sequence[Path]) -> bool:
    """Whether recordings are of a 2-D laser alone; the first one decides.

    Raises:
        RecordingError: If it cannot be read.
    """
    return is_laser2d(recordings[0])


def process_2d(
    sources: Sources, out: Path, *, settings: Settings, preset: str, progress: Progress
) -> Summary2d:
    """Make a 2-D map of recordings, or continue where an earlier call stopped.

    Args:
        sources: A CARMEN log, or bags of one walk; without a rig and without CSV files.
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
        run_stages_2d(runner, recordings)
        about = About(read_description(out), settings)
        return publish_2d(out, runner.runs, about, progress=progress)


def run_stages_2d(runner: StageRunner, recordings: Input) -> None:
    """Every stage in order; each is skipped when its artifact is there."""
    run = runner.run
    scans = run(stages_2d.SCANS_2D, recordings=recordings)
    odometry = run(stages_2d.ODOMETRY_2D, scans=scans)
    searched = run(stages_2d.GRAPH_2D, scans=scans, odometry=odometry)
    graph = run(stages.VERIFICATION, graph=searched)
    run(stages_2d.MAP_2D, scans=scans, odometry=odometry, graph=graph)


def _check_sources(sources: Sources) -> None:
    given = {"a rig": sources.rig, "IMU samples": sources.imu, "GNSS samples": sources.gnss}
    unused = [name for name, value in given.items() if value is not None]
    if unused:
        raise ConfigError(
            f"{sources.recordings[0].name} is a recording of a 2-D laser: it is processed without "
            f"{' and '.join(unused)}"
        )
