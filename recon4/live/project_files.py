"""The project of a capture: created at the start, with its first stage done at the end."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

from recon4.errors import StoreError
from recon4.live.recorder.ports import check_sources
from recon4.live.session import CaptureSession
from recon4.locales.coded import CodedText
from recon4.model.figures import FrameFigures
from recon4.model.rig import Rig, format_rig, load_rig
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.settings.reads import ImportReads
from recon4.store.atomic import make_folders, write_text
from recon4.store.hashing import hash_json, size_of
from recon4.store.inputs import input_file, input_files
from recon4.store.project import Project, is_project
from recon4.store.stage import Input, StageContext, StageRunner, figures_of
from recon4.workflows import stages
from recon4.workflows.planar import SCANS_2D, laser_input


def begin(project: Path, rig: Rig, **how: Any) -> CaptureSession:
    """Create the project of a capture that is about to start.

    Args:
        project: Folder that does not exist yet, or is empty.
        rig: The sensors of the backpack.
        how: Fields of `CaptureSession`.

    Raises:
        ConfigError: If the packets of two LiDARs of the rig cannot be distinguished.
        StoreError: If the folder is a project or something else, or cannot be written.
    """
    check_sources(rig)
    session = CaptureSession(project=project, **how)
    try:
        taken = is_project(project) and not _never_ran(session)
    except OSError as error:
        raise StoreError(
            CodedText("project-unusable", folder=str(project), why=str(error.strerror))
        ) from error
    if taken:
        raise StoreError(CodedText("project-exists-already", project=project.name))
    with Project.open(project) as opened:
        opened.describe(preset=session.preset, rig=rig.name)
        make_folders(session.capture.parent)
        write_text(session.rig, format_rig(rig))
        session.save()
    return session


def discard(session: CaptureSession) -> None:
    """Remove the project of a recorder that could not start; nothing was recorded."""
    if _never_ran(session):
        shutil.rmtree(session.project, ignore_errors=True)


def _never_ran(session: CaptureSession) -> bool:
    """Whether the project holds only what `begin` wrote."""
    left = (session.capture, session.outcome, *(session.project / "artifacts").glob("*"))
    return (session.folder / "session.json").exists() and not any(path.exists() for path in left)


def finish(session: CaptureSession, frames: Path, settings: Settings) -> int:
    """Store the frames made during the capture as the project's stage ``frames``.

    `recon4.pipeline.process` reuses them: reading the capture again gives the same frames.

    Args:
        session: Of a capture that has ended.
        frames: Folder of a frame store; its files are moved.
        settings: Settings the frames were made with.

    Returns:
        Number of multiframes.

    Raises:
        StoreError: If the project is in use or cannot be written.
    """

    def moved(context: StageContext[ImportReads], **_: object) -> FrameFigures:
        for path in frames.iterdir():
            shutil.move(path, context.out / path.name)
        return stages.frames_figures(context.out)

    progress = Silent()
    with Project.open(session.project) as project:
        rig = load_rig(session.rig)
        key = input_file(session.capture, project.ledger, progress).key
        about = {"name": session.capture.name, "bytes": size_of(session.capture), "sha256": key}
        project.describe(preset=session.preset, rig=rig.name, inputs=[about])
        runner = StageRunner(project, settings, progress)
        runner.run(
            replace(stages.FRAMES, function=moved),
            recordings=input_files([session.capture], project.ledger, progress),
            rig=Input(hash_json(format_rig(rig)), rig),
            imu=None,
            gnss=None,
        )
        shutil.rmtree(frames, ignore_errors=True)
        return figures_of(runner.runs, stages.FRAMES).multiframes


def finish_scans(session: CaptureSession, settings: Settings) -> int:
    """Store the scans of a 2-D laser alone as the project's stage ``scans_2d``.

    Args:
        session: Of a capture that has ended.
        settings: Settings of the project.

    Returns:
        Number of scans.

    Raises:
        RecordingError: If the capture has no scan.
        StoreError: If the project is in use or cannot be written.
    """
    progress = Silent()
    with Project.open(session.project) as project:
        recordings = input_files([session.capture], project.ledger, progress)
        about = {
            "name": session.capture.name,
            "bytes": size_of(session.capture),
            "sha256": recordings.key,
        }
        project.describe(preset=session.preset, rig="", inputs=[about])
        runner = StageRunner(project, settings, progress)
        laser = laser_input(load_rig(session.rig))
        runner.run(SCANS_2D, recordings=recordings, laser=laser)
        return figures_of(runner.runs, SCANS_2D).scans
