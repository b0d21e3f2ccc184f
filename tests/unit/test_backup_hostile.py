"""Backups of other people: names, modes and sizes that no backup of recon4 has."""

import json
import os
import stat

import pytest

from recon4.backup import restore
from recon4.backup_listing import newest
from recon4.errors import NoSpace, StoreError
from recon4.progress import Silent
from recon4.store.hashing import hash_file, hash_json

DATA = b"some bytes"


def made(folder, entries, *, with_keys=False):
    """A backup with these names and modes, whose own hash is right."""
    objects = folder / "objects"
    objects.mkdir(parents=True)
    (folder / "data").write_bytes(DATA)
    sha256 = hash_file(folder / "data")
    (objects / sha256[:2]).mkdir()
    (folder / "data").rename(objects / sha256[:2] / sha256)
    files = {
        name: {"bytes": len(DATA), "sha256": sha256, "mode": 0o644} | more
        for name, more in entries.items()
    }
    body = {"format": 1, "made": "2026-11-26T10-00-00Z", "with_keys": with_keys, "left_out": []}
    body["files"] = files
    path = folder / "2026-11-26T10-00-00Z.json"
    path.write_text(json.dumps(body | {"sha256": hash_json(body)}))
    return objects / sha256[:2] / sha256


@pytest.mark.parametrize(
    "name", ["a\0b", "a//b", "./a", "a/./b", "../a", "/a", "a/../../b", "", ".", "a/"]
)
def test_a_name_that_is_none_is_refused_and_nothing_is_left(tmp_path, name):
    made(tmp_path / "backup", {"fine": {}, name: {}})

    with pytest.raises(StoreError, match=r"is no name of a file|leads outside"):
        restore(tmp_path / "backup", tmp_path / "new", with_keys=False, progress=Silent())

    assert sorted(os.listdir(tmp_path)) == ["backup"]


@pytest.mark.parametrize(
    ("name", "mode", "expected"),
    [
        ("file", 0o777, 0o644),
        ("file", 0o7777, 0o644),
        ("file", 0, 0o400),
        ("file", 0o222, 0o600),
        ("file", 0o444, 0o444),
        ("file", 0o600, 0o600),
        (".recon4/signing.key", 0o777, 0o600),
        (".recon4/access.sqlite", 0o644, 0o600),
        (".recon4/backups/access-2026-11-26.sqlite", 0o666, 0o600),
        (".recon4/metrics.token", 0, 0o400),
    ],
)
def test_a_restored_file_can_be_read_by_its_owner_and_written_by_nobody_else(
    tmp_path, name, mode, expected
):
    made(tmp_path / "backup", {name: {"mode": mode}}, with_keys=True)

    restore(tmp_path / "backup", tmp_path / "new", with_keys=True, progress=Silent())

    restored = tmp_path / "new" / name
    assert stat.S_IMODE(restored.stat().st_mode) == expected
    assert restored.read_bytes() == DATA


def test_a_metrics_token_of_a_foreign_backup_is_not_taken_without_asking(tmp_path):
    made(tmp_path / "backup", {".recon4/metrics.token": {}, "fine": {}}, with_keys=True)

    restore(tmp_path / "backup", tmp_path / "new", with_keys=False, progress=Silent())

    assert os.listdir(tmp_path / "new") == ["fine"]


def test_a_sparse_object_of_terabytes_is_refused_before_it_is_read(tmp_path):
    name = made(tmp_path / "backup", {"huge": {}})
    os.truncate(name, 8 << 40)

    with pytest.raises(StoreError, match=f"expected {len(DATA)} bytes, got {8 << 40}"):
        restore(tmp_path / "backup", tmp_path / "new", with_keys=False, progress=Silent())


def test_a_backup_larger_than_the_disk_is_refused_before_it_is_read(tmp_path):
    name = made(tmp_path / "backup", {"huge": {"bytes": 8 << 40}})
    os.truncate(name, 8 << 40)

    with pytest.raises(NoSpace, match=r"has 8796\.1 GB"):
        restore(newest(tmp_path / "backup"), tmp_path / "new", with_keys=False, progress=Silent())
