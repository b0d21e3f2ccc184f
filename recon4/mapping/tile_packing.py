"""A block of a tile's rows as compressed bytes, field by field.

Each field becomes whole numbers: lengths and times in steps, all else as it is. The rows of a block
are stored in spatial order, where neighbors are alike; the bytes of the numbers stand apart, and
Zstandard with a checksum compresses them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.tile_packing import (
    bits_to_bytes,
    bytes_to_numbers,
    lengths_to_bits,
    numbers_to_bits,
)
from recon4.mapping.tile import DEVIATION, FIELDS, as_half
from recon4.mapping.tile_order import Rows
from recon4.mapping.tuning import TILES
from recon4.store.compressed import compress, expand
from recon4.store.tuning import PACKING


@dataclass(frozen=True, slots=True)
class FieldPacking:
    """How the numbers of a field are stored."""

    along: bool = False
    """As differences to the point before: for what is alike on a surface."""
    step: float = 0.0
    """In whole steps of this [unit of the field]; 0 = exact."""


FIELD_PACKING: Mapping[str, FieldPacking] = {
    "xyz": FieldPacking(along=True, step=TILES.position_step_m),
    "intensity": FieldPacking(along=True),
    "intensity_normalized": FieldPacking(along=True, step=TILES.intensity_step),
    "ring": FieldPacking(),
    "sensor": FieldPacking(),
    "echo": FieldPacking(),
    "classification": FieldPacking(),
    "frame_id": FieldPacking(along=True),
    "t_ns": FieldPacking(step=TILES.time_step_ns),
    "normal": FieldPacking(along=True),
    "raw_offset_m": FieldPacking(step=PACKING.step_m),
    "surface_returns": FieldPacking(along=True),
    "surface_sd_m": FieldPacking(along=True),
    "planarity": FieldPacking(along=True),
    DEVIATION: FieldPacking(along=True, step=TILES.deviation_step_m),
}
"""Of every field that is stored."""


class PackedField(NamedTuple):
    """A field of a block."""

    data: bytes
    """Compressed."""
    width: int
    """Bytes of each of its numbers."""
    step: float
    """Of its numbers [unit of the field]; 0 = exact."""


def pack(name: str, values: NDArray[Any]) -> PackedField:
    """A field of a block, compressed.

    Args:
        name: Of the field.
        values: In spatial order, (N,) or (N, K); times from the start of their multiframes.
    """
    dtype, many = FIELDS[name]
    packing, column = FIELD_PACKING[name], np.ascontiguousarray(values, dtype).reshape(-1, many)
    bits = np.empty((many, len(column)), np.uint64)
    if packing.step and column.dtype.kind == "f":
        lengths = column.astype(np.float32, copy=False)
        width = lengths_to_bits(lengths, packing.step, packing.along, bits)
    else:
        halves = column.dtype.kind == "f"
        width = numbers_to_bits(_numbers(name, column), packing.along, halves, bits)
    out = np.empty((many, width, len(column)), np.uint8)
    bits_to_bytes(bits, out)
    return PackedField(compress(out.data), width, packing.step)


def unpack(name: str, packed: PackedField, *, rows: Rows, out: NDArray[Any], where: str) -> None:
    """Write the values of `pack` to some rows.

    Args:
        name: Of the field.
        packed: What `pack` returned.
        rows: Of each value, (N,).
        out: Receives the values, (at least N,) or (at least N, K).
        where: File and block, for errors.

    Raises:
        StoreError: If the data are damaged or of another number of rows.
    """
    dtype, many = np.dtype(FIELDS[name][0]), FIELDS[name][1]
    along, count = FIELD_PACKING[name].along, len(rows)
    data, width, step = packed
    expanded = expand(data, many * width * count, where)
    digits = np.frombuffer(expanded, np.uint8).reshape(many, width, count)
    into = out.reshape(len(out), many)
    if step and dtype == np.float32:
        bytes_to_numbers(digits, rows, along, step, into)
    elif step and dtype == np.float16:
        lengths, every = np.empty((count, many), np.float32), np.arange(count, dtype=np.int32)
        bytes_to_numbers(digits, every, along, step, lengths)
        into[rows] = as_half(lengths)
    else:
        # Numbers without a sign and halves are bits, which the kernel cuts off as it stores them.
        bits = into.view(f"i{dtype.itemsize}")
        bytes_to_numbers(digits, rows, along, int(step) or 1, bits)


def as_stored(name: str, values: NDArray[Any]) -> NDArray[Any]:
    """The values of a field in steps as they will be read, in double precision."""
    return _numbers(name, values) * FIELD_PACKING[name].step


def _numbers(name: str, values: NDArray[Any]) -> NDArray[np.int64]:
    """Whole numbers of a field, in steps or as they are; of halves their bits."""
    dtype, step = FIELDS[name][0], FIELD_PACKING[name].step
    column = np.ascontiguousarray(values, dtype=dtype)
    if step > 0.0 and column.dtype.kind == "f":
        return np.rint(column.astype(np.float64) / step).astype(np.int64)
    if step > 0.0:
        return (column + int(step) // 2) // int(step)
    return (column.view(np.int16) if column.dtype.kind == "f" else column).astype(np.int64)
