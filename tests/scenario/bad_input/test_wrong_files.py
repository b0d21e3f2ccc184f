"""Wrong files, rigs and samples on the command line: a clear error message, or a warning."""

import os
import re
import subprocess
import sys
import zipfile

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.store.project import Project
from tests.builders import (
    T0_NS,
)
from tests.scenario.bad_input.inputs import (
    FEW,
    assert_warned,
    counts,
    write_gnss,
    write_imu,
    write_pcap,
)

# -- files that are something else


def write_zip(path):
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("letter.txt", "Dear Sir or Madam")


OTHERS = {
    "empty.pcap": lambda path: path.write_bytes(b""),
    "photo.jpg": lambda path: path.write_bytes(b"\xff\xd8\xff\xe0\x00\x10JFIF\x00" + bytes(999)),
    "letters.zip": write_zip,
    "letter.pcap": lambda path: path.write_text("Dear Sir or Madam, " * 40),
    "folder": lambda path: path.mkdir(),
    "header_only.pcap": lambda path: write_pcap(path, np.zeros(0), np.zeros((0, 9), np.uint8)),
    "other_traffic.pcap": lambda path: write_pcap(
        path, T0_NS + np.arange(9), np.zeros((9, 300), np.uint8)
    ),
}


@pytest.mark.parametrize(
    ("name", "command"),
    [
        *((name, "process") for name in OTHERS),
        *((name, "info") for name in OTHERS if name != "other_traffic.pcap"),
    ],
)
def test_a_file_of_another_kind_is_one_line_with_its_name(refuse, tmp_path, name, command):
    OTHERS[name](tmp_path / name)

    assert name in refuse(tmp_path / name, command=command)


def test_info_lists_the_traffic_of_a_capture_without_lidar(tmp_path, capsys):
    OTHERS["other_traffic.pcap"](tmp_path / "other_traffic.pcap")

    assert main(["info", str(tmp_path / "other_traffic.pcap")]) == 0
    assert "9 packets from 192.168.1.201 to port 2368" in capsys.readouterr().out


def test_a_missing_file_is_one_line_with_its_name(pcap, refuse, tmp_path):
    assert "nowhere.pcap" in refuse(tmp_path / "nowhere.pcap")
    assert "nowhere.csv" in refuse(pcap, "--imu", tmp_path / "nowhere.csv")


# -- rig and samples


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (None, "rig.toml"),
        ("name = [", "rig.toml"),
        ("name = 'x'\n", "sensor"),
        (b"\xff\xfe\x00", "rig.toml"),
    ],
    ids=["missing", "no TOML", "no sensors", "no text"],
)
def test_a_rig_that_cannot_be_read_is_one_line(pcap, refuse, tmp_path, content, expected):
    path = tmp_path / "rig.toml"
    if content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())

    assert expected in refuse(pcap, "--rig", path)


@pytest.mark.study
def test_angular_rates_in_degrees_are_converted_and_said(pcap, process, tmp_path):
    summary = process(pcap, "--imu", write_imu(tmp_path / "imu.csv", gyro=(0.0, 3.0, 45.0)))

    assert counts(tmp_path)["imu_gyro_scaled"] == 100
    assert "are in deg/s, stored in rad/s" in summary["report"]


@pytest.mark.study
def test_accelerations_in_g_are_scaled_with_a_warning(pcap, process, tmp_path):
    summary = process(pcap, "--imu", write_imu(tmp_path / "imu.csv", accel=(0.0, 0.0, 1.0)))

    assert summary["multiframes"] == 8
    assert counts(tmp_path)["imu_accel_scaled"] == 100
    assert "was in g" in summary["report"]


def test_an_imu_that_contradicts_the_lidar_is_not_used_with_a_warning(pcap, process, tmp_path):
    imu = write_imu(tmp_path / "imu.csv", gyro=(0.0, 0.0, 3.0))

    summary = process(pcap, "--imu", imu)

    assert summary["lost"] == 0
    assert_warned(summary, "gyroscope")


def test_an_imu_of_which_all_samples_are_the_same_is_named(pcap, process, tmp_path):
    imu = write_imu(tmp_path / "imu.csv", gyro=(0.0, 0.0, 3.0), noise=0.0)

    summary = process(pcap, "--imu", imu)

    assert summary["lost"] == 0
    assert_warned(summary, "no gyroscope", "Its values along x, y, z never change")


def test_samples_of_another_day_are_refused(pcap, refuse, tmp_path):
    imu = write_imu(tmp_path / "imu.csv")
    imu.write_text(imu.read_text().replace(str(T0_NS)[:6], "160000"))

    assert "IMU samples cover 1600000000" in refuse(pcap, "--imu", imu)


def test_positions_that_jump_do_not_move_the_map(pcap, process, tmp_path):
    places = [(49.2 + (0.01 if k % 3 == 1 else 0.0), 16.6 + 0.02 * k) for k in range(9)]

    summary = process(pcap, "--gnss", write_gnss(tmp_path / "gnss.csv", places))

    assert summary["crs"] == ""
    assert_warned(summary, "positions")
    assert summary["path_length_m"] < 0.1


# -- the place of the results


def test_a_foreign_folder_is_not_changed(pcap, refuse, tmp_path):
    (tmp_path / "project").mkdir()
    (tmp_path / "project" / "thesis.doc").write_text("years of work")

    assert "thesis.doc" in refuse(pcap)
    assert [p.name for p in (tmp_path / "project").iterdir()] == ["thesis.doc"]


def test_a_folder_that_cannot_be_written_is_one_line(pcap, refuse, tmp_path):
    (tmp_path / "file").write_text("not a folder")

    assert "file" in refuse(pcap, out="file/project")
    assert "proc" in refuse(pcap, out="/proc/recon4")


def test_a_project_in_use_is_refused(pcap, refuse, tmp_path):
    with Project.open(tmp_path / "project"):
        assert "in use by another recon4" in refuse(pcap)


LIMITED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]), resource.RLIM_INFINITY))
from recon4.cli.main import main
sys.exit(main(sys.argv[2:]))
"""


@pytest.mark.study
def test_a_full_disk_is_one_line_and_the_next_run_resumes(pcap, process, tmp_path):
    """No file may grow beyond a limit: for a program the same as a full disk.

    Each run has more room than the one before it and goes on after it.
    """
    command = ["process", str(pcap), "--out", str(tmp_path / "project"), *FEW]
    for limit_kb in (1, 60, 300, 500):
        limited = [sys.executable, "-c", LIMITED, str(1000 * limit_kb), *command]

        done = subprocess.run(limited, capture_output=True, text=True, timeout=100, env=os.environ)

        assert done.returncode == 1, done.stderr
        said = done.stderr.splitlines()[-1]
        assert re.match(r"recon4: .*(no space|disk|full)", said), said
        assert "Traceback" not in done.stderr
        assert not (tmp_path / "project" / "summary.json").exists()
    assert process(pcap)["multiframes"] == 8
