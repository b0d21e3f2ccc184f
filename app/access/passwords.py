"""Passwords: argon2id hashes, and refusal of those that are guessed first."""

from __future__ import annotations

import re
import unicodedata

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError

from app.errors import WeakPassword

SHORTEST, LONGEST = 12, 256
"""Characters of a password."""
LEAST_FREE = 6
"""So many characters must be left after all that is guessed first is taken out."""

HASHER = PasswordHasher(time_cost=2, memory_cost=64 * 1024, parallelism=1)
"""64 MiB, two passes: a tenth of a second here, dear on a graphics card."""
STAND_IN = HASHER.hash("nobody has this password")
"""Verified when there is no such person, so that the answer takes as long."""

WORDS = (
    *(
        "password",
        "passwort",
        "passord",
        "heslo",
        "secret",
        "geheim",
        "tajne",
        "letmein",
        "welcome",
    ),
    *("changeme", "default", "admin", "administrator", "root", "user", "guest", "test", "login"),
    *("master", "server", "access", "hello", "hallo", "monkey", "dragon", "football", "baseball"),
    *("sunshine", "princess", "iloveyou", "superman", "batman", "starwars", "pokemon", "whatever"),
    *("spring", "summer", "autumn", "winter", "recon4", "recon", "lidar", "backpack", "velodyne"),
    *("mapping", "survey", "company", "computer", "internet", "system", "demo", "love", "pass"),
)
"""Words that guessing begins with, the product's own included."""

ROWS = (
    "abcdefghijklmnopqrstuvwxyz",
    "01234567890",
    "qwertyuiop",
    "qwertzuiop",
    "azertyuiop",
    "asdfghjkl",
    "zxcvbnm",
    "yxcvbnm",
    "1q2w3e4r5t6y7u8i9o0p",
    "1qaz2wsx3edc4rfv5tgb",
)
"""Neighbours in the alphabet and on keyboards."""

LEET = str.maketrans("013457@$!", "oleastasi")
YEAR = re.compile(r"(19|20)\d\d")
REPEATED = re.compile(r"(.{1,4})\1{2,}")


def check(password: str, name: str) -> None:
    """See that a new password is none that is guessed first.

    Raises:
        WeakPassword: With the reason, never with the password.
    """
    if not SHORTEST <= len(password) <= LONGEST:
        raise WeakPassword(
            f"the password needs {SHORTEST} to {LONGEST} characters, got {len(password)}; "
            "a few words you do not say together are good"
        )
    folded = unicodedata.normalize("NFKC", password).casefold()
    for text in (folded, folded.translate(LEET)):
        free = _free(text, name.casefold())
        if len(free) < LEAST_FREE or len(set(free)) < LEAST_FREE - 1:
            raise WeakPassword(
                "the password is guessed too easily: it is mostly a common word, your name, a "
                "year, a row of keys or a repetition; take a few words you do not say together"
            )


def hashed(password: str) -> str:
    """Argon2id hash with its salt and parameters."""
    return HASHER.hash(_normal(password))


def fits(password: str, stored: str | None) -> bool:
    """Whether a password is the one hashed; takes as long when there is none."""
    try:
        return HASHER.verify(stored or STAND_IN, _normal(password)) and bool(stored)
    except (VerificationError, InvalidHashError):
        return False


def _normal(password: str) -> str:
    """One spelling for what looks the same, whatever keyboard it was typed on."""
    return unicodedata.normalize("NFKC", password)


def _free(text: str, name: str) -> str:
    """What is left of a password when all that is guessed first is taken out."""
    names = {part for part in re.split(r"[\W_]+", name) if len(part) > 2} | {name}
    for word in sorted({*WORDS, *names} - {""}, key=len, reverse=True):
        text = text.replace(word, "")
    text = REPEATED.sub("", YEAR.sub("", text))
    for row in ROWS:
        for way in (row, row[::-1]):
            text = _without_runs(text, way)
    return re.sub(r"\s", "", text)


def _without_runs(text: str, row: str) -> str:
    """Without pieces of four or more neighbours in a row."""
    for length in range(len(row), 3, -1):
        for start in range(len(row) - length + 1):
            text = text.replace(row[start : start + length], "")
    return text
