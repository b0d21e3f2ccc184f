"""Damaged recordings on the command line: a map of what is left, with counts and warnings."""

import numpy as np
import pytest

from tests.builders import (
    T0_NS,
    Bag,
    bag_path,
    room_cloud,
    room_packets,
    storage_file,
    write_pcd,
    write_room_bag,
)
from tests.scenario.bad_input.inputs import (
    HOUR_NS,
    altered_cloud,
    assert_warned,
    counts,
    write_pcap,
)

# -- cut off


@pytest.mark.parametrize("share", [0.5, pytest.param(0.97, marks=pytest.mark.study)])
def test_a_pcap_cut_off_becomes_a_map_of_what_is_left(pcap, process, tmp_path, share):
    cut = tmp_path / "cut.pcap"
    cut.write_bytes(pcap.read_bytes()[: int(share * pcap.stat().st_size) + 7])

    summary = process(cut)

    assert summary["multiframes"] == pytest.approx(8 * share, abs=1)
    assert_warned(summary, "cut.pcap", "salvaged")


@pytest.mark.parametrize(
    "kind", [*(pytest.param(one, marks=pytest.mark.study) for one in ("bag1", "db3")), "mcap"]
)
def test_a_bag_cut_off_becomes_a_map_of_what_is_left(process, tmp_path, kind):
    source = storage_file(write_room_bag(tmp_path, kind, seconds=2.5 if kind == "mcap" else 1.0))
    cut = tmp_path / f"cut{source.suffix}"
    cut.write_bytes(source.read_bytes()[: int(0.7 * source.stat().st_size)])

    summary = process(cut)

    assert summary["multiframes"] >= 3
    assert_warned(summary, cut.name, "salvaged")


# -- packets


@pytest.mark.study
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
    assert "data packets: received twice, the copies dropped" in summary["report"]


@pytest.mark.study
def test_a_product_byte_of_another_model_is_overridden_and_reported(process, tmp_path, whole):
    t_ns, payloads = room_packets(seconds=0.8)
    payloads[:, 1205] = 0x21

    summary = process(write_pcap(tmp_path / "odd.pcap", t_ns, payloads))

    assert summary["points"] == pytest.approx(whole, rel=0.01)
    assert_warned(summary, "HDL-32E", "VLP-16")


@pytest.mark.study
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
    assert "points: not finite or at the origin" in summary["report"]


def test_frames_without_points_are_counted_and_skipped(process, tmp_path):
    folder = tmp_path / "frames"
    folder.mkdir()
    for k in range(4):
        table = room_cloud()
        write_pcd(folder / f"{k}.pcd", {n: v[: 0 if k == 1 else None] for n, v in table.items()})

    summary = process(folder)

    assert summary["multiframes"] == 3
    assert counts(tmp_path)["frames_empty"] == 1


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

    assert "x, y, z" in said
    assert "depth" in said


# -- charts of hardly anything


def test_one_frame_is_a_map(drawn, process, tmp_path):
    (tmp_path / "frames").mkdir()
    write_pcd(tmp_path / "frames" / "0.pcd", room_cloud())

    summary = process(tmp_path / "frames")

    assert summary["multiframes"] == 1
    assert summary["points"] > 0
