"""People, sessions and throttling, with a clock in hand."""

import asyncio
import contextlib
import re
import threading

import pytest
from msgspec import structs

from recon4_app.access.login.login_service import LoginOrigin
from recon4_app.access.login.sessions import LIVES, form_token
from recon4_app.access.middleware import session as session_middleware
from recon4_app.access.people import ASSIGNABLE, Role
from recon4_app.errors import Conflict, NotFound, Refused, WeakPassword, WrongPassword
from tests.deadlines import HANG_S

PASSWORD = "three green owls dance"
HERE = LoginOrigin(address="192.0.2.1", agent="Firefox", browser="")


# -- sessions


@pytest.mark.parametrize("role", ASSIGNABLE)
def test_a_session_ends_when_it_was_idle_too_long_and_not_before(access, clock, role):
    access.accounts.add("Anna", role, PASSWORD)
    token = access.sessions.begin("Anna", address="?", agent="")

    clock.now_s += LIVES[role].idle_s - 1.0
    before = access.sessions.find(token)
    clock.now_s += 2.0

    assert before is not None and before.person.role is role
    assert access.sessions.find(token) is None
    assert access.sessions.cached_sessions(token) is None


@pytest.mark.parametrize("role", ASSIGNABLE)
def test_a_session_in_use_ends_at_last(access, clock, role):
    access.accounts.add("Anna", role, PASSWORD)
    token = access.sessions.begin("Anna", address="?", agent="")
    began_s = clock.now_s

    while (visit := access.sessions.find(token)) is not None:
        access.sessions.note(visit.session)
        clock.now_s += LIVES[role].idle_s / 2

    assert LIVES[role].whole_s < clock.now_s - began_s <= LIVES[role].whole_s * 1.5
    assert access.sessions.all() == []


def test_a_socket_outlives_no_session_even_if_a_cancellation_is_lost(access, clock, monkeypatch):
    monkeypatch.setattr(
        session_middleware,
        "SESSION_WATCH",
        structs.replace(session_middleware.SESSION_WATCH, look_again_s=0.01),
    )
    monkeypatch.setattr(
        session_middleware,
        "SESSION_WATCH",
        structs.replace(session_middleware.SESSION_WATCH, cancel_again_s=0.01),
    )
    access.accounts.add("Anna", Role.VIEWER, PASSWORD)
    session = access.sessions.find(access.sessions.begin("Anna", address="?", agent="")).session
    sent = []

    async def loses_one(scope, receive, send):
        await send({"type": "websocket.accept"})
        access.sessions.end(session.id)
        with contextlib.suppress(asyncio.CancelledError):
            await asyncio.Event().wait()
        await asyncio.Event().wait()

    async def send(message):
        sent.append(message["type"])

    async def open_socket():
        monitor = session_middleware.SessionMonitor(access, session, {"type": "websocket"})
        async with asyncio.timeout(HANG_S):
            await monitor.run(loses_one, asyncio.Event().wait, send)

    asyncio.run(open_socket())

    assert sent == ["websocket.accept", "websocket.close"]


def test_the_lives_of_sessions_are_as_documented():
    assert LIVES[Role.VIEWER].whole_s == 12 * 3600
    assert (LIVES[Role.OPERATOR].whole_s, LIVES[Role.OPERATOR].idle_s) == (12 * 3600, 2 * 3600)
    assert (LIVES[Role.ADMIN].whole_s, LIVES[Role.ADMIN].idle_s) == (8 * 3600, 1800)


def test_the_age_of_a_login_counts_from_the_last_password(access, clock):
    access.accounts.add("Anna", Role.REVIEWER, PASSWORD)
    token = access.sessions.begin("Anna", address="?", agent="")
    clock.now_s += 1000.0
    old_age_s = access.sessions.age_s(access.sessions.find(token).session)

    fresh = access.sessions.prove(access.sessions.find(token).session.id)

    assert old_age_s == 1000.0
    assert access.sessions.find(token) is None
    assert access.sessions.age_s(access.sessions.find(fresh).session) == 0.0


