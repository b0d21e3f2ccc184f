"""The stage ``frames``, from files written here to a store, and everything that can be wrong."""

import json

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from recon4.errors import ConfigError, EmptyRecording, RecordingError, UnknownFormat
from recon4.model.events import Remarked
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.samples.csv_files import GNSS_HEADER, IMU_HEADER
from tests.builders import T0_NS, room_cloud, write_pcd, write_room_bag, write_room_pcap
from tests.unit.recording.ingested import frame_folder, imu_csv, run
from tests.warned import K, derivations, warned

# -- from recording to frame store


def test_a_pcap_becomes_frames_of_one_revolution(pcap, tmp_path):
    store = run(pcap, out=tmp_path / "o")

    assert len(store) == 10
    assert store.index["duration_ns"].tolist() == [100_000_000] * 10
    assert store.report["rig"] == "single VLP-16"
    assert store.report["sensors"][0]["rotation_hz"] == pytest.approx(10.0, abs=0.02)
    assert store.report["points"] == store.points == store.report["sensors"][0]["points"]
    assert any("No rig given" in text for text in derivations(store.report))
    assert any("No IMU" in text for text in derivations(store.report))


def test_points_lie_on_the_walls_of_the_room(pcap, tmp_path):
    frame = run(pcap, out=tmp_path / "o")[3]

    walls = np.abs(np.abs(frame.xyz) - np.array([4.0, 3.0, 1.5]))
    assert np.quantile(walls.min(axis=1), 0.99) < 0.02


def test_a_bag_brings_its_imu_positions_and_poses(tmp_path):
    store = run(write_room_bag(tmp_path, "mcap"), out=tmp_path / "o")

    assert store.report["imu"]["samples"] == len(store.imu) == 110
    assert store.report["gnss"]["samples"] == len(store.gnss) == 6
    assert len(read_tum(tmp_path / "o" / "poses.tum")) == 11


def test_csv_files_beside_the_recording_are_found_by_their_header(pcap, tmp_path):
    gnss = tmp_path / "b.csv"
    gnss.write_text(",".join(GNSS_HEADER[:3]) + f"\n{T0_NS},50,14\n")

    store = run(pcap, imu_csv(tmp_path / "a.csv"), gnss, out=tmp_path / "o")

    assert (len(store.imu), len(store.gnss)) == (100, 1)
    assert store.report["recordings"] == ["room.pcap"]


def test_a_given_imu_replaces_the_recordings(tmp_path):
    bag = write_room_bag(tmp_path, "db3")

    store = run(bag, out=tmp_path / "o", imu=imu_csv(tmp_path / "imu.csv", count=50))

    assert len(store.imu) == 50
    assert any("those of the CSV file" in text for text in derivations(store.report))


def test_two_sensors_in_one_file_are_told_apart_by_port(tmp_path):
    pcap = write_room_pcap(tmp_path / "two.pcap", ports=(2368, 2369), seconds=0.5)

    store = run(pcap, out=tmp_path / "o")

    assert store.rig.name == "4RECON"
    assert np.bincount(store[1].sensor).tolist()[0] == np.bincount(store[1].sensor).tolist()[1]
    assert any("match the preset 4RECON" in text for text in derivations(store.report))


def test_two_sensors_in_two_files_are_one_recording(tmp_path):
    a = write_room_pcap(tmp_path / "a.pcap", ports=(2368,), seconds=0.5)
    b = write_room_pcap(tmp_path / "b.pcap", ports=(2369,), seconds=0.5)

    store = run(a, b, out=tmp_path / "o", rig=load_rig("4recon"))

    assert set(store[1].sensor.tolist()) == {0, 1}


def test_two_sensors_on_unknown_ports_need_a_rig(tmp_path):
    pcap = write_room_pcap(tmp_path / "two.pcap", ports=(2370, 2371), seconds=0.3)

    with pytest.raises(ConfigError, match="how they are mounted is unknown"):
        run(pcap, out=tmp_path / "o")


def test_a_missing_second_sensor_is_counted(pcap, tmp_path):
    store = run(pcap, out=tmp_path / "o", rig=load_rig("4recon"))

    assert store.report["counts"]["frames_without_vertical"] == 10
    assert warned(store.report, K.PACKETS_MISSING, sensor="vertical")


def test_progress_and_warnings_are_reported(pcap, tmp_path):
    started = []

    class Watch(Silent):
        def start(self, what, total, unit):
            started.append((what, total, unit))

    watch = Watch()
    run(pcap, out=tmp_path / "o", rig=load_rig("4recon"), progress=watch)

    assert started[0] == ("frames", 10, "multiframe")
    assert any(isinstance(event, Remarked) for event in watch.events)


def test_the_same_input_gives_the_same_bytes(pcap, tmp_path):
    run(pcap, out=tmp_path / "a")
    run(pcap, out=tmp_path / "b")

    for file in sorted((tmp_path / "a").iterdir()):
        assert file.read_bytes() == (tmp_path / "b" / file.name).read_bytes()


# -- what is wrong

GGA = b"$GPGGA,120000.00,4912.0,N,01636.0,E,4,12,0.7,250.1,M,44.0,M,1.0,0001*7D\r\n"
"""A position as it lies in packets of a Velodyne."""


