"""The stage ``frames``, from files written here to a store, and everything that can be wrong."""

import json

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from recon4.errors import ConfigError, CorruptFile, EmptyRecording, RecordingError, UnknownFormat
from recon4.model.events import Warned
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.folders import natural
from recon4.recording.formats.poses import read_tum
from recon4.recording.frame_times import name_time_ns, read_times
from recon4.recording.info import describe
from recon4.recording.ingest import ingest
from recon4.recording.open import RecordingKind, recognize
from recon4.recording.samples.csv_files import GNSS_HEADER, IMU_HEADER
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.store.frames import FrameStore
from tests.builders import (
    T0_NS,
    room_cloud,
    write_bin,
    write_pcd,
    write_ply,
    write_room_bag,
    write_room_pcap,
)


def run(*paths, out, rig=None, imu=None, gnss=None, progress=None, **options):
    sources = Sources(paths, rig, imu, gnss)
    ingest(sources, out, settings=IngestSettings(**options), progress=progress or Silent())
    return FrameStore.open(out)


def imu_csv(path, *, start_ns=T0_NS, count=100, accel=9.8):
    lines = [f"{start_ns + k * 10_000_000},0,0,0.1,0,0,{accel}" for k in range(count)]
    path.write_text("\n".join([",".join(IMU_HEADER), *lines]) + "\n")
    return path


def frame_folder(folder, names, **options):
    folder.mkdir()
    for name in names:
        write_pcd(folder / name, room_cloud(**options))
    return folder


@pytest.fixture(scope="module")
def pcap(tmp_path_factory):
    return write_room_pcap(tmp_path_factory.mktemp("pcap") / "room.pcap", seconds=1.0)


# -- from recording to frame store


def test_a_pcap_becomes_frames_of_one_revolution(pcap, tmp_path):
    store = run(pcap, out=tmp_path / "o")

    assert len(store) == 10
    assert store.index["duration_ns"].tolist() == [100_000_000] * 10
    assert store.report["rig"] == "single VLP-16"
    assert store.report["sensors"][0]["rotation_hz"] == pytest.approx(10.0, abs=0.02)
    assert store.report["points"] == store.points == store.report["sensors"][0]["points"]
    assert any("no rig given" in text for text in store.report["derived"])
    assert any("no IMU" in text for text in store.report["warnings"])


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
    assert any("those of the CSV file" in text for text in store.report["derived"])


def test_two_sensors_in_one_file_are_told_apart_by_port(tmp_path):
    pcap = write_room_pcap(tmp_path / "two.pcap", ports=(2368, 2369), seconds=0.5)

    store = run(pcap, out=tmp_path / "o")

    assert store.rig.name == "4RECON"
    assert np.bincount(store[1].sensor).tolist()[0] == np.bincount(store[1].sensor).tolist()[1]
    assert any("match the preset 4RECON" in text for text in store.report["derived"])


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
    assert any("vertical" in text for text in store.report["warnings"])


def test_progress_and_warnings_are_reported(pcap, tmp_path):
    started = []

    class Watch(Silent):
        def start(self, what, total, unit):
            started.append((what, total, unit))

    watch = Watch()
    run(pcap, out=tmp_path / "o", progress=watch)

    assert started[0] == ("frames", 10, "multiframe")
    assert any(isinstance(event, Warned) for event in watch.events)


def test_the_same_input_gives_the_same_bytes(pcap, tmp_path):
    run(pcap, out=tmp_path / "a")
    run(pcap, out=tmp_path / "b")

    for file in sorted((tmp_path / "a").iterdir()):
        assert file.read_bytes() == (tmp_path / "b" / file.name).read_bytes()


# -- folders


@pytest.mark.parametrize("write", [write_pcd, write_ply, write_bin], ids=["pcd", "ply", "bin"])
def test_a_folder_of_frames_is_one_frame_a_file(tmp_path, write):
    folder = tmp_path / "frames"
    folder.mkdir()
    suffix = write.__name__[-3:]
    for k in (8, 9, 10):
        write(folder / f"{k}.{suffix}", {n: c[: k * 160] for n, c in room_cloud().items()})

    store = run(folder, out=tmp_path / "o")

    assert [len(f) for f in store] == [1280, 1440, 1600]
    assert store.index["t_ns"].tolist() == [0, 100_000_000, 200_000_000]
    assert any("10 Hz from 0 is assumed" in text for text in store.report["warnings"])


def test_a_folder_with_one_frame_works(tmp_path):
    assert len(run(frame_folder(tmp_path / "f", ["a.pcd"]), out=tmp_path / "o")) == 1


def test_a_single_file_is_one_frame(tmp_path):
    assert len(run(write_pcd(tmp_path / "a.pcd", room_cloud()), out=tmp_path / "o")) == 1


