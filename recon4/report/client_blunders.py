"""Suspected blunders of a survey, which ``georeference.json`` has in English, in a language."""

from __future__ import annotations

import re
from functools import cache

from recon4.locales.languages import ENGLISH
from recon4.locales.texts import texts
from recon4.report.client_words import Words

_VALUES = ("names", "offset", "length", "east", "north", "up")
_SENTENCES = ("feet", "axes", "names", "point", "offset", "contradiction")


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
