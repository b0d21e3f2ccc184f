"""Cloning: a new project that reuses the finished stages of another one."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Mapping
from pathlib import Path

from recon4.errors import NoSpace, Recon4Error
from recon4.locales.coded import CodedText, coded
from recon4.store.atomic import raise_if_full
from recon4.store.project import Project
from recon4_app.errors import Conflict, NoRoom


def clone_artifacts(artifacts: Mapping[str, Path], target: Path, work: Path) -> None:
    """Create a project from the artifacts of another one.

    Artifacts are never changed, so their files are shared (hard links) where the file system can.
    The new project has no ledger: its first run reads and verifies every byte before reusing it.

    Args:
        artifacts: Stage -> folder.
        target: The new project's folder; must not exist.
        work: Where to build it: a folder of the same file system.

    Raises:
        Conflict: If ``target`` exists.
        NoRoom: If the disk is full.
    """
    if target.exists():
        raise Conflict(CodedText("name-taken", name=target.name))
    work.mkdir(parents=True, exist_ok=True)
    building = work / f"clone-{secrets.token_hex(6)}" / target.name
    try:
        building.parent.mkdir()
        with Project.open(building):
            for artifact in artifacts.values():
                shutil.copytree(
                    artifact, building / "artifacts" / artifact.name, copy_function=_link
                )
        building.rename(target)
    except (OSError, shutil.Error) as error:
        _raise_no_room(error, target)
        raise
    except Recon4Error as error:
        _raise_no_room(error, target)
        raise
    finally:
        shutil.rmtree(building.parent, ignore_errors=True)


def _link(source: str, target: str) -> None:
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)


def _raise_no_room(error: BaseException, target: Path) -> None:
    try:
        raise_if_full(error, target)
    except NoSpace as full:
        raise NoRoom(coded(full)) from error
