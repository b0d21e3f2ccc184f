"""Passwords that an attacker tries first: none of them is accepted.

Figures: every one of the 10 000 most common passwords, doubled, reversed, with a year or digits,
and every role, product, host and person's name alike, is refused; one check takes less than 2 s
whatever is sent, and the reason never contains the password.
"""

import itertools
import time

import pytest
from zxcvbn.frequency_lists import FREQUENCY_LISTS

from recon4_app.access.login import passwords
from recon4_app.access.login.passwords import require_strong
from recon4_app.access.tuning import PASSWORDS
from recon4_app.errors import WeakPassword

NAME = "Anna Kowalska"
WORDS = (
    "viewer",
    "operator",
    "reviewer",
    "admin",
    "recon4",
    "anna",
    "kowalska",
    "lidar",
    "wolkenbruch",
)


@pytest.fixture(autouse=True)
def host(monkeypatch):
    monkeypatch.setattr("socket.gethostname", lambda: "wolkenbruch.lan")


def accepted(candidates):
    """Those of the candidates that pass."""
    return [one for one in candidates if not refused(one)]


def refused(password):
    """Whether it is refused, with a reason that does not contain it."""
    try:
        require_strong(password, NAME)
    except WeakPassword as reason:
        return password.casefold() not in str(reason).casefold()
    return False


def dressed(word):
    """A word extended to twelve characters as people do it."""
    yield from (word * 2, word[::-1] * 2, word.title() * 2, word * 3, f"{word}-{word}")
    yield from (f"{word}123456", f"{word}2026{word}", f"123456{word}", f"{word}!!!!!!!!")
    yield from (f"{word} {word} {word}", f"{word}.{word[::-1]}", " ".join(word * 2))
    yield word.translate(str.maketrans("aeio", "4310")) * 2


@pytest.mark.parametrize("word", WORDS)
def test_a_name_known_here_is_no_password_however_it_is_dressed(word):
    candidates = [one for one in dressed(word) if len(one) >= PASSWORDS.shortest]

    assert len(candidates) >= 5
    assert accepted(candidates) == []


def test_two_names_known_here_joined_are_no_password():
    pairs = itertools.permutations(WORDS, 2)
    joined = [a + between + b for a, b in pairs for between in ("", " ", "-", "1")]

    assert accepted([one for one in joined if len(one) >= PASSWORDS.shortest]) == []


def test_the_ten_thousand_most_common_passwords_are_refused_also_doubled_and_with_a_year():
    common = FREQUENCY_LISTS["passwords"][:10_000]
    assert len(common) == 10_000
    long_ones = [one for one in common if len(one) >= PASSWORDS.shortest]
    sample = common[::100]
    doubled = [(one * 3)[: max(12, 2 * len(one))] for one in sample]
    with_year = [f"{one}{'2026' * 3}"[: max(12, len(one) + 4)] for one in sample]

    assert accepted(long_ones + doubled + with_year) == []


@pytest.mark.parametrize(
    "password",
    [
        "qwertyuiop[]",
        "qwertzuiopasdfghjkl",
        "йцукенгшщзхъ",
        "zaq12wsxcde3",
        "sunshinefootball",
        "dragonmonkey12",
        "iloveyoubaby",
        "thequickbrownfox",
        "heslohesloheslo",
        "abbabaabbaba",
        "12.11.1987 1987",
        "\ud800" * 12,
        "a" * 256,
        "-" * 64,
    ],
)
def test_rows_sentences_dates_and_few_characters_are_no_passwords(password):
    assert accepted([password]) == []


def test_the_reason_says_what_to_change():
    with pytest.raises(WeakPassword) as reason:
        require_strong("kowalska2026", NAME)

    assert "your name" in str(reason.value)
    assert "date or year" in str(reason.value)
    assert "Add two or three unrelated words" in str(reason.value)


@pytest.mark.parametrize(
    "password",
    ["4@8({[<3691!|750$+%2" * 12, "1!7|4@0$5" * 28, "ab" * 128, "password" * 32, "١" * 256],
)
def test_no_password_makes_the_check_slow(password):
    began = time.monotonic()
    accepted([password[: PASSWORDS.longest]])

    assert time.monotonic() - began < 2.0


def test_one_estimate_at_a_time_as_the_estimator_keeps_its_words_in_a_global(monkeypatch):
    estimate, locked = passwords.zxcvbn, []

    def watched(*args, **options):
        locked.append(passwords._estimating.locked())
        return estimate(*args, **options)

    monkeypatch.setattr("recon4_app.access.login.passwords.zxcvbn", watched)
    require_strong("copper violin under seven hedges", NAME)

    assert locked == [True, True]
