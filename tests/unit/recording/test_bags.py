"""Bags of every kind, whole and cut off."""

import shutil
import sqlite3
from contextlib import closing

import numpy as np
import pytest
import zstandard
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from recon4.errors import ConfigError, CorruptFile, EmptyRecording, RecordingError
from recon4.model.rig import load_rig
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.recording.assembly.shots import Shots
from recon4.recording.bags.recording import BagRecording
from recon4.recording.formats.bags import CLOUD, Bag
from recon4.recording.info.describe import describe
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, bag_path, room_cloud, room_packets, storage_file, write_room_bag
from tests.builders import Bag as BagFile
from tests.warned import K, derivations, warned

KINDS = ("bag1", "db3", "mcap")


@pytest.fixture(scope="module")
def rooms(tmp_path_factory):
    folder = tmp_path_factory.mktemp("rooms")
    return {kind: write_room_bag(folder, kind) for kind in KINDS}


def messages(path, report=None):
    with Bag([path], report or ImportReport()) as bag:
        return list(bag.messages({topic.name for topic in bag.topics}))


def read(path, rig=None):
    report = ImportReport()
    recording = BagRecording([path], rig, settings=IngestSettings(), report=report)
    items = list(recording.read())
    return items, report, recording


def of(items, kind):
    return [item for item in items if isinstance(item, kind)]


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_gives_the_same_points_and_samples(rooms, kind):
    items, report, recording = read(rooms[kind])
    expected = of(read(rooms["db3"])[0], Shots)

    points = np.concatenate([s.xyz for s in of(items, Shots)])
    np.testing.assert_array_equal(points, np.concatenate([s.xyz for s in expected]))
    assert recording.rig.sensors[0].model == "VLP-16"
    assert sum(len(s) for s in of(items, ImuSamples)) == 110
    fixes = of(items, GnssSamples)[0]
    assert set(fixes.quality.tolist()) == {GnssQuality.RTK_FIXED}
    np.testing.assert_allclose(fixes.sd_enu_m[0], [0.01, 0.02, 0.03])
    assert of(items, Trajectory)[0].T_a_b.t[:, 0].tolist() == list(range(11))
    assert report.outcome == "complete"


@pytest.mark.parametrize("kind", ["db3", "mcap"])
def test_a_bare_storage_file_is_read_without_its_folder(rooms, kind, tmp_path):
    bare = tmp_path / storage_file(rooms[kind]).name
    shutil.copy(storage_file(rooms[kind]), bare)

    assert len(messages(bare)) == len(messages(rooms[kind]))


def test_a_folder_without_its_description_is_read_file_by_file(rooms, tmp_path):
    folder = tmp_path / "bag"
    shutil.copytree(rooms["db3"], folder)
    (folder / "metadata.yaml").unlink()
    report = ImportReport()

    assert len(messages(folder, report)) == len(messages(rooms["db3"]))
    assert any("no metadata.yaml" in text for text in derivations(report))
    assert not report.findings


@pytest.mark.parametrize("listed", ["other.db3", "same"])
def test_files_that_the_description_does_not_list_are_read_too(rooms, tmp_path, listed):
    folder = tmp_path / "bag"
    shutil.copytree(rooms["db3"], folder)
    whole = storage_file(folder)
    if listed == "other.db3":
        whole.rename(folder / "renamed.db3")
        shutil.copy(storage_file(rooms["mcap"]), folder / whole.name)
    else:
        shutil.copy(storage_file(rooms["mcap"]), folder / "more.mcap")
    report = ImportReport()

    assert len(messages(folder, report)) == 2 * len(messages(rooms["db3"]))
    name = "renamed.db3" if listed == "other.db3" else "more.mcap"
    assert warned(report, K.FOLDER_DESCRIPTION, error=f"metadata.yaml does not list {name}")


def test_what_a_folder_lacks_is_counted_once(rooms, tmp_path):
    folder = tmp_path / "bag"
    shutil.copytree(rooms["db3"], folder)
    text = (folder / "metadata.yaml").read_text()
    name = storage_file(folder).name
    listed = text.replace(f"  - {name}\n", f"  - {name}\n  - lost_1.db3\n")
    (folder / "metadata.yaml").write_text(listed)

    found = describe(folder)

    assert [(loss.name, loss.number) for loss in found.lost] == [("files_missing", 1)]
    assert warned(found, K.FILES_MISSING, files=1, missing="lost_1.db3")