def test_times_in_the_file_names_are_used_and_gaps_reported(tmp_path):
    names = [f"{T0_NS + k * 100_000_000}.pcd" for k in (0, 1, 2, 3, 9)]

    store = run(frame_folder(tmp_path / "f", names), out=tmp_path / "o")

    assert store.index["t_ns"].tolist() == [int(name[:19]) for name in names]
    (gap,) = store.report["gaps"]
    assert gap["seconds"] == pytest.approx(0.6)


def test_one_damaged_file_is_left_out_and_counted(tmp_path):
    folder = frame_folder(tmp_path / "f", ["1.pcd", "2.pcd", "3.pcd"])
    (folder / "2.pcd").write_bytes((folder / "2.pcd").read_bytes()[:-100])

    store = run(folder, out=tmp_path / "o")

    assert len(store) == 2
    assert store.report["outcome"] == "lossy"
    assert store.report["counts"]["files_corrupt"] == 1
    assert any("2.pcd: cut" in text for text in store.report["warnings"])


def test_only_damaged_files_are_an_error(tmp_path):
    folder = frame_folder(tmp_path / "f", ["1.pcd"])
    (folder / "1.pcd").write_bytes((folder / "1.pcd").read_bytes()[:-100])

    with pytest.raises(CorruptFile, match=r"1\.pcd: cut"):
        run(folder, out=tmp_path / "o")


def test_a_frame_without_points_is_counted(tmp_path):
    folder = frame_folder(tmp_path / "f", ["1.pcd", "3.pcd"])
    write_pcd(folder / "2.pcd", {n: c[:0] for n, c in room_cloud().items()})

    store = run(folder, out=tmp_path / "o")

    assert [f.frame_id for f in store] == [0, 1]
    assert store.report["counts"]["frames_empty"] == 1


@pytest.mark.parametrize(
    ("stem", "expected"),
    [
        ("1673400472138016708", 1673400472138016708),
        ("1673400472138016", 1673400472138016000),
        ("1673400472.5", 1673400472500000000),
        ("2021-10-26-16-21-29-468", 1635265289468000000),
        ("top-2022-02-15-17-36-04-449", 1644946564449000000),
        ("1673400472138", 1673400472138000000),
        ("scan_1673400472138", 1673400472138000000),
        ("cloud-1673400472.25", 1673400472250000000),
        ("lidar2_1673400472_000000005", 1673400472000000005),
        ("2021-13-40-16-21-29-468", None),
        ("000012", None),
        ("scan2024", None),
        ("16734004721380167081", None),
    ],
)
def test_times_in_names(stem, expected):
    assert name_time_ns(stem) == expected


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("# seconds\n0\n0.1036712345\n", [0, 103_671_234]),
        ("1.000000000000000000e+00\n1.5e+00\n", [1_000_000_000, 1_500_000_000]),
        ("1673400472.138016708\n", [1673400472138016708]),
        ("1673400472138\r\n1673400472238.5\r\n", [1673400472138000000, 1673400472238500000]),
        ("2011-09-26 13:02:25.951199337\n", [1317042145951199337]),
        ("2011-09-26T13:02:25Z\n\n", [1317042145000000000]),
    ],
)
def test_times_in_text_files(tmp_path, lines, expected):
    (tmp_path / "times.txt").write_bytes(lines.encode())

    assert read_times(tmp_path / "times.txt").tolist() == expected


def test_a_line_that_is_no_time_is_named(tmp_path):
    (tmp_path / "times.txt").write_text("0.0\n0,1\n")

    with pytest.raises(CorruptFile, match=r"times\.txt, line 2: expected seconds or a date"):
        read_times(tmp_path / "times.txt")


def test_kitti_raw_timestamps_lie_beside_the_folder_of_the_frames(tmp_path):
    folder = frame_folder(tmp_path / "data", ["0.pcd", "1.pcd"])
    stamps = ("2011-09-26 13:02:25.951199337", "2011-09-26 13:02:26.054870000")
    (tmp_path / "timestamps.txt").write_text("\n".join(stamps))

    store = run(folder, out=tmp_path / "o")

    assert store.index["t_ns"].tolist() == [1317042145951199337, 1317042146054870000]
    assert not any("assumed" in text for text in store.report["warnings"])


@pytest.mark.parametrize(
    ("lines", "remark"),
    [
        ("0.0\n0.1\n0.2\n", "times.txt has 3 times for 2 files, not used"),
        ("0.1\n0.1\n", "times.txt: time 2 is not later than the one before, not used"),
    ],
)
def test_times_that_do_not_fit_are_named_before_10_hz_are_assumed(tmp_path, lines, remark):
    folder = frame_folder(tmp_path / "f", ["0.pcd", "1.pcd"])
    (folder / "times.txt").write_text(lines)

    warnings = run(folder, out=tmp_path / "o").report["warnings"]

    assert remark in warnings
    assert any("10 Hz from 0 is assumed" in text for text in warnings)
    assert remark in describe(folder).warnings


