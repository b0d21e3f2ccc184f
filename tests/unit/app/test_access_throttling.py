"""Waiting between logins: by person, by household, with a clock in hand."""

import threading

import pytest

from recon4_app.access.login.login_backoff import LoginBackoff, TokenBuckets, network
from recon4_app.access.login.login_service import LoginOrigin
from recon4_app.access.people import Role
from recon4_app.errors import TooMany, WrongPassword

PASSWORD = "three green owls dance"
HERE = LoginOrigin(address="192.0.2.1", agent="Firefox", browser="")


def test_waiting_doubles_up_to_a_quarter_of_an_hour(clock):
    waits = LoginBackoff(clock=clock)
    free = [waits.begin("anna") for _ in range(5)]
    waited = []
    for _ in range(14):
        left_s = waits.begin("anna")
        waited.append(left_s)
        clock.now_s += left_s
        assert waits.begin("anna") == 0.0

    assert free == [0.0] * 5
    assert waited[:4] == [1.0, 2.0, 4.0, 8.0]
    assert max(waited) == waited[-1] == 900.0


def test_asking_while_one_waits_does_not_make_it_longer(clock):
    waits = LoginBackoff(clock=clock)
    for _ in range(5):
        waits.begin("anna")

    assert {waits.begin("anna") for _ in range(100)} == {1.0}


def test_parallel_tries_are_counted_before_they_are_judged(clock):
    waits, passed = LoginBackoff(clock=clock), []
    threads = [
        threading.Thread(target=lambda: passed.append(waits.begin("anna") == 0.0))
        for _ in range(50)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    assert sum(passed) == 5


def test_a_bucket_refills(clock):
    buckets = TokenBuckets(burst=3, per_s=0.5, clock=clock)
    taken = [buckets.take("a") for _ in range(4)]
    clock.now_s += 2.0

    assert taken == [0.0, 0.0, 0.0, 2.0]
    assert (buckets.take("a"), buckets.take("a") > 0, buckets.take("b")) == (0.0, True, 0.0)


def test_1000_guesses_get_few_tries_and_the_owner_behind_the_same_address_still_gets_in(
    access, logins, clock
):
    access.accounts.add("Anna", Role.ADMIN, PASSWORD)
    known = logins.sign_in("Anna", PASSWORD, HERE).browser
    outcomes = []
    for _ in range(1000):
        clock.now_s += 1.0
        with pytest.raises((WrongPassword, TooMany)) as refused:
            logins.sign_in("Anna", "wrong", HERE)
        outcomes.append(refused.type)

    assert outcomes.count(WrongPassword) < 20
    owner = LoginOrigin(address=HERE.address, agent="", browser=known)
    assert logins.sign_in("Anna", PASSWORD, owner).account.name == "Anna"
    clock.now_s += 900.0  # no ban is for ever
    assert logins.sign_in("Anna", PASSWORD, HERE).account.name == "Anna"


def test_many_names_from_one_address_are_throttled_together(access, logins, clock):
    outcomes = []
    for k in range(300):
        with pytest.raises((WrongPassword, TooMany)) as refused:
            logins.sign_in(f"person {k}", "wrong", HERE)
        outcomes.append(refused.type)

    assert outcomes.count(WrongPassword) == 100
    clock.now_s += 3600.0
    with pytest.raises(WrongPassword):
        logins.sign_in("somebody", "wrong", HERE)


def test_a_known_browser_is_known_for_its_person_only(access, logins):
    for name in ("Anna", "Bert"):
        access.accounts.add(name, Role.ADMIN, PASSWORD)
    annas = logins.sign_in("Anna", PASSWORD, HERE).browser

    assert access.sessions.knows_browser(annas, "anna")
    assert not access.sessions.knows_browser(annas, "Bert")


@pytest.mark.parametrize(
    ("address", "counted_as"),
    [
        ("192.0.2.1", "192.0.2.1"),
        ("::ffff:192.0.2.1", "192.0.2.1"),
        ("2001:db8:1:2:3:4:5:6", "2001:db8:1:2::/64"),
        ("?", "?"),
    ],
)
def test_guesses_are_counted_by_household(address, counted_as):
    assert network(address) == counted_as
