"""Rigs a capture may be started with: one's own files, then those that ship with recon4."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import ConfigError
from recon4.model.rig import load_rig, rig_presets

MOST_FILES = 100
LARGEST_BYTES = 1 << 17


@dataclass(frozen=True, slots=True)
class RigChoice:
    """One rig."""

    rig: str
    """What to start a capture with: a name, or the path of a file."""
    name: str
    """What it is called."""
    sensors: list[str]
    """Its LiDARs."""
    problem: str
    """Why it cannot be used, in words; empty = it can."""


def rigs_at_hand(
    folders: Sequence[Path], shows: Callable[[Path], bool] = lambda _: True
) -> list[RigChoice]:
    """Rig files that lie in some folders, not deeper, or in ``rigs`` in them; then shipped ones.

    Args:
        folders: Where to look.
        shows: Whether a file may be shown at all (`ImportFolders.shows`).
    """
    files = [path for folder in folders for path in _files(folder) if shows(path)]
    own = [choice for path in files[:MOST_FILES] if (choice := _choice(path)) is not None]
    return own + [_shipped(name) for name in rig_presets()]


def _files(folder: Path) -> Iterator[Path]:
    yield from sorted(folder.glob("*.toml"))
    yield from sorted(folder.glob("rigs/*.toml"))


def _choice(path: Path) -> RigChoice | None:
    """A file that says it has sensors; others are no rigs."""
    try:
        if path.stat().st_size > LARGEST_BYTES or "[[sensor]]" not in path.read_text("utf-8"):
            return None
        rig = load_rig(path)
    except ConfigError as error:
        return RigChoice(str(path), path.name, [], str(error))
    except (OSError, UnicodeDecodeError):
        return None
    return RigChoice(str(path), f"{rig.name} ({path.name})", [s.name for s in rig.sensors], "")


def _shipped(name: str) -> RigChoice:
    return RigChoice(name, name, [sensor.name for sensor in load_rig(name).sensors], "")
