"""Line scans and scans of a 2-D laser beside the multiframes of a recording.

lines.npz              fields of `LineScans`
laser2d_range_m.npy    (N, M) float32, streamed out, memory-mapped in
laser2d.npz            the other fields of `LaserScans`
"""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

import numpy as np

from recon4.errors import StoreError
from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.line_scans import LineScans
from recon4.store.arrays import load_arrays, load_record, save_record
from recon4.store.frames import storing

LINES, SCANS, RANGES = "lines.npz", "laser2d.npz", "laser2d_range_m.npy"
_HEADER_BYTES = 128
_SCALARS = ("angle_min_rad", "angle_step_rad", "range_max_m", "time_step_s")


class LineStoreWriter:
    """Appends line scans and 2-D scans, with one batch of ranges in memory."""

    def __init__(self, folder: Path) -> None:
        """Nothing is created until something is appended."""
        self._folder = folder
        self._lines: list[LineScans] = []
        self._t_ns: list[np.ndarray[tuple[int], np.dtype[np.int64]]] = []
        self._odometry: list[Array] = []
        self._first: LaserScans | None = None
        self._file: BinaryIO | None = None

    def append_lines(self, lines: LineScans) -> None:
        """Append line scans."""
        self._lines.append(lines)

    def append_scans(self, scans: LaserScans) -> None:
        """Append scans of the layout of the first ones.

        Raises:
            StoreError: If they cannot be written (`NoSpace` when the disk is full).
        """
        with storing(self._folder):
            if self._file is None:
                self._first = scans[:0]
                self._file = (self._folder / RANGES).open("wb")
                self._file.write(_header(0, scans.range_m.shape[1]))
            self._file.write(np.ascontiguousarray(scans.range_m, "<f4").data)
        self._t_ns.append(scans.t_ns)
        if scans.odometry is not None:
            self._odometry.append(scans.odometry)

    def close(self) -> tuple[int, int]:
        """Write the rest; returns the numbers of line scans and 2-D scans."""
        with storing(self._folder):
            if self._lines:
                save_record(self._folder / LINES, joined_lines(self._lines))
            if self._file is not None and self._first is not None:
                t_ns = np.concatenate(self._t_ns)
                self._file.seek(0)
                self._file.write(_header(len(t_ns), self._first.range_m.shape[1]))
                self._file.close()
                values = {name: getattr(self._first, name) for name in _SCALARS}
                if self._odometry:
                    values["odometry"] = np.concatenate(self._odometry)
                np.savez(self._folder / SCANS, t_ns=t_ns, **values)
        return sum(len(part) for part in self._lines), sum(len(part) for part in self._t_ns)


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
    missing = {"t_ns", *_SCALARS} - arrays.keys()
    if missing:
        raise StoreError(f"{folder.name}/{SCANS}: expected arrays {sorted(missing)}, got none")
    t_ns = arrays["t_ns"].astype(np.int64)
    try:
        ranges = np.load(folder / RANGES, mmap_mode="c").view(np.ndarray)
    except (OSError, ValueError, EOFError) as error:
        raise StoreError(f"{folder.name}/{RANGES} cannot be read: {error}") from error
    if ranges.ndim != 2 or len(ranges) != len(t_ns) or ranges.dtype != np.float32:
        raise StoreError(
            f"{folder.name}/{RANGES}: expected {len(t_ns)} rows of float32, got {ranges.shape} of "
            f"{ranges.dtype}"
        )
    if np.any(np.diff(t_ns) <= 0):
        raise StoreError(f"{folder.name}/{SCANS}: expected increasing times")
    odometry = arrays.get("odometry")
    if odometry is not None and odometry.shape != (len(t_ns), 3):
        raise StoreError(f"{folder.name}/{SCANS}: expected {len(t_ns)} poses, got {odometry.shape}")
    return LaserScans(
        t_ns=t_ns,
        range_m=ranges,
        angle_min_rad=float(arrays["angle_min_rad"]),
        angle_step_rad=float(arrays["angle_step_rad"]),
        range_max_m=float(arrays["range_max_m"]),
        time_step_s=float(arrays["time_step_s"]),
        odometry=odometry,
    )


def _header(rows: int, width: int) -> bytes:
    """Header of a version 1.0 ``.npy`` file, of constant size so that it can be rewritten."""
    text = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({rows}, {width}), }}"
    body = text.encode("latin1").ljust(_HEADER_BYTES - 11) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(body).to_bytes(2, "little") + body
