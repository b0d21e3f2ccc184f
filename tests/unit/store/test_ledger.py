"""The ledger records finished stages and detects damage."""

import sqlite3
from dataclasses import replace

import pytest

from recon4.errors import StoreError
from recon4.store.ledger import FinishedStage, Ledger
from tests.unit.store.small_pipeline import run_all

ROW = FinishedStage("k1", "odometry", 3, "2026-11-21T10:00:00Z", 1.5, 1.25, 1000)


def test_a_row_written_is_there_for_the_next_process(tmp_path):
    with Ledger(tmp_path / "l.sqlite") as ledger:
        ledger.add(ROW)
        ledger.set_current("odometry", "k1")

    with Ledger(tmp_path / "l.sqlite") as ledger:
        assert ledger.find("k1") == ROW
        assert ledger.current() == {"odometry": "k1"}


def test_commits_are_durable_and_readers_do_not_wait(tmp_path):
    with Ledger(tmp_path / "l.sqlite") as ledger:
        found = [
            ledger._db.execute(f"PRAGMA {name}").fetchone()[0]
            for name in ("journal_mode", "synchronous")
        ]

    assert found == ["wal", 2]


def test_stages_come_in_the_order_they_finished(tmp_path):
    later = replace(ROW, key="k0", finished="2026-11-21T11:00:00Z")
    with Ledger(tmp_path / "l.sqlite") as ledger:
        ledger.add(later)
        ledger.add(ROW)

        assert [row.key for row in ledger.stages()] == ["k1", "k0"]


def test_stages_of_the_same_second_come_in_the_order_in_which_they_were_written(tmp_path):
    keys = ["k3", "k1", "k2"]
    with Ledger(tmp_path / "l.sqlite") as ledger:
        for key in keys:
            ledger.add(replace(ROW, key=key))

        assert [row.key for row in ledger.stages()] == keys


def test_a_deleted_stage_is_removed_from_the_latest_run(tmp_path):
    with Ledger(tmp_path / "l.sqlite") as ledger:
        ledger.add(ROW)
        ledger.set_current("odometry", "k1")
        ledger.forget("k1")

        assert (ledger.find("k1"), ledger.current()) == (None, {})


def test_a_file_of_another_kind_is_refused(tmp_path):
    (tmp_path / "l.sqlite").write_text("this is a letter, not a database " * 200)

    with pytest.raises(StoreError, match="damaged or cannot be used"):
        Ledger(tmp_path / "l.sqlite")


def test_a_ledger_with_a_torn_page_is_refused_and_left_as_it_is(tmp_path):
    path = tmp_path / "l.sqlite"
    with Ledger(path) as ledger:
        for k in range(500):
            ledger.add(replace(ROW, key=f"key {k}"))
    data = bytearray(path.read_bytes())
    data[5 * 4096 : 6 * 4096] = b"\xa5" * 4096
    path.write_bytes(data)

    with pytest.raises(StoreError, match="move it away and start again"):
        Ledger(path)

    assert path.read_bytes() == bytes(data)


def test_moving_a_damaged_ledger_away_loses_no_finished_stage(tmp_path):
    run_all(tmp_path / "p")
    ledger = tmp_path / "p" / "ledger.sqlite"
    ledger.write_bytes(b"\x00" * 8192)
    with pytest.raises(StoreError, match="move it away"):
        run_all(tmp_path / "p")

    ledger.rename(tmp_path / "damaged.sqlite")
    again = run_all(tmp_path / "p")

    assert all(run.reused for run in again.runs.values())


def test_a_ledger_of_a_later_version_is_refused(tmp_path):
    Ledger(tmp_path / "l.sqlite").close()
    db = sqlite3.connect(tmp_path / "l.sqlite")
    db.execute("PRAGMA user_version = 7")
    db.close()

    with pytest.raises(StoreError, match="version 7, this recon4 reads version 1"):
        Ledger(tmp_path / "l.sqlite")
