"""Reads an exported map again, and compares it with the map before it is packed."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, zip_longest
from pathlib import Path

import numpy as np

from recon4.delivery.tuning import DELIVERIES
from recon4.errors import StoreError
from recon4.export.points import OutputCrs, PointSource
from recon4.geometry.se3 import Array
from recon4.mapping.tiles import TileSet
from recon4.recording.formats.cloud_files import cloud_chunks

UNCHECKED = (".ply", ".pcd", ".xyz")
"""Formats whose writers do not read back all they wrote; the others do (`recon4.export`)."""


def compare_export(path: Path, tiles: TileSet, output: OutputCrs) -> None:
    """Compare every point of a file with the map, in order, streaming.

    Raises:
        StoreError: If a point is another, or their number.
    """
    ending = path.suffix.lower()
    if ending not in UNCHECKED:
        return
    source = PointSource.of(tiles, output)
    shift = source.offset if ending == ".pcd" else np.zeros(3)
    expected = (block.xyz - shift for block in source.blocks([], None))
    found = _text_points(path) if ending == ".xyz" else _points(path)
    count = 0
    for want, got in zip_longest(_even(expected), _even(found)):
        number = 0 if got is None else len(got)
        same = want is not None and got is not None and want.shape == got.shape
        if not (same and _are_same(want, got, single=ending == ".pcd")):
            raise StoreError(
                f"{path.name} reads back wrong: of {source.count} points, {count + number} were "
                f"read, and one after number {count} is another"
            )
        count += number


def _are_same(want: Array, got: Array, *, single: bool) -> bool:
    """Whether points are the same but for rounding; what is not a number is another."""
    rounded_m = np.abs(want) * np.finfo(np.float32).eps if single else 0.0
    return bool((np.abs(want - got) <= DELIVERIES.same_point_m + rounded_m).all())


def _points(path: Path) -> Iterator[Array]:
    for chunk in cloud_chunks(path):
        yield np.stack([np.asarray(chunk[axis], np.float64) for axis in "xyz"], axis=1)


def _text_points(path: Path) -> Iterator[Array]:
    with path.open("rb") as file:
        while lines := file.readlines(DELIVERIES.block_bytes):
            try:
                yield np.loadtxt(lines, usecols=(0, 1, 2), ndmin=2, comments="//")
            except ValueError as error:
                raise StoreError(f"{path.name} reads back wrong: {error}") from error


def _even(blocks: Iterator[Array]) -> Iterator[Array]:
    """The same rows in blocks of one size, so that two files can be compared block by block."""
    kept: Array = np.empty((0, 3))
    size = DELIVERIES.compared_points
    for block in chain(blocks, (None,)):
        kept = kept if block is None else np.concatenate([kept, block])
        while len(kept) >= size:
            yield kept[:size]
            kept = kept[size:]
    if len(kept):
        yield kept
