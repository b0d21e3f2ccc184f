"""Control and check points of a finished map: residuals, and what may be said of its accuracy."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import msgspec

from recon4.errors import StoreError
from recon4.evaluation.table import text_table
from recon4.evaluation.tuning import ACCURACY_CLASSES
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Texts, texts
from recon4.untrusted.typed import as_type

Offset = tuple[float | None, float | None, float | None]
_HEAD = "point de dn dh d2 d3 sd-h sd-v redundancy mde-h mde-v w"


class PointTest(msgspec.Struct, frozen=True):
    """What the other control points say of one; None = nothing controls it, or not measured."""

    redundancy: tuple[float, ...]
    w: float
    limit: float
    single_handed: bool
    least_found_h_m: float | None = None
    least_found_v_m: float | None = None


class ControlRow(msgspec.Struct, frozen=True):
    """A point with its residuals, map minus survey: east, north, up [m]; None = not measured."""

    id: str
    role: str
    sd_m: tuple[float, float]
    rigid_m: Offset
    adjusted_m: Offset
    test: PointTest | None = None


class ControlOutcome(msgspec.Struct, frozen=True):
    """``control`` of ``georeference.json``."""

    crs: str
    freedom: int
    scale: float
    points: tuple[ControlRow, ...]
    scale_sd: float | None = None
    sd0: float | None = None
    blunders: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class RoleAccuracy:
    """Residuals of the points of one role [m]; None = measured at no point."""

    role: str
    points: int
    measured_h: int
    """Points that were measured horizontally, in east and north."""
    measured_v: int
    """Points that were measured in height."""
    rmse_h_m: float | None
    """Root mean square of the horizontal length."""
    rmse_v_m: float | None
    rmse_3d_m: float | None
    mean_h_m: float | None
    mean_v_m: float | None
    max_h_m: float | None
    max_v_m: float | None
    survey_h_m: float
    """Horizontal error of the survey and the pick themselves, by length."""
    survey_v_m: float


def control_in(record: Mapping[str, object]) -> ControlOutcome | None:
    """Read ``control`` of a parsed ``georeference.json``; None = there were no control points.

    Raises:
        StoreError: If it is damaged.
    """
    if "control" not in record:
        return None
    try:
        return as_type(record["control"], ControlOutcome)
    except msgspec.ValidationError as error:
        raise StoreError(CodedText("control-unreadable", why=str(error))) from error


def accuracy_of(outcome: ControlOutcome, role: str, *, rigid: bool = False) -> RoleAccuracy:
    """Statistics of the points of one role.

    Args:
        outcome: Of the map.
        role: ``control`` or ``check``.
        rigid: Of the rigid fit, in place of the adjustment.
    """
    own = [one for one in outcome.points if one.role == role]
    off = [one.rigid_m if rigid else one.adjusted_m for one in own]
    flat = [math.hypot(e, n) for e, n, _ in off if e is not None and n is not None]
    up = [abs(u) for _, _, u in off if u is not None]
    space = [
        math.hypot(e, n, u) for e, n, u in off if e is not None and n is not None and u is not None
    ]
    return RoleAccuracy(
        role=role,
        points=len(own),
        measured_h=len(flat),
        measured_v=len(up),
        rmse_h_m=_rms(flat),
        rmse_v_m=_rms(up),
        rmse_3d_m=_rms(space),
        mean_h_m=_mean(flat),
        mean_v_m=_mean(up),
        max_h_m=max(flat, default=None),
        max_v_m=max(up, default=None),
        survey_h_m=math.sqrt(2.0) * (_rms([one.sd_m[0] for one in own]) or 0.0),
        survey_v_m=_rms([one.sd_m[1] for one in own]) or 0.0,
    )


def statements(outcome: ControlOutcome, language: str = ENGLISH) -> list[str]:
    """What may be said of the accuracy: ASPRS Edition 2 (2023), the limits of V, USIBD LOA (2016).

    The error of the survey is part of it (ASPRS Edition 2, 7.11). A map counts as tested from 30
    check points on; with fewer its accuracy is estimated.
    """
    said = texts(language, "report")
    found = accuracy_of(outcome, "check")
    if not found.points:
        return [said.part("statement", "none", {})]
    lines, few = list[str](), list[str]()
    for name, points, rmse_m, survey_m in (
        ("horizontal", found.measured_h, found.rmse_h_m, found.survey_h_m),
        ("vertical", found.measured_v, found.rmse_v_m, found.survey_v_m),
    ):
        if points < ACCURACY_CLASSES.tested_points:
            few.append(said.part("statement", f"few-{name}", {"points": points}))
        if rmse_m is not None:
            tested = points >= ACCURACY_CLASSES.tested_points
            values = {
                "total": 100.0 * math.hypot(rmse_m, survey_m),
                "points": points,
                "survey": 100.0 * survey_m,
            }
            lines.append(
                said.part("statement", f"{'tested' if tested else 'estimated'}-{name}", values)
            )
    if few:
        both = said.part("statement", "and", {"one": few[0], "other": few[-1]})
        all_few = both if len(few) > 1 else few[0]
        of = ACCURACY_CLASSES.tested_points
        lines.append(said.part("statement", "untested", {"few": all_few, "of": of}))
    return [*lines, *_walk_limits(found, said), *_level_of_accuracy(found, said)]


def outcome_text(
    outcome: ControlOutcome, language: str = ENGLISH, blunders: Sequence[str] | None = None
) -> str:
    """Residuals and tests as tables for a terminal, in centimeters.

    Args:
        outcome: Of the map.
        language: Of its texts.
        blunders: Suspected ones in this language; None = as the outcome has them.
    """
    say = _table_words(language)
    rows = [
        (
            f"{one.id} ({say(one.role, {})})",
            *_cells(*one.adjusted_m, _length(one.adjusted_m[:2]), _length(one.adjusted_m), say=say),
            *_cells(*one.sd_m, say=say),
            *_test_cells(one.test, say),
        )
        for one in outcome.points
    ]
    figures = [
        (
            f"{say(found.role, {})}, {found.points}",
            *_cells(found.rmse_h_m, found.rmse_v_m, found.rmse_3d_m, say=say),
            *_cells(found.max_h_m, found.max_v_m, say=say),
        )
        for found in (accuracy_of(outcome, role) for role in ("control", "check"))
        if found.points
    ]
    names = ("role-points", "rmse-h", "rmse-v", "rmse-3d", "max-h", "max-v")
    sd = "" if outcome.scale_sd is None else f" ± {1e6 * outcome.scale_sd:.0f}"
    known: dict[str, str | int | float] = {
        "crs": outcome.crs,
        "freedom": outcome.freedom,
        "scale": f"{1e6 * (outcome.scale - 1.0):+z.0f}{sd}",
    }
    found = outcome.blunders if blunders is None else blunders
    return "\n".join(
        [
            text_table((*(say(name, {}) for name in _HEAD.split()), ""), rows),
            text_table(tuple(say(name, {}) for name in names), figures),
            say("known", known),
            *remarks(outcome, language),
            *(say("suspected", {"text": text}) for text in found),
        ]
    )


_Say = Callable[[str, Mapping[str, str | int | float]], str]


def remarks(outcome: ControlOutcome, language: str = ENGLISH) -> list[str]:
    """What is said of all points: residuals beyond chance, and `statements`."""
    return [*_beyond_chance(outcome, _table_words(language)), *statements(outcome, language)]


def said_of_test(test: PointTest | None, language: str = ENGLISH) -> str:
    """What the other points say of one, in a word; empty = nothing is wrong."""
    said = _verdict_of(test)
    return _table_words(language)(said, {}) if said else ""


def _table_words(language: str) -> _Say:
    return partial(texts(language, "report").part, "control-table")


def _verdict_of(test: PointTest | None) -> str:
    if test is None:
        return ""
    return "blunder" if test.w > test.limit else "single-handed" if test.single_handed else ""


def _beyond_chance(outcome: ControlOutcome, say: _Say) -> Sequence[str]:
    """A sentence if the residuals of control points are larger than stated, at 0.1 %."""
    from scipy.special import chdtri  # slow to import

    rows = sum(len(one.test.redundancy) for one in outcome.points if one.test)
    free = rows - outcome.freedom
    if outcome.sd0 is None or free <= 0:
        return ()
    limit = math.sqrt(chdtri(free, ACCURACY_CLASSES.significance) / free)
    values = {"sd0": outcome.sd0, "limit": limit}
    return (say("beyond-chance", values),) if outcome.sd0 > limit else ()


def _test_cells(test: PointTest | None, say: _Say) -> tuple[str, ...]:
    if test is None:
        return ("", "", "", "", "")
    r = "/".join(say("redundancy-of", {"value": value}) for value in test.redundancy)
    found = _cells(test.least_found_h_m, test.least_found_v_m, say=say)
    said = _verdict_of(test)
    ratio = say("w-of", {"w": test.w, "limit": test.limit})
    return (r, *found, ratio, say(said, {}) if said else "")


def _walk_limits(found: RoleAccuracy, said: Texts) -> Sequence[str]:
    """Limits of V §3.3: mean 14 cm and 12 cm, largest 28 cm and 24 cm."""
    given = (found.mean_h_m, found.mean_v_m, found.max_h_m, found.max_v_m)
    limits = ACCURACY_CLASSES.walk_limits_m
    known = [(one, limit) for one, limit in zip(given, limits, strict=True) if one is not None]
    if not known:
        return ()
    shown = ", ".join(
        said.part("statement", "of", {"value": 100.0 * one, "limit": 100.0 * limit})
        for one, limit in known
    )
    holds = all(one <= limit for one, limit in known)
    return (said.part("statement", "within" if holds else "outside", {"figures": shown}),)


def _level_of_accuracy(found: RoleAccuracy, said: Texts) -> Sequence[str]:
    if found.rmse_3d_m is None:
        return ()
    total_m = math.hypot(found.rmse_3d_m, found.survey_h_m, found.survey_v_m)
    most_m = 2.0 * total_m
    level = "LOA10"
    for name, limit_m in ACCURACY_CLASSES.loa_m:
        if most_m <= limit_m:
            level = name
    return (said.part("statement", "level", {"most": 100.0 * most_m, "level": level}),)


def _length(offset: Sequence[float | None]) -> float | None:
    known = [one for one in offset if one is not None]
    return math.hypot(*known) if len(known) == len(offset) else None


def _rms(values: Sequence[float]) -> float | None:
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else None


def _mean(values: Sequence[float]) -> float | None:
    return sum(values) / len(values) if values else None


def _cells(*values_m: float | None, say: _Say) -> tuple[str, ...]:
    return tuple("–" if one is None else say("cm", {"value": 100.0 * one}) for one in values_m)
