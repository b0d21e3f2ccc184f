"""Bad input on the command line: a clear error message, or a reported count of repairs."""

import html
import json
import os
import re
import subprocess
import sys
import zipfile

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.recording.samples.csv_files import GNSS_HEADER, IMU_HEADER
from recon4.recording.velodyne.encode import PcapWriter
from recon4.store.project import Project
from tests.builders import (
    T0_NS,
    Bag,
    bag_path,
    room_cloud,
    room_packets,
    storage_file,
    write_pcd,
    write_room_bag,
    write_room_pcap,
)

FEW = [
    *("--set", "map.voxel_m=0.1", "--set", "graph.node_stride=10"),
    *("--set", "segments.preserved=2"),
]
SOURCE = "192.168.1.201"
HOUR_NS = 3_600_000_000_000


@pytest.fixture(scope="module")
def pcap(tmp_path_factory):
    return write_room_pcap(tmp_path_factory.mktemp("pcap") / "room.pcap", seconds=0.8)


@pytest.fixture
def process(tmp_path, capsys):
    """Run ``recon4 process`` on an input; returns the summary with the text of the report."""

    def run(recording, *more, out="project"):
        capsys.readouterr()
        code = main(["process", str(recording), "--out", str(tmp_path / out), *FEW, *more])
        said = capsys.readouterr().err
        assert code == 0, said
        summary = json.loads((tmp_path / out / "summary.json").read_text())
        summary["report"] = html.unescape((tmp_path / out / "report.html").read_text("utf-8"))
        return summary

    return run


@pytest.fixture
def refuse(tmp_path, capsys):
    """Run a command that must fail; returns its error line."""

    def run(*arguments, command="process", out="project"):
        capsys.readouterr()
        more = ["--out", str(tmp_path / out), *FEW] if command == "process" else []
        code = main([command, *map(str, arguments), *more])
        said = capsys.readouterr().err
        assert code == 1, said
        assert said.count("recon4: ") == 1
        assert "Traceback" not in said
        line = said.splitlines()[-1]
        assert line.startswith("recon4: ")
        return line

    return run


@pytest.fixture(scope="module")
def whole(pcap, tmp_path_factory):
    """Points in the map of the unharmed recording."""
    out = tmp_path_factory.mktemp("whole") / "project"
    assert main(["process", str(pcap), "--out", str(out), *FEW]) == 0
    return json.loads((out / "summary.json").read_text())["points"]


def counts(tmp_path, out="project"):
    (report,) = (tmp_path / out / "artifacts").glob("*/report.json")
    return json.loads(report.read_text())["counts"]


def assert_warned(summary, *words):
    """One warning contains all words, in the summary and in the report."""
    found = [text for text in summary["warnings"] if all(word in text for word in words)]
    assert found, summary["warnings"]
    assert found[0] in summary["report"]


def write_pcap(path, t_ns, payloads):
    with PcapWriter(path) as file:
        file.write(t_ns, payloads, source=SOURCE)
    return path


def write_imu(path, *, count=100, gyro=(0.0, 0.0, 0.0), accel=(0.0, 0.0, 9.80665)):
    values = ",".join(map(str, (*gyro, *accel)))
    rows = [f"{T0_NS + k * 10_000_000},{values}" for k in range(count)]
    path.write_text("\n".join([",".join(IMU_HEADER), *rows]) + "\n")
    return path


def write_gnss(path, degrees, *, every_ns=100_000_000):
    rows = [
        f"{T0_NS + k * every_ns},{lat},{lon},300,0.01,0.01,0.02,4,,,"
        for k, (lat, lon) in enumerate(degrees)
    ]
    path.write_text("\n".join([",".join(GNSS_HEADER), *rows]) + "\n")
    return path


def altered_cloud(**changes):
    table = room_cloud()
    for name, change in changes.items():
        table[name] = change(table[name])
    return table


# -- cut off


