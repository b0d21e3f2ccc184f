"""Backups of other people: names, modes and sizes that no backup of recon4 has."""

import json
import os
import stat
from pathlib import Path

import pytest

from recon4.archive.backup import _put, restore
from recon4.archive.listing import newest, read_list
from recon4.errors import NoSpace, Recon4Error, StoreError
from recon4.progress import Silent
from recon4.store.hashing import hash_file, hash_json

DATA = b"some bytes"


def made(folder, entries, *, with_keys=False):
    """A backup with these names and modes, whose own hash is right; returns its one object."""
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


def refused(backup, root, *, with_keys=False, error=StoreError):
    """The words with which a backup is refused; nothing may be left of it."""
    before = sorted(os.listdir(root.parent))
    with pytest.raises(error) as raised:
        restore(backup, root, with_keys=with_keys, progress=Silent())
    assert sorted(os.listdir(root.parent)) == before
    return str(raised.value)


def a_pipe(place):
    place.unlink()
    os.mkfifo(place)


def a_folder(place):
    place.unlink()
    place.mkdir()


def a_link_to(target):
    def make(place):
        place.unlink()
        place.symlink_to(target)

    return make


def a_device(place):
    """Only root makes one; a link to one is the same to a reader."""
    place.unlink()
    try:
        os.mknod(place, 0o666 | stat.S_IFCHR, os.makedev(1, 5))
    except PermissionError:
        place.symlink_to("/dev/zero")


@pytest.mark.parametrize(
    "spoil",
    [
        a_pipe,
        a_folder,
        a_device,
        a_link_to("/dev/zero"),
        a_link_to("/etc/passwd"),
        a_link_to("nowhere"),
        a_link_to("."),
    ],
)
def test_an_object_that_is_no_file_of_its_bytes_is_refused(tmp_path, spoil):
    spoil(made(tmp_path / "backup", {"fine": {}}))

    assert "expected" in refused(tmp_path / "backup", tmp_path / "new")


@pytest.mark.parametrize("spoil", [a_pipe, a_device, a_link_to("/dev/zero")])
def test_a_listing_that_is_no_file_is_refused_at_once(tmp_path, spoil):
    made(tmp_path / "backup", {"fine": {}})
    spoil(newest(tmp_path / "backup"))

    assert "expected a regular file" in refused(tmp_path / "backup", tmp_path / "new")


def test_a_restored_file_shares_nothing_with_the_backup_or_with_another(tmp_path):
    """Objects may be hard links of other people's files; writing to ours must not change them."""
    place = made(tmp_path / "backup", {"one": {}, "two": {}})
    os.link(place, tmp_path / "somebody-elses")

    restore(tmp_path / "backup", tmp_path / "new", with_keys=False, progress=Silent())
    (tmp_path / "new" / "one").write_bytes(b"changed")

    assert (tmp_path / "new" / "two").read_bytes() == DATA
    assert (tmp_path / "somebody-elses").read_bytes() == DATA
    assert (tmp_path / "new" / "one").stat().st_nlink == 1


@pytest.mark.study
def test_one_object_listed_a_million_times_is_refused_before_it_is_copied(tmp_path):
    """A small backup that becomes 10 TB."""
    place = made(tmp_path / "backup", {f"{k:06d}": {"bytes": 10 << 20} for k in range(100_000)})
    os.truncate(place, 10 << 20)

    words = refused(tmp_path / "backup", tmp_path / "new", error=NoSpace)
    assert "the backup has 1048.6 GB" in words


@pytest.mark.parametrize(
    "names",
    [("a", "a/b"), ("a/b", "a"), ("x" * 300,), ("a/" * 1500 + "b",), ("a/" * 60 + "b", "a")],
)
def test_names_that_no_folder_can_hold_are_refused_and_nothing_is_left(tmp_path, names):
    made(tmp_path / "backup", {name: {} for name in names})

    assert refused(tmp_path / "backup", tmp_path / "new")


