"""Points by a recipe: columns with any names and units become those that every cloud has."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.point_recipes import PointRecipe, Term
from recon4.recording.clouds.point_fields import NS_TIME
from recon4.recording.formats.point_messages import WHOLE
from recon4.recording.tuning import RECIPES

Column = NDArray[Any]
Columns = Mapping[str, Column]


def as_points(recipe: PointRecipe, lists: Mapping[str, Columns]) -> dict[str, Column]:
    """The columns x, y, z [m] of points, and of time, ring and intensity those that are known.

    Args:
        recipe: What the columns are.
        lists: Lists of points, by name, with their columns (N,); numbers of the message as a whole
            are columns of the list `WHOLE`, (1,).

    Raises:
        CorruptFile: If a column is not there, or no number.
    """
    points = chosen_list(recipe.columns, lists)
    found: dict[str, Column] = {}
    for role, terms in recipe.terms.items():
        parts = [points.column(term.column) for term in terms]
        for term, part in zip(terms, parts, strict=True):
            if part.dtype.kind not in "fiub":
                raise CorruptFile(
                    CodedText(
                        "recipe-no-number", role=role, column=term.column, dtype=str(part.dtype)
                    )
                )
        found[role] = parts[0]
        if role == "time" and terms[0].unit:
            found[role] = _sum_ns(parts, terms)
        elif role not in ("time", "ring", "intensity"):
            found[role] = _scaled(parts[0], terms[0])
    if "range" in found:
        found |= _cartesian(found)
    table = {axis: found[axis].astype(np.float32) for axis in "xyz"}
    table |= {role: found[role] for role in ("ring", "intensity") if role in found}
    if "time" in found:
        table[NS_TIME if recipe.time_has_unit else "time"] = found["time"]
    return table


@dataclass(frozen=True, slots=True)
class PointList:
    """A list of points of a message, and the numbers of the message as a whole."""

    name: str
    columns: Columns
    whole: Columns

    def has(self, wanted: str) -> bool:
        """Whether there is a column, or a number of the message, of a name in a recipe."""
        return self._own(wanted) in self.columns or wanted in self.whole

    @property
    def count(self) -> int:
        """Number of points."""
        return len(next(iter(self.columns.values()), ()))

    def column(self, wanted: str) -> Column:
        """A column, or a number of the message for each of the points, (N,)."""
        found = self.columns.get(self._own(wanted))
        return found if found is not None else np.repeat(self.whole[wanted], self.count)

    def _own(self, wanted: str) -> str:
        return wanted.removeprefix(f"{self.name}.")


def chosen_list(names: Iterable[str], lists: Mapping[str, Columns]) -> PointList:
    """The list of points that has all columns.

    Raises:
        CorruptFile: If none has; it names what is missing.
    """
    wanted = list(names)
    missing = []
    whole = lists.get(WHOLE, {})
    for name, columns in lists.items():
        if name == WHOLE:
            continue
        one = PointList(name, columns, whole)
        absent = [w for w in wanted if not one.has(w)]
        if not absent:
            return one
        missing.append(absent)
    fewest = min(missing, key=len, default=wanted)
    there = ", ".join(key for name, one in lists.items() for key in one if name != WHOLE)
    raise CorruptFile(
        CodedText(
            "recipe-columns-missing",
            missing=", ".join(map(repr, fewest[:5])),
            there=there[:300] or CodedText("found-none"),
        )
    )


def _scaled(column: Column, term: Term) -> Array:
    sign = -1.0 if term.negative else 1.0
    return column.astype(np.float64) * (sign * (term.unit or 1.0))


def _sum_ns(parts: Sequence[Column], terms: Sequence[Term]) -> Column:
    """The sum of columns in nanoseconds, int64; NaN and what no clock shows is far in the past."""
    total = np.zeros(len(parts[0]), np.int64)
    wrong = np.zeros(len(parts[0]), np.bool_)
    for part, term in zip(parts, terms, strict=True):
        with np.errstate(invalid="ignore", over="ignore"):
            wrong |= ~(np.abs(part.astype(np.float64)) * term.unit < RECIPES.latest_ns)
        total += _whole_ns(np.where(wrong, 0, part), term.unit)
    total[wrong] = -RECIPES.latest_ns
    return total


def _whole_ns(values: Column, unit: float) -> Column:
    """Nanoseconds; whole numbers of a whole unit exactly."""
    if values.dtype == np.uint32 and len(values):
        middle = np.sort(values)[len(values) // 2]
        # A counter that begins again inside a cloud goes on.
        values = int(middle) + (values - middle).view(np.int32).astype(np.int64)
    if values.dtype.kind in "iub" and unit.is_integer():
        return values.astype(np.int64) * int(unit)
    whole = np.floor(values.astype(np.float64))
    part = np.rint((values - whole) * unit).astype(np.int64)
    if unit.is_integer():
        return whole.astype(np.int64) * int(unit) + part
    return np.rint(values.astype(np.float64) * unit).astype(np.int64)


def _cartesian(polar: Columns) -> dict[str, Column]:
    """x, y, z of range, azimuth and elevation or zenith."""
    up = polar["elevation"] if "elevation" in polar else np.pi / 2.0 - polar["zenith"]
    flat = polar["range"] * np.cos(up)
    azimuth = polar["azimuth"]
    return {
        "x": flat * np.cos(azimuth),
        "y": flat * np.sin(azimuth),
        "z": polar["range"] * np.sin(up),
    }
