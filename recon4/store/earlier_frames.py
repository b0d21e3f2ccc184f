"""Multiframes as stored before 2026-11-27: one ``.npy`` file per column. They are only read.

Points of frame ``k`` are rows ``index["start"][k]`` to ``index["stop"][k]`` of every column.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.locales.coded import unreadable
from recon4.model.multiframe import COLUMNS

EARLIER_INDEX = np.dtype(
    [(name, "<i8") for name in ("frame_id", "t_ns", "duration_ns", "start", "stop")]
)
"""One row of ``index.npy``."""


def is_earlier(folder: Path) -> bool:
    """Whether a folder has multiframes in columns."""
    return (folder / "xyz.npy").exists()


def earlier_columns(folder: Path, start: int, stop: int) -> dict[str, NDArray[Any]]:
    """Some rows of all columns, in memory of their own.

    Raises:
        StoreError: If a column is missing or damaged.
    """
    return {name: _rows(folder, name, start, stop=stop) for name in COLUMNS}


def _rows(folder: Path, name: str, start: int, *, stop: int) -> NDArray[Any]:
    dtype, width = COLUMNS[name]
    try:
        column = np.load(folder / f"{name}.npy", mmap_mode="r", allow_pickle=False)
    except (OSError, ValueError, EOFError, SyntaxError, TypeError) as error:
        raise StoreError(unreadable(f"{folder.name}/{name}.npy", error)) from error
    rows = np.array(column[start:stop], subok=False)
    expected = (stop - start, width) if width > 1 else (stop - start,)
    if rows.dtype != dtype or rows.shape != expected:
        raise StoreError(
            f"{folder.name}/{name}.npy: expected {expected} of {dtype} from row {start} on, "
            f"got {rows.shape} of {rows.dtype}"
        )
    return rows
