"""Who looks for a file while another process creates it finds no file, or all of its tables."""

import os
import sqlite3
import subprocess
import sys
from contextlib import closing

import pytest

from recon4.review import journal
from recon4.review.decisions import Decision, DecisionKind
from recon4.store import sqlite_files
from recon4.store.ledger import Ledger
from recon4.store.sqlite_files import connect, create_whole

SCHEMA = "CREATE TABLE one (x INTEGER); CREATE TABLE two (x INTEGER);"
REJECT = Decision(kind=DecisionKind.REJECT, who="Eva", why="", pair=(2, 7))


@pytest.mark.parametrize("table", ["journal", "stages"])
def test_a_file_gets_its_name_when_it_has_its_tables(tmp_path, monkeypatch, table):
    link, seen = os.link, []

    def looking(made, target):
        with closing(sqlite3.connect(made)) as db:
            rows = db.execute(f"SELECT count(*) FROM {table}").fetchone()
        seen.append((rows, target.exists()))
        link(made, target)

    monkeypatch.setattr(sqlite_files.os, "link", looking)
    if table == "journal":
        journal.append(tmp_path, REJECT)
    else:
        with Ledger(tmp_path / "ledger.sqlite"):
            pass

    assert seen == [((0,), False)]


def test_the_file_of_who_was_faster_stays(tmp_path, monkeypatch):
    path = tmp_path / "file.sqlite"

    def other(made, target):
        with closing(sqlite3.connect(target)) as db:
            db.executescript(f"{SCHEMA} INSERT INTO one VALUES (5);")
        raise FileExistsError(made)

    monkeypatch.setattr(sqlite_files.os, "link", other)
    create_whole(path, SCHEMA)

    with closing(connect(path)) as db:
        assert db.execute("SELECT x FROM one").fetchall() == [(5,)]
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_a_disk_without_hard_links_has_the_file_too(tmp_path, monkeypatch):
    def refused(*_):
        raise PermissionError("no hard links")

    monkeypatch.setattr(sqlite_files.os, "link", refused)
    create_whole(tmp_path / "file.sqlite", SCHEMA)

    with closing(connect(tmp_path / "file.sqlite")) as db:
        assert db.execute("SELECT count(*) FROM two").fetchone() == (0,)


CONFINED = """
import sys
from pathlib import Path
from recon4.review.journal import read_rows
from recon4.sandbox import Policy, confine
project, out = map(Path, sys.argv[1:])
confine(Policy(read=(Path("/"),), write=(out,), temporary=out))
print([row.kind for row in read_rows(project)])
"""


def test_a_journal_is_read_by_a_command_that_may_not_write_beside_it(tmp_path):
    project, out = tmp_path / "project", tmp_path / "out"
    for folder in (project, out):
        folder.mkdir()
    journal.append(project, REJECT)

    done = subprocess.run(
        [sys.executable, "-c", CONFINED, project, out], capture_output=True, text=True, check=False
    )

    assert (done.stdout, done.stderr) == ("['reject']\n", "")
