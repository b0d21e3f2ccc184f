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


def approval_words(text: str, say: Texts) -> str:
    """The line about the approval of a map; `web/shared/approval.js` says it in the same way."""
    found = re.fullmatch(r"Approved v(\d+) · (.*) · (\d{4}-\d\d-\d\d)(.*)", text)
    if found is None:
        return _phrase(text, say)
    signed = say("approval-signed", version=found[1], who=found[2], day=found[3])
    return signed + _phrase(found[4], say)


def _phrase(text: str, say: Texts) -> str:
    """A part of that line, which may name a version or a key."""
    named = re.search(r"(?<=version )\d+|(?<=unknown key )\S+(?=:)", text)
    value = named[0] if named else ""
    name = f"approval-{_slug(text.replace(value, '') if value else text)}"
    return say(name, version=value, key=value) if name in say else text


def word_of(prefix: str, word: str, say: Texts) -> str:
    """What a word of the program is called: the message ``prefix-word``, else the word itself."""
    name = f"{prefix}-{_slug(word)}"
    return say(name) if name in say else word


def _slug(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")