def test_two_sessions_have_two_form_tokens_that_do_not_tell_the_session(access):
    access.accounts.add("Anna", Role.VIEWER, PASSWORD)
    one, two = (access.sessions.begin("Anna", address="?", agent="") for _ in range(2))

    assert form_token(one) != form_token(two)
    assert one not in form_token(one)


# -- people


@pytest.mark.parametrize(
    "name",
    [
        "",
        " ",
        "a" * 65,
        "../../etc",
        "a/b",
        "a\nb",
        "a\x00b",
        "\u202eanna",
        "<b>x",
        "_anna",
    ],
)
def test_unfit_names_are_refused(access, name):
    with pytest.raises(Refused, match=re.escape("letters, digits, spaces and . ' @ + - _;")):
        access.accounts.add(name, Role.VIEWER, PASSWORD)


@pytest.mark.parametrize("name", ["local", "LOCAL", "Nobody"])
def test_names_of_people_without_an_account_are_reserved(access, name):
    with pytest.raises(Refused, match=f"{name}.* is reserved"):
        access.accounts.add(name, Role.VIEWER, PASSWORD)


@pytest.mark.parametrize(
    "name", ["Anna", "Žofie Nováková", "李小龙", "o'brien", "a.b@example.org", "a_b_"]
)
def test_names_of_any_script_are_taken(access, name):
    assert access.accounts.add(name, Role.VIEWER, PASSWORD).name == name


def test_one_name_in_other_letters_is_the_same_person(access):
    access.accounts.add("Straße", Role.VIEWER, PASSWORD)

    assert access.accounts.get("STRASSE").name == "Straße"
    with pytest.raises(Conflict):
        access.accounts.add("strasse", Role.VIEWER, PASSWORD)


def test_nobody_can_be_given_no_role(access):
    with pytest.raises(Refused):
        access.accounts.add("Anna", Role.NOBODY, PASSWORD)


def test_the_last_admin_stays_and_what_failed_changed_nothing(access):
    access.accounts.add("Anna", Role.ADMIN, PASSWORD)
    token = access.sessions.begin("Anna", address="?", agent="")

    with pytest.raises(Conflict):
        access.accounts.set_role("Anna", Role.VIEWER)

    assert access.accounts.get("Anna").role is Role.ADMIN
    assert access.sessions.find(token) is not None


def test_who_is_disabled_is_out_at_once_and_cannot_come_back(access, logins):
    access.accounts.add("Anna", Role.ADMIN, PASSWORD)
    access.accounts.add("Vera", Role.VIEWER, PASSWORD)
    token = logins.sign_in("Vera", PASSWORD, HERE).session

    access.accounts.set_disabled("Vera", True)

    assert access.sessions.find(token) is None
    with pytest.raises(WrongPassword):
        logins.sign_in("Vera", PASSWORD, HERE)


# -- the first admin


def test_the_one_time_token_makes_one_admin_even_when_used_twice_at_once(access, logins):
    token = logins.open_setup()
    made = []

    def use(name):
        with contextlib.suppress(Refused):
            made.append(logins.set_up(token, name, password=PASSWORD, caller=HERE).account.name)

    threads = [threading.Thread(target=use, args=(name,)) for name in ("Anna", "Bert", "Carl")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    assert len(made) == 1
    assert len(access.accounts.all()) == 1


def test_without_a_setup_opened_no_token_is_right(access, logins):
    for token in ("", "x", "0" * 43):
        with pytest.raises(Refused):
            logins.set_up(token, "Anna", password=PASSWORD, caller=HERE)


def test_a_weak_password_does_not_use_up_the_token(access, logins):
    token = logins.open_setup()
    with pytest.raises(WeakPassword):
        logins.set_up(token, "Anna", password="password1234", caller=HERE)

    assert logins.set_up(token, "Anna", password=PASSWORD, caller=HERE).account.role is Role.ADMIN


def test_a_missing_account_is_reported(access):
    with pytest.raises(NotFound, match="no account is named"):
        access.accounts.get("Anna")
