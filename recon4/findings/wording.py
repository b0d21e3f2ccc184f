"""Findings in words: the catalog with the values of a finding filled in.

``en.toml`` has what witnesses find, ``readers_en.toml`` what readers of recordings warn of.

A text is a list of sentences. A sentence is left out if a value that it quotes is not known, or if
the value named by its ``if`` is not true. Formats after the colon, besides those of Python:

========== ==========================================================================
``length``  meters as centimeters below one meter, else as meters
``percent`` a ratio as percent with one digit; ``percent0`` without
``deg``     radians as degrees with two digits; ``deg1`` with one, ``deg3`` with three
``count``   a whole number with its thousands apart
``label``   name of a count of the import: what it counts (`recon4.model.count_words`)
``counts``  several such counts, ``name=number name=number``
``noun``    name of a count: what is counted; ``fates`` of several: what became of how many
``word``    the text of a word, from ``words`` of the kind, else from those of the catalog
========== ==========================================================================
"""

from __future__ import annotations

import math
import string
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any, TypeVar

import msgspec
from msgspec.structs import replace

from recon4.model.finding import Finding, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_counts import count_fate, count_label, count_noun, count_text

_T = TypeVar("_T")
_DEGREE_DIGITS = {"deg": 2, "deg1": 1, "deg3": 3}


class Sentence(msgspec.Struct, frozen=True):
    """A sentence that stands only under a condition."""

    text: str
    given: str = msgspec.field(name="if", default="")
    """Name of a value that must be there and not be false, zero or empty; empty = always."""


class KindText(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the catalog says of one kind of finding."""

    title: str
    """Two to five words, for lists and filters."""
    text: tuple[str | Sentence, ...]
    remedy: str = ""
    """What to do about it; empty = nothing."""
    meaning: str = ""
    """What it says of the map, for ``docs/reference/findings.md`` and ``recon4 explain``."""
    detection: str = ""
    """How it is detected, and from which size on; empty = its text says so."""
    words: dict[str, str] = {}


class Catalog(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A catalog in one language."""

    headlines: dict[str, str]
    """Usability -> headline of a verdict."""
    words: dict[str, str]
    kinds: dict[FindingKind, KindText]
    readers: frozenset[FindingKind] = frozenset()
    """Kinds that readers of recordings warn of, not witnesses."""


class _Texts(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    kinds: dict[FindingKind, KindText]


@cache
def catalog() -> Catalog:
    """The English catalog."""
    of_readers = _read("readers_en.toml", _Texts).kinds
    found = _read("en.toml", Catalog)
    return replace(found, kinds=found.kinds | of_readers, readers=frozenset(of_readers))


def _read(name: str, kind: type[_T]) -> _T:
    text = resources.files("recon4.findings").joinpath(name).read_text("utf-8")
    return msgspec.convert(tomllib.loads(text), kind)


def text_of(finding: Finding) -> str:
    """A finding as sentences, without its remedy."""
    entry = catalog().kinds[finding.kind]
    fill = _Filling(entry.words)
    values = _values(finding)
    parts = (fill.sentence(one, values) for one in entry.text)
    return " ".join(part for part in parts if part) or f"{entry.title}."


def remedy_of(finding: Finding) -> str:
    """What to do about a finding; empty = nothing."""
    entry = catalog().kinds[finding.kind]
    return _Filling(entry.words).sentence(entry.remedy, _values(finding))


def whole_text(finding: Finding) -> str:
    """A finding with its remedy, as a reason of a verdict."""
    return " ".join(part for part in (text_of(finding), remedy_of(finding)) if part)


def title_of(kind: FindingKind) -> str:
    """Title of a kind of finding."""
    return catalog().kinds[kind].title


def word_of(kind: FindingKind, word: str) -> str:
    """A word of a kind of finding in the language of the catalog; one it does not have as it is."""
    return _Filling(catalog().kinds[kind].words).format_field(word, "word")


def headline(usability: str) -> str:
    """The verdict in one line."""
    return catalog().headlines[usability]


def said(finding: Finding) -> dict[str, object]:
    """A finding for files and pages: the record with its title, text and remedy."""
    record: dict[str, object] = msgspec.to_builtins(finding)
    return record | {
        "title": title_of(finding.kind),
        "text": text_of(finding),
        "remedy": remedy_of(finding),
    }


def _values(finding: Finding) -> dict[str, Value]:
    values = {name: value for name, value in finding.values.items() if _is_known(value)}
    if finding.span_s is not None:
        values["start_s"], values["end_s"] = finding.span_s
    if finding.direction:
        values["direction"] = finding.direction
    if finding.sensor:
        values["sensor"] = finding.sensor
    return values


def _is_known(value: Value) -> bool:
    return not (isinstance(value, float) and math.isnan(value))


class _Filling(string.Formatter):
    """Fills values into a sentence of the catalog."""

    def __init__(self, words: Mapping[str, str]) -> None:
        self._words = words

    def sentence(self, one: str | Sentence, values: Mapping[str, Value]) -> str:
        """The sentence, or nothing where a value is missing."""
        if isinstance(one, Sentence):
            if one.given and not values.get(one.given):
                return ""
            one = one.text
        named = {name for _, name, _, _ in self.parse(one) if name}
        return self.vformat(one, (), values) if named <= values.keys() else ""

    def format_field(self, value: Any, format_spec: str) -> str:
        """One value in its format."""
        match format_spec:
            case "length":
                return _length(value)
            case "percent" | "percent0":
                return f"{100.0 * value:.{0 if format_spec.endswith('0') else 1}f} %"
            case "deg" | "deg1" | "deg3":
                return f"{math.degrees(value):.{_DEGREE_DIGITS[format_spec]}f}°"
            case "count":
                return f"{value:,}".replace(",", "\u202f")
            case "label":
                return count_label(value)
            case "counts":
                counts = _counts(value)
                return "; ".join(count_text(name, counts) for name in counts)
            case "fates":
                counts = _counts(value)
                return "; ".join(f"{number}: {count_fate(name)}" for name, number in counts.items())
            case "noun":
                return count_noun(value)
            case "word":
                return self._words.get(value) or catalog().words.get(value, value)
        return super().format_field(value, format_spec)


def _counts(value: str) -> dict[str, int]:
    pairs = (one.partition("=") for one in value.split())
    return {name: int(number) for name, _, number in pairs}


def _length(value_m: float) -> str:
    if not math.isfinite(value_m):
        return "–"
    return f"{100.0 * value_m:.1f} cm" if value_m < 1.0 else f"{value_m:.2f} m"
