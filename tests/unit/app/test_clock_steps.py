"""The clock of the server is set back by a day: nothing lasts a day longer, no order is lost."""

import os
import time

import pytest

from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, broken, read_rows
from recon4.store.project import Project
from recon4_app.access.people import Role
from recon4_app.access.tuning import PEOPLE_TIMES
from recon4_app.jobs.folder import JobFolder
from recon4_app.projects.trash import Trash

PASSWORD = "three green owls dance"
DAY_S = 86_400.0


def test_a_password_given_before_the_step_is_not_recent(access, clock):
    access.accounts.add("Anna", Role.REVIEWER, PASSWORD)
    token = access.sessions.begin("Anna", address="?", agent="")
    clock.now_s -= DAY_S
    session = access.sessions.find(token).session

    assert access.sessions.age_s(session) > PEOPLE_TIMES.recent_login_s
    fresh = access.sessions.find(access.sessions.prove(session.id)).session
    assert access.sessions.age_s(fresh) == 0.0


def test_a_clock_that_is_corrected_by_seconds_asks_nobody_again(access, clock):
    access.accounts.add("Anna", Role.REVIEWER, PASSWORD)
    token = access.sessions.begin("Anna", address="?", agent="")
    clock.now_s -= 5.0

    assert access.sessions.age_s(access.sessions.find(token).session) == 0.0


def test_the_audit_log_keeps_its_order_and_its_chain(access, clock):
    access.log.add("Anna", "?", action="start job", what="first")
    clock.now_s -= DAY_S
    access.log.add("Anna", "?", action="start job", what="second")

    assert [entry.object for entry in access.log.newest(2)] == ["second", "first"]
    assert access.log.verify().broken_at is None


def test_refusals_are_written_again_after_the_step(access, clock):
    for _ in range(100):
        access.log.add("nobody", "?", action="request", what="/", outcome="refused")
    clock.now_s -= DAY_S
    access.log.add("nobody", "?", action="request", what="/", outcome="refused")

    assert "40 more" in access.log.newest(1)[0].object


def test_decisions_keep_their_order(tmp_path, monkeypatch):
    root = tmp_path / "office"
    Project.open(root).close()
    append(root, Decision(kind=DecisionKind.REJECT, who="anna", pair=(0, 300)))

    class Yesterday:
        @staticmethod
        def now(zone):
            from datetime import datetime, timedelta

            return datetime.now(zone) - timedelta(days=1)

    monkeypatch.setattr("recon4.review.journal.datetime", Yesterday)
    append(root, Decision(kind=DecisionKind.UNDO, who="anna"))

    rows = read_rows(root)
    assert [row.kind for row in rows] == ["reject", "undo"] and rows[1].time < rows[0].time
    assert broken(rows) == []


def test_a_worker_asked_to_stop_before_the_step_is_not_left_for_a_day(tmp_path):
    folder = JobFolder(tmp_path)
    folder.request_stop()
    tomorrow_s = time.time() + DAY_S
    os.utime(tmp_path / "cancel", (tomorrow_s, tomorrow_s))

    assert folder.stop_requested_s() == 0.0
    assert (tmp_path / "cancel").stat().st_mtime == pytest.approx(time.time(), abs=60.0)


def test_the_trash_is_not_emptied_early(tmp_path):
    trash = Trash(tmp_path, tmp_path / "trash", kept_s=100.0)
    (tmp_path / "office").mkdir()
    deleted = trash.put(tmp_path / "office")

    assert trash.sweep(time.time() - DAY_S) == []
    assert trash.restore(deleted.id) == "office"
