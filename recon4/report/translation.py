"""A report as HTML in another language: its texts are recognized by the English ones.

A file of results is in English, and the one of an approved map keeps its bytes. Who reads it in
another language is shown the same page with its texts, and numbers as that language writes them.
What an element with ``translate="no"`` says stays as it is.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from html import escape, unescape

from recon4.findings.wording import headline
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Texts, pattern_of, quoted_by, texts
from recon4.model.usability import Usability
from recon4.report.client_words import words

_TAG = r"<(?:[^<>\"]|\"[^\"]*\")*>"
_PIECES = re.compile(
    rf"(<style.*?</style>|<metadata.*?</metadata>|<!--.*?-->|<[^<>]*translate=\"no\"[^<>]*>[^<]*"
    rf"|{_TAG})",
    re.DOTALL,
)
"""What is no text of a page, or stays."""
_TITLE = re.compile(r'(?<= title=")[^"]*')
_BETWEEN = (" · ", " → ", ": ", "; ", ", ")
"""Stand between texts of their own in a longer one."""
_MESSAGE = "quality"
_FILES = {_MESSAGE: _MESSAGE, "findings": "GNSS-NOT-USED", "recordings": "recording-[a-z0-9_]+"}
"""File -> messages whose parts stand in a page as they are."""


def in_language(page: str, language: str, known: Mapping[str, str]) -> str:
    """A report or the page of a calibration in a language.

    Args:
        page: HTML as recon4 writes it, in English.
        language: Its code.
        known: Further texts of the page in English -> the same in the language.
    """
    if language == ENGLISH:
        return page
    translation = _Translation(language, known)
    pieces = _PIECES.split(page.replace('<html lang="en">', f'<html lang="{language}">', 1))
    pieces[::2] = map(translation.of_html, pieces[::2])
    pieces[1::2] = [_TITLE.sub(translation.of_match, piece) for piece in pieces[1::2]]
    return "".join(pieces)


class _Translation:
    """The texts of one page in a language."""

    def __init__(self, language: str, known: Mapping[str, str]) -> None:
        self._known = {**_exact(language), **known}
        self._texts, self._words = texts(language, _MESSAGE), words(language)

    def of_html(self, text: str) -> str:
        """The text between two tags; spaces around it stay."""
        inner = text.strip()
        if not inner:
            return text
        said = escape(self(" ".join(unescape(inner).split())), quote=False)
        return text.replace(inner, said, 1)

    def of_match(self, found: re.Match[str]) -> str:
        """An attribute."""
        return escape(self(unescape(found[0])))

    def __call__(self, text: str) -> str:
        """A text in the language; one that is not known with its numbers in that language."""
        if text in self._known:
            return self._known[text]
        for part, pattern in _patterns():
            found = pattern.fullmatch(text)
            if found:
                values = {name: self(value) for name, value in found.groupdict().items()}
                return self._texts.part(_MESSAGE, part, values)
        if (term := self._words.term(text)) != text:
            return term
        for between in _BETWEEN:
            if between in text:
                return between.join(map(self, text.split(between)))
        return self._words.decimal(text)


@cache
def _exact(language: str) -> dict[str, str]:
    """Verdicts, why GNSS was not used, kinds of recordings, and the other texts without values."""
    pairs = {headline(one): headline(one, language) for one in Usability}
    for file, names in _FILES.items():
        english, own = Texts(ENGLISH, file), Texts(language, file)
        for message in filter(re.compile(names).fullmatch, english.names()):
            for part, pattern in english.parts(message).items():
                if not quoted_by(pattern):
                    pairs[english.part(message, part, {})] = own.part(message, part, {})
    return pairs


@cache
def _patterns() -> tuple[tuple[str, re.Pattern[str]], ...]:
    """The texts with values, those with most words first."""
    parts = Texts(ENGLISH, _MESSAGE).parts(_MESSAGE)
    found = [(part, pattern_of(one)) for part, one in parts.items() if quoted_by(one)]
    return tuple(sorted(found, key=lambda pair: -len(pair[1].pattern)))
