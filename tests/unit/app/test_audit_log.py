"""The audit log: a chain that shows what was changed, forged or left out."""

import sqlite3
import threading
from dataclasses import replace

import pytest

from recon4_app.access.audit import entry_hash
from recon4_app.access.login.login_service import open_access
from recon4_app.access.people import LOCAL


def test_the_log_is_a_chain_that_shows_what_was_changed(access, tmp_path):
    for k in range(5):
        access.log.add("Anna", "192.0.2.1", action="start job", what=f"office {k}")
    whole = access.log.verify()

    with sqlite3.connect(tmp_path / "access.sqlite") as file:
        file.execute("DROP TRIGGER audit_no_update")
        file.execute("UPDATE audit SET person = 'Bert' WHERE number = 3")
    file.close()

    assert (whole.last_number, whole.broken_at) == (5, None)
    assert access.log.verify().broken_at == 3


def test_a_row_forged_together_with_its_hash_shows_at_the_next(access, tmp_path):
    for k in range(5):
        access.log.add("Anna", "?", action="start job", what=f"office {k}")
    newest = access.log.newest(5)
    forged = replace(newest[2], person="Bert")
    forged = replace(forged, hash=entry_hash(newest[3].hash, forged))

    with sqlite3.connect(tmp_path / "access.sqlite") as file:
        file.execute("DROP TRIGGER audit_no_update")
        values = (forged.person, forged.hash)
        file.execute("UPDATE audit SET person = ?, hash = ? WHERE number = 3", values)
    file.close()

    assert access.log.verify().broken_at == 4


def test_a_row_taken_out_shows(access, tmp_path):
    for k in range(5):
        access.log.add("Anna", "?", action="start job", what=f"office {k}")

    with sqlite3.connect(tmp_path / "access.sqlite") as file:
        file.execute("DROP TRIGGER audit_no_delete")
        file.execute("DELETE FROM audit WHERE number = 2")
    file.close()

    assert access.log.verify().broken_at == 3


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

    assert (access.log.verify().last_number, access.log.verify().broken_at) == (20, None)


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
