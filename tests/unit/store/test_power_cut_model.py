"""What the model of a power cut keeps, and that new folders survive one."""

import numpy as np
import pytest

from recon4.store import atomic
from recon4.store.atomic import make_folders
from tests.power_cut.disk_model import Disk, Keeps

FILE = [
    ["mkdir", "/project"],
    ["create", 3, "/project/.tmp"],
    ["write", 3, 0, b"whole"],
    ["fsync", 3],
    ["rename", "/project/.tmp", "/project/file"],
]


def after(target, operations, keeps=Keeps.LOST):
    disk = Disk()
    for operation in operations:
        disk.follow(operation)
    disk.after_cut(target, keeps, np.random.default_rng(1))
    return {
        path.relative_to(target).as_posix(): path.read_bytes()
        for path in target.rglob("*")
        if path.is_file()
    }


def test_a_name_is_safe_when_its_folder_and_those_above_were_fsynced(tmp_path):
    synced = [["fsyncdir", "/project"], ["fsyncdir", "/"]]

    assert after(tmp_path / "a", [*FILE, *synced]) == {"project/file": b"whole"}
    assert after(tmp_path / "b", [*FILE, synced[0]]) == {}
    assert after(tmp_path / "c", [*FILE, synced[1]]) == {}


def test_names_without_data_are_zeros(tmp_path):
    unsynced = [operation for operation in FILE if operation[0] != "fsync"]

    assert after(tmp_path / "a", unsynced, Keeps.NAMES) == {"project/file": bytes(5)}


def test_a_move_between_folders_happens_as_a_whole_or_not_at_all(tmp_path):
    moved = [
        *([["mkdir", "/a"], ["mkdir", "/b"], ["create", 3, "/a/file"], ["fsync", 3]]),
        *([["fsyncdir", "/"], ["fsyncdir", "/a"], ["rename", "/a/file", "/b/file"]]),
    ]

    assert list(after(tmp_path / "a", moved)) == ["a/file"]
    assert list(after(tmp_path / "b", [*moved, ["fsyncdir", "/b"]])) == ["b/file"]


@pytest.mark.parametrize("depth", [1, 3])
def test_every_folder_above_a_new_one_is_fsynced(tmp_path, monkeypatch, depth):
    synced = []
    monkeypatch.setattr(atomic, "fsync", synced.append)
    new = tmp_path.joinpath(*"abc"[:depth])

    make_folders(new)
    make_folders(new)

    assert synced == [tmp_path, *list(reversed(new.parents))[-depth + 1 :]][:depth]
    assert new.is_dir()
