"""Which passwords are refused, and how they are kept."""

import pytest

from recon4_app.access.login import passwords
from recon4_app.errors import WeakPassword


@pytest.mark.parametrize(
    "password",
    [
        "short",
        "elevenchars",
        "x" * 257,
        "password1234",
        "Password2024!",
        "P@ssw0rd1234",
        "aaaaaaaaaaaaaaaa",
        "abcabcabcabcabc",
        "123456789012",
        "qwertyuiopasdfghjkl",
        "1qaz2wsx3edc4rfv",
        "987654321098",
        "recon4recon4",
        "Recon4-2026-admin",
        "anna.kowalska1",
        "kowalska2026",
        "welcome12345",
        "summer2026!!",
        "            ",
        "adminadmin12",
        "letmeinletmein",
        "correct horse battery staple",
    ],
)
def test_what_is_guessed_first_is_refused_without_repeating_it(password):
    with pytest.raises(WeakPassword) as refused:
        passwords.require_strong(password, "Anna Kowalska")

    assert password not in str(refused.value) or not password.strip()


@pytest.mark.parametrize(
    "password",
    [
        "copper violin under seven hedges",
        "Xk7$m-2!vR9z",
        "three green owls dance",
        "vGk3-tPq9-LmZ2",
        "žlutý kůň skáče přes",
        "绿色的猫头鹰在月光下跳舞唱歌",
        "Xk7$mQ2!vR9z",
    ],
)
def test_what_takes_long_to_guess_is_taken(password):
    passwords.require_strong(password, "Anna Kowalska")


def test_a_hash_is_argon2id_dear_enough_and_salted():
    first, second = passwords.hashed("three green owls"), passwords.hashed("three green owls")

    assert first.startswith("$argon2id$v=19$m=65536,t=2,p=1$")
    assert first != second
    assert passwords.matches("three green owls", first)
    assert not passwords.matches("three green owl", first)


def test_the_same_letters_typed_otherwise_are_the_same_password():
    stored = passwords.hashed("caf\u00e9 au lait noir")

    assert passwords.matches("cafe\u0301 au lait noir", stored)


@pytest.mark.parametrize("stored", [None, "", "no hash", "$argon2id$v=19$m=1"])
def test_nothing_fits_what_is_no_hash(stored):
    assert not passwords.matches("nobody has this password", stored)


def test_a_name_without_an_account_costs_as_much_as_one_with_an_account():
    assert not passwords.HASHER.check_needs_rehash(passwords.STAND_IN)
    assert passwords.HASHER.verify(passwords.STAND_IN, "nobody has this password")
    assert not passwords.matches("nobody has this password", None)
