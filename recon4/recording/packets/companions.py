"""Small files beside a recording that may describe its LiDARs: metadata, tables of angles."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from recon4.recording.packets.family import Companion

COMPANION_SUFFIXES = frozenset({".json", ".csv", ".yaml", ".yml", ".xml", ".dat", ".cal"})
MAX_COMPANION_BYTES = 1 << 20
_MOST_FILES = 100
_NOT_CALIBRATION = frozenset({"metadata.yaml", "recording.json", "info.json"})


def companions_of(paths: Sequence[Path]) -> list[Companion]:
    """The files given, and those beside a recording or in its folder; large ones are none.

    Args:
        paths: Recordings: files or folders.
    """
    given = [path for path in paths if path.is_file() and path.suffix.lower() in COMPANION_SUFFIXES]
    folders = dict.fromkeys(path if path.is_dir() else path.parent for path in paths)
    beside = [file for folder in folders for file in _files_in(folder)]
    found = []
    for file in list(dict.fromkeys([*given, *beside]))[:_MOST_FILES]:
        try:
            if file.stat().st_size <= MAX_COMPANION_BYTES:
                found.append(Companion(file.name, file.read_bytes()))
        except OSError:  # not readable for a confined process, or gone: not of this recording
            continue
    return found


def _files_in(folder: Path) -> list[Path]:
    try:
        files = sorted(folder.iterdir())
    except OSError:
        return []
    return [
        file
        for file in files
        if file.suffix.lower() in COMPANION_SUFFIXES
        and file.name not in _NOT_CALIBRATION
        and file.is_file()
        and not file.is_symlink()
    ]