@pytest.mark.parametrize("share", [0.5, 0.97])
def test_a_pcap_cut_off_becomes_a_map_of_what_is_left(pcap, process, tmp_path, share):
    cut = tmp_path / "cut.pcap"
    cut.write_bytes(pcap.read_bytes()[: int(share * pcap.stat().st_size) + 7])

    summary = process(cut)

    assert summary["multiframes"] == pytest.approx(8 * share, abs=1)
    assert_warned(summary, "cut.pcap", "salvaged")


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_a_bag_cut_off_becomes_a_map_of_what_is_left(process, tmp_path, kind):
    source = storage_file(write_room_bag(tmp_path, kind, seconds=2.5 if kind == "mcap" else 1.0))
    cut = tmp_path / f"cut{source.suffix}"
    cut.write_bytes(source.read_bytes()[: int(0.7 * source.stat().st_size)])

    summary = process(cut)

    assert summary["multiframes"] >= 3
    assert_warned(summary, cut.name, "salvaged")


# -- packets


def test_garbage_duplicates_and_disorder_do_not_change_the_map(process, tmp_path, whole):
    rng = np.random.default_rng(1)
    t_ns, payloads = room_packets(seconds=0.8)
    twice = np.sort(np.append(np.arange(len(t_ns)), rng.choice(len(t_ns), 60, replace=False)))
    order = twice[np.argsort(np.arange(len(twice)) + rng.uniform(0, 20, len(twice)))]
    t_ns, payloads = np.sort(t_ns[order]), payloads[order].copy()
    at = rng.choice(len(t_ns), 40, replace=False)
    payloads = np.insert(payloads, at, rng.integers(0, 256, (40, 1206)), axis=0)

    summary = process(write_pcap(tmp_path / "mess.pcap", np.insert(t_ns, at, t_ns[at]), payloads))

    assert summary["points"] == pytest.approx(whole, rel=0.01)
    found = counts(tmp_path)
    assert found["packets_duplicate"] == 60
    assert found["packets_wrong_flag"] == 40
    assert "packets duplicate" in summary["report"]


def test_a_product_byte_of_another_model_is_overridden_and_reported(process, tmp_path, whole):
    t_ns, payloads = room_packets(seconds=0.8)
    payloads[:, 1205] = 0x21

    summary = process(write_pcap(tmp_path / "odd.pcap", t_ns, payloads))

    assert summary["points"] == pytest.approx(whole, rel=0.01)
    assert_warned(summary, "HDL-32E", "VLP-16")


