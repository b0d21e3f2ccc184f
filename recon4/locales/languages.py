"""Which languages there are, and which of them a person reads."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from recon4.errors import ConfigError

ENGLISH = "en"
"""The language of every text; a text that another language lacks is shown in it."""
ENVIRONMENT = "RECON4_LANGUAGE"
"""Environment variable with the language of a terminal."""
LANGUAGE_HELP = f"Of help, errors, reports and findings, as de; default: {ENVIRONMENT}, else en."
"""Of the option of commands."""
ROOT = Path(__file__).parent
"""Has a folder for each language."""
_ASKED = re.compile(r"\s*([A-Za-z]{1,8})(?:[-_][\w-]*)?\s*(?:;\s*q\s*=\s*([\d.]+))?\s*")


@cache
def languages(root: Path = ROOT) -> tuple[str, ...]:
    """Codes of all languages (ISO 639), English first: the folders with texts."""
    found = sorted(one.parent.name for one in root.glob("*/findings.ftl"))
    return (ENGLISH, *(one for one in found if one != ENGLISH))


def best_of(accept: str, *, among: Iterable[str] | None = None) -> str:
    """The language that a browser asks for, of those there are; English if none fits.

    Args:
        accept: ``Accept-Language`` of a request (RFC 9110), as ``de-AT,de;q=0.9,en;q=0.8``.
        among: Codes to choose from; None = all.
    """
    known = tuple(among or languages())
    asked = [_quality(part) for part in accept[:400].split(",")]
    fitting = [(quality, code) for code, quality in asked if code in known and quality > 0.0]
    return max(fitting, key=lambda pair: pair[0])[1] if fitting else ENGLISH


def of_terminal() -> str:
    """The language of a command: as in the environment, where ``--language`` puts it, else English.

    Raises:
        ConfigError: If there are no texts in the language that is stated.
    """
    return checked(os.environ.get(ENVIRONMENT) or ENGLISH)


def checked(language: str) -> str:
    """The code of a language that has texts.

    Raises:
        ConfigError: If there is none.
    """
    if language not in languages():
        known = ", ".join(languages())
        raise ConfigError(f"language {language[:20]!r}: expected one of {known}")
    return language


def _quality(part: str) -> tuple[str, float]:
    found = _ASKED.fullmatch(part)
    if found is None:
        return "", 0.0
    try:
        return found[1].lower(), float(found[2] or 1.0)
    except ValueError:
        return "", 0.0
