"""Sentences of a message: the parts ``text1`` … whose values are known, in order.

A sentence is left out if a value that it quotes is not known; one whose name ends with
``-if-VALUE`` also if that value is not there or not true.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from recon4.locales.coded import CODE, StoredText, folded_values, said
from recon4.locales.texts import Functions, Texts, quoted_by, readable
from recon4.model.finding import Value
from recon4.model.import_counts import count_fate, count_label, count_noun, count_text

_SENTENCE = re.compile(r"text\d+(?:-if-(\w+))?")


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence of a message."""

    part: str
    """Its name in the message."""
    given: str
    """Name of a value that must be there and not be false, zero or empty; empty = always."""
    quotes: frozenset[str]
    """Names of the values in it."""
    readable: str
    """It, with the names of its values in place of them."""


def sentences_of(texts: Texts, name: str) -> tuple[Sentence, ...]:
    """The sentences of a message.

    Raises:
        KeyError: If there is no such message.
    """
    return tuple(
        Sentence(part, found[1] or "", quoted_by(pattern), readable(pattern))
        for part, pattern in texts.parts(name).items()
        if (found := _SENTENCE.fullmatch(part))
    )


def said_of(
    texts: Texts, name: str, sentences: Iterable[Sentence], *, values: Mapping[str, Value]
) -> str:
    """The sentences of a message whose values are known; empty = none is."""
    return " ".join(
        texts.part(name, one.part, values)
        for one in sentences
        if one.quotes <= values.keys() and (not one.given or values.get(one.given))
    )


def known_values(values: Mapping[str, Value], language: str) -> dict[str, Value]:
    """The values that are numbers, or no numbers by their kind.

    Errors and texts with a code are in the language.
    """
    folded = folded_values({name: value for name, value in values.items() if _is_known(value)})
    known = {n: said(one, language) if isinstance(one, str) else one for n, one in folded.items()}
    quoted = {name.removesuffix(CODE): code for name, code in known.items() if name.endswith(CODE)}
    errors = {
        name: StoredText(text=str(known[name]), code=str(code), values={"detail": str(known[name])})
        for name, code in quoted.items()
        if name in known
    }
    return known | {name: text.said(language) for name, text in errors.items()}


def functions(texts: Texts) -> Functions:
    """What sentences call besides the functions for numbers."""
    language = texts.language

    def fates(value: str) -> str:
        counts = _counts(value).items()
        return "; ".join(f"{number}: {count_fate(name, language)}" for name, number in counts)

    def counted(value: str) -> str:
        counts = _counts(value)
        return "; ".join(count_text(name, counts, language=language) for name in counts)

    def called(value: Any, *, of: str = "") -> str:
        return word(texts, str(value), of)

    return {
        "WORD": called,
        "COUNTED": lambda name: count_label(name, language),
        "COUNTS": counted,
        "FATES": fates,
        "NOUN": lambda name: count_noun(name, language),
    }


def word(texts: Texts, value: str, message: str) -> str:
    """The words of a value in a message, else those of all; else the value."""
    name = f"word-{in_name(value)}"
    if message and name in texts.parts(message):
        return texts.part(message, name, {})
    return texts(name) if name in texts else value


def in_name(value: str) -> str:
    """A value as a part of the name of a message."""
    return value.replace(" ", "-")


def _is_known(value: Value) -> bool:
    return not (isinstance(value, float) and math.isnan(value))


def _counts(value: str) -> dict[str, int]:
    pairs = (one.partition("=") for one in value.split())
    return {name: int(number) for name, _, number in pairs}
