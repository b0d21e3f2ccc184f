"""Columns of a map as stored before 2026-11-27: one ``.npy`` file per field. They are only read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from recon4.errors import StoreError
from recon4.mapping.sensor_paths import SensorPaths
from recon4.mapping.threads import Each, in_turn
from recon4.mapping.tile import FIELDS, Columns
from recon4.mapping.tile_order import spatial_order
from recon4.store.checked import CheckedArtifact
from recon4.store.earlier_names import TILE_FIELDS
from recon4.store.growing_arrays import HEADER_BYTES

_EARLIER = {now: earlier for earlier, now in TILE_FIELDS.items()}


@dataclass(frozen=True, slots=True)
class EarlierColumns:
    """The columns of a map, memory-mapped; `recon4.mapping.columns.TileColumns`."""

    folder: Path
    """``tiles``"""
    fields: tuple[str, ...]
    paths: SensorPaths = field(default_factory=SensorPaths)
    """Not known: ranges are stored."""

    @staticmethod
    def open(folder: Path, fields: Sequence[str], rows: int) -> EarlierColumns:
        """Check that there is a column of the right size for every field.

        Raises:
            StoreError: If a field is unknown or a file has another size.
        """
        for name in fields:
            if name not in FIELDS:
                raise StoreError(f"tiles.json: unknown field {name!r}; known: {list(FIELDS)}")
            path = _file(folder, name)
            expected = HEADER_BYTES + rows * _row_bytes(name)
            found = path.stat().st_size if path.is_file() else -1
            if found != expected:
                raise StoreError(
                    f"{folder.name}/{path.name}: expected {expected} bytes for {rows} points, "
                    f"got {found if found >= 0 else 'no file'}"
                )
        return EarlierColumns(folder, tuple(fields))

    def read(
        self, names: Sequence[str], rows: slice, *, checked: CheckedArtifact | None = None
    ) -> Columns:
        """See `TileColumns.read`."""
        found: Columns = {}
        for name in names:
            path, size = _file(self.folder, name), _row_bytes(name)
            first = HEADER_BYTES + rows.start * size
            count = rows.stop - rows.start
            if checked is not None and count:
                checked.check(f"tiles/{path.name}", first, first + count * size)
            dtype, width = FIELDS[name]
            shape = (count, width) if width > 1 else (count,)
            if not count:
                found[name] = np.empty(shape, dtype)
                continue
            try:
                mapped = np.memmap(path, dtype, mode="r", offset=first, shape=shape)
            except (OSError, ValueError, OverflowError) as error:
                raise StoreError(
                    f"{self.folder.name}/{path.name} cannot be read: {error}"
                ) from error
            found[name] = mapped.view(np.ndarray)[:: rows.step]
        return found

    def read_in_space(
        self,
        names: Sequence[str],
        rows: slice,
        *,
        checked: CheckedArtifact | None = None,
        each: Each = in_turn,
    ) -> Columns:
        """See `TileColumns.read_in_space`."""
        order = spatial_order(rows.stop - rows.start)
        found = self.read(names, rows, checked=checked)
        return {name: np.take(values, order, axis=0) for name, values in found.items()}


def _file(folder: Path, name: str) -> Path:
    """File of a column; maps of still earlier versions have some under another name."""
    current = folder / f"{name}.npy"
    if name not in _EARLIER or current.exists():
        return current
    earlier = folder / f"{_EARLIER[name]}.npy"
    return earlier if earlier.exists() else current


def _row_bytes(name: str) -> int:
    dtype, width = FIELDS[name]
    return np.dtype(dtype).itemsize * width
