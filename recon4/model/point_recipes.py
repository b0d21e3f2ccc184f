"""Recipes: which columns of points of an unknown maker are coordinates, times and intensities.

In a rig file a recipe is ``fields = { x = "px:mm", …, time = "stamp:us" }`` of a sensor, or the
table ``[sensor.fields]``; on the command line ``--fields x=px:mm,…,time=stamp:us``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.limits import RIG_LIMITS
from recon4.model.toml_tables import TomlTable

Units = Mapping[str, float]
"""Unit -> meters, radians or nanoseconds."""
LENGTHS: Units = {"m": 1.0, "cm": 0.01, "mm": 0.001}
ANGLES: Units = {"rad": 1.0, "deg": float(np.pi / 180.0)}
TIMES: Units = {"s": 1e9, "ms": 1e6, "us": 1e3, "ns": 1.0}
NUMBERED = {"m": LENGTHS, "deg": ANGLES, "s": TIMES}
"""A number in place of a unit is a multiple of this one: ``distance:0.004`` has steps of 4 mm."""
UNITS_OF: Mapping[str, Units] = {
    **dict.fromkeys(("x", "y", "z", "range"), LENGTHS),
    **dict.fromkeys(("azimuth", "elevation", "zenith"), ANGLES),
    "time": TIMES,
    "ring": {},
    "intensity": {},
}
"""Each role of a column, and its units; azimuth counterclockwise from x, elevation up from the x-y
plane, zenith down from z."""
PLACES = (
    ("x", "y", "z"),
    ("range", "azimuth", "elevation"),
    ("range", "azimuth", "zenith"),
)
"""Columns that say where a point is: one of these."""
_TERM = re.compile(r"(-?)([^\s:+,=-][^\s:+,=]{0,99})(?::([^\s:+,=]{1,20}))?")


@dataclass(frozen=True, slots=True)
class Term:
    """One column of a role; several are added."""

    column: str
    """Name, lower case, as ``px``; of one of several lists ``second.px``."""
    unit: float = 0.0
    """Meters, radians or nanoseconds of one; 0 = not said."""
    negative: bool = False
    """Whether the axis points the other way."""


@dataclass(frozen=True, slots=True)
class PointRecipe:
    """Which columns of points are what."""

    texts: tuple[tuple[str, str], ...]
    """Role and column as declared, in the order of `UNITS_OF`."""
    terms: Mapping[str, tuple[Term, ...]]
    """Role -> its columns."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of all columns, lower case."""
        return tuple(term.column for terms in self.terms.values() for term in terms)

    @property
    def time_has_unit(self) -> bool:
        """Whether the unit of the times is said; else the duration of clouds tells it."""
        return bool(self.terms.get("time")) and self.terms["time"][0].unit > 0.0

    @property
    def has_lengths(self) -> bool:
        """Whether the unit of the coordinates is said."""
        return any(self.terms[role][0].unit for role in ("x", "range") if role in self.terms)

    def text(self) -> str:
        """As on the command line."""
        return ",".join(f"{role}={text}" for role, text in self.texts)

    def toml(self) -> str:
        """As a line of a rig file."""
        pairs = (f"{role} = {json.dumps(text, ensure_ascii=False)}" for role, text in self.texts)
        return f"fields = {{ {', '.join(pairs)} }}"


def parse_fields(value: object, where: str) -> PointRecipe | None:
    """Read the table ``[sensor.fields]`` of a rig file; None = there is none.

    Raises:
        ConfigError: Names the role, the expected and the found value.
    """
    if value is None:
        return None
    table = TomlTable.of(value, where, set(UNITS_OF))
    texts = {role: table.text(role) for role in UNITS_OF if role in table}
    return recipe_of(texts, where)


def parse_fields_text(text: str, where: str) -> PointRecipe:
    """Read ``x=px,y=py,z=pz,time=stamp:us``.

    Raises:
        ConfigError: Names the part, the expected and the found value.
    """
    texts: dict[str, str] = {}
    for part in text.split(","):
        role, equals, column = (one.strip() for one in part.partition("="))
        if not equals or role not in UNITS_OF:
            raise ConfigError(
                CodedText(
                    "recipe-form", where=where, roles=", ".join(UNITS_OF), got=f"{part[:80]!r}"
                )
            )
        if role in texts:
            raise ConfigError(CodedText("recipe-twice", where=where, role=role))
        texts[role] = column
    return recipe_of(texts, where)


def recipe_of(texts: Mapping[str, str], where: str) -> PointRecipe:
    """A recipe of roles and columns.

    Args:
        texts: Role -> column with unit, as ``px:mm``.
        where: File and sensor, for errors.

    Raises:
        ConfigError: If a column or unit makes no sense, or the places of points are not complete.
    """
    terms = {role: _terms(role, texts[role], where) for role in UNITS_OF if role in texts}
    given = {role for places in PLACES for role in places if role in terms}
    if given not in [set(places) for places in PLACES]:
        wanted = "; ".join(", ".join(places) for places in PLACES)
        got = ", ".join(role for role in UNITS_OF if role in given)
        raise ConfigError(CodedText("recipe-places", where=where, wanted=wanted, got=got or "–"))
    names = [term.column for parts in terms.values() for term in parts]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ConfigError(CodedText("recipe-two-roles", where=where, column=f"{twice[0]!r}"))
    return PointRecipe(tuple((role, texts[role]) for role in terms), terms)


def _terms(role: str, text: str, where: str) -> tuple[Term, ...]:
    parts = [part.strip() for part in text.split("+")]
    found = tuple(_term(role, part, f"{where}: {role}") for part in parts)
    are_sum = (
        role == "time" and len(found) <= RIG_LIMITS.time_terms and all(term.unit for term in found)
    )
    if len(found) > 1 and not are_sum:
        raise ConfigError(
            CodedText(
                "recipe-one-column",
                where=where,
                role=role,
                limit=RIG_LIMITS.time_terms,
                got=f"{text[:80]!r}",
            )
        )
    return found


def _term(role: str, text: str, where: str) -> Term:
    match = _TERM.fullmatch(text)
    if match is None:
        raise ConfigError(CodedText("recipe-column", where=where, got=f"{text[:80]!r}"))
    sign, column, unit = match.groups()
    if sign and role in ("range", "time", "ring", "intensity"):
        raise ConfigError(CodedText("recipe-negative", where=where, got=f"{text[:80]!r}"))
    return Term(column.lower(), _unit(role, unit, where) if unit else 0.0, bool(sign))


def _unit(role: str, unit: str, where: str) -> float:
    units = UNITS_OF[role]
    if unit in units:
        return units[unit]
    base = next((name for name, table in NUMBERED.items() if table is units), "")
    try:
        number = float(unit) if base else 0.0
    except ValueError:
        number = 0.0
    if not 1e-9 <= number <= 1e3:
        code = "recipe-unit" if base else "recipe-no-unit"
        known = {"units": ", ".join(units), "base": base} if base else {}
        raise ConfigError(CodedText(code, where=where, got=repr(unit), **known))
    return number * units[base]