def test_a_recording_over_the_full_hour_is_one_recording(process, tmp_path, whole):
    start_ns = (T0_NS // HOUR_NS + 1) * HOUR_NS - 400_000_000
    t_ns, payloads = room_packets(seconds=0.8, t0_ns=start_ns)

    summary = process(write_pcap(tmp_path / "hour.pcap", t_ns, payloads))

    assert summary["duration_s"] == pytest.approx(0.8, abs=0.02)
    assert summary["points"] == pytest.approx(whole, rel=0.01)


def test_a_clock_that_is_set_back_is_continued_and_reported(process, tmp_path, whole):
    t_ns, payloads = room_packets(seconds=0.8)
    half = len(t_ns) // 2
    t_ns[half:] -= 30_000_000_000
    stamp_us = payloads[:, 1200:1204].copy().view("<u4")
    stamp_us[half:] -= 30_000_000
    payloads[:, 1200:1204] = stamp_us.view(np.uint8)

    summary = process(write_pcap(tmp_path / "back.pcap", t_ns, payloads))

    assert summary["duration_s"] == pytest.approx(0.8, abs=0.02)
    assert summary["points"] == pytest.approx(whole, rel=0.01)
    assert_warned(summary, "clock")


def test_shots_without_a_return_are_counted_and_skipped(process, tmp_path, whole):
    t_ns, payloads = room_packets(seconds=0.8)
    blocks = payloads[:, :1200].reshape(-1, 12, 100)
    blocks[:, ::2, 4:100:3] = 0
    blocks[:, ::2, 5:100:3] = 0

    summary = process(write_pcap(tmp_path / "zero.pcap", t_ns, payloads))

    assert summary["points"] == pytest.approx(whole, rel=0.2)
    assert counts(tmp_path)["points_no_return"] == len(t_ns) * 6 * 32


# -- what is missing


def test_a_silent_second_lidar_is_named(pcap, process):
    summary = process(pcap, "--rig", "4recon")

    assert summary["rig"] == "4RECON"
    assert summary["points"] > 0
    assert_warned(summary, "vertical")


def test_without_imu_and_gnss_the_map_is_local_with_a_warning(pcap, process):
    summary = process(pcap, "--preset", "outdoor")

    assert summary["crs"] == ""
    assert_warned(summary, "no IMU")


# -- clouds


def test_invalid_points_are_dropped_and_counted(process, tmp_path):
    folder = tmp_path / "frames"
    folder.mkdir()
    for k in range(3):
        holes = np.where(np.arange(5760) % 4 == k, np.nan, 1.0).astype(np.float32)
        write_pcd(folder / f"{k}.pcd", altered_cloud(x=lambda x, h=holes: x * h))
    write_pcd(folder / "3.pcd", altered_cloud(x=np.zeros_like, y=np.zeros_like, z=np.zeros_like))

    summary = process(folder)

    assert summary["multiframes"] == 3
    found = counts(tmp_path)
    assert found["points_invalid"] == 3 * 1440 + 5760
    assert "points invalid" in summary["report"]


def test_frames_without_points_are_counted_and_skipped(process, tmp_path):
    folder = tmp_path / "frames"
    folder.mkdir()
    for k in range(4):
        table = room_cloud()
        write_pcd(folder / f"{k}.pcd", {n: v[: 0 if k == 1 else None] for n, v in table.items()})

    summary = process(folder)

    assert summary["multiframes"] == 3
    assert counts(tmp_path)["frames_empty"] == 1


def test_one_frame_is_a_map(process, tmp_path):
    (tmp_path / "frames").mkdir()
    write_pcd(tmp_path / "frames" / "0.pcd", room_cloud())

    summary = process(tmp_path / "frames")

    assert summary["multiframes"] == 1
    assert summary["points"] > 0


def cloud_bag(folder, table, frames=4):
    path = bag_path(folder, "db3")
    with Bag(path, "db3") as bag:
        for k in range(frames):
            bag.cloud("/points", T0_NS + k * 100_000_000, table)
    return path


def test_unknown_fields_of_a_cloud_are_ignored(process, tmp_path):
    table = room_cloud()
    table = {"mystery": np.ones(len(table["x"]), np.float64), **table, "rgb_2": table["ring"]}

    summary = process(cloud_bag(tmp_path, table))

    assert summary["multiframes"] == 4


def test_a_cloud_without_coordinates_lists_the_fields_it_has(refuse, tmp_path):
    table = room_cloud()
    table["depth"] = table.pop("z")

    said = refuse(cloud_bag(tmp_path, table))

    assert "x, y and z" in said
    assert "depth" in said


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
    assert "9 packets to port 2368" in capsys.readouterr().out


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


def test_angular_rates_in_degrees_are_refused_with_the_unit(pcap, refuse, tmp_path):
    imu = write_imu(tmp_path / "imu.csv", gyro=(0.0, 3.0, 45.0))

    said = refuse(pcap, "--imu", imu)

    assert "rad/s" in said
    assert "deg/s" in said


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


@pytest.mark.parametrize("limit_kb", [1, 60, 400, 1000])
def test_a_full_disk_is_one_line_and_the_next_run_resumes(pcap, process, tmp_path, limit_kb):
    """No file may grow beyond a limit: for a program the same as a full disk."""
    command = ["process", str(pcap), "--out", str(tmp_path / "project"), *FEW]
    limited = [sys.executable, "-c", LIMITED, str(1000 * limit_kb), *command]

    done = subprocess.run(limited, capture_output=True, text=True, timeout=100, env=os.environ)

    assert done.returncode == 1, done.stderr
    said = done.stderr.splitlines()[-1]
    assert re.match(r"recon4: .*(no space|disk|full)", said), said
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "project" / "summary.json").exists()
    assert process(pcap)["multiframes"] == 8