def test_a_name_that_the_disk_takes_for_another_is_refused(tmp_path):
    place = made(tmp_path / "backup", {"fine": {}})
    entry = read_list(newest(tmp_path / "backup")).files["fine"]
    objects = place.parents[1]
    _put(objects, tmp_path / "new", "fine", entry=entry)

    with pytest.raises(StoreError, match="'fine' is there already"):
        _put(objects, tmp_path / "new", "fine", entry=entry)


def test_names_that_differ_in_case_only_are_both_restored_or_refused(tmp_path):
    """On disks that ignore case the second would replace the first."""
    made(tmp_path / "backup", {"Walk.pcap": {}, "walk.pcap": {}})
    (tmp_path / "probe").touch()
    if (tmp_path / "PROBE").exists():
        assert "is there already" in refused(tmp_path / "backup", tmp_path / "new")
    else:
        restore(tmp_path / "backup", tmp_path / "new", with_keys=False, progress=Silent())
        assert sorted(os.listdir(tmp_path / "new")) == ["Walk.pcap", "walk.pcap"]


@pytest.mark.parametrize(
    "name",
    [
        ".recon4/metrics.token",
        ".RECON4/metrics.token",
        ".recon4./metrics.token. ",
        ".recon4/Metrics.Token",
        "office/.recon4/TRUSTED_KEYS/eve.pem",
        ".recon4/TLS/key.pem",
        ".recon4/Backups/access-2026-11-26.sqlite",
    ],
)
def test_no_spelling_of_a_secret_passes_without_asking(tmp_path, name):
    """A disk that ignores case would take it for the secret."""
    made(tmp_path / "backup", {name: {}, "fine": {}}, with_keys=True)

    restore(tmp_path / "backup", tmp_path / "new", with_keys=False, progress=Silent())

    assert os.listdir(tmp_path / "new") == ["fine"]


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("sha256", "../../../../etc/passwd"),
        ("sha256", "0" * 63 + "/"),
        ("sha256", 5),
        ("bytes", -1),
        ("bytes", 10**30),
        ("bytes", 1.5),
        ("bytes", True),
        ("mode", "rwx"),
        ("mode", None),
    ],
)
def test_a_field_of_a_listing_that_is_none_is_refused(tmp_path, field, value):
    made(tmp_path / "backup", {"fine": {field: value}})

    assert refused(tmp_path / "backup", tmp_path / "new", error=Recon4Error)


@pytest.mark.parametrize("mode", [-1, 10**30, 0o120777, 0o60666])
def test_a_mode_of_a_link_or_device_makes_an_ordinary_file(tmp_path, mode):
    made(tmp_path / "backup", {"fine": {"mode": mode}})

    restore(tmp_path / "backup", tmp_path / "new", with_keys=False, progress=Silent())

    status = (tmp_path / "new" / "fine").lstat()
    assert stat.S_ISREG(status.st_mode)
    assert stat.S_IMODE(status.st_mode) & ~0o644 == 0


@pytest.mark.parametrize("depth", [100, 100_000])
def test_a_listing_nested_without_end_is_refused(tmp_path, depth):
    made(tmp_path / "backup", {"fine": {}})
    newest(tmp_path / "backup").write_text('{"format":' + "[" * depth)

    assert "cannot be read" in refused(tmp_path / "backup", tmp_path / "new")


def test_a_link_that_waits_where_a_backup_is_built_is_not_followed(tmp_path):
    """In a folder that others may write, they could choose where the bytes go."""
    made(tmp_path / "backup", {"fine": {}})
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / f".tmp-restore-new-{os.getpid()}").symlink_to(tmp_path / "elsewhere")

    restore(tmp_path / "backup", tmp_path / "new", with_keys=False, progress=Silent())

    assert os.listdir(tmp_path / "elsewhere") == []
    assert not (tmp_path / "new").is_symlink()


def test_a_restore_into_the_working_folder_works(tmp_path, monkeypatch):
    made(tmp_path / "backup", {"fine": {}})
    (tmp_path / "new").mkdir()
    monkeypatch.chdir(tmp_path / "new")

    restore(tmp_path / "backup", Path("."), with_keys=False, progress=Silent())

    assert (tmp_path / "new" / "fine").read_bytes() == DATA
