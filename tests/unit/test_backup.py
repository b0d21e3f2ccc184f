"""A backup contains every byte, restores it, and rejects damaged data."""

import json
import os
import sqlite3
import threading

import pytest

from recon4.archive.backup import back_up, restore
from recon4.archive.listing import newest, read_list
from recon4.archive.verify import verify
from recon4.cli.main import main
from recon4.errors import ConfigError, StoreError
from recon4.progress import Silent
from recon4.store.hashing import files_below, hash_file, hash_json
from tests.benchmarks.flips import make, make_server_state
from tests.deadlines import HANG_S

NOT_COPIED = (".lock", ".seals.lock", ".changes.lock", "seals.json", "audit.room")


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """Files of a server: an approved project, queue, users, keys, an upload."""
    root = tmp_path_factory.mktemp("server")
    make_server_state(root)
    make(root)
    (root / "recordings" / "walk").mkdir(parents=True)
    (root / "recordings" / "walk" / "walk.pcap").write_bytes(os.urandom(3_000_000))
    return root


def hashes(root):
    names = [name for name in files_below(root) if name.rsplit("/", 1)[-1] not in NOT_COPIED]
    return {name: hash_file(root / name) for name in names}


def test_a_restored_backup_has_the_same_bytes_and_verifies(server, tmp_path):
    made = back_up(server, tmp_path / "backups", with_keys=True, progress=Silent())
    restore(tmp_path / "backups", tmp_path / "new", with_keys=True, progress=Silent())

    assert (made.left_out, made.damaged) == ((), ())
    assert hashes(tmp_path / "new") == hashes(server)
    found = verify(tmp_path / "new", Silent())
    assert found.damaged == () and len(found.approvals) == 1
    key = tmp_path / "new" / ".recon4" / "signing.key"
    assert key.stat().st_mode & 0o777 == 0o600


def test_keys_and_users_are_saved_and_restored_only_on_request(server, tmp_path):
    back_up(server, tmp_path / "without", with_keys=False, progress=Silent())
    back_up(server, tmp_path / "with", with_keys=True, progress=Silent())

    restore(tmp_path / "with", tmp_path / "new", with_keys=False, progress=Silent())

    names = read_list(newest(tmp_path / "without")).files
    assert not [n for n in names if n.endswith((".key", "access.sqlite", ".pem"))]
    assert not (tmp_path / "new" / ".recon4" / "signing.key").exists()
    with pytest.raises(ConfigError, match="made without keys"):
        restore(tmp_path / "without", tmp_path / "other", with_keys=True, progress=Silent())


def test_a_second_backup_adds_only_what_is_new(server, tmp_path):
    first = back_up(server, tmp_path / "backups", with_keys=True, progress=Silent())
    second = back_up(server, tmp_path / "backups", with_keys=True, progress=Silent())

    assert first.new_bytes > 3_000_000 and second.new_bytes == 0
    assert first.path != second.path and second.files == first.files


@pytest.mark.parametrize("spoil", ["flip", "remove", "list", "name"])
def test_a_damaged_backup_is_refused_and_leaves_nothing(server, tmp_path, spoil):
    made = back_up(server, tmp_path / "backups", with_keys=True, progress=Silent())
    objects = sorted((tmp_path / "backups" / "objects").glob("*/*"))
    if spoil == "flip":
        objects[0].chmod(0o600)
        objects[0].write_bytes(b"\x01" + objects[0].read_bytes()[1:])
    elif spoil == "remove":
        objects[0].unlink()
    else:
        record = json.loads(made.path.read_text())
        name = next(iter(record["files"]))
        record["files"]["../out" if spoil == "name" else f"{name}x"] = record["files"].pop(name)
        body = {key: value for key, value in record.items() if key != "sha256"}
        if spoil == "name":  # the list's own hash fits: only the name itself is wrong
            record["sha256"] = hash_json(body)
        made.path.write_text(json.dumps(record))

    with pytest.raises(StoreError):
        restore(made.path, tmp_path / "new", with_keys=True, progress=Silent())

    assert sorted(path.name for path in tmp_path.iterdir()) == ["backups"]


def test_a_folder_that_is_not_empty_is_not_restored_into(server, tmp_path):
    back_up(server, tmp_path / "backups", with_keys=False, progress=Silent())
    (tmp_path / "new").mkdir()
    (tmp_path / "new" / "mine").write_text("x")

    with pytest.raises(ConfigError, match="not empty"):
        restore(tmp_path / "backups", tmp_path / "new", with_keys=False, progress=Silent())
    with pytest.raises(ConfigError, match="lies in"):
        back_up(server, server / "backups", with_keys=False, progress=Silent())


def test_damage_before_the_backup_is_reported_and_fails_the_command(server, tmp_path, capsys):
    path = server / "office" / "project.json"
    whole = path.read_bytes()
    path.write_bytes(whole.replace(b"office", b"0ffice"))

    code = main(["backup", str(server), "--out", str(tmp_path / "backups")])
    path.write_bytes(whole)

    assert code == 1
    assert "damaged before it was copied: office/project.json" in capsys.readouterr().out


def copied_counts(root, new):
    """Rows of both tables in a backup that was restored."""
    back_up(root, new.parent / "backups", with_keys=False, progress=Silent())
    restore(new.parent / "backups", new, with_keys=False, progress=Silent())
    db = sqlite3.connect(new / ".recon4" / "jobs.sqlite")
    assert db.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    found = [db.execute(f"SELECT count(*) FROM {table}").fetchone()[0] for table in "ab"]
    db.close()
    return found


def test_a_database_that_is_being_written_is_copied_consistently(tmp_path):
    """Two tables always hold the same count; so must every copy of them."""
    root = tmp_path / "root"
    make_server_state(root)
    path = root / ".recon4" / "jobs.sqlite"
    stop = threading.Event()
    written = threading.Event()

    def write():
        db = sqlite3.connect(path, isolation_level=None)
        db.execute("CREATE TABLE a (n)")
        db.execute("CREATE TABLE b (n)")
        while not stop.is_set():
            db.execute("BEGIN IMMEDIATE")
            db.execute("INSERT INTO a VALUES (randomblob(500))")
            db.execute("INSERT INTO b VALUES (randomblob(500))")
            db.execute("COMMIT")
            written.set()
        db.close()

    writer = threading.Thread(target=write)
    writer.start()
    try:
        assert written.wait(30.0)
        counts = [copied_counts(root, tmp_path / f"r{number}") for number in range(5)]
    finally:
        stop.set()
        writer.join(HANG_S)

    assert all(a == b > 0 for a, b in counts)