@pytest.mark.parametrize(
    ("name", "content", "error", "message"),
    [
        ("a.pcap", b"", EmptyRecording, "the file is empty"),
        ("a.pcap", b"\xff\xd8\xff\xe0 photo", UnknownFormat, "looks like a JPEG image"),
        ("a.ptx", b"2\n3\n" + b"1 0 0\n" * 4, UnknownFormat, "looks like PTX scans"),
        ("a.zip", b"PK\x03\x04\xb2\xa1" + GGA * 9, UnknownFormat, "a zip archive: unpack it first"),
        ("a.pcap", b"\x34\xcd\xb2\xa1" + GGA * 9, UnknownFormat, "a patched libpcap: convert it"),
        ("a.bag", b"PK\x03\x04 archive", UnknownFormat, "a zip archive: unpack it first"),
        ("a.txt", b"hello", UnknownFormat, "known: packets of LiDARs .pcap., .*, rosbag1, rosbag2"),
        ("a.las", b"LASF\x00\x00", UnknownFormat, "a LAS/LAZ point cloud"),
        ("a.bin", b"\x00" * 16 + b"\xff" * 20, UnknownFormat, "no reader recognizes it"),
        ("a.csv", ",".join(IMU_HEADER).encode() + b"\n", UnknownFormat, "has no points"),
    ],
)
def test_another_kind_of_file_is_named(tmp_path, name, content, error, message):
    (tmp_path / name).write_bytes(content)

    with pytest.raises(error, match=message):
        run(tmp_path / name, out=tmp_path / "o")


def test_a_path_that_is_not_there_is_named(tmp_path):
    with pytest.raises(RecordingError, match=r"nothing\.pcap does not exist"):
        run(tmp_path / "nothing.pcap", out=tmp_path / "o")


def test_an_empty_folder_and_a_folder_of_other_things_are_named(tmp_path):
    (tmp_path / "f").mkdir()
    with pytest.raises(EmptyRecording, match="the folder is empty"):
        run(tmp_path / "f", out=tmp_path / "o")
    (tmp_path / "f" / "notes.txt").write_text("hello")
    with pytest.raises(UnknownFormat, match=r"it has notes\.txt"):
        run(tmp_path / "f", out=tmp_path / "o")


def test_recordings_of_two_kinds_are_refused(pcap, tmp_path):
    bag = write_room_bag(tmp_path, "db3", seconds=0.3)

    with pytest.raises(UnknownFormat, match="recordings of one kind expected"):
        run(pcap, bag, out=tmp_path / "o")


def test_only_bad_points_are_an_empty_recording_with_the_reasons(tmp_path):
    far = room_cloud()
    for axis in "xyz":
        far[axis] *= 1000
    folder = tmp_path / "f"
    folder.mkdir()
    write_pcd(folder / "1.pcd", far)

    with pytest.raises(EmptyRecording, match=r"no usable points \(.*57\d* points: farther than"):
        run(folder, out=tmp_path / "o")


def test_imu_samples_of_another_time_are_refused_when_given(pcap, tmp_path):
    imu = imu_csv(tmp_path / "imu.csv", start_ns=T0_NS - 3600 * 10**9)

    with pytest.raises(ConfigError, match="are the clocks the same"):
        run(pcap, out=tmp_path / "o", imu=imu)


def test_a_rig_of_two_does_not_fit_a_folder_of_frames(tmp_path):
    folder = frame_folder(tmp_path / "f", ["1.pcd"])

    with pytest.raises(ConfigError, match="is one LiDAR"):
        run(folder, out=tmp_path / "o", rig=load_rig("4recon"))


@settings(max_examples=12, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0.0, 0.999))
def test_a_pcap_cut_anywhere_gives_what_is_left(pcap, tmp_path_factory, share):
    folder = tmp_path_factory.mktemp("cut")
    data = pcap.read_bytes()
    path = folder / "room.pcap"
    path.write_bytes(data[: int(share * len(data))])
    try:
        store = run(path, out=folder / "o")
    except RecordingError:
        assert share < 0.01
        return
    assert store.report["outcome"] == "lossy" or store.report["counts"]["packets"] > 0
    assert store.points == pytest.approx(share * 289_000, rel=0.1, abs=6000)


# -- real recordings


@pytest.mark.parametrize(
    ("name", "model", "rate_hz", "frames"),
    [
        ("packets/veloview/vlp-16-test-90deg-1-50-frames.pcap", "VLP-16", 20.0, 51),
        ("packets/veloview/monterey-first-100-packets.pcap", "HDL-32E", 11.77, 18),
        ("packets/mrpt/sample_velodyne_vlp16_gps.pcap", "VLP-16", 10.0, 4),
        ("packets/mrpt/sample_velodyne_hdl32.pcap", "HDL-32E", 9.04, 3),
        ("packets/nebula/velodyne/vlp16/1673400471837873222", "VLP-16", 10.0, 4),
        ("packets/nebula/velodyne/vlp32/1713492677464078412", "VLP-32C", 10.0, 5),
        ("sequences/vlp16-corridor", "VLP-16", 10.0, 22),
        ("calibration/0001", "generic", 10.0, 3),
        ("gnss/lidar2imu/top_center_lidar", "generic", 10.0, 5),
    ],
)
def test_real_recordings_become_whole_revolutions(data, tmp_path, name, model, rate_hz, frames):
    store = run(data(name), out=tmp_path / "o")

    assert store.rig.sensors[0].model == model
    assert len(store) == frames
    assert 1e9 / store.index["duration_ns"][0] == pytest.approx(rate_hz, rel=0.005)
    sizes = [len(frame) for frame in store]
    if model != "generic":
        assert min(sizes[:-1]) > 0.95 * max(sizes)
    for frame in store:
        assert np.isfinite(frame.xyz).all()
        assert 0 <= frame.dt_ns.min() <= frame.dt_ns.max() <= 1.05 * frame.duration_ns
        assert (np.diff(frame.dt_ns) >= 0).all()


def test_the_report_is_json(pcap, tmp_path):
    run(pcap, out=tmp_path / "o")

    report = json.loads((tmp_path / "o" / "report.json").read_text("utf-8"))
    assert {"kind", "outcome", "sensors", "counts", "gaps", "derived", "findings"} <= set(report)
