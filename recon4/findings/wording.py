"""Findings in words: the texts of a language with the values of a finding filled in.

``recon4/locales/LANGUAGE/findings.ftl`` has what witnesses find, ``readers.ftl`` what readers of
recordings warn of: a message for each kind, with its title. Its parts are

============= ====================================================================================
``text1`` …    sentences, in order. One is left out if a value that it quotes is not known; one
               whose name ends with ``-if-VALUE`` also if that value is not there or not true
``remedy``     what to do about it
``meaning``    what it says of the map, for ``docs/reference/findings.md`` and ``recon4 explain``
``detection``  how it is detected, and from which size on
``word-WORD``  what ``WORD($value, of: "KIND")`` says for a value; without ``of`` the message
               ``word-WORD`` says it, and what has no words is shown as it is
============= ====================================================================================

Texts call the functions of `recon4.locales.numbers`, and ``COUNTED``, ``COUNTS``, ``FATES`` and
``NOUN`` for the counts of an import (`recon4.model.import_counts`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import msgspec

from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Functions, Texts, quoted_by, readable
from recon4.model.finding import Finding, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_counts import count_fate, count_label, count_noun, count_text

_SENTENCE = re.compile(r"text\d+(?:-if-(\w+))?")


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence of a kind of finding."""

    part: str
    """Its name in the message."""
    given: str
    """Name of a value that must be there and not be false, zero or empty; empty = always."""
    quotes: frozenset[str]
    """Names of the values in it."""
    readable: str
    """It, with the names of its values in place of them."""


@dataclass(frozen=True, slots=True)
class KindText:
    """What the texts of a language say of one kind of finding."""

    title: str
    """Two to five words, for lists and filters."""
    text: tuple[Sentence, ...]
    remedy: str
    """What to do about it, with names in place of values; empty = nothing."""
    remedy_quotes: frozenset[str]
    meaning: str
    detection: str
    """Empty = its text says so."""


@dataclass(frozen=True, slots=True)
class Catalog:
    """The texts of all kinds of findings in one language."""

    texts: Texts
    kinds: Mapping[FindingKind, KindText]
    readers: frozenset[FindingKind]
    """Kinds that readers of recordings warn of, not witnesses."""

    def word(self, value: str, kind: str = "") -> str:
        """The words of a value of a kind of finding, else those of all; else the value."""
        return _word(self.texts, value, kind)


@cache
def catalog(language: str = ENGLISH) -> Catalog:
    """All kinds of findings in a language."""
    texts = Texts(language, "findings", "readers", "counts", functions=_functions)
    of_readers = set(Texts(ENGLISH, "readers").names())
    kinds = {kind: _kind_text(texts, kind) for kind in FindingKind}
    return Catalog(texts, kinds, frozenset(kind for kind in FindingKind if kind in of_readers))


def text_of(finding: Finding, language: str = ENGLISH) -> str:
    """A finding as sentences, without its remedy."""
    known = catalog(language)
    entry = known.kinds[finding.kind]
    values = _values(finding)
    parts = [
        known.texts.part(finding.kind, one.part, values)
        for one in entry.text
        if one.quotes <= values.keys() and (not one.given or values.get(one.given))
    ]
    return " ".join(parts) or f"{entry.title}."


def remedy_of(finding: Finding, language: str = ENGLISH) -> str:
    """What to do about a finding; empty = nothing."""
    known = catalog(language)
    entry = known.kinds[finding.kind]
    values = _values(finding)
    if not entry.remedy or not entry.remedy_quotes <= values.keys():
        return ""
    return known.texts.part(finding.kind, "remedy", values)


def whole_text(finding: Finding, language: str = ENGLISH) -> str:
    """A finding with its remedy, as a reason of a verdict."""
    parts = (text_of(finding, language), remedy_of(finding, language))
    return " ".join(part for part in parts if part)


def title_of(kind: FindingKind, language: str = ENGLISH) -> str:
    """Title of a kind of finding."""
    return catalog(language).kinds[kind].title


def word_of(kind: FindingKind, word: str, language: str = ENGLISH) -> str:
    """A word of a kind of finding; one that has no words as it is."""
    return catalog(language).word(word, kind)


def headline(usability: str, language: str = ENGLISH) -> str:
    """The verdict in one line."""
    return catalog(language).texts(f"headline-{_name(usability)}")


def said(finding: Finding, language: str = ENGLISH) -> dict[str, object]:
    """A finding for files and pages: the record with its title, text and remedy."""
    record: dict[str, object] = msgspec.to_builtins(finding)
    return record | {
        "title": title_of(finding.kind, language),
        "text": text_of(finding, language),
        "remedy": remedy_of(finding, language),
    }


def _kind_text(texts: Texts, kind: FindingKind) -> KindText:
    parts = texts.parts(kind)
    shown = {name: readable(pattern) for name, pattern in parts.items()}
    sentences = [
        Sentence(name, found[1] or "", quoted_by(pattern), shown[name])
        for name, pattern in parts.items()
        if (found := _SENTENCE.fullmatch(name))
    ]
    return KindText(
        title=shown[""],
        text=tuple(sentences),
        remedy=shown.get("remedy", ""),
        remedy_quotes=quoted_by(parts["remedy"]) if "remedy" in parts else frozenset(),
        meaning=shown.get("meaning", ""),
        detection=shown.get("detection", ""),
    )


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


def _functions(texts: Texts) -> Functions:
    """What texts of findings call besides the functions for numbers."""
    language = texts.language

    def fates(value: str) -> str:
        counts = _counts(value).items()
        return "; ".join(f"{number}: {count_fate(name, language)}" for name, number in counts)

    def counted(value: str) -> str:
        counts = _counts(value)
        return "; ".join(count_text(name, counts, language=language) for name in counts)

    def word(value: Any, *, of: str = "") -> str:
        return _word(texts, str(value), of)

    return {
        "WORD": word,
        "COUNTED": lambda name: count_label(name, language),
        "COUNTS": counted,
        "FATES": fates,
        "NOUN": lambda name: count_noun(name, language),
    }


def _word(texts: Texts, value: str, kind: str) -> str:
    word = f"word-{_name(value)}"
    if kind and word in texts.parts(kind):
        return texts.part(kind, word, {})
    return texts(word) if word in texts else value


def _name(value: str) -> str:
    """A value as a part of the name of a message."""
    return value.replace(" ", "-")


def _counts(value: str) -> dict[str, int]:
    pairs = (one.partition("=") for one in value.split())
    return {name: int(number) for name, _, number in pairs}
