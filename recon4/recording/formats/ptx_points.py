"""Points of PTX files: scans as text, each with a grid and the pose of its scanner."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import BinaryIO

import numpy as np

from recon4.errors import CorruptFile, RecordingError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.recording.formats.las_records import CHUNK, MAX_POINTS
from recon4.recording.limits import LIMITS
from recon4.untrusted.bounded import open_regular

_LINE_BYTES = 512
_WIDTHS = (3, 3, 3, 3, 4, 4, 4, 4)
"""Numbers in each line of a head behind columns and rows: position, axes, transformation."""
_COUNT = re.compile(rb"\s*([1-9]\d{0,9})\s*")


@dataclass(frozen=True, slots=True)
class _TextScan:
    """A scan whose points are next in a file."""

    file: BinaryIO
    where: str
    """File and number of the scan, for errors."""

    def transformation(self) -> Array:
        """Of row vectors, (4, 4)."""
        head = [self._numbers(self._line(), width) for width in _WIDTHS]
        matrix = np.stack(head[4:])
        if not np.isfinite(matrix).all():
            raise CorruptFile(CodedText("ptx-not-finite", where=self.where))
        turn = matrix[:3, :3]
        skew = turn @ turn.T - np.eye(3) if np.abs(turn).max() < 2.0 else turn
        if np.abs(skew).max() > LIMITS.ptx_skew or np.linalg.det(turn) < 0.0:
            raise CorruptFile(CodedText("ptx-no-rotation", where=self.where))
        return matrix

    def count(self, line: bytes) -> int:
        """Columns or rows."""
        found = _COUNT.fullmatch(line)
        if not found:
            raise CorruptFile(CodedText("ptx-size", where=self.where, line=repr(line)))
        return int(found[1])

    def points(self, count: int) -> Iterator[Array]:
        """Its points in the frame of the scanner, without those that had no return, (N, 3)."""
        for first in range(0, count, CHUNK):
            want = min(CHUNK, count - first)
            lines = list(islice(iter(self._line, b""), want))
            if len(lines) < want:
                got = first + len(lines)
                raise CorruptFile(CodedText("ptx-points", where=self.where, count=count, got=got))
            try:
                xyz = np.loadtxt(lines, ndmin=2, usecols=(0, 1, 2))
            except ValueError as error:
                raise CorruptFile(
                    CodedText("ptx-no-numbers", where=self.where, why=str(error))
                ) from error
            if len(xyz) != want:
                raise CorruptFile(
                    CodedText("ptx-lines", where=self.where, want=want, count=len(xyz))
                )
            yield xyz[(xyz != 0.0).any(axis=1)]

    def _line(self) -> bytes:
        line = self.file.readline(_LINE_BYTES)
        if len(line) == _LINE_BYTES:
            raise CorruptFile(CodedText("ptx-line-long", where=self.where, line_bytes=_LINE_BYTES))
        return line

    def _numbers(self, line: bytes, width: int) -> Array:
        try:
            numbers = np.array([float(word) for word in line.split()])
        except ValueError:
            numbers = np.empty(0)
        if len(numbers) != width:
            raise CorruptFile(CodedText("ptx-head", where=self.where, width=width, line=repr(line)))
        return numbers


def ptx_points(path: Path) -> Iterator[Array]:
    """Points of all scans in the coordinates of the file, float64 (N, 3) at a time.

    Raises:
        CorruptFile: If a scan is cut or is no text of numbers.
        RecordingError: If it cannot be opened, or promises too many points.
    """
    with open_regular(path, failure=RecordingError) as file:
        number, promised = 0, 0
        while line := file.readline(_LINE_BYTES):
            if not line.strip():
                continue
            number += 1
            scan = _TextScan(file, f"{path.name}, scan {number}")
            count = scan.count(line) * scan.count(file.readline(_LINE_BYTES))
            promised += count
            if promised > MAX_POINTS:
                raise RecordingError(
                    CodedText("ptx-many", where=scan.where, max_points=MAX_POINTS // 10**6)
                )
            matrix = scan.transformation()
            for xyz in scan.points(count):
                yield xyz @ matrix[:3, :3] + matrix[3, :3]
