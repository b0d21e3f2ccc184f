"""A capture is a project from its first moment; when the walk ends its first stage is done."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

from recon4 import stages
from recon4.errors import StoreError
from recon4.live.session import Session
from recon4.model.rig import Rig, format_rig, load_rig
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.store.atomic import write_text
from recon4.store.hashing import hash_json, size_of
from recon4.store.inputs import input_file, input_files
from recon4.store.project import Project
from recon4.store.stage import Input, StageRunner


def begin(project: Path, rig: Rig, **how: Any) -> Session:
    """Make the project of a capture that is about to start.

    Args:
        project: Folder that does not exist yet, or is empty.
        rig: What is on the backpack.
        how: Fields of `Session`.

    Raises:
        StoreError: If the folder is something else or cannot be written.
    """
    with Project.open(project) as opened:
        session = Session(project=project, **how)
        if session.capture.exists():
            raise StoreError(f"{project} has a capture already; give a new folder")
        opened.describe(preset=session.preset, rig=rig.name)
        session.capture.parent.mkdir(exist_ok=True)
        write_text(session.rig, format_rig(rig))
        session.save()
    return session


def finish(session: Session, frames: Path, settings: Settings) -> int:
    """Give the frames made while walking to the project as its stage ``frames``.

    `recon4.pipeline.process` finds them there: reading the capture again would give the same.

    Args:
        session: Of a capture that has ended.
        frames: Folder of a frame store; it is moved away.
        settings: They were made with.

    Returns:
        How many multiframes there are.

    Raises:
        StoreError: If the project is in use or cannot be written.
    """

    def moved(*, out: Path, **_: Any) -> dict[str, Any]:
        for path in frames.iterdir():
            shutil.move(path, out / path.name)
        return stages.frames_figures(out)

    progress = Silent()
    with Project.open(session.project) as project:
        rig = load_rig(session.rig)
        key = input_file(session.capture, project.ledger, progress).key
        about = {"name": session.capture.name, "bytes": size_of(session.capture), "sha256": key}
        project.describe(preset=session.preset, rig=rig.name, inputs=[about])
        runner = StageRunner(project, settings, progress)
        artifact = runner.run(
            replace(stages.FRAMES, function=moved),
            recordings=input_files([session.capture], project.ledger, progress),
            rig=Input(hash_json(format_rig(rig)), rig),
            imu=None,
            gnss=None,
        )
        shutil.rmtree(frames, ignore_errors=True)
        return int(artifact.manifest()["figures"]["multiframes"])