def test_compressed_messages_are_read_without_their_description_beside_others(rooms, tmp_path):
    packed = tmp_path / "packed"
    with Writer(packed, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        kind = "sensor_msgs/msg/Imu"
        connection = writer.add_connection("/imu", kind, typestore=get_typestore(Stores.LATEST))
        for message in messages(rooms["db3"]):
            if message.topic == "/imu":
                data = zstandard.ZstdCompressor().compress(message.data)
                writer.write(connection, message.t_ns, data)
    (packed / "metadata.yaml").unlink()

    with Bag([packed, rooms["db3"]], ImportReport()) as bag:
        found = [(m.t_ns, bag.decode(m).angular_velocity.x) for m in bag.messages({"/imu"})]

    assert found and found[::2] == found[1::2]


def test_a_damaged_description_of_a_folder_is_a_warning(rooms, tmp_path):
    folder = tmp_path / "bag"
    shutil.copytree(rooms["db3"], folder)
    (folder / "metadata.yaml").write_text("no description")
    report = ImportReport()

    assert len(messages(folder, report)) == len(messages(rooms["db3"]))
    assert warned(report, K.FOLDER_DESCRIPTION)


def test_messages_of_several_files_come_in_order_of_time(tmp_path):
    paths = [tmp_path / "b.bag", tmp_path / "a.bag"]
    for path, start in zip(paths, (1, 0), strict=True):
        with BagFile(path, "bag1") as bag:
            for k in range(5):
                bag.imu("/imu", T0_NS + (2 * k + start) * 1000, (0.0,) * 3, (0.0,) * 3)

    with Bag(paths, ImportReport()) as bag:
        times = [message.t_ns - T0_NS for message in bag.messages({"/imu"})]

    assert times == [k * 1000 for k in range(10)]


# -- cut off


def cut(path, share, folder):
    """A copy of the file with the messages, cut."""
    source = storage_file(path)
    target = folder / source.name
    target.write_bytes(source.read_bytes()[: int(share * source.stat().st_size)])
    return target


@pytest.mark.parametrize("share", [0.01, 0.03, *np.linspace(0.08, 0.99, 12).round(3).tolist()])
@pytest.mark.parametrize("kind", KINDS)
def test_a_bag_cut_anywhere_gives_what_is_left(rooms, kind, share, tmp_path):
    """At least the kept share, less two chunks (of 1 MB in an mcap: the room has one)."""
    whole = messages(rooms[kind])
    path = cut(rooms[kind], share, tmp_path)
    report = ImportReport()
    try:
        left = messages(path, report)
    except CorruptFile:
        left = []

    known = {(m.topic, m.t_ns, m.data) for m in whole}
    assert {(m.topic, m.t_ns, m.data) for m in left} <= known
    assert report.outcome in ({"lossy"} if left else {"nothing", "complete"})
    if kind != "mcap":
        assert len(left) >= (share - 0.2) * len(whole)


@pytest.mark.parametrize("compression", ["BZ2", "LZ4"])
def test_a_compressed_rosbag1_cut_off_gives_what_is_left(compression, tmp_path):
    path = tmp_path / "c.bag"
    bag = BagFile(path, "bag1")
    bag.writer.set_compression(bag.writer.CompressionFormat[compression])
    rng = np.random.default_rng(1)
    with bag:
        for k in range(3000):
            bag.imu("/imu", T0_NS + k, tuple(rng.normal(size=3)), (0.0,) * 3)
    size = path.stat().st_size
    path.write_bytes(path.read_bytes()[: size // 2])
    report = ImportReport()

    left = messages(path, report)

    assert report.counts["messages_salvaged"] == len(left) > 800


def test_a_cut_recording_still_becomes_points(rooms, tmp_path):
    items, report, _ = read(cut(rooms["bag1"], 0.6, tmp_path))

    points = sum(len(s) for s in of(items, Shots))
    assert 0.4 < points / sum(len(s) for s in of(read(rooms["bag1"])[0], Shots)) < 0.7
    assert report.outcome == "lossy"
    assert sum("messages" in one.values for one in report.findings) == 1


@pytest.mark.parametrize("kind", KINDS)
def test_changed_bytes_give_messages_or_a_recording_error(rooms, kind, tmp_path):
    data = bytearray(storage_file(rooms[kind]).read_bytes())
    rng = np.random.default_rng(8)
    for round_ in range(15):
        damaged = bytearray(data)
        for at in rng.integers(0, len(data), 20):
            damaged[at] = int(rng.integers(256))
        path = tmp_path / f"{round_}{storage_file(rooms[kind]).suffix}"
        path.write_bytes(damaged)
        try:
            read(path)
        except (RecordingError, ConfigError):
            continue


def test_an_empty_bag_is_named(tmp_path):
    path = bag_path(tmp_path, "db3")
    with BagFile(path, "db3"):
        pass

    with pytest.raises(EmptyRecording, match="a bag without messages"):
        messages(path)


@pytest.mark.parametrize(
    ("statement", "why"),
    [
        (
            "DELETE FROM topics",
            r"its table topics is empty: what the \d+ messages are is not known",
        ),
        ("DROP TABLE topics", "expected a table topics, got nothing of that name"),
        ("DELETE FROM messages", "a bag without messages"),
    ],
)
def test_a_database_that_lost_a_table_says_which(rooms, statement, why, tmp_path):
    path = cut(rooms["db3"], 1.0, tmp_path)
    with closing(sqlite3.connect(path, isolation_level=None)) as database:
        database.execute(statement)

    with pytest.raises(RecordingError, match=why):
        messages(path)


def test_a_database_cut_off_behind_its_first_page_says_so(rooms, tmp_path):
    path = cut(rooms["db3"], 1.0, tmp_path)
    path.write_bytes(path.read_bytes()[:4096])

    with pytest.raises(CorruptFile, match="cut off, not one message is left"):
        messages(path)


def test_a_bag_without_lidar_lists_its_topics(tmp_path):
    path = bag_path(tmp_path, "db3")
    with BagFile(path, "db3") as bag:
        bag.imu("/imu", T0_NS, (0.0,) * 3, (0.0,) * 3)

    with pytest.raises(EmptyRecording, match=r"no LiDAR data; topics: /imu \(sensor_msgs"):
        read(path)


# -- clouds


def cloud_bag(folder, tables, *, kind="db3", topic="/points"):
    path = bag_path(folder, kind)
    with BagFile(path, kind) as bag:
        for t_ns, table in tables:
            bag.cloud(topic, t_ns, table)
    return path


@pytest.mark.parametrize("kind", KINDS)
def test_clouds_become_shots(tmp_path, kind):
    table = room_cloud()
    tables = [(T0_NS + k * 100_000_000, table) for k in range(3)]

    items, _, recording = read(cloud_bag(tmp_path, tables, kind=kind))

    assert recording.rig.sensors[0].model == "VLP-16"
    assert [len(s) for s in of(items, Shots)] == [len(table["x"])] * 3
    np.testing.assert_array_equal(items[1].xyz[:, 0], table["x"])
    assert [int(s.t_ns[0]) - T0_NS for s in items] == [0, 100_000_000, 200_000_000]


def test_a_stamp_of_zero_is_replaced_by_the_time_of_recording(tmp_path):
    path = bag_path(tmp_path, "db3")
    with BagFile(path, "db3") as bag:
        bag.header = lambda _t, make=bag.make: make(
            "std_msgs/msg/Header", stamp=bag.time(0), frame_id="x"
        )
        bag.cloud("/points", T0_NS, room_cloud())

    items, report, _ = read(path)

    assert int(items[0].t_ns[0]) == T0_NS - 100_000_000
    assert report.counts["stamps_missing"] == 1


def test_raw_packets_win_over_clouds(tmp_path):
    path = bag_path(tmp_path, "db3")
    t_ns, payloads = room_packets(seconds=0.3)
    with BagFile(path, "db3") as bag:
        bag.scan("/velodyne_packets", t_ns[:75], payloads[:75])
        bag.cloud("/velodyne_points", T0_NS, room_cloud())

    _, report, recording = read(path)

    assert recording.rig.sensors[0].topic == "/velodyne_packets"
    assert any("not /velodyne_points" in text for text in derivations(report))
    assert {t.type for t in recording.topics} == {"velodyne_msgs/msg/VelodyneScan", CLOUD}


# -- two sensors


def test_topics_named_like_the_preset_get_its_mounting(tmp_path):
    topics = ("/horizontal/velodyne_packets", "/vertical/velodyne_packets")

    _, report, recording = read(write_room_bag(tmp_path, "db3", seconds=0.3, topics=topics))

    assert recording.rig.name == "4RECON"
    assert [s.topic for s in recording.rig.sensors] == list(topics)
    assert any("match the preset" in text for text in derivations(report))


def test_two_unknown_sensors_need_a_rig(tmp_path):
    path = write_room_bag(tmp_path, "db3", seconds=0.3, topics=("/a", "/b"))

    with pytest.raises(ConfigError, match="give a rig"):
        read(path)

    _, report, recording = read(path, load_rig("4recon"))
    assert [s.topic for s in recording.rig.sensors] == ["/a", "/b"]
    assert any("horizontal is topic /a" in text for text in derivations(report))


def test_a_missing_second_sensor_is_said(tmp_path):
    path = write_room_bag(tmp_path, "db3", seconds=0.3, topics=("/horizontal/packets",))

    items, report, _ = read(path, load_rig("4recon"))

    assert {s.sensor for s in of(items, Shots)} == {0}
    assert warned(report, K.SENSOR_NOT_RECORDED, sensor="vertical")
