"""Texts of the report for the client: ``report.ftl`` of a language."""

from __future__ import annotations

import re
from functools import cache

from recon4.evaluation.table import number
from recon4.locales.languages import ENGLISH, checked
from recon4.locales.numbers import localized
from recon4.locales.texts import Texts, texts

_NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+\.\d+(?![\d.])")
"""A decimal number; an address or a version has more points."""

_NO_WORDS = re.compile(r"[^A-Za-z ]")
"""Stands beside a term that is translated; a sentence of words is left whole."""
_AXES = "(east, north, up)"
"""Ends the values of three axes."""


class Words:
    """The texts of a language; the key of a text is its message and its part, ``limits.draft``."""

    def __init__(self, language: str, found: Texts) -> None:
        self.language = language
        self._texts = found

    def __call__(self, key: str, /, **values: str) -> str:
        """A text with the values that it quotes filled in; the values are taken as they are."""
        message, _, part = key.partition(".")
        return self._texts.part(message, part, values)

    def all(self, message: str) -> dict[str, str]:
        """All texts of a message, by their parts."""
        return {part: self._texts.part(message, part, {}) for part in self._texts.parts(message)}

    def number(self, value: float, digits: int = 2, scale: float = 1.0) -> str:
        """A number for a cell; a dash where it is not finite."""
        return self.decimal(number(value, digits, scale))

    def decimal(self, text: str) -> str:
        """A text with its decimal numbers as the language writes them."""
        return _NUMBER.sub(lambda found: localized(found[0], self.language), text)

    def term(self, text: str) -> str:
        """A word of a record, or the name of an axis; one without a translation as it is."""
        name = re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")
        if self.language == ENGLISH or name not in self._texts.parts("term"):
            return text
        return self(f"term.{name}")

    def label(self, text: str) -> str:
        """The name of a row: a term, or one before the name that people gave something."""
        if (whole := self.term(text)) != text:
            return whole
        kind, _, name = text.partition(" ")
        return f"{self.term(kind)} {name}" if name else text

    def value(self, text: str) -> str:
        """The value of a row: parts between commas that are, begin or end with a term."""
        if self.language == ENGLISH:
            return text
        if (whole := self.term(text)) != text:
            return whole
        if text.endswith(_AXES):
            return f"{self.decimal(text.removesuffix(_AXES))}({self.term(_AXES)})"
        return self.decimal(", ".join(map(self._part, text.split(", "))))

    def _part(self, text: str) -> str:
        if (whole := self.term(text)) != text:
            return whole
        split = text.split(" ")
        for k in range(len(split) - 1, 0, -1):
            head, tail = " ".join(split[:k]), " ".join(split[k:])
            known = (self.term(head) != head, self.term(tail) != tail)
            if all(known) or (any(known) and _NO_WORDS.search(tail if known[0] else head)):
                return f"{self.term(head)} {self.term(tail)}"
        return text


@cache
def words(language: str = ENGLISH) -> Words:
    """The texts of a language.

    Raises:
        ConfigError: If there is none.
    """
    return Words(checked(language), texts(language, "report"))
