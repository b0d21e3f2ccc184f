"""What a file of points must turn out to hold, and the comparison with what it holds."""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.export.tuning import POINT_EXPORT
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.threads import Each, in_turn


@dataclass(slots=True, eq=False)
class PointAccount:
    """Count, bounds, classes and checksums of points, in their order."""

    crs: str = ""
    """As the file names it; empty = none."""
    count: int = 0
    low_m: Array = field(default_factory=lambda: np.full(3, np.inf))
    high_m: Array = field(default_factory=lambda: np.full(3, -np.inf))
    """Bounds in the coordinates of the file [m], (3,)."""
    classes: NDArray[np.int64] = field(default_factory=lambda: np.zeros(256, np.int64))
    """How many points have each code, (256,)."""
    sums: list[int] = field(default_factory=list)
    """CRC-32 of the stored bytes of each `PointExportTuning.summed` points."""
    summed: int = 0

    def add(self, xyz: Array, classification: NDArray[np.uint8]) -> None:
        """Account for coordinates of the file (N, 3) and classes (N,)."""
        if not len(xyz):
            return
        # Column by column: along the rows of a narrow array NumPy takes five times as long.
        corners = np.array([(column.min(), column.max()) for column in xyz.T]).T
        self.add_summary(len(xyz), corners, classification)

    def add_summary(self, count: int, corners: Array, classification: NDArray[np.uint8]) -> None:
        """Account for points by their number, lowest and highest coordinates (2, 3) and classes."""
        self.count += count
        self.low_m = np.minimum(self.low_m, corners[0])
        self.high_m = np.maximum(self.high_m, corners[1])
        self.classes += np.bincount(classification, minlength=256)

    def merge(self, other: PointAccount) -> None:
        """Account for the points of another one, but for their stored bytes."""
        self.count += other.count
        self.low_m = np.minimum(self.low_m, other.low_m)
        self.high_m = np.maximum(self.high_m, other.high_m)
        self.classes += other.classes

    def add_stored(self, rows: NDArray[Any], each: Each = in_turn) -> None:
        """Account for the bytes of points as the file stores them, (N, ...)."""
        step = POINT_EXPORT.summed
        lacking = -self.summed % step  # rows of the last sum
        if lacking:
            self.sums[-1] = _crc(rows[:lacking], self.sums[-1])
        parts = (rows[at : at + step] for at in range(lacking, len(rows), step))
        self.sums.extend(each(_crc, parts))
        self.summed += len(rows)

    def compare(self, found: PointAccount, name: str, *, within_m: float) -> None:
        """Compare what was meant with what was found in a file.

        Args:
            found: Account of the file, read again.
            name: Of the file, for errors.
            within_m: How far bounds may differ by rounding [m].

        Raises:
            StoreError: With the first difference.
        """
        for what, expected, got in self._differences(found, within_m):
            raise StoreError(
                CodedText(
                    "reread-differs", name=name, what=what, expected=str(expected), got=str(got)
                )
            )

    def _differences(
        self, found: PointAccount, within_m: float
    ) -> Iterator[tuple[str, object, object]]:
        if self.count != found.count:
            yield "points", self.count, found.count
        elif self.count:
            off = np.abs([self.low_m - found.low_m, self.high_m - found.high_m])
            if not (off <= within_m).all():  # also if one is not a number
                meant, got = ((one.low_m.tolist(), one.high_m.tolist()) for one in (self, found))
                yield "bounds", meant, got
        if not np.array_equal(self.classes, found.classes):
            yield "classes", _shown(self.classes), _shown(found.classes)
        if self.crs != found.crs:
            yield "CRS", repr(self.crs[:200]), repr(found.crs[:200])
        if self.sums != found.sums:
            pairs = zip(self.sums, found.sums, strict=False)
            wrong = next((k for k, (a, b) in enumerate(pairs) if a != b), len(found.sums))
            first = wrong * POINT_EXPORT.summed
            yield f"points from number {first} on", "the same", "others"


def _crc(rows: NDArray[Any], before: int = 0) -> int:
    """CRC-32 of the bytes of rows (N, ...) that follow others, by the sum of these."""
    return zlib.crc32(np.ascontiguousarray(rows).view(np.uint8).reshape(-1).data, before)


def _shown(classes: NDArray[np.int64]) -> dict[int, int]:
    return {int(code): int(classes[code]) for code in np.flatnonzero(classes)}
