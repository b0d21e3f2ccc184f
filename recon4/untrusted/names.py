"""Names that people give: what is refused, and how what is on disk already is shown.

An invisible character can make one name look like another: controls, marks of writing direction
(U+202E), zero-width characters, halves of characters.
"""

from __future__ import annotations

import unicodedata

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.untrusted.limits import LIMITS

_HIDDEN = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})
"""Unicode categories of control, format and surrogate characters, line and paragraph separators."""


def check_name(text: str, *, what: str, most: int = LIMITS.name) -> str:
    """A name as it was given.

    Args:
        text: The name.
        what: What it names, for the error.
        most: How many characters it may have.

    Raises:
        ConfigError: If it is too long or has invisible characters.
    """
    return _check(text, what, most, allowed="")


def check_note(text: str, *, what: str, most: int = LIMITS.note) -> str:
    """A text of several lines as it was given.

    Raises:
        ConfigError: If it is too long or has invisible characters, except tabs and line ends.
    """
    return _check(text, what, most, allowed="\t\n\r")


def visible(text: str, *, most: int = LIMITS.name) -> str:
    """A name from a file, fit to be shown: hidden characters as their numbers, cut at ``most``."""
    short = text if len(text) <= most else f"{text[: most - 1]}…"
    return "".join(f"<U+{ord(one):04X}>" if _hidden(one) else one for one in short)


def is_unnameable(path: object) -> bool:
    """Whether a path has bytes that are no UTF-8 text; JSON cannot carry it."""
    return any("\ud800" <= one <= "\udfff" for one in str(path))


def _check(text: str, what: str, most: int, *, allowed: str) -> str:
    if len(text) > most:
        raise ConfigError(CodedText("name-long", what=what, most=most, got=len(text)))
    hidden = [one for one in text if _hidden(one) and one not in allowed]
    if hidden:
        raise ConfigError(
            CodedText(
                "name-invisible",
                what=what,
                character=f"U+{ord(hidden[0]):04X}",
                place=text.index(hidden[0]) + 1,
            )
        )
    return text


def _hidden(character: str) -> bool:
    return unicodedata.category(character) in _HIDDEN
