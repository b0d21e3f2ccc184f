"""Guest links: tokens, ends, and what outlives nothing."""

import sqlite3
from datetime import UTC, datetime

import pytest

from recon4_app.access.people import Person, Role
from recon4_app.access.restoring import access_copies
from recon4_app.access.tuning import GUEST_LINK
from recon4_app.errors import Refused, TooMany

DAY_S = 24 * 3600.0

RITA = Person("Rita", Role.REVIEWER)
PLACE = {"address": "203.0.113.7", "agent": "a browser"}


@pytest.fixture
def shared(access):
    """A link to the project office, with its token."""
    access.accounts.add("Rita", Role.REVIEWER, "three green owls dance")
    return access.guests.make("office", RITA, label="Client", days=7)


def opens(access, token):
    entry = access.guests.open(token, **PLACE)
    return access.sessions.find(entry.token)


def test_a_guest_sees_one_project_until_the_link_expires(access, shared, clock):
    link, token = shared

    found = opens(access, token)

    assert found.person == Person("guest: Client", Role.GUEST, "office")
    assert (link.by, link.until_s) == ("Rita", clock.now_s + 7 * DAY_S)
    clock.now_s += 7 * DAY_S
    assert access.sessions.alive(found.session.id) is None
    day = datetime.fromtimestamp(link.until_s, UTC).date()
    with pytest.raises(Refused, match=f"expired on {day}"):
        access.guests.open(token, **PLACE)
    assert not access.guests.of_project("office")[0].works


def test_a_session_begun_late_ends_with_its_link(access, shared, clock):
    _, token = shared
    clock.now_s += 7 * DAY_S - 60.0

    found = opens(access, token)

    clock.now_s += 59.0
    assert access.sessions.alive(found.session.id) is not None
    clock.now_s += 1.0
    assert access.sessions.alive(found.session.id) is None


def test_no_token_is_on_the_disk(access, shared, tmp_path):
    _, token = shared
    entry = access.guests.open(token, **PLACE)

    stored = b"".join(path.read_bytes() for path in tmp_path.iterdir() if path.is_file())

    assert b"Client" in stored
    assert token.encode() not in stored and entry.token.encode() not in stored


def test_a_revoked_link_opens_nothing_and_ends_its_sessions(access, shared, clock):
    link, token = shared
    entry = access.guests.open(token, **PLACE)
    assert access.sessions.find(entry.token) is not None  # and it is cached now

    access.guests.revoke(link, RITA)

    assert access.sessions.cached_sessions(entry.token) is None
    assert access.sessions.find(entry.token) is None
    day = datetime.fromtimestamp(clock.now_s, UTC).date()
    clock.now_s += 30 * DAY_S  # it would have expired, too
    with pytest.raises(Refused, match=f"revoked on {day}"):
        access.guests.open(token, **PLACE)
    (after,) = access.guests.of_project("office")
    assert (after.revoked_by, after.opened, after.works) == ("Rita", 1, False)


@pytest.mark.parametrize("change", ["disable", "demote"])
def test_a_link_ends_with_the_rights_of_its_maker(access, shared, change):
    _, token = shared
    entry = access.guests.open(token, **PLACE)

    if change == "disable":
        access.accounts.set_disabled("Rita", True)
    else:
        access.accounts.set_role("Rita", Role.VIEWER)

    assert access.sessions.find(entry.token) is None
    with pytest.raises(Refused):
        access.guests.open(token, **PLACE)


def test_guesses_are_limited(access):
    for _ in range(GUEST_LINK.tries_a_minute):
        with pytest.raises(Refused, match="no such link"):
            access.guests.open("x" * 43, **PLACE)

    with pytest.raises(TooMany):
        access.guests.open("x" * 43, **PLACE)


def test_the_oldest_browser_of_a_link_leaves_for_the_newest(access, shared, clock, monkeypatch):
    _, token = shared
    entries = []
    for place in range(GUEST_LINK.max_sessions + 1):
        clock.now_s += 1.0
        at = {**PLACE, "address": f"203.0.113.{place}"}
        entries.append(access.guests.open(token, **at).token)

    assert access.sessions.find(entries[0]) is None
    assert access.sessions.find(entries[1]) is not None
    assert access.sessions.all(person="Rita") == []  # no session of hers


def test_a_restored_copy_has_no_links(access, shared, tmp_path):
    access_copies(tmp_path).make(renew=True)

    (copy,) = (tmp_path / "backups").glob("access-*.sqlite")
    with sqlite3.connect(copy) as database:
        assert database.execute("SELECT count(*) FROM people").fetchone() == (1,)
        assert database.execute("SELECT count(*) FROM guest_links").fetchone() == (0,)
    database.close()


@pytest.mark.parametrize("role", [Role.GUEST, Role.NOBODY])
def test_no_account_is_a_guest(access, role):
    with pytest.raises(Refused, match="cannot be assigned"):
        access.accounts.add("Gus", role, "three green owls dance")
