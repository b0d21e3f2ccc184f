"""Reads an exported file of points again, for the comparison with what was meant."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, StoreError
from recon4.export.account import PointAccount
from recon4.export.tuning import REREAD
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText, text_of
from recon4.progress import Progress
from recon4.recording.formats.cloud_files import cloud_chunks


def check_size(path: Path, expected: int, name: str) -> None:
    """Check the bytes of a file.

    Raises:
        StoreError: If they are not as many as expected.
    """
    found = path.stat().st_size
    if found != expected:
        raise StoreError(CodedText("file-bytes", name=name, expected=expected, found=found))


def account_of_rows(
    path: Path, row: np.dtype[np.void], progress: Progress, *, offset: Array
) -> PointAccount:
    """Account of a PLY or PCD file whose points have the fields of a row.

    Args:
        path: The file.
        row: Names and types of the fields; their bytes are summed in this order.
        progress: Counts bytes.
        offset: What was taken from its coordinates [m], (3,).

    Raises:
        StoreError: If it cannot be read.
    """
    found = PointAccount(crs=_crs_comment(path))
    progress.start("compare", path.stat().st_size, "B")
    try:
        for table in cloud_chunks(path):
            if not len(table["x"]):
                continue
            rows = np.zeros(len(table["x"]), row)
            for name in row.names or ():
                rows[name] = table[name]
            xyz = np.stack([table[axis] for axis in "xyz"], axis=1).astype(np.float64)
            found.add(xyz + offset, rows["classification"])
            found.add_stored(rows)
            progress.advance(rows.nbytes)
    except (CorruptFile, KeyError) as error:
        raise StoreError(CodedText("reread-why", name=path.name, why=text_of(error))) from error
    return found


def account_of_text(path: Path, progress: Progress) -> PointAccount:
    """Account of a file of lines: x, y, z, intensity, class.

    Raises:
        StoreError: If it cannot be read.
    """
    found = PointAccount()
    progress.start("compare", path.stat().st_size, "B")
    for values in _lines(path, progress):
        found.add(values[:, :3], values[:, 4].astype(np.uint8))
        found.add_stored(values + 0.0)  # no negative zeros
    return found


def _lines(path: Path, progress: Progress) -> Iterator[NDArray[np.float64]]:
    with path.open("rb") as file:
        while lines := file.readlines(REREAD.text_bytes):
            try:
                values = np.loadtxt(lines, ndmin=2, comments="//")
            except ValueError as error:
                raise StoreError(CodedText("reread-why", name=path.name, why=str(error))) from error
            if values.size and values.shape[1] != 5:
                raise StoreError(
                    CodedText("reread-columns", file=path.name, shape=str(values.shape[1]))
                )
            if values.size:
                yield values
            progress.advance(sum(map(len, lines)))


def _crs_comment(path: Path) -> str:
    """The CRS in a comment of a head; empty = none."""
    with path.open("rb") as file:
        head = file.read(REREAD.head_bytes)
    for line in head.splitlines():
        for begin in (b"comment crs ", b"# crs "):
            if line.startswith(begin):
                return line[len(begin) :].decode("ascii", "replace")
    return ""
