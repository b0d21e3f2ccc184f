"""Invitations and requests of phones, with a clock in hand."""

import contextlib
import threading

import pytest

from recon4_app.access.pairing.pairings import Pairings, roles_for
from recon4_app.access.people import Person, Role
from recon4_app.access.tuning import PAIRING
from recon4_app.errors import NotFound, Refused, TooMany

OTTO = Person("otto", Role.OPERATOR)
VERA = Person("vera", Role.VIEWER)
RITA = Person("rita", Role.REVIEWER)


@pytest.fixture
def pairings(clock):
    return Pairings(clock)


def test_an_invitation_lets_one_phone_in_once(pairings):
    token = pairings.invite(OTTO, Role.OPERATOR)

    grant = pairings.redeem(token, "192.0.2.1")

    assert (grant.person, grant.role) == ("otto", Role.OPERATOR)
    assert len(token) >= 22  # 128 bits, six a letter
    with pytest.raises(Refused, match="used already"):
        pairings.redeem(token, "192.0.2.1")


def test_an_invitation_is_good_for_two_minutes(pairings, clock):
    in_time, late = (pairings.invite(OTTO, Role.VIEWER) for _ in range(2))
    clock.now_s += PAIRING.invitation_s

    assert pairings.redeem(in_time, "192.0.2.1").role is Role.VIEWER
    clock.now_s += 0.1
    with pytest.raises(Refused):
        pairings.redeem(late, "192.0.2.1")


def test_fifty_phones_with_one_invitation_are_one(pairings):
    token = pairings.invite(OTTO, Role.VIEWER)
    gate, won = threading.Barrier(50), []

    def redeem(k):
        gate.wait()
        with contextlib.suppress(Refused):
            won.append(pairings.redeem(token, f"192.0.2.{k}"))

    threads = [threading.Thread(target=redeem, args=(k,)) for k in range(50)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(won) == 1


@pytest.mark.parametrize(
    ("maker", "roles"),
    [
        (OTTO, [Role.OPERATOR, Role.VIEWER]),
        (VERA, [Role.VIEWER]),
        (RITA, [Role.VIEWER]),
        (Person("anna", Role.ADMIN), [Role.OPERATOR, Role.VIEWER]),
        (Person("nobody", Role.NOBODY), []),
    ],
)
def test_a_phone_never_may_more_than_who_lets_it_in(pairings, maker, roles):
    assert roles_for(maker) == roles
    for role in set(Role) - set(roles):
        with pytest.raises(Refused, match="may not pair"):
            pairings.invite(maker, role)
        with pytest.raises(Refused):
            pairings.approve("000000", maker, role)


def test_a_phone_waits_with_its_digits_until_somebody_types_them(pairings):
    asked = pairings.request("Otto's phone", "192.0.2.7")
    assert pairings.claim(asked.token) is None

    found = pairings.approve(asked.code, OTTO, Role.OPERATOR)

    assert (found.name, found.address) == ("Otto's phone", "192.0.2.7")
    grant = pairings.claim(asked.token)
    assert grant is not None and (grant.person, grant.role) == ("otto", Role.OPERATOR)
    with pytest.raises(Refused):
        pairings.claim(asked.token)
    with pytest.raises(NotFound):
        pairings.approve(asked.code, OTTO, Role.OPERATOR)


def test_digits_are_good_for_five_minutes_and_are_no_token(pairings, clock):
    asked = pairings.request("phone", "192.0.2.7")
    with pytest.raises(Refused):
        pairings.claim(asked.code)
    assert asked.token not in repr(asked)
    clock.now_s += PAIRING.request_s + 0.1

    with pytest.raises(NotFound):
        pairings.approve(asked.code, OTTO, Role.VIEWER)
    with pytest.raises(Refused):
        pairings.claim(asked.token)


def test_digits_cannot_be_guessed_by_trying(pairings, clock):
    asked = pairings.request("phone", "192.0.2.7")
    wrong = f"{(int(asked.code) + 1) % 1_000_000:06d}"
    for _ in range(PAIRING.tries_a_minute):
        with pytest.raises(NotFound):
            pairings.approve(wrong, OTTO, Role.VIEWER)

    with pytest.raises(TooMany):
        pairings.approve(asked.code, OTTO, Role.VIEWER)
    clock.now_s += 60.0 / PAIRING.tries_a_minute
    assert pairings.approve(asked.code, OTTO, Role.VIEWER).code == asked.code


def test_tokens_cannot_be_guessed_by_trying(pairings):
    token = pairings.invite(OTTO, Role.VIEWER)
    for _ in range(PAIRING.tries_a_minute):
        with pytest.raises(Refused):
            pairings.redeem("attempt", "192.0.2.66")

    with pytest.raises(TooMany):
        pairings.redeem(token, "192.0.2.66")
    assert pairings.redeem(token, "192.0.2.1").person == "otto"


def test_a_flood_of_requests_keeps_no_other_phone_out(pairings, clock):
    for _ in range(PAIRING.max_open_a_network):
        pairings.request("flood", "192.0.2.66")
    with pytest.raises(TooMany):
        pairings.request("flood", "192.0.2.66")

    assert len(pairings.request("phone", "192.0.2.1").code) == 6


def test_never_more_than_twenty_wait(pairings, clock):
    codes = {pairings.request("x", f"192.0.{k}.1").code for k in range(PAIRING.max_open)}
    assert len(codes) == PAIRING.max_open
    with pytest.raises(TooMany):
        pairings.request("x", "198.51.100.1")
    clock.now_s += PAIRING.request_s + 0.1
    pairings.request("x", "198.51.100.1")


def test_a_name_is_short_and_cannot_forge_lines(pairings):
    with pytest.raises(Refused, match="64"):
        pairings.request("x" * 65, "192.0.2.1")
    asked = pairings.request("a\nb\x1b[2J", "192.0.2.1")

    assert pairings.approve(asked.code, OTTO, Role.VIEWER).name.isprintable()