def test_deskewed_clouds_have_no_motion_inside(tmp_path):
    folder = tmp_path / "f"
    folder.mkdir()
    for name in ("0.bin", "1.bin"):
        write_bin(folder / name, room_cloud())

    plain = run(folder, out=tmp_path / "a")
    deskewed = run(folder, out=tmp_path / "b", deskewed=True)

    assert plain[0].dt_ns.max() > 50_000_000
    assert deskewed[0].dt_ns.max() == 0
    assert any("ingest.deskewed" in text for text in plain.report["warnings"])
    assert not any("ingest.deskewed" in text for text in deskewed.report["warnings"])


def test_names_are_sorted_by_their_numbers(tmp_path):
    names = [tmp_path / n for n in ("10.pcd", "8.pcd", "a2.pcd", "a10.pcd")]

    assert [p.name for p in sorted(names, key=natural)] == ["8.pcd", "10.pcd", "a2.pcd", "a10.pcd"]


# -- what is wrong


@pytest.mark.parametrize(
    ("name", "content", "error", "message"),
    [
        ("a.pcap", b"", EmptyRecording, "the file is empty"),
        ("a.pcap", b"\xff\xd8\xff\xe0 photo", UnknownFormat, "looks like a JPEG image"),
        ("a.bag", b"PK\x03\x04 archive", UnknownFormat, "a zip archive: unpack it first"),
        ("a.txt", b"hello", UnknownFormat, "known: Velodyne pcap, rosbag1, rosbag2"),
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

    with pytest.raises(EmptyRecording, match=r"no usable points \(.*points_far 57"):
        run(folder, out=tmp_path / "o")


def test_imu_samples_of_another_time_are_refused_when_given(pcap, tmp_path):
    imu = imu_csv(tmp_path / "imu.csv", start_ns=T0_NS - 3600 * 10**9)

    with pytest.raises(ConfigError, match="are the clocks the same"):
        run(pcap, out=tmp_path / "o", imu=imu)


def test_a_rig_of_two_does_not_fit_a_folder_of_frames(tmp_path):
    folder = frame_folder(tmp_path / "f", ["1.pcd"])

    with pytest.raises(ConfigError, match="is one LiDAR"):
        run(folder, out=tmp_path / "o", rig=load_rig("4recon"))


@settings(
    max_examples=12, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
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


# -- info


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_info_of_a_bag_names_topics_rates_and_what_is_derived(tmp_path, kind):
    info = describe(write_room_bag(tmp_path, kind))

    (sensor,) = info.sensors
    assert (sensor.label, sensor.model, sensor.count) == ("/velodyne_packets", "VLP-16", 11)
    assert sensor.rotation_hz == pytest.approx(10.0, abs=0.02)
    text = "\n".join(info.lines())
    assert "/imu: IMU, 110" in text
    assert "/fix: GNSS positions, 6" in text
    assert "2023-11-14 22:13:20.000 UTC" in text
    assert "derived   no rig given" in text


def test_info_of_a_pcap_says_what_is_missing(pcap):
    info = describe(pcap)

    assert info.sensors[0].count == 753
    assert any("IMU" in text for text in info.missing)
    assert "lidar     192.168.1.201:2368 VLP-16: 753 packets" in "\n".join(info.lines())


def test_info_asks_for_a_rig(tmp_path):
    info = describe(write_room_bag(tmp_path, "db3", seconds=0.3, topics=("/a", "/b")))

    assert len(info.sensors) == 2
    assert any("give a rig file" in text for text in info.missing)


def test_info_of_frames_names_fields(tmp_path):
    info = describe(frame_folder(tmp_path / "f", ["1.pcd", "2.pcd"]))

    assert info.sensors[0].fields == ("x", "y", "z", "intensity", "ring", "time")
    assert "no absolute times" in "\n".join(info.lines())


def test_info_of_samples(tmp_path):
    info = describe(imu_csv(tmp_path / "imu.csv"))

    assert info.kind == RecordingKind.IMU_CSV
    assert info.samples == ("100 IMU samples, 100.0 a second",)


def test_poses_are_recognized_and_are_no_recording(tmp_path):
    path = tmp_path / "t.txt"
    path.write_text("1.0 0 0 0 0 0 0 1\n")

    assert recognize(path) is RecordingKind.POSES
    with pytest.raises(UnknownFormat, match="alone is no recording"):
        run(path, out=tmp_path / "o")


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
    assert {"kind", "outcome", "sensors", "counts", "gaps", "derived", "warnings"} <= set(report)
