"""Proposes a recipe for points with unknown columns, by their names and by their values."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.point_recipes import (
    ANGLES,
    LENGTHS,
    PLACES,
    TIMES,
    UNITS_OF,
    PointRecipe,
    Units,
    recipe_of,
)
from recon4.recording.clouds.point_fields import (
    EXACT_TIME,
    INTENSITY_FIELDS,
    RING_FIELDS,
    TIME_FIELDS,
    find_field,
)
from recon4.recording.formats.point_messages import WHOLE
from recon4.recording.recipes.apply import Columns
from recon4.recording.report import ImportReport
from recon4.recording.tuning import LISTED, RECIPES

_NAMES: Mapping[str, tuple[str, ...]] = {
    "x": ("x", "px", "posx", "xpos", "cx", "forward"),
    "y": ("y", "py", "posy", "ypos", "cy", "left"),
    "z": ("z", "pz", "posz", "zpos", "cz", "up"),
    "range": ("range", "r", "distance", "dist", "depth", "rho"),
    "azimuth": ("azimuth", "az", "azi", "azimuthangle", "hangle", "horizontalangle", "yaw"),
    "elevation": ("elevation", "el", "ele", "elev", "elevationangle", "vangle", "verticalangle",
                  "altitude", "pitch"),
    "zenith": ("zenith", "polar", "zenithangle", "polarangle"),
    "time": ("time", "t", "timestamp", "stamp", "timeoffset", "offsettime", "toffset", "offset",
             "relativetime", "pointtime", "gpstime", "ts", "dt", "curvature"),
    "ring": ("ring", "channel", "line", "laserid", "beam", "laser", "beamid", "ringid", "channelid",
             "lineid", "layer", "scanid", "row", "ch"),
    "intensity": ("intensity", "i", "reflectivity", "refl", "reflectance", "remission", "signal",
                  "amplitude", "amp", "strength", "power", "rssi", "energy", "echostrength"),
}  # fmt: skip
"""Names of columns without blanks between words, unit and prefix; the first match wins."""
_DOUBTFUL = {"forward", "left", "up", "r", "yaw", "pitch", "depth", "altitude", "offset", "dt",
             "curvature", "row", "i", "power"}  # fmt: skip
"""Names that often mean something else."""
_PREFIXES = {"p", "pt", "pos", "position", "point", "coord", "coords", "cartesian", "xyz", "polar"}
_WORDS = {"sec": "s", "secs": "s", "seconds": "s", "usec": "us", "nsec": "ns", "nanosec": "ns",
          "msec": "ms", "nanoseconds": "ns", "microseconds": "us", "degrees": "deg",
          "radians": "rad", "degree": "deg"}  # fmt: skip
_JOINED = re.compile(
    r"(\w+?)(nanosec|nsec|usec|msec|secs?|seconds|nanoseconds|microseconds|ns|us|ms)"
)
"""A name with its unit, as ``timestampNsec``: the fields of clouds are in lower case."""
_SUFFIXES = {*LENGTHS, *ANGLES, *TIMES}


Doubt = dict[str, Value]
"""Values of `DerivedKind.COLUMN_UNCERTAIN`: role and column, and what is uncertain about them."""


@dataclass(frozen=True, slots=True)
class Proposal:
    """A recipe for points, as far as names and values show it."""

    recipe: PointRecipe | None
    """None = no columns say where the points are."""
    columns: tuple[str, ...]
    """Names of all columns of the list that looks most like points."""
    uncertain: tuple[Doubt, ...] = ()
    """What a person should look at."""

    @property
    def is_of_lidar(self) -> bool:
        """Whether there is something that a LiDAR measures besides places."""
        roles = set(self.recipe.terms) if self.recipe else set()
        return not roles.isdisjoint({"time", "ring", "intensity"})

    def with_doubts(self, texts: Sequence[str]) -> Proposal:
        """The proposal with texts of a check that it does not pass."""
        more: list[Doubt] = [{"detail": one} for one in texts]
        return replace(self, uncertain=(*self.uncertain, *more))


@dataclass(slots=True)
class _Draft:
    """Roles found so far."""

    texts: dict[str, str] = field(default_factory=dict)
    uncertain: list[Doubt] = field(default_factory=list)


def propose(name: str, lists: Mapping[str, Columns], period_s: float) -> Proposal:
    """The best recipe for points.

    Args:
        name: Topic or file, for messages.
        lists: Lists of points of a message or file, as for `as_points`.
        period_s: Usual time from one to the next [s]; NaN = not known.
    """
    found = [
        _of_list(name, columns, period_s)
        for key, columns in lists.items()
        if key != WHOLE and _count(columns) >= RECIPES.fewest_points
    ]
    none = Proposal(None, tuple(k for key, c in lists.items() if key != WHOLE for k in c))
    return max(found, key=lambda one: len(one.recipe.terms) if one.recipe else 0, default=none)


_COMMON = {"time": (EXACT_TIME, *TIME_FIELDS), "ring": RING_FIELDS, "intensity": INTENSITY_FIELDS}


def proposal_values(proposal: Proposal) -> dict[str, Value]:
    """A proposal as values of `DerivedKind.COLUMNS_UNKNOWN`."""
    if proposal.recipe is None:
        names = ", ".join(column[:40] for column in proposal.columns[: LISTED.names])
        return {"columns": names}
    return {"recipe": proposal.recipe.toml()}


def say_doubts(name: str, proposal: Proposal, report: ImportReport) -> None:
    """State what a person should look at before a recipe is used.

    Args:
        name: Topic or file.
        proposal: The recipe.
        report: Receives it.
    """
    for doubt in proposal.uncertain:
        report.derive(DerivedKind.COLUMN_UNCERTAIN, where=name, **doubt)


def say_overlooked(
    name: str, proposal: Proposal, columns: Columns, *, report: ImportReport
) -> None:
    """State which columns of points that are read look like what is missing otherwise.

    Args:
        name: Topic or file.
        proposal: For the same columns.
        columns: With the common names x, y, z.
        report: Receives them, with a recipe.
    """
    recipe = proposal.recipe
    if recipe is None:
        return
    more = [r for r in _COMMON if r in recipe.terms and not find_field(columns, _COMMON[r])]
    if not more:
        return
    texts = dict(recipe.texts)
    report.derive(
        DerivedKind.COLUMNS_OVERLOOKED,
        where=name,
        columns=", ".join(f"{role} = {texts[role]}" for role in more),
        recipe=recipe.toml(),
    )
    say_doubts(name, proposal, report)


def _count(columns: Columns) -> int:
    return len(next(iter(columns.values()), ()))


def _of_list(name: str, columns: Columns, period_s: float) -> Proposal:
    draft = _Draft()
    by_role = {role: _candidates(role, columns) for role in UNITS_OF}
    places = next((p for p in PLACES if all(by_role[role] for role in p)), ())
    for role in (*places, "time", "ring", "intensity"):
        if by_role[role]:
            together = (
                [by_role[axis][0] for axis in places] if role in "xyz" else [by_role[role][0]]
            )
            values = np.linalg.norm([columns[one].astype(np.float64) for one in together], axis=0)
            _add(draft, role, by_role[role], values=values, period_s=period_s)
    if "time" not in draft.texts:
        draft.uncertain.append({"untimed": True})
    try:
        recipe = recipe_of(draft.texts, name) if places else None
    except ConfigError:  # names that a recipe cannot have
        recipe = None
    return Proposal(recipe, tuple(columns), tuple(draft.uncertain) if recipe else ())


def _split(column: str) -> tuple[str, str]:
    """Core of a name, and the unit it ends with; ``pos_x_mm`` is x and mm."""
    words = [word for word in re.split(r"[._\s]+", column.lower()) if word]
    if words and (joined := _JOINED.fullmatch(words[-1])) and joined[1] in _NAMES["time"]:
        words = [*words[:-1], joined[1], joined[2]]
    unit = ""
    if len(words) == 1 and _WORDS.get(words[0]) in TIMES:
        return "time", _WORDS[words[0]]
    if len(words) > 1:
        last = _WORDS.get(words[-1], words[-1])
        if last in _SUFFIXES:
            unit, words = last, words[:-1]
    while len(words) > 1 and words[0] in _PREFIXES:
        words = words[1:]
    return "".join(words), unit


def _candidates(role: str, columns: Columns) -> list[str]:
    """Columns that may have a role, the best name first."""
    rank = {alias: k for k, alias in enumerate(_NAMES[role])}
    found = []
    for column, values in columns.items():
        core, unit = _split(column)
        fits = not unit or not UNITS_OF[role] or unit in UNITS_OF[role]
        if core in rank and fits and values.dtype.kind in "fiu":
            found.append((rank[core], column))
    return [column for _, column in sorted(found)]


def _add(draft: _Draft, role: str, found: list[str], *, values: Array, period_s: float) -> None:
    """Add a role with its unit, and what is uncertain about it.

    Args:
        draft: Receives it.
        role: The role.
        found: Columns that may have it, the best one first.
        values: Of that column, absolute; of x, y and z together, as they have one unit.
        period_s: Usual time from cloud to cloud [s].
    """
    column = found[0]
    core, unit = _split(column)
    if core in _DOUBTFUL:
        draft.uncertain.append({"role": role, "column": column, "doubtful": True})
    if role == "time" and (parts := _seconds_and_rest(found)):
        draft.texts[role] = "+".join(parts)
        return
    if len(found) > 1:
        others = ", ".join(found[1:4])
        draft.uncertain.append({"role": role, "column": column, "others": others})
    known = unit
    if UNITS_OF[role] and not unit:
        unit = _unit_by_values(role, values, period_s)
    if UNITS_OF[role] and not known and unit not in ("m", "rad"):
        by_values: Doubt = {"unit": unit} if unit else {"no_unit": True}
        draft.uncertain.append({"role": role, "column": column, **by_values})
    draft.texts[role] = column + (f":{unit}" if unit and unit != "m" else "")


def _seconds_and_rest(found: list[str]) -> list[str]:
    """Two columns that are seconds and nanoseconds of one time, with their units; none = not so."""
    by_unit = {_split(column)[1]: column for column in found}
    if {"s", "ns"} <= by_unit.keys() and _split(by_unit["s"])[0] == _split(by_unit["ns"])[0]:
        return [f"{by_unit['s']}:s", f"{by_unit['ns']}:ns"]
    return []


def _unit_by_values(role: str, values: Array, period_s: float) -> str:
    """The unit in which values are plausible; empty = none is, or several are."""
    numbers = values[np.isfinite(values)]
    if not len(numbers):
        return ""
    if UNITS_OF[role] is LENGTHS:
        return _length_unit(numbers)
    if UNITS_OF[role] is ANGLES:
        return _angle_unit(numbers)
    span = float(np.ptp(np.percentile(numbers, [2, 98])))
    return _time_unit(TIMES, span, period_s)


def _length_unit(numbers: Array) -> str:
    usual = float(np.median(np.abs(numbers[numbers != 0.0]))) if numbers.any() else 0.0
    for unit in ("m", "mm"):
        if RECIPES.nearest_m <= usual * LENGTHS[unit] <= RECIPES.farthest_m:
            return unit
    return "m" if usual < RECIPES.nearest_m else "mm"


def _angle_unit(numbers: Array) -> str:
    widest = float(np.abs(numbers).max())
    if widest <= 2.0 * np.pi + RECIPES.angle_tolerance_rad:
        return "rad"
    for unit in (1.0, 0.1, 0.01, 0.001):
        if widest * unit <= 361.0:
            return "deg" if unit == 1.0 else f"{unit:g}"
    return ""


def _time_unit(units: Units, span: float, period_s: float) -> str:
    low, high = RECIPES.cloud_periods
    found = [n for n, unit in units.items() if low <= span * unit * 1e-9 / period_s <= high]
    return found[0] if len(found) == 1 else ""
