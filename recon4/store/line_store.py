"""Line scans and scans of a 2-D laser beside the multiframes of a recording.

lines.npz              fields of `LineScans`
laser2d_range_m.npy    ranges of all scans, (R,) float32, streamed out, memory-mapped in
laser2d.npz            the other fields of `LaserScans`
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.geometry.se3 import Array
from recon4.locales.coded import unreadable
from recon4.model.laser_scans import LaserScans
from recon4.model.line_scans import LineScans
from recon4.store.arrays import load_arrays, load_record, save_arrays, save_record
from recon4.store.frames import storing
from recon4.store.growing_arrays import npy_header

LINES, SCANS, RANGES = "lines.npz", "laser2d.npz", "laser2d_range_m.npy"
_PER_SCAN = ("t_ns", "angle_min_rad", "angle_step_rad", "time_step_s")
_FIELDS = (*_PER_SCAN, "start", "range_max_m")


class LineStoreWriter:
    """Appends line scans and 2-D scans, with one batch of ranges in memory."""

    def __init__(self, folder: Path) -> None:
        """Nothing is created until something is appended."""
        self._folder = folder
        self._lines: list[LineScans] = []
        self._parts: dict[str, list[Array]] = {name: [] for name in (*_PER_SCAN, "beams")}
        self._odometry: list[Array | None] = []
        self._range_max_m = 0.0
        self._file: BinaryIO | None = None

    def append_lines(self, lines: LineScans) -> None:
        """Append line scans."""
        self._lines.append(lines)

    def append_scans(self, scans: LaserScans) -> None:
        """Append scans of the 2-D laser.

        Raises:
            StoreError: If they cannot be written (`NoSpace` when the disk is full).
        """
        with storing(self._folder):
            if self._file is None:
                self._file = (self._folder / RANGES).open("wb")
                self._file.write(npy_header("<f4", (0,)))
            self._file.write(np.ascontiguousarray(scans.range_m, "<f4").data)
        for name, parts in self._parts.items():
            parts.append(getattr(scans, name))
        self._odometry.append(scans.odometry)
        self._range_max_m = max(self._range_max_m, scans.range_max_m)

    def close(self) -> tuple[int, int]:
        """Write the rest; returns the numbers of line scans and 2-D scans."""
        with storing(self._folder):
            if self._lines:
                save_record(self._folder / LINES, joined_lines(self._lines))
            if self._file is not None:
                self._close_scans(self._file)
        lines = sum(len(part) for part in self._lines)
        return lines, sum(len(part) for part in self._parts["t_ns"])

    def _close_scans(self, file: BinaryIO) -> None:
        arrays: dict[str, NDArray[Any]] = {
            name: np.concatenate(self._parts[name]) for name in _PER_SCAN
        }
        arrays["start"] = np.concatenate([[0], *self._parts["beams"]]).cumsum()
        arrays["range_max_m"] = np.array(self._range_max_m)
        known = [poses for poses in self._odometry if poses is not None]
        if len(known) == len(self._odometry):
            arrays["odometry"] = np.concatenate(known)
        file.seek(0)
        file.write(npy_header("<f4", (int(arrays["start"][-1]),)))
        file.close()
        save_arrays(self._folder / SCANS, arrays)


def joined_lines(parts: list[LineScans]) -> LineScans:
    """Consecutive line scans as one record."""
    return LineScans(
        np.concatenate([part.t_ns for part in parts]),
        np.concatenate([part.head_rad for part in parts]),
        np.concatenate([part.points for part in parts]),
    )


def load_lines(folder: Path) -> LineScans:
    """Line scans of a recording.

    Raises:
        StoreError: If there are none, or the file is damaged.
    """
    lines = load_record(folder / LINES, LineScans)
    if len(lines.t_ns) == 0 or np.any(np.diff(lines.t_ns) <= 0):
        raise StoreError(f"{folder.name}/{LINES}: expected increasing times of line scans")
    return lines


def load_laser_scans(folder: Path) -> LaserScans | None:
    """Scans of the 2-D laser with ranges mapped from the disk; None = there are none.

    Raises:
        StoreError: If the files are damaged or do not fit each other.
    """
    if not (folder / SCANS).exists():
        return None
    arrays = load_arrays(folder / SCANS)
    try:
        ranges = np.load(folder / RANGES, mmap_mode="c").view(np.ndarray)
    except (OSError, ValueError, EOFError) as error:
        raise StoreError(unreadable(f"{folder.name}/{RANGES}", error)) from error
    if ranges.ndim == 2:
        ranges = _of_earlier_version(arrays, ranges)
    missing = set(_FIELDS) - arrays.keys()
    if missing:
        raise StoreError(f"{folder.name}/{SCANS}: expected arrays {sorted(missing)}, got none")
    _check_scans(folder.name, arrays, ranges)
    return LaserScans(
        range_m=ranges,
        range_max_m=float(arrays["range_max_m"]),
        odometry=arrays.get("odometry"),
        **{name: arrays[name] for name in ("start", *_PER_SCAN)},
    )


def _of_earlier_version(arrays: dict[str, NDArray[Any]], ranges: NDArray[Any]) -> NDArray[Any]:
    """Ranges of a store whose scans all have the same angles, one row a scan."""
    count, beams = ranges.shape
    arrays["start"] = beams * np.arange(count + 1, dtype=np.int64)
    for name in set(_PER_SCAN[1:]) & arrays.keys():
        arrays[name] = np.full(count, arrays[name], np.float64)
    return ranges.reshape(-1)


def _check_scans(folder: str, arrays: Mapping[str, NDArray[Any]], ranges: NDArray[Any]) -> None:
    """Raise `StoreError` if the arrays do not fit each other."""
    count, start = arrays["t_ns"].size, arrays["start"]
    shapes = {name: arrays[name].shape for name in _FIELDS}
    if shapes != dict.fromkeys(_PER_SCAN, (count,)) | {"start": (count + 1,), "range_max_m": ()}:
        raise StoreError(f"{folder}/{SCANS}: expected {count} values each, got {shapes}")
    kinds = {name: arrays[name].dtype.kind for name in _FIELDS}
    if kinds != dict.fromkeys(_FIELDS, "f") | {"t_ns": "i", "start": "i"}:
        raise StoreError(f"{folder}/{SCANS}: expected numbers, got {kinds}")
    if start[0] != 0 or np.any(np.diff(start) <= 0):
        raise StoreError(f"{folder}/{SCANS}: expected increasing starts of {count} scans")
    if ranges.shape != (int(start[-1]),) or ranges.dtype != np.float32:
        raise StoreError(
            f"{folder}/{RANGES}: expected {start[-1]} ranges as float32, got {ranges.shape} of "
            f"{ranges.dtype}"
        )
    if np.any(np.diff(arrays["t_ns"]) <= 0):
        raise StoreError(f"{folder}/{SCANS}: expected increasing times")
    odometry = arrays.get("odometry")
    if odometry is not None and odometry.shape != (count, 3):
        raise StoreError(f"{folder}/{SCANS}: expected {count} poses, got {odometry.shape}")
