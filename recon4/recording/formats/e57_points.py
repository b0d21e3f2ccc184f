"""Points of an E57 file, piece by piece: all scans, in the coordinates of the file.

pye57 itself reads a scan at once, which takes a hundred bytes of memory a point.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from recon4.errors import CorruptFile
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.recording.formats.e57_xml import check_e57_xml

_FORMS = ("cartesian", ("X", "Y", "Z")), ("spherical", ("Range", "Azimuth", "Elevation"))
"""Beginnings of the names of fields, and their ends."""


class E57Points:
    """The points of a file that is open."""

    def __init__(self, path: Path) -> None:
        """Open a file, and count its points.

        Raises:
            CorruptFile: If it is damaged.
        """
        import pye57
        from pye57.libe57 import E57Exception

        check_e57_xml(path)
        self._name = path.name
        self._damage = (E57Exception, RuntimeError, ValueError, KeyError, AttributeError, OSError)
        try:
            self._file = pye57.E57(str(path))
            self._scans = [self._file.get_header(k) for k in range(self._file.scan_count)]
            self.promised = sum(int(scan.point_count) for scan in self._scans)
        except self._damage as error:
            raise self._unsound(error) from error

    def chunks(self, rows: int) -> Iterator[Array]:
        """Valid points as float64 (N, 3), at most ``rows`` at a time.

        Raises:
            CorruptFile: If the file is damaged, or a scan has no coordinates.
        """
        try:
            for number, scan in enumerate(self._scans):
                if scan.point_count:
                    yield from self._scan(number, scan, rows)
        except self._damage as error:
            raise self._unsound(error) from error

    def _scan(self, number: int, scan: Any, rows: int) -> Iterator[Array]:
        form, axes = self._form(number, scan)
        invalid = f"{form}InvalidState"
        fields = [*axes, *([invalid] if invalid in scan.point_fields else [])]
        data, buffers = self._file.make_buffers(fields, min(rows, scan.point_count))
        reader = scan.points.reader(buffers)
        got = 0
        while count := reader.read():
            got += count
            if got > scan.point_count:
                raise CorruptFile(CodedText("e57-more-points", name=self._name, number=number))
            points = np.column_stack([data[axis][:count] for axis in axes]).astype(np.float64)
            if invalid in fields:
                points = points[data[invalid][:count] == 0]
            yield self._placed(points, scan, form)
        reader.close()

    def _form(self, number: int, scan: Any) -> tuple[str, Sequence[str]]:
        for form, ends in _FORMS:
            axes = [f"{form}{end}" for end in ends]
            if set(axes) <= set(scan.point_fields):
                return form, axes
        raise CorruptFile(
            CodedText(
                "e57-coordinates",
                name=self._name,
                number=number,
                point_fields=str(sorted(scan.point_fields)[:20]),
            )
        )

    def _placed(self, points: Array, scan: Any, form: str) -> Array:
        from pye57.utils import convert_spherical_to_cartesian

        if form == "spherical":
            points = convert_spherical_to_cartesian(points)
        if scan.has_pose():
            points = self._file.to_global(points, scan.rotation, scan.translation)
        return np.ascontiguousarray(points)

    def _unsound(self, error: Exception) -> CorruptFile:
        said = (str(error) or repr(error)).splitlines()[0]  # below it: places in the library
        return CorruptFile(CodedText("e57-unsound", name=self._name, why=said))
