"""People, sessions and throttling, with a clock in hand."""

import contextlib
import sqlite3
import threading
from dataclasses import replace

import pytest

from app.access.audit import link
from app.access.login.login_backoff import LoginBackoff, TokenBuckets, network
from app.access.login.login_service import LoginOrigin, LoginService, open_access
from app.access.login.sessions import LIVES, form_token
from app.access.people import LOCAL, Role
from app.errors import Conflict, NotFound, Refused, TooMany, WeakPassword, WrongPassword
from app.network.certificate import made_certificate, own_certificate
from app.network.hosts import own_names
from recon4.errors import ConfigError

PASSWORD = "three green owls dance"
HERE = LoginOrigin(address="192.0.2.1", agent="Firefox", browser="")


@pytest.fixture
def access(tmp_path, clock, monkeypatch):
    # One round of little memory: what is tested here is not how dear a hash is.
    monkeypatch.setattr("app.access.login.passwords.hashed", lambda password: f"hash of {password}")
    monkeypatch.setattr(
        "app.access.login.passwords.fits", lambda password, stored: stored == f"hash of {password}"
    )
    opened = open_access(tmp_path, login=True, clock=clock)
    yield opened
    opened.close()


@pytest.fixture
def logins(access, clock):
    return LoginService(access.accounts, access.sessions, clock=clock)


# -- sessions


@pytest.mark.parametrize("role", LIVES)
def test_a_session_ends_when_it_was_idle_too_long_and_not_before(access, clock, role):
    access.accounts.add("Anna", role, PASSWORD)
    token = access.sessions.begin("Anna", address="?", agent="")

    clock.now_s += LIVES[role].idle_s - 1.0
    before = access.sessions.find(token)
    clock.now_s += 2.0

    assert before is not None and before.person.role is role
    assert access.sessions.find(token) is None
    assert access.sessions.cached_sessions(token) is None


@pytest.mark.parametrize("role", LIVES)
def test_a_session_in_use_ends_at_last(access, clock, role):
    access.accounts.add("Anna", role, PASSWORD)
    token = access.sessions.begin("Anna", address="?", agent="")
    began_s = clock.now_s

    while (visit := access.sessions.find(token)) is not None:
        access.sessions.note(visit.session)
        clock.now_s += LIVES[role].idle_s / 2

    assert LIVES[role].whole_s < clock.now_s - began_s <= LIVES[role].whole_s * 1.5
    assert access.sessions.all() == []


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
        "local",
        "LOCAL",
    ],
)
def test_unfit_names_are_refused(access, name):
    with pytest.raises(Refused):
        access.accounts.add(name, Role.VIEWER, PASSWORD)


@pytest.mark.parametrize("name", ["Anna", "Žofie Nováková", "李小龙", "o'brien", "a.b@example.org"])
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


# -- throttling


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


# -- the audit log


def test_the_log_is_a_chain_that_shows_what_was_changed(access, tmp_path):
    for k in range(5):
        access.log.add("Anna", "192.0.2.1", action="start job", what=f"office {k}")
    whole = access.log.check()

    with sqlite3.connect(tmp_path / "access.sqlite") as file:
        file.execute("DROP TRIGGER audit_no_update")
        file.execute("UPDATE audit SET person = 'Bert' WHERE number = 3")
    file.close()

    assert (whole.entries, whole.broken_at) == (5, None)
    assert access.log.check().broken_at == 3


def test_a_row_forged_together_with_its_hash_shows_at_the_next(access, tmp_path):
    for k in range(5):
        access.log.add("Anna", "?", action="start job", what=f"office {k}")
    newest = access.log.newest(5)
    forged = replace(newest[2], person="Bert")
    forged = replace(forged, hash=link(newest[3].hash, forged))

    with sqlite3.connect(tmp_path / "access.sqlite") as file:
        file.execute("DROP TRIGGER audit_no_update")
        values = (forged.person, forged.hash)
        file.execute("UPDATE audit SET person = ?, hash = ? WHERE number = 3", values)
    file.close()

    assert access.log.check().broken_at == 4


def test_a_row_taken_out_shows(access, tmp_path):
    for k in range(5):
        access.log.add("Anna", "?", action="start job", what=f"office {k}")

    with sqlite3.connect(tmp_path / "access.sqlite") as file:
        file.execute("DROP TRIGGER audit_no_delete")
        file.execute("DELETE FROM audit WHERE number = 2")
    file.close()

    assert access.log.check().broken_at == 3


@pytest.mark.parametrize("statement", ["UPDATE audit SET person = 'x'", "DELETE FROM audit"])
def test_rows_are_only_ever_added(access, tmp_path, statement):
    access.log.add("Anna", "?", action="start job", what="office")

    with (
        sqlite3.connect(tmp_path / "access.sqlite") as file,
        pytest.raises(sqlite3.IntegrityError, match="only ever added"),
    ):
        file.execute(statement)
    file.close()


def test_entries_of_several_threads_and_processes_make_one_chain(access, tmp_path, clock):
    other = open_access(tmp_path, login=True, clock=clock)
    threads = [
        threading.Thread(target=lambda log=log: log.add("Anna", "?", action="x", what="y"))
        for log in (access.log, other.log) * 10
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    other.close()

    assert (access.log.check().entries, access.log.check().broken_at) == (20, None)


def test_forged_lines_and_endless_texts_do_not_get_into_the_log(access):
    access.log.add("An\nna", "?", action="x", what="a\r\n\x1b[2J\u202e" + "b" * 10_000)

    entry = access.log.newest(1)[0]
    assert entry.person == "An\N{REPLACEMENT CHARACTER}na"
    assert entry.object.isprintable()
    assert len(entry.object) == 300


def test_a_flood_of_refusals_is_counted_and_does_not_fill_the_disk(access, clock):
    for _ in range(500):
        access.log.add("nobody", "?", action="request", what="/", outcome="refused")
    access.log.add(LOCAL.name, "?", action="start job", what="office")
    clock.now_s += 60.0
    access.log.add("nobody", "?", action="request", what="/", outcome="refused")

    entries = access.log.newest(1000)
    assert len(entries) == 62
    assert entries[1].action == "start job"
    assert "440 more" in entries[0].object


# -- the certificate


def test_a_certificate_is_made_once_for_this_computers_names(tmp_path):
    made = made_certificate(tmp_path / "tls", own_names())
    again = made_certificate(tmp_path / "tls", own_names())

    assert made.fingerprint() == again.fingerprint()
    assert len(made.fingerprint()) == 95
    assert {"localhost", "127.0.0.1", "::1"} <= made.names()
    assert made.key.stat().st_mode & 0o777 == 0o600


def test_a_damaged_certificate_is_made_anew(tmp_path):
    first = made_certificate(tmp_path / "tls", frozenset({"localhost"})).fingerprint()
    (tmp_path / "tls" / "key.pem").write_text("broken")

    assert made_certificate(tmp_path / "tls", frozenset({"localhost"})).fingerprint() != first


def test_a_certificate_and_a_key_that_do_not_fit_are_refused(tmp_path):
    one = made_certificate(tmp_path / "one", frozenset({"localhost"}))
    two = made_certificate(tmp_path / "two", frozenset({"localhost"}))

    with pytest.raises(ConfigError, match="not a certificate and its key"):
        own_certificate(one.chain, two.key)
    with pytest.raises(ConfigError, match="no file"):
        own_certificate(tmp_path / "none.pem", one.key)
    assert own_certificate(one.chain, one.key).own


def test_a_missing_account_is_reported(access):
    with pytest.raises(NotFound, match="no account is named"):
        access.accounts.get("Anna")
