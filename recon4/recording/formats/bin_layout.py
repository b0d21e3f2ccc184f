"""KITTI BIN files: rows of float32 without a header; how many there are in a row is found."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.bags.tuning import BIN_FILES
from recon4.recording.formats.cloud_headers import CloudLayout, Field

_COLUMNS = ("x", "y", "z", "intensity", "ring", "time")
_USUAL = 4


def is_bin(head: bytes, size: int) -> bool:
    """Whether the content is plausibly that of a KITTI BIN file.

    Args:
        head: Its first bytes.
        size: Of the file [bytes].
    """
    if len(head) < BIN_FILES.looked_at and not any(size % (4 * n) == 0 for n in BIN_FILES.widths):
        return False
    values = _numbers(head[: BIN_FILES.looked_at])
    return bool(np.all(np.isfinite(values)) and np.all(np.abs(values) < BIN_FILES.largest))


def bin_layout(head: bytes, size: int, name: str) -> CloudLayout:
    """Layout of the rows: x y z intensity, in some data sets also ring, or ring and time.

    Rows are as wide as makes the numbers below each other most alike: with a wrong width each
    column holds all quantities. A fifth number that is no ring has no name, and is not read.

    Args:
        head: The first bytes of the file, `HEADER_BYTES` of them, or all.
        size: Of the file [bytes].
        name: Of the file, for messages.

    Raises:
        CorruptFile: If no number of rows makes the size.
    """
    fitting = [n for n in BIN_FILES.widths if size % (4 * n) == 0]
    if not fitting:
        raise CorruptFile(CodedText("kitti-bin-size", name=name, size=size, excess=size % 16))
    values = _numbers(head)
    likeness = {n: _likeness(values, n) for n in fitting}
    width = max(fitting, key=lambda n: likeness[n] + (n == _USUAL) * BIN_FILES.clearer)
    columns = _COLUMNS[:width]
    if width > _USUAL and not _is_ring(_rows(values, width)[:, _USUAL]):
        columns = (*columns[:_USUAL], *[""] * (width - _USUAL))
    fields = tuple(Field(key, "<f4") for key in columns)
    return CloudLayout(fields, size // (4 * width), "binary", 0)


def _numbers(head: bytes) -> NDArray[np.float32]:
    return np.frombuffer(head[: len(head) // 4 * 4], "<f4")


def _rows(values: NDArray[np.float32], width: int) -> NDArray[np.float32]:
    return values[: len(values) // width * width].reshape(-1, width)


def _likeness(values: NDArray[np.float32], width: int) -> float:
    """How alike numbers are that are ``width`` apart, -2..2: the rank correlations of the numbers
    and of their sizes. Ranks, because the quantities have different units.
    """
    if len(values) < width * BIN_FILES.fewest_rows:
        return 0.0
    total = 0.0
    for column in (values, np.abs(values)):
        rank = np.argsort(np.argsort(column, kind="stable")) / len(column) - 0.5
        total += 12.0 * float(np.mean(rank[:-width] * rank[width:]))
    return total


def _is_ring(column: NDArray[np.float32]) -> bool:
    return bool(np.all((column >= 0.0) & (column <= 255.0) & (column % 1.0 == 0.0)))
