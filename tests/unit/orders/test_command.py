"""``recon4 process`` with workers: the command runs again in a confined process of its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from recon4.cli import main as commands
from recon4.cli.main import main
from recon4.executors.executor import InOrder
from tests.planar_walks import along, furnished_room, scanned, write_carmen


@pytest.fixture
def recording(tmp_path) -> Path:
    there_and_back = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0], [0.0, 1.0]])
    path = tmp_path / "a walk.log"
    write_carmen(path, scanned(furnished_room(), along(there_and_back)).scans)
    return path


def test_the_command_is_repeated_with_its_options_and_gives_its_exit_code(tmp_path, monkeypatch):
    programs = []

    def run(program, executor, **_):
        programs.append(program)
        return 3

    monkeypatch.setattr("recon4.orders.parent.run_with_workers", run)
    monkeypatch.setattr(commands, "chosen_workers", lambda *_, **__: InOrder())
    recording, out = tmp_path / "a walk.pcap", tmp_path / "out"
    recording.touch()
    options = ["--preset=hector", "--set", "map.voxel_m=0.02", "--set", "map.tile_m=7", "-v"]

    code = main(["process", str(recording), "--out", str(out), *options, "--workers", "2"])

    assert code == 3
    (program,) = programs
    assert program.project == out
    repeated, _, behind = " ".join(program.arguments).partition(" -- ")
    assert repeated == (
        f"process --out {out} --preset hector --set map.voxel_m=0.02 --set map.tile_m=7 --verbose"
    )
    assert behind == str(recording)


def test_an_error_of_the_command_is_said_once_and_is_its_exit_code(tmp_path, monkeypatch, capfd):
    monkeypatch.setattr(commands, "chosen_workers", lambda *_, **__: InOrder())
    (tmp_path / "damaged.bag").write_bytes(b"#ROSBAG V2.0\n" + bytes(100))

    code = main(["process", str(tmp_path / "damaged.bag"), "--out", str(tmp_path / "out")])

    said = capfd.readouterr().err
    assert code == 1
    assert said.count("recon4:") == 1
    assert "damaged.bag" in said


@pytest.mark.study
def test_workers_of_dask_make_a_project(recording, tmp_path, capfd):
    assert main(["process", str(recording), "--out", str(tmp_path / "out"), "--workers", "1"]) == 0
    assert (tmp_path / "out" / "summary.json").exists()
