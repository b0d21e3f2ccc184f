"""What readers derived, in words: ``derived.ftl`` of a language with the values filled in.

A message for each kind has only sentences (`recon4.findings.sentences`).
"""

from __future__ import annotations

from functools import cache

import msgspec

from recon4.findings.sentences import Sentence, functions, known_values, said_of, sentences_of
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Texts
from recon4.model.derived import Derived
from recon4.model.derived_kinds import DerivedKind


@cache
def derived_sentences(kind: DerivedKind, language: str = ENGLISH) -> tuple[Sentence, ...]:
    """The sentences of a kind in a language."""
    return sentences_of(_texts(language), kind)


def derived_text(one: Derived, language: str = ENGLISH) -> str:
    """What was derived, as sentences; its code if it lacks all values that they quote."""
    sentences = derived_sentences(one.kind, language)
    values = known_values(one.values, language)
    return said_of(_texts(language), one.kind, sentences, values=values) or one.kind


def said_derived(one: Derived, language: str = ENGLISH) -> dict[str, object]:
    """What was derived, for files: the record with its text."""
    record: dict[str, object] = msgspec.to_builtins(one)
    return record | {"text": derived_text(one, language)}


@cache
def _texts(language: str) -> Texts:
    """With the files that have words of values which findings quote, too."""
    return Texts(language, "derived", "findings", "readers", functions=functions)
