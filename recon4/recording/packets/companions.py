"""Small files beside a recording that describe its LiDARs: metadata, tables of angles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from recon4.model.rig import Rig
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import Companion, same_start

COMPANION_SUFFIXES = frozenset({".json", ".csv", ".yaml", ".yml", ".xml", ".dat", ".cal"})
MAX_COMPANION_BYTES = 1 << 20
_MOST_FILES = 100


def described_in(rig: Rig | None) -> list[Companion]:
    """The descriptions of sensors in a rig file."""
    sensors = rig.sensors if rig is not None else ()
    return [
        Companion(f"{s.name} (rig file)", s.description.encode()) for s in sensors if s.description
    ]


def is_companion(path: Path) -> bool:
    """Whether a file describes a LiDAR, by its contents."""
    return bool(_read([path]))


def companion_paths(recording: Path) -> list[Path]:
    """The files beside or in a recording that describe a LiDAR."""
    files = [file for folder in _folders_of(recording) for file in _files_in(folder)]
    return [path for path in files if path != recording and is_companion(path)]


def _folders_of(recording: Path) -> list[Path]:
    """Where files of a recording lie: a rosbag2 is a folder of its own."""
    if not recording.is_dir():
        return [recording.parent]
    is_bag = (recording / "metadata.yaml").exists()
    return [recording, recording.parent] if is_bag else [recording]


def _files_in(folder: Path) -> list[Path]:
    try:
        return sorted(file for file in folder.iterdir() if not file.is_symlink())
    except OSError:  # a confined process may not list it; what it may read was given
        return []


def companions_of(paths: Sequence[Path]) -> list[Companion]:
    """The files among the sources that describe a LiDAR, and those beside them.

    Args:
        paths: Recordings, files or folders, and such files.
    """
    beside = [file for path in paths for file in companion_paths(path)]
    recordings = [path.stem for path in paths if path.suffix.lower() not in COMPANION_SUFFIXES]
    return _read(dict.fromkeys([*paths, *beside]), recordings)


def _read(paths: Iterable[Path], recordings: Sequence[str] = ()) -> list[Companion]:
    small = [path for path in paths if path.suffix.lower() in COMPANION_SUFFIXES]
    found = []
    for path in small[:_MOST_FILES]:
        try:
            if path.is_file() and path.stat().st_size <= MAX_COMPANION_BYTES:
                alike = (same_start(path.stem, name) for name in recordings)
                found.append(Companion(path.name, path.read_bytes(), max(alike, default=0)))
        except OSError:
            continue
    return [one for one in found if any(family.describes(one) for family in FAMILIES)]
