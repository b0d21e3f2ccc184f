"""The journal on disk."""

import sqlite3
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from threading import Barrier

import pytest

from recon4.errors import StoreError
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import (
    NAME,
    JournalChanged,
    NothingToUndo,
    append,
    broken,
    head,
    read_decided,
    read_rows,
)
from tests.deadlines import HANG_S
from tests.unit.review.test_decisions import correction, decide


def reject(j, who="Eva", why=""):
    return Decision(kind=DecisionKind.REJECT, who=who, why=why, pair=(2, j))


def undo(who="Eva"):
    return Decision(kind=DecisionKind.UNDO, who=who)


def test_a_project_without_decisions_has_an_empty_journal_and_no_file(tmp_path):
    assert read_rows(tmp_path) == []
    assert not read_decided(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_rows_say_who_when_and_why_and_follow_each_other(tmp_path):
    append(tmp_path, reject(7, why="other floor"))
    append(tmp_path, reject(9, who="Jan"))

    first, second = read_rows(tmp_path)

    assert (first.seq, first.who, first.kind, first.why) == (1, "Eva", "reject", "other floor")
    assert first.time.endswith("+00:00")
    assert second.prev_hash == first.hash
    assert broken([first, second]) == []


def test_undo_of_nothing_is_refused_and_leaves_no_row(tmp_path):
    append(tmp_path, reject(7))
    append(tmp_path, undo())

    with pytest.raises(NothingToUndo, match="nothing to undo"):
        append(tmp_path, undo())
    assert len(read_rows(tmp_path)) == 2


def test_an_append_after_an_outdated_row_is_rejected(tmp_path):
    append(tmp_path, reject(7))
    append(tmp_path, reject(9, who="Jan"))

    with pytest.raises(JournalChanged, match="decided once meanwhile"):
        append(tmp_path, undo(), after_seq=1)
    assert append(tmp_path, undo(), after_seq=2).seq == 3


def test_writers_at_once_lose_nothing(tmp_path):
    people = ["Eva", "Jan", "Ada", "Max"]
    together = Barrier(len(people), timeout=HANG_S)

    def write(who):
        for k in range(20):
            together.wait()
            append(tmp_path, reject(10 + k + 100 * people.index(who), who=who))

    with ThreadPoolExecutor(len(people)) as pool:
        list(pool.map(write, people))

    rows = read_rows(tmp_path)
    assert broken(rows) == []
    for first, who in zip(range(10, 400, 100), people, strict=True):
        assert [row.frame_j for row in rows if row.who == who] == list(range(first, first + 20))


def test_what_was_acknowledged_survives_kill_9(tmp_path):
    program = (
        "import sys; from pathlib import Path; from tests.unit.review.test_journal import *\n"
        "for k in range(10, 10**6): append(Path(sys.argv[1]), reject(k)); print(k, flush=True)"
    )
    for _ in range(3):
        child = subprocess.Popen(
            [sys.executable, "-c", program, str(tmp_path)], stdout=subprocess.PIPE, text=True
        )
        with child, child.stdout:
            said = [child.stdout.readline() for _ in range(15)]
            child.kill()
            said += child.stdout.readlines()
        whole = [line for line in said if line.endswith("\n")]

        rows = read_rows(tmp_path)
        assert broken(rows) == []
        assert rows[-1].frame_j >= int(whole[-1])


@pytest.mark.parametrize(
    "change", [{"who": "Jan"}, {"why": "x"}, {"frame_j": 8}, {"time": "2020"}, {"kind": "accept"}]
)
def test_a_changed_row_breaks_the_chain(tmp_path, change):
    for j in (7, 8, 9):
        append(tmp_path, reject(j))
    rows = read_rows(tmp_path)

    rows[1] = (
        replace(rows[1], **change) if change != {"frame_j": 8} else replace(rows[1], frame_j=6)
    )

    assert any("row 2" in what and "changed" in what for what in broken(rows))


def test_a_row_with_a_recomputed_hash_breaks_the_chain_after_it(tmp_path):
    for j in (7, 8, 9):
        append(tmp_path, reject(j))
    rows = read_rows(tmp_path)
    forged = replace(rows[1], who="Jan")

    rows[1] = replace(forged, hash=forged.sealed())

    assert broken(rows) == ["row 3 does not follow the row before it"]


def test_a_removed_row_breaks_the_chain(tmp_path):
    for j in (7, 8, 9):
        append(tmp_path, reject(j))
    rows = read_rows(tmp_path)

    assert broken([rows[0], rows[2]]) == ["row 2 is missing"]
    assert head(rows) != head(rows[:2])


def test_the_database_itself_refuses_changes(tmp_path):
    append(tmp_path, reject(7))
    db = sqlite3.connect(tmp_path / NAME)

    with pytest.raises(sqlite3.IntegrityError, match="only appended"):
        db.execute("UPDATE journal SET who = 'Jan'")
    with pytest.raises(sqlite3.IntegrityError, match="only appended"):
        db.execute("DELETE FROM journal")
    db.close()


def test_a_damaged_journal_is_one_clear_error(tmp_path):
    (tmp_path / NAME).write_bytes(b"not a database, but long enough to be taken for one" * 30)

    with pytest.raises(StoreError, match=NAME):
        read_rows(tmp_path)


def classify(who="Eva", x=0.0):
    return decide(DecisionKind.CLASSIFY, who=who, correction=correction(x))


def test_two_people_who_correct_classes_at_once_look_again(tmp_path):
    seen = append(tmp_path, classify()).seq
    append(tmp_path, reject(7, who="Jan"))
    append(tmp_path, classify(x=5.0), seen_seq=seen)  # Jan decided about something else

    with pytest.raises(JournalChanged, match="Eva changed corrections of classes meanwhile"):
        append(tmp_path, classify(who="Jan", x=9.0), seen_seq=seen)
    with pytest.raises(JournalChanged, match="Eva made the same correction"):
        append(tmp_path, classify(who="Jan"))
    assert len(read_rows(tmp_path)) == 3


def test_only_a_correction_in_force_is_withdrawn(tmp_path):
    row = append(tmp_path, classify())
    (one,) = read_decided(tmp_path).corrections
    withdrawal = Decision(kind=DecisionKind.WITHDRAW, who="Jan", withdraws=one.id)

    append(tmp_path, withdrawal)

    assert (one.who, one.time) == ("Eva", row.time)
    assert read_decided(tmp_path).corrections == ()
    with pytest.raises(NothingToUndo, match=f"no correction of classes {one.id}"):
        append(tmp_path, withdrawal)
    append(tmp_path, undo())
    assert read_decided(tmp_path).corrections == (one,)
