"""The kinds of findings for people: ``recon4 explain`` and ``docs/reference/findings.md``.

``measured.toml`` is written with ``python -m tests.benchmarks.precision RUNS --toml NAME``; each
source is one set of runs. An *alarm* makes the verdict worse than good. It is *true* in a run whose
trajectory is wrong, or whose fault it names. ``--faults`` counts kinds at any level.
"""

from __future__ import annotations

import textwrap
import tomllib
from difflib import get_close_matches
from functools import cache
from importlib import resources

import msgspec

from recon4.errors import ConfigError
from recon4.findings.derived import derived_sentences
from recon4.findings.wording import KindText, catalog
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import texts
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.untrusted.typed import as_type

_WIDTH = 88
_INTRODUCTION = """\
# Findings

What recon4 says of a map, by the code that stands beside it on the terminal, in the report, on the
pages and in `summary.json`. `recon4 explain CODE` prints the same text.

A code keeps its meaning in all versions. The verdict of a map is that of its worst finding:
*good*, *note* (the verdict stays good), *check* or *do not use*.
`recon4 audit PROJECT` works the findings of a finished map out again, without a new map.
An approval covers the findings too: with other findings the map is a draft until it is approved
again.

On the pages each finding has a link to its place in the viewer, and a reviewer can acknowledge it
with a note ([review](../how-to/review.md#acknowledging-a-finding)). More than four can be filtered
by level and kind. `recon4 export PROJECT FILE.csv`
(or `.geojson`, also on the page of the project) writes all of them. CSV is a table with both ends
of each stretch in the CRS of the map, GeoJSON has lines along the walk in longitude and latitude.
If the map is not georeferenced, both are in its local frame, and the file says so. A finding about
the whole map has no place there.

*Measured* counts the alarms (*check* or *do not use*) in runs with known truth. An alarm is true in
a run whose trajectory is wrong, or whose fault it names; wrong runs without it may have others.
Of kinds that may be notes it says in how many runs with and without their fault they are said.
[Precision](../studies/precision.md) says how the runs were made. Of a published table only the
first reason of each run is known, by the code of its time.

This page is made from the English texts in `recon4/locales/en` and the counts in `measured.toml`:
`make docs`. [Languages](../how-to/languages.md) says how another language is added.
"""
_READERS = """\
## Warnings of readers

What the readers of recordings repair, leave out or doubt. `recon4 info` says it before a map is
made, `recon4 process` while it reads, the phone while it records. They make a 3-D map *check*. Of a
2-D map they are notes, except what they say of mounts. Most are counted together in the
measured runs, as IMPORT-REMARK.
"""
_DERIVED = """\
## What readers derive

What a recording does not say, and its reader works out or chooses. It is no finding and changes no
verdict. `recon4 info`, the page of a new project and the report list it, `report.json` of the
import has code and values. A sentence whose values are not known is left out.
"""


def listed(language: str = ENGLISH) -> str:
    """All codes with their titles, a line each."""
    width, kinds = max(map(len, FindingKind)), catalog(language).kinds
    return "\n".join(f"{kind:<{width}}  {kinds[kind].title}" for kind in FindingKind)


def explained(code: str, language: str = ENGLISH) -> str:
    """A kind of finding, or of what readers derive, on a terminal.

    Raises:
        ConfigError: If there is no such code.
    """
    name = code.upper()
    if name in list(DerivedKind):
        sentences = derived_sentences(DerivedKind(name), language)
        return "\n\n".join([name, *(textwrap.fill(one.readable, _WIDTH) for one in sentences)])
    try:
        kind = FindingKind(name)
    except ValueError:
        near = get_close_matches(name, [*FindingKind, *DerivedKind], n=3)
        hint = f"; similar: {', '.join(near)}" if near else ""
        raise ConfigError(CodedText("explain-code", code=code, hint=hint)) from None
    entry, heads = catalog(language).kinds[kind], texts(language, "findings")
    parts = [("", entry.title), ("", entry.meaning)]
    parts.append((heads("explain-detected"), entry.detection.replace("*", "")))
    parts.append((heads("explain-remedy"), entry.remedy))
    paragraphs = [textwrap.fill(f"{head} {text}".strip(), _WIDTH) for head, text in parts if text]
    return "\n\n".join([f"{kind}", *paragraphs])


def markdown() -> str:
    """The page ``docs/reference/findings.md``."""
    readers = catalog().readers
    witnesses = (
        _section(kind, catalog().kinds[kind]) for kind in FindingKind if kind not in readers
    )
    warnings = (_section(kind, catalog().kinds[kind]) for kind in FindingKind if kind in readers)
    derived = (_derived_row(kind) for kind in DerivedKind)
    return "\n".join([_INTRODUCTION, *witnesses, _READERS, *warnings, _DERIVED, *derived, ""])


def _derived_row(kind: DerivedKind) -> str:
    shown = " ".join(one.readable for one in derived_sentences(kind))
    return f"- **{kind}**: {shown}"


def _section(kind: FindingKind, entry: KindText) -> str:
    shown = " ".join(one.readable for one in entry.text)
    rows = [f"## {kind}", "", f"**{entry.title}.** {entry.meaning}", "", f"- says: {shown}"]
    if entry.detection:
        rows.append(f"- detected: {entry.detection}")
    by_reader = kind in catalog().readers
    counted = [one for one in sources() if not by_reader or kind in one.faults]
    if counted:
        measured = (_capital(source.words(kind)) for source in counted)
        rows.append(f"- measured: {'. '.join(measured)}")
    if entry.remedy:
        rows.append(f"- what to do: {entry.remedy}")
    return "\n".join([*rows, ""])


def _capital(text: str) -> str:
    """The text as the begin of a sentence."""
    return text[:1].upper() + text[1:]


class Alarms(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Alarms of one kind in the runs of one source."""

    alarms: int
    true: int
    of_wrong: int
    """In wrong runs."""

    @property
    def precision(self) -> float:
        """Ratio of its alarms that are true."""
        return self.true / self.alarms


class FaultCounts(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """In how many runs a kind is said, at any level."""

    with_fault: int
    """Runs with a fault that it names …"""
    said: int
    """… and those of them that say it."""
    without: int
    false: int
    """Likewise without such a fault."""


class MeasuredRuns(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A set of runs."""

    name: str
    right: int
    """Runs whose trajectory is right …"""
    wrong: int
    """… and those whose is not."""
    kinds: dict[FindingKind, Alarms]
    faults: dict[FindingKind, FaultCounts] = {}
    """Kinds that were counted as notes, too."""

    def words(self, kind: FindingKind) -> str:
        """What it says of a kind."""
        named = self.faults.get(kind)
        if named is not None:
            text = f"said in {named.said} of {named.with_fault} runs with its fault"
            return f"{text}, in {named.false} of {named.without} without it ({self.name})"
        runs = self.right + self.wrong
        found = self.kinds.get(kind)
        if found is None:
            return f"no alarm in {runs} runs ({self.name})"
        text = f"{found.alarms} alarms in {runs} runs, {100.0 * found.precision:.0f} % of them true"
        return f"{text}, in {found.of_wrong} of {self.wrong} wrong runs ({self.name})"


class _Measured(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    sources: tuple[MeasuredRuns, ...]


@cache
def sources() -> tuple[MeasuredRuns, ...]:
    """All sources, the largest first."""
    text = resources.files("recon4.findings").joinpath("measured.toml").read_text("utf-8")
    return as_type(tomllib.loads(text), _Measured).sources


if __name__ == "__main__":
    from recon4.cli.terminal import write

    write(markdown(), end="")
