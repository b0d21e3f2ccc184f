"""Findings in words: the texts of a language with the values of a finding filled in.

``recon4/locales/LANGUAGE/findings.ftl`` has what witnesses find, ``readers.ftl`` what readers of
recordings warn of: a message for each kind, with its title. Its parts are

============= ====================================================================================
``text1`` …    sentences, in order (`recon4.findings.sentences`)
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

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

import msgspec

from recon4.findings.sentences import (
    Sentence,
    functions,
    in_name,
    known_values,
    said_of,
    sentences_of,
    word,
)
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Texts, quoted_by, readable
from recon4.model.finding import Finding, Value
from recon4.model.finding_kinds import FindingKind


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


class KindTexts(Mapping[FindingKind, KindText]):
    """What the texts of a language say of all kinds, each read when it is asked for."""

    def __init__(self, texts: Texts) -> None:
        """Prepare."""
        self._texts, self._known = texts, dict[FindingKind, KindText]()

    def __getitem__(self, kind: FindingKind) -> KindText:
        if kind not in self._known:
            self._known[kind] = _kind_text(self._texts, kind)
        return self._known[kind]

    def __iter__(self) -> Iterator[FindingKind]:
        return iter(FindingKind)

    def __len__(self) -> int:
        return len(FindingKind)


@dataclass(frozen=True, slots=True)
class Catalog:
    """The texts of all kinds of findings in one language."""

    texts: Texts
    kinds: KindTexts
    readers: frozenset[FindingKind]
    """Kinds that readers of recordings warn of, not witnesses."""

    def word(self, value: str, kind: str = "") -> str:
        """The words of a value of a kind of finding, else those of all; else the value."""
        return word(self.texts, value, kind)


@cache
def catalog(language: str = ENGLISH) -> Catalog:
    """All kinds of findings in a language."""
    texts = Texts(language, "findings", "readers", "counts", functions=functions)
    of_readers = set(Texts(ENGLISH, "readers").names())
    return Catalog(
        texts, KindTexts(texts), frozenset(kind for kind in FindingKind if kind in of_readers)
    )


def text_of(finding: Finding, language: str = ENGLISH) -> str:
    """A finding as sentences, without its remedy."""
    known = catalog(language)
    entry = known.kinds[finding.kind]
    text = said_of(known.texts, finding.kind, entry.text, values=_values(finding, language))
    return text or f"{entry.title}."


def remedy_of(finding: Finding, language: str = ENGLISH) -> str:
    """What to do about a finding; empty = nothing."""
    known = catalog(language)
    entry = known.kinds[finding.kind]
    values = _values(finding, language)
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
    return catalog(language).texts(f"headline-{in_name(usability)}")


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
    return KindText(
        title=shown[""],
        text=sentences_of(texts, kind),
        remedy=shown.get("remedy", ""),
        remedy_quotes=quoted_by(parts["remedy"]) if "remedy" in parts else frozenset(),
        meaning=shown.get("meaning", ""),
        detection=shown.get("detection", ""),
    )


def _values(finding: Finding, language: str) -> dict[str, Value]:
    values = known_values(finding.values, language)
    if finding.span_s is not None:
        values["start_s"], values["end_s"] = finding.span_s
    if finding.direction:
        values["direction"] = finding.direction
    if finding.sensor:
        values["sensor"] = finding.sensor
    return values
