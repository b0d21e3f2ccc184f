"""Files beside a recording that may describe its LiDARs, by their names: nothing is read.

A server lists them for a worker, which may not list folders.
"""

from __future__ import annotations

from pathlib import Path

COMPANION_SUFFIXES = frozenset({".json", ".csv", ".yaml", ".yml", ".xml", ".dat", ".cal"})


def files_near(recording: Path) -> list[Path]:
    """Files beside or in a recording that may describe a LiDAR; no links."""
    folders = [recording] if recording.is_dir() else [recording.parent]
    if (recording / "metadata.yaml").exists():  # a rosbag2 is a folder of its own
        folders.append(recording.parent)
    return [file for folder in folders for file in _files_in(folder) if file != recording]


def _files_in(folder: Path) -> list[Path]:
    try:
        files = [file for file in folder.iterdir() if file.suffix.lower() in COMPANION_SUFFIXES]
        return sorted(file for file in files if file.is_file() and not file.is_symlink())
    except OSError:  # a confined process may not list it
        return []
