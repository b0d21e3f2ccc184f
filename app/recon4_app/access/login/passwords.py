"""Passwords: argon2id hashes, and rejection of those an attacker finds first."""

from __future__ import annotations

import re
import socket
import threading
import unicodedata

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError
from zxcvbn import zxcvbn

from recon4.locales.coded import CodedText
from recon4_app.access.tuning import PASSWORDS
from recon4_app.errors import WeakPassword
from recon4_app.settings import allowed_hosts_from_environment

HASHER = PasswordHasher(time_cost=2, memory_cost=64 * 1024, parallelism=1)
"""64 MiB, two passes: a tenth of a second here, expensive on a graphics card."""
STAND_IN = (
    "$argon2id$v=19$m=65536,t=2,p=1$2ySJvDjQ1hOAhQrmBwnLig"
    "$4y2DWzMawV5ft4msH71j6cSQoLyUgHwqnUQvQ4Bliag"
)
"""Verified when there is no such account, so that the response takes as long. It is of
``nobody has this password``; hashing it at every start would take half a second."""

SUBSTITUTES = frozenset("4@8({[<3691!|70$5+%2")
"""Characters zxcvbn reads as letters."""

CONTEXT = (
    *("viewer", "operator", "reviewer", "admin", "administrator", "root", "user", "guest", "local"),
    *("recon4", "4recon", "recon", "lidar", "backpack", "velodyne", "mapping", "survey", "slam"),
    *("pointcloud", "surveyor", "scanner", "project", "server", "workstation", "company", "demo"),
)
"""Words an attacker knows of this product: roles, its name, its purpose."""

COMMON = (
    *("passwort", "passord", "heslo", "haslo", "motdepasse", "contrasena", "senha", "wachtwoord"),
    *("geheim", "tajne", "hallo", "sommer", "winter", "bonjour", "soleil", "changeme", "default"),
    *("thequickbrownfox", "correcthorsebatterystaple", "tobeornottobe", "maytheforcebewithyou"),
    *("qwertzuiop", "asdfghjkl", "yxcvbnm", "azertyuiop", "qsdfghjklm", "wxcvbn"),
    *("йцукенгшщзхъ", "йцукен", "фывапролджэ", "фыва", "ячсмить", "пароль", "привет"),
)
"""Common words, sentences and keyboard rows that the lists of zxcvbn (English, QWERTY) lack."""

_estimating = threading.Lock()
"""zxcvbn keeps the words it is given in a global dictionary."""


def require_strong(password: str, name: str) -> None:
    """Require that a new password withstands an offline attack.

    The estimate is that of zxcvbn (30 000 common passwords, words and names, repetitions, keyboard
    rows, sequences, dates, reversed and with substitutes), given what is known here: the person's
    name, the roles, the product, the computer. Spaces and punctuation between weak parts do not
    help much, so the estimate is repeated without them and both must suffice.

    Args:
        password: The new password.
        name: The person's name.

    Raises:
        WeakPassword: With the reason and what to change, never with the password.
    """
    shortest, longest = PASSWORDS.shortest, PASSWORDS.longest
    if not shortest <= len(password) <= longest:
        raise WeakPassword(
            CodedText("password-length", shortest=shortest, longest=longest, length=len(password))
        )
    text = _normal(password)[: PASSWORDS.longest_estimated]
    known = _known_words(name)
    if len(SUBSTITUTES.intersection(text)) <= PASSWORDS.max_substitutes:
        _check_reading(text, known, separators=0)
    letters = "".join(one for one in unicodedata.normalize("NFKD", text) if one.isalnum())
    _check_reading(letters, known, separators=len({one for one in text if not one.isalnum()}))


def hashed(password: str) -> str:
    """Argon2id hash with its salt and parameters."""
    return HASHER.hash(_normal(password))


def matches(password: str, stored: str | None) -> bool:
    """Whether a password matches its hash; takes as long when there is no hash."""
    try:
        return HASHER.verify(stored or STAND_IN, _normal(password)) and bool(stored)
    except (VerificationError, InvalidHashError):
        return False


def _normal(password: str) -> str:
    """One spelling (NFKC) for what looks the same, on every keyboard."""
    return unicodedata.normalize("NFKC", password)


def _check_reading(text: str, known: list[str], *, separators: int) -> None:
    """Check one reading of a password; each kind of separator left out counts as a factor of 10."""
    with _estimating:
        found = zxcvbn(text, user_inputs=known, max_length=2 * PASSWORDS.longest_estimated)
    strings = len(set(text.casefold())) ** len(text)
    attempts = min(int(found["guesses"]), strings) * 10**separators
    if attempts < PASSWORDS.min_attempts:
        kinds = dict.fromkeys(_kind(match) for match in found["sequence"])
        weak = [kind for kind in kinds if kind != "bruteforce"]
        raise WeakPassword(
            CodedText(
                "password-weak",
                attempts=float(f"{attempts:.0e}"),
                needed=PASSWORDS.min_attempts,
                weak=" ".join(weak) or "bruteforce",
            )
        )


def _kind(match: dict[str, object]) -> str:
    """Pattern of zxcvbn, with words that are known of the person; a word of the texts."""
    known = match.get("dictionary_name") == "user_inputs"
    return "user_inputs" if known and match["matched_word"] not in COMMON else str(match["pattern"])


def _known_words(name: str) -> list[str]:
    """Words an attacker would try first for this person on this computer."""
    names = (name, socket.gethostname(), *allowed_hosts_from_environment())
    parts = {part for one in names for part in re.split(r"[\W_]+", one) if len(part) > 2}
    return [*sorted({*parts, *names} - {""}), *CONTEXT, *COMMON]
