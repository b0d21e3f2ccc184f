"""Rigs for a capture: own files first, then those that ship with recon4."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from stat import S_ISREG

from recon4.errors import ConfigError, CorruptFile
from recon4.model.rig import load_rig, rig_presets
from recon4.untrusted.bounded import read_text_limited
from recon4.untrusted.names import is_unnameable
from recon4_app.live.tuning import LIVE_RIGS
from recon4_app.rigs.store import RIGS, newest_files


@dataclass(frozen=True, slots=True)
class RigChoice:
    """A rig to choose from."""

    rig: str
    """Value to start a capture with: name of a shipped rig, or path of a file."""
    name: str
    """Display name."""
    sensors: list[str]
    """Names of its LiDARs, 2-D laser and profiler."""
    problem: str
    """Why it cannot be used; empty = it can."""


def rig_files(
    folders: Sequence[Path], shows: Callable[[Path], bool] = lambda _: True
) -> tuple[Path, ...]:
    """TOML files directly in some folders or in their subfolders ``rigs``.

    Of the rigs of the server, the newest version is listed.

    Args:
        folders: Folders to search.
        shows: Whether a file may be listed (`ImportFolders.shows`).
    """
    files = (path for folder in folders for path in _files(folder) if _fits(path) and shows(path))
    return tuple(islice(files, LIVE_RIGS.max_files))


def rigs_in(files: tuple[Path, ...]) -> list[RigChoice]:
    """Read the rigs among some files; runs in a child process, because users wrote the files."""
    return [choice for path in files if (choice := _choice(path)) is not None]


def shipped_rigs() -> list[RigChoice]:
    """The rigs that come with recon4."""
    return [_shipped(name) for name in rig_presets()]


def _files(folder: Path) -> Iterator[Path]:
    yield from sorted(folder.glob("*.toml"))
    yield from sorted(folder.glob("rigs/*.toml"))
    yield from newest_files(folder / RIGS)


def _fits(path: Path) -> bool:
    try:
        found = path.lstat()
    except OSError:
        return False
    return (
        S_ISREG(found.st_mode)
        and found.st_size <= LIVE_RIGS.largest_bytes
        and not is_unnameable(path)
    )


def _choice(path: Path) -> RigChoice | None:
    """The rig in a file; None if the file has no sensors."""
    try:
        if "[[sensor]]" not in read_text_limited(path, LIVE_RIGS.largest_bytes):
            return None
        rig = load_rig(path)
    except ConfigError as error:
        return RigChoice(str(path), path.name, [], str(error))
    except (OSError, CorruptFile):
        return None
    return RigChoice(str(path), f"{rig.name} ({path.name})", [s.name for s in rig.sensors], "")


def _shipped(name: str) -> RigChoice:
    return RigChoice(name, name, [sensor.name for sensor in load_rig(name).sensors], "")
