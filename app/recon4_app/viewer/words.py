"""The texts of the viewer in the language of a person."""

from __future__ import annotations

import re

from recon4.locales.languages import ENGLISH, languages
from recon4.locales.texts import Texts, texts

FILES = ("shared", "review", "graph")
"""Files of the texts; reasons and judges are those of the review."""


def words(language: str) -> Texts:
    """The texts of a language, read once."""
    return texts(language, *FILES)


def known_language(text: str | None) -> str:
    """A language that there is, from what a browser says; else English."""
    return text if text in languages() else ENGLISH


def word_of(prefix: str, word: str, say: Texts) -> str:
    """What a word of the program is called: the message ``prefix-word``, else the word itself."""
    name = f"{prefix}-{_slug(word)}"
    return say(name) if name in say else word


def _slug(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")
