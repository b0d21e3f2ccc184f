"""Columns of the map on disk: one ``.npy`` file per field, with a header of constant size."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.mapping.tile import FIELDS
from recon4.store.earlier_names import TILE_FIELDS
from recon4.store.growing_arrays import HEADER_BYTES, npy_header

_EARLIER = {now: earlier for earlier, now in TILE_FIELDS.items()}


def column_file(folder: Path, name: str) -> str:
    """Name of the file of a column; maps of earlier versions have some under another one."""
    earlier = f"{_EARLIER[name]}.npy" if name in _EARLIER else ""
    current = f"{name}.npy"
    is_earlier = earlier and not (folder / current).exists() and (folder / earlier).exists()
    return earlier if is_earlier else current


def column_shape(name: str, rows: int) -> tuple[int, ...]:
    """Shape of a column."""
    width = FIELDS[name][1]
    return (rows, width) if width > 1 else (rows,)


def column_header(name: str, rows: int) -> bytes:
    """Header of the file of a column."""
    return npy_header(FIELDS[name][0], column_shape(name, rows))


def row_offset(name: str, row: int) -> tuple[int, int]:
    """Offset of a row in its file, and the size of a row [bytes]."""
    row_bytes = np.dtype(FIELDS[name][0]).itemsize * FIELDS[name][1]
    return HEADER_BYTES + row * row_bytes, row_bytes


def map_rows(folder: Path, name: str, start: int, *, count: int) -> NDArray[Any]:
    """Rows of a column, mapped.

    Raises:
        StoreError: If they cannot be read.
    """
    dtype = np.dtype(FIELDS[name][0])
    if count == 0:
        return np.empty(column_shape(name, 0), dtype)
    offset, _ = row_offset(name, start)
    path = folder / column_file(folder, name)
    try:
        mapped = np.memmap(path, dtype, mode="r", offset=offset, shape=column_shape(name, count))
    except (OSError, ValueError, OverflowError) as error:
        raise StoreError(f"{folder.name}/{path.name} cannot be read: {error}") from error
    return mapped.view(np.ndarray)


def check_columns(folder: Path, fields: Sequence[str], points: int) -> None:
    """Check that there is a column of the right size for every field.

    Raises:
        StoreError: If a field is unknown or a file has another size.
    """
    for name in fields:
        if name not in FIELDS:
            raise StoreError(f"tiles.json: unknown field {name!r}; known: {list(FIELDS)}")
        path = folder / column_file(folder, name)
        expected = HEADER_BYTES + points * np.dtype(FIELDS[name][0]).itemsize * FIELDS[name][1]
        found = path.stat().st_size if path.is_file() else -1
        if found != expected:
            raise StoreError(
                f"{folder.name}/{path.name}: expected {expected} bytes for {points} points, "
                f"got {found if found >= 0 else 'no file'}"
            )
