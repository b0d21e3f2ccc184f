"""A folder of walks becomes a folder of projects, on one worker or several."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest

from recon4.batch.table import BatchRow, table_lines
from recon4.batch.walks import find_walks, walk_tasks
from recon4.cli.main import main
from recon4.errors import ConfigError
from recon4.locales.coded import said
from recon4.recording.samples.csv_files import IMU_HEADER
from tests.made_once import made_once
from tests.planar_walks import along, furnished_room, scanned, write_carmen

AROUND = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0], [3.0, 1.0], [0.0, 1.0]])
SAME = ("trajectory.tum", "graph.g2o", "map.png")


def write_walks(folder: Path) -> None:
    """Two walks, a damaged one and a note."""
    folder.mkdir()
    for name, corners in (("first", AROUND), ("second", AROUND[::-1])):
        write_carmen(folder / f"{name}.log", scanned(furnished_room(), along(corners)).scans)
    (folder / "damaged.bag").write_bytes(b"#ROSBAG V2.0\n" + bytes(100))
    (folder / "notes.txt").write_text("The door was locked.\n", "utf-8")


@pytest.fixture(scope="module")
def walks(tmp_path_factory):
    return made_once(tmp_path_factory, "batch_walks", write_walks)


@pytest.fixture(scope="module")
def alone(walks, tmp_path_factory):
    """The projects of a batch in this process's order, without Dask."""

    def make(out: Path) -> None:
        assert main(["batch", str(walks), "--out", str(out)]) == 1  # one is damaged

    return made_once(tmp_path_factory, "batch_alone", make)


def path_length_m(corners: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum())


def bytes_of(projects: Path) -> dict[str, bytes]:
    return {
        f"{walk}/{name}": (projects / walk / name).read_bytes()
        for walk in ("first", "second")
        for name in SAME
    }


def test_every_walk_has_a_row(alone):
    rows = json.loads((alone / "batch.json").read_text("utf-8"))["walks"]
    table = list(csv.DictReader((alone / "batch.csv").read_text("utf-8").splitlines()))

    assert [row["walk"] for row in rows] == ["damaged", "first", "second"]
    assert [row["result"] for row in rows] == ["failed", "good", "good"]
    assert "damaged.bag" in rows[0]["why"]
    assert rows[1]["path_length_m"] == pytest.approx(path_length_m(AROUND), abs=1.0)
    assert [row["result"] for row in table] == [row["result"] for row in rows]


@pytest.mark.study
def test_two_workers_make_the_same_bytes(walks, alone, tmp_path, capsys):
    assert main(["batch", str(walks), "--out", str(tmp_path / "out"), "--workers", "2"]) == 1

    shown = capsys.readouterr()
    assert bytes_of(tmp_path / "out") == bytes_of(alone)
    assert "no walks, left out: notes.txt" in shown.err
    assert "first: good" in shown.err
    assert "%" not in shown.err
    assert shown.out.count("good") == 2


def test_its_table_is_in_the_language_of_the_terminal():
    row = BatchRow(walk="a", result="do not use", seconds=3.0)

    head, line = table_lines([row], lambda text: said(text, "de"))

    assert head.split() == ["Begehung", "Ergebnis", "Dauer", "Weg", "brauchte", "warum"]
    assert "nicht verwenden" in line and head.index("brauchte") + len("brauchte") >= len(line)


def test_started_again_it_only_reads_what_is_done(walks, alone, tmp_path, capsys):
    before = {path.name for path in (alone / "first" / "artifacts").iterdir()}
    (tmp_path / "first.log").write_bytes((walks / "first.log").read_bytes())
    copytree(alone / "first", tmp_path / "out" / "first")

    assert main(["batch", str(tmp_path), "--out", str(tmp_path / "out")]) == 0

    assert "first: audit: already there" in capsys.readouterr().err
    assert {path.name for path in (tmp_path / "out/first/artifacts").iterdir()} == before


def test_a_wrong_setting_is_refused_before_any_walk(walks, tmp_path, capsys):
    assert main(["batch", str(walks), "--out", str(tmp_path), "--set", "map.voxel_cm=3"]) == 1

    assert "map.voxel_cm" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_walk_is_given_the_samples_and_the_rig_in_its_folder(tmp_path):
    walk = tmp_path / "walk"
    walk.mkdir()
    (walk / "walk.bag").write_bytes(b"#ROSBAG V2.0\n")
    (walk / "imu.csv").write_text(f"{','.join(IMU_HEADER)}\n", "utf-8")
    (walk / "rig.toml").write_text("", "utf-8")

    (task,) = walk_tasks(tmp_path, (walk,), out=tmp_path / "out", options=())
    (given,) = walk_tasks(tmp_path, (walk,), out=tmp_path / "out", options=("--rig", "4recon"))

    assert task.options == ("--imu", str(walk / "imu.csv"), "--rig", str(walk / "rig.toml"))
    assert given.options == ("--imu", str(walk / "imu.csv"), "--rig", "4recon")


@pytest.mark.parametrize("two", [("a.bag", "a.pcap"), ("a/b.pcap", "a-b.pcap")])
def test_two_walks_never_become_one_project(tmp_path, two):
    recordings = tuple(tmp_path / name for name in (*two, "c.bag"))

    with pytest.raises(ConfigError, match="both would become the project a"):
        walk_tasks(tmp_path, recordings, out=tmp_path, options=())


def test_a_folder_without_walks_is_refused(tmp_path):
    (tmp_path / "notes.txt").write_text("nothing", "utf-8")

    with pytest.raises(ConfigError, match="expected recordings in it, found none"):
        find_walks(tmp_path)


def test_a_folder_of_clouds_is_one_walk(tmp_path):
    for k in range(3):
        (tmp_path / f"{k}.pcd").write_text("# .PCD v0.7\n", "ascii")

    with pytest.raises(ConfigError, match="is one recording"):
        find_walks(tmp_path)


def test_a_folder_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="no folder"):
        find_walks(tmp_path / "missing")
