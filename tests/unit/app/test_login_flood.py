"""Logins from many addresses at once, and several processes that change people at once."""

import queue
import subprocess
import sys
import threading

import pytest

from recon4_app.access.login.login_backoff import LoginBackoff, TokenBuckets
from recon4_app.access.login.login_service import LoginOrigin
from recon4_app.access.people import Role
from recon4_app.access.tuning import BACKOFF, LOGINS
from recon4_app.errors import TooMany, WrongPassword
from tests.deadlines import HANG_S

PASSWORD = "three green owls dance"


def origin(k, browser=""):
    return LoginOrigin(address=f"203.0.113.{k}", agent="", browser=browser)


def test_a_flood_from_many_addresses_waits_in_few_threads_and_the_owner_gets_in(
    access, logins, monkeypatch
):
    access.accounts.add("Anna", Role.REVIEWER, PASSWORD)
    home = logins.sign_in("Anna", PASSWORD, origin(1)).browser
    gate, outcomes = threading.Event(), queue.Queue()
    monkeypatch.setattr(logins, "_fits", lambda name, password: gate.wait(60.0) and False)

    def attack(k):
        try:
            logins.prove("Anna", "wrong", origin(k))
        except (TooMany, WrongPassword) as error:
            outcomes.put(type(error))

    threads = [threading.Thread(target=attack, args=(k,)) for k in range(2, 102)]
    for thread in threads:
        thread.start()
    refused = [outcomes.get(timeout=HANG_S) for _ in range(100 - LOGINS.waiting_logins)]
    monkeypatch.setattr(logins, "_fits", lambda name, password: password == PASSWORD)
    logins.prove("Anna", PASSWORD, origin(1, home))  # while the others wait
    gate.set()
    for thread in threads:
        thread.join(HANG_S)

    assert set(refused) == {TooMany}
    assert [outcomes.get_nowait() for _ in range(LOGINS.waiting_logins)] == [WrongPassword] * 8
    logins.prove("Anna", PASSWORD, origin(200))  # places are free again


def test_refused_for_the_flood_is_not_counted_as_a_wrong_password(access, logins, monkeypatch):
    access.accounts.add("Anna", Role.REVIEWER, PASSWORD)
    monkeypatch.setattr(logins, "_waiting", threading.BoundedSemaphore(1))
    logins._waiting.acquire()
    for _ in range(50):
        with pytest.raises(TooMany, match="at once"):
            logins.prove("Anna", PASSWORD, origin(1))
    logins._waiting.release()

    logins.prove("Anna", PASSWORD, origin(1))


def test_memory_is_bounded_however_many_addresses_try(clock):
    backoff, buckets = LoginBackoff(clock=clock), TokenBuckets(burst=1, per_s=1.0, clock=clock)
    for k in range(BACKOFF.max_keys + 500):
        backoff.begin(("anna", str(k)))
        buckets.take(str(k))

    assert len(backoff._failures) == len(buckets._left) == BACKOFF.max_keys


def users(root, *words):
    return subprocess.Popen(
        [sys.executable, "-m", "recon4", "users", *words, "--root", str(root)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def ended(processes, text=""):
    found = [
        (process.communicate(text, timeout=HANG_S), process.returncode) for process in processes
    ]
    assert not [one for one in found if "Traceback" in one[0][1]], found
    return [code for _, code in found]


@pytest.mark.study
def test_processes_that_change_people_at_once_leave_one_admin_and_one_account(tmp_path):
    first = ended([users(tmp_path, "add", "anna", "--role", "admin")], PASSWORD + " slowly")
    twice = [users(tmp_path, "add", "Emma", "--role", "admin") for _ in range(2)]
    added = ended(twice, PASSWORD + " slowly")
    both = [users(tmp_path, "disable", name) for name in ("anna", "emma")]
    disabled = ended(both)
    audit = users(tmp_path, "audit")
    log, _ = audit.communicate(timeout=HANG_S)

    assert first == [0] and sorted(added) == [0, 1] and sorted(disabled) == [0, 1]
    assert audit.returncode == 0 and "chain whole" in log
    assert log.count("add person") == 2 and log.count("disable:") == 1
