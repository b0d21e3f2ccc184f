"""Control and check points in the report for the client."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from functools import cache

from recon4.evaluation.site_control import (
    ControlOutcome,
    ControlRow,
    accuracy_of,
    control_in,
    statements,
)
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import texts
from recon4.model.site_control import SITE_GRID
from recon4.report.client import Row, Section, Table
from recon4.report.client_front import grouped, shown
from recon4.report.client_words import Words
from recon4.report.tuning import CLIENT_REPORT


def control_section(georeference: Mapping[str, object], words: Words) -> Section:
    """Residuals of all points, their tests, and what may be said of the accuracy.

    Args:
        georeference: Contents of ``georeference.json``.
        words: The catalog.
    """
    title = words("section.control")
    outcome = control_in(georeference)
    if outcome is None:
        return Section(title=title)
    sd = "" if outcome.scale_sd is None else f" ± {words.number(1e6 * outcome.scale_sd, 0)}"
    scale = words("control.scale_value", ppm=f"{1e6 * (outcome.scale - 1.0):+z.0f}", sd=sd)
    grid = outcome.crs == SITE_GRID
    rows = [
        Row(words("control.crs"), words("control.crs_site") if grid else shown(outcome.crs)),
        Row(words("control.freedom"), str(outcome.freedom)),
        Row(words("control.scale"), scale),
        *(
            Row("" if k else words("control.statement"), text)
            for k, text in enumerate(statements(outcome, words.language))
        ),
        *(
            Row(words("control.blunder"), shown(blunder_in(text, words)))
            for text in outcome.blunders
        ),
    ]
    found = [one for one in (_points(outcome, words), _roles(outcome, words)) if one.rows]
    left = len(outcome.points) - CLIENT_REPORT.most_points
    more = (words("control.more", count=str(left)),) if left > 0 else ()
    text = (words("text.control"), *more)
    return Section(title=title, text=text, rows=tuple(rows), tables=tuple(found))


def _points(outcome: ControlOutcome, words: Words) -> Table:
    """Each point with its residual, what its role is, and how well the others control it."""
    names = ("point", "role", "de", "dn", "dh", "d2", "d3", "mde_h", "mde_v", "test")
    rows = tuple(_row(one, words) for one in outcome.points[: CLIENT_REPORT.most_points])
    return Table(head=tuple(words(f"control.{one}") for one in names), rows=rows, texts=(1, 9))


def _row(one: ControlRow, words: Words) -> tuple[str, ...]:
    test = one.test
    least = (None, None) if test is None else (test.least_found_h_m, test.least_found_v_m)
    said = ""
    if test is not None and test.w > test.limit:
        said = words(
            "control.suspected", w=words.number(test.w, 1), limit=words.number(test.limit, 1)
        )
    elif test is not None and test.single_handed:
        said = words("control.single_handed")
    lengths = (_length(one.adjusted_m[:2]), _length(one.adjusted_m))
    return (
        shown(one.id),
        words(f"control.{one.role}"),
        *(_cm(value, words) for value in (*one.adjusted_m, *lengths, *least)),
        said,
    )


def _roles(outcome: ControlOutcome, words: Words) -> Table:
    """RMSE and largest residual of the points of each role."""
    names = ("role", "points", "rmse_h", "rmse_v", "rmse_3d", "max_h", "max_v")
    found = [accuracy_of(outcome, role) for role in ("control", "check")]
    rows = tuple(
        (
            words(f"control.{one.role}"),
            grouped(one.points),
            *(
                _cm(value, words)
                for value in (one.rmse_h_m, one.rmse_v_m, one.rmse_3d_m, one.max_h_m, one.max_v_m)
            ),
        )
        for one in found
        if one.points
    )
    return Table(head=tuple(words(f"control.{one}") for one in names), rows=rows)


def _length(offset: Sequence[float | None]) -> float | None:
    known = [one for one in offset if one is not None]
    return math.hypot(*known) if len(known) == len(offset) else None


def _cm(value_m: float | None, words: Words) -> str:
    return "–" if value_m is None else words.number(value_m, 1, 100.0)


_VALUES = ("names", "offset", "length", "east", "north", "up")
_SENTENCES = ("feet", "feet-up", "axes", "names", "point", "offset", "contradiction")


def blunder_in(text: str, words: Words) -> str:
    """A suspected blunder in the words of a language; one of another version as it is."""
    if words.language == ENGLISH:
        return text
    for part in _SENTENCES:
        if found := _pattern(part).fullmatch(text):
            values = found.groupdict()
            if "names" in values:
                values["names"] = values["names"].replace(_and(ENGLISH), _and(words.language))
            if "offset" in values:
                values["offset"] = _offset_in(values["offset"], words)
            return words(f"blunder.{part}", **values)
    return text


def _offset_in(text: str, words: Words) -> str:
    for part in ("far", "offset-of"):
        if found := _pattern(part).fullmatch(text):
            values = {name: words.decimal(value) for name, value in found.groupdict().items()}
            return words(f"blunder.{part}", **values)
    return text


def _and(language: str) -> str:
    return texts(language, "report").part("blunder", "and", {})


@cache
def _pattern(part: str) -> re.Pattern[str]:
    """The English text of a part, with a group for each value."""
    said = texts(ENGLISH, "report").part("blunder", part, {name: f"<{name}>" for name in _VALUES})
    groups = re.sub(r"<(\w+)>", r"(?P<\1>.+)", re.escape(said))
    return re.compile(groups)
