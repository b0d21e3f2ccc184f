"""Messages of points: read by their definition, without generated code."""

from itertools import pairwise

import numpy as np
import pytest
from rosbags.typesys import Stores, get_typestore

from recon4.errors import CorruptFile, EmptyRecording
from recon4.recording.clouds.exact_times import ExactClock
from recon4.recording.formats.message_schema import parse_schema, read_message
from recon4.recording.formats.point_messages import POINT_MESSAGES, point_reader
from recon4.recording.info.describe import describe
from recon4.recording.report import ImportReport
from tests.builders import T0_NS, Bag, bag_path
from tests.unit.recording.point_bags import header, read, register
from tests.warned import K, derivations, warned

CUSTOM = "livox_ros_driver/msg/CustomMsg"
CUSTOM2 = "livox_ros_driver2/msg/CustomMsg"
OWN = "my_msgs/msg/Points"
MIXED = """std_msgs/Header header
my_msgs/Point[] points
string[] names
float64[] values
uint8[3] three
uint16 KIND=7
my_msgs/Point single
===
MSG: my_msgs/Point
uint8 ring
float64 t  # since power-on
uint16[2] pair
my_msgs/Place place
===
MSG: my_msgs/Place
float32 x
float32 y
float32 z
"""


@pytest.mark.parametrize("ros1", [True, False])
@pytest.mark.parametrize("count", [0, 1, 2, 3, 17])
def test_values_are_those_that_another_library_wrote(ros1, count):
    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    register(store, OWN, MIXED)
    point, place = store.types["my_msgs/msg/Point"], store.types["my_msgs/msg/Place"]
    made = [
        point(k, k * 0.25, np.array([k, 500 + k], np.uint16), place(k, -k, 0.5 * k))
        for k in range(count)
    ]
    message = store.types[OWN](
        header(store, T0_NS),
        made,
        ["a", "längs"],
        np.arange(count) * 1.5,
        np.array([1, 2, 3], np.uint8),
        point(9, 2.5, np.array([1, 2], np.uint16), place(1.0, 2.0, 3.0)),
    )
    data = bytes((store.serialize_ros1 if ros1 else store.serialize_cdr)(message, OWN))
    found = read_message(parse_schema(OWN, MIXED), data, ros1=ros1)

    assert found.header.frame_id == "livox_frame"
    assert (found.header.stamp.sec, found.header.stamp.nanosec) == divmod(T0_NS, 10**9)
    assert list(found.points) == [
        "ring",
        "t",
        "pair.0",
        "pair.1",
        "place.x",
        "place.y",
        "place.z",
    ]
    np.testing.assert_array_equal(found.points["ring"], np.arange(count))
    np.testing.assert_array_equal(found.points["t"], 0.25 * np.arange(count))
    np.testing.assert_array_equal(found.points["pair.1"], 500 + np.arange(count))
    np.testing.assert_array_equal(found.points["place.y"], -np.arange(count))
    assert (found.names, found.three.tolist()) == (["a", "längs"], [1, 2, 3])
    np.testing.assert_array_equal(found.values, 1.5 * np.arange(count))
    assert found.single.t == 2.5 and found.single.place.z == 3.0


def many_types():
    """A chain of types with a hundred of the next one each, which holds nothing in the end."""
    names = [f"my_msgs/T{k}" for k in range(9)]
    inner = [f"MSG: {a}\n" + "".join(f"{b} f{k}\n" for k in range(100)) for a, b in pairwise(names)]
    return "===\n".join([f"{names[0]} top\n", *inner, f"MSG: {names[-1]}\n"])


@pytest.mark.parametrize(
    ("definition", "words"),
    [
        ("my_msgs/Gone[] points", "leaves out the type my_msgs/Gone"),
        ("float32 x; drop", "with the line"),
        ("my_msgs/A a\n===\nMSG: my_msgs/A\nmy_msgs/A a\n", "contain each other"),
        (many_types(), "contain each other, or too much"),
        ("int8 a\n" * 20_000, "a definition of 140000 characters"),
    ],
)
def test_a_definition_that_makes_no_sense_is_refused(definition, words):
    with pytest.raises(CorruptFile, match=words):
        parse_schema(OWN, definition)


def test_a_message_that_ends_early_or_has_absurd_lengths_is_refused():
    schema = parse_schema(OWN, "uint32 count\nstring name\nfloat64[] values")
    for data in (b"", b"\0\1\0\0", b"\0\1\0\0" + bytes([9, 0, 0, 0]) + b"\xff\xff\xff\x7f"):
        with pytest.raises(CorruptFile):
            read_message(schema, data, ros1=False)


def custom_points(store, package, count, *, step_ns):
    point = store.types[f"{package}/msg/CustomPoint"]
    x = 4.0 + 0.001 * np.arange(count)
    return [
        point(step_ns * k, float(x[k]), 1.0, 0.5, k % 256, (0, 0x01, 0x20, 0)[k % 4], k % 4)
        for k in range(count)
    ]


def livox_bag(tmp_path, kind, *, message=CUSTOM, stamps=None, bases=None, step_ns=5000):
    """A bag of frames of 0.1 s with a point every 5 µs."""
    frames, count = 3, 400
    package = message.partition("/")[0]
    path = bag_path(tmp_path, kind)
    with Bag(path, kind) as bag:
        register(
            bag.store,
            message,
            POINT_MESSAGES[message].definition.replace("livox_ros_driver/", f"{package}/"),
        )
        for k in range(frames):
            t_ns = T0_NS + k * 100_000_000
            points = custom_points(bag.store, package, count, step_ns=step_ns)
            stamp = stamps[k] if stamps else t_ns
            base = bases[k] if bases else t_ns
            bag.recorded_ns = t_ns + 101_000_000
            content = bag.store.types[message](
                header(bag.store, stamp), base, count, 1, np.zeros(3, np.uint8), points
            )
            bag.write("/livox/lidar", message, stamp, content)
    return path


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_points_of_a_livox_driver_have_their_own_times(kind, tmp_path):
    path = livox_bag(tmp_path, kind)
    recording, shots, report = read(path)

    assert recording.rig.sensors[0].model == "Mid-360"
    assert [len(one) for one in shots] == [300, 300, 300]
    assert report.counts["points_noise"] == 300
    kept = np.flatnonzero(np.arange(400) % 4 != 1)
    np.testing.assert_array_equal(shots[1].t_ns, T0_NS + 100_000_000 + 5000 * kept)
    np.testing.assert_array_equal(shots[0].intensity, kept % 256)
    np.testing.assert_array_equal(shots[0].echo, kept % 4 == 2)
    np.testing.assert_allclose(shots[0].xyz[0], [4.0, 1.0, 0.5])
    assert not report.findings
    assert "line" in "\n".join(describe(path).lines())


def test_the_second_driver_keeps_points_of_every_tag(tmp_path):
    _, shots, report = read(livox_bag(tmp_path, "mcap", message=CUSTOM2))

    assert [len(one) for one in shots] == [400, 400, 400]
    assert not report.counts["points_noise"]


def test_frames_with_one_stamp_keep_the_times_of_their_points(tmp_path):
    path = livox_bag(tmp_path, "bag1", stamps=[T0_NS] * 3)
    _, shots, _ = read(path)

    assert [int(one.t_ns[0]) - T0_NS for one in shots] == [0, 100_000_000, 200_000_000]


def test_a_timebase_since_power_on_is_moved_to_the_stamps(tmp_path):
    bases = [77_000_000_000 + k * 100_000_000 for k in range(3)]
    _, shots, report = read(livox_bag(tmp_path, "bag1", bases=bases))

    assert [int(one.t_ns[0]) - T0_NS for one in shots] == [0, 100_000_000, 200_000_000]
    assert any("the points' clock is not the stamps' clock" in text for text in derivations(report))


def test_equal_times_of_a_whole_frame_are_spread_and_counted(tmp_path):
    path = livox_bag(tmp_path, "bag1", step_ns=0)
    _, shots, report = read(path)

    assert report.counts["clouds_wrong_times"] == 3
    assert int(shots[1].t_ns[-1]) - T0_NS - 100_000_000 == 99_666_666
    assert (np.diff(shots[1].t_ns) > 0).all()


def test_a_message_without_timebase_counts_from_its_stamp(tmp_path):
    _, shots, _ = read(livox_bag(tmp_path, "bag1", bases=[0] * 3))

    assert [int(one.t_ns[0]) - T0_NS for one in shots] == [0, 100_000_000, 200_000_000]


def test_single_damaged_times_are_dropped_and_a_jump_of_the_clock_is_announced():
    report = ImportReport()
    clock = ExactClock("livox", report)
    values = T0_NS + 5000 * np.arange(200)
    damaged = values.copy()
    damaged[7] += 10**12
    sound = clock.times(damaged, t_ns=T0_NS, period_ns=10**8)[1]
    for k in range(1, 7):
        leap = 30 * 10**9 * (k > 3)
        found, _ = clock.times(values + k * 10**8 + leap, t_ns=T0_NS + k * 10**8, period_ns=10**8)

    assert np.flatnonzero(~sound).tolist() == [7] and report.counts["points_wrong_time"] == 1
    assert int(found[0]) == T0_NS + 6 * 10**8
    assert report.counts["clock_jumps"] == 1
    assert warned(report, K.CLOCK_JUMP, whose="points", jump_s=30.0)


@pytest.mark.parametrize("points_too", [True, False])
def test_points_go_on_where_the_clock_of_the_stamps_was_set(points_too):
    report = ImportReport()
    clock = ExactClock("livox", report)
    values = T0_NS + 5000 * np.arange(200)
    starts = []
    for k in range(8):
        set_ns = 37 * 10**9 * (k > 3)
        clock.stamps_set_ns = set_ns
        t_ns = T0_NS + k * 10**8  # as the stamps go on without the jump
        found, _ = clock.times(values + k * 10**8 + set_ns * points_too, t_ns=t_ns, period_ns=10**8)
        starts.append(int(found[0]))

    assert starts == [T0_NS + k * 10**8 for k in range(8)]
    assert not report.counts["clock_jumps"]


@pytest.mark.parametrize("kind", ["bag1", "mcap"])
def test_a_point_cloud_of_livox_has_exact_times_lines_and_echoes_of_no_tag(kind, tmp_path):
    """PointXYZRTLT: x y z intensity tag line timestamp, the last one a double of nanoseconds."""
    path, frames, count = bag_path(tmp_path, kind), 3, 4000
    k = np.arange(count)
    azimuth, elevation = 2.4 * k, np.deg2rad(-7.0 + 59.0 * (0.618 * k % 1.0))
    ray = [
        np.cos(elevation) * np.cos(azimuth),
        np.cos(elevation) * np.sin(azimuth),
        np.sin(elevation),
    ]
    with Bag(path, kind) as bag:
        for frame in range(frames):
            t_ns = T0_NS + frame * 100_000_000
            x, y, z = (4.0 * one.astype(np.float32) for one in np.stack(ray))
            stamps = t_ns + 25_000.0 * k
            table = {"x": x, "y": y, "z": z, "intensity": (k % 150).astype(np.float32)}
            table |= {"tag": (k % 4).astype(np.uint8), "line": (k % 4).astype(np.uint8)}
            bag.cloud("/livox/lidar", t_ns, table | {"timestamp": stamps})
    recording, shots, report = read(path)

    assert recording.rig.sensors[0].model == "Mid-360"
    assert [len(one) for one in shots] == [count] * frames
    np.testing.assert_allclose(shots[1].t_ns - T0_NS, 100_000_000 + 25_000 * k, atol=256)
    np.testing.assert_array_equal(shots[0].intensity, k % 150)
    np.testing.assert_array_equal(shots[0].ring, k % 4)
    assert not report.findings and not report.counts["clouds_wrong_times"]


def test_point_cloud_of_ros1_has_its_channels(tmp_path):
    path = bag_path(tmp_path, "bag1")
    kind = "sensor_msgs/msg/PointCloud"
    with Bag(path, "bag1") as bag:
        types = bag.store.types
        point, channel = types["geometry_msgs/msg/Point32"], types["sensor_msgs/msg/ChannelFloat32"]
        for k in range(3):
            t_ns = T0_NS + k * 100_000_000
            points = [point(3.0 + 0.01 * i, 0.01 * i, 0.2) for i in range(200)]
            times = channel("time", (0.0004 * np.arange(200)).astype(np.float32))
            other = channel("Intensity", np.arange(200).astype(np.float32))
            content = types[kind](header(bag.store, t_ns), points, [times, other])
            bag.write("/scan_cloud", kind, t_ns, content)
    _, shots, _ = read(path)

    assert [len(one) for one in shots] == [200, 200, 200]
    np.testing.assert_array_equal(shots[0].intensity, np.arange(200))
    assert abs(int(shots[1].t_ns[50]) - T0_NS - 100_000_000 - 20_000_000) < 1000


OWN_CLOUD = """std_msgs/Header header
my_msgs/Echo[] echoes
===
MSG: my_msgs/Echo
float64 {0}
float64 y
float64 z
uint32 time_offset
uint16 reflectivity
uint8 ring
"""


def own_bag(tmp_path, kind, *, x="x"):
    definition = OWN_CLOUD.format(x)
    path = bag_path(tmp_path, kind)
    with Bag(path, kind) as bag:
        register(bag.store, OWN, definition)
        echo = bag.store.types["my_msgs/msg/Echo"]
        for k in range(3):
            t_ns = T0_NS + k * 100_000_000
            echoes = [echo(5.0, 0.01 * i, 0.1, 500_000 * i, 300 + i, i % 8) for i in range(200)]
            bag.write("/own", OWN, t_ns, bag.store.types[OWN](header(bag.store, t_ns), echoes))
    return path


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_a_type_that_the_bag_defines_is_read_by_its_definition(kind, tmp_path):
    _, shots, _ = read(own_bag(tmp_path, kind))

    assert [len(one) for one in shots] == [200, 200, 200]
    np.testing.assert_array_equal(shots[2].intensity, 300 + np.arange(200))
    np.testing.assert_array_equal(np.diff(shots[0].t_ns), 500_000)


def test_points_of_unknown_fields_are_named_with_what_would_be_needed(tmp_path):
    words = r"/own has lists of ahead, y, z, time_offset.*named x, y, z"

    with pytest.raises(EmptyRecording, match=words):
        read(own_bag(tmp_path, "mcap", x="ahead"))


def test_corners_and_poses_are_no_points():
    polygon = "std_msgs/Header header\ngeometry_msgs/Point32[] corners"
    reader = point_reader("my_msgs/msg/Area", polygon)

    assert reader is not None and not reader.is_known
    assert point_reader("my_msgs/msg/Text", "string text") is None


def test_a_damaged_definition_of_a_known_type_is_replaced_by_the_usual_one():
    assert point_reader(CUSTOM, "nonsense;").columns == ()
    assert point_reader(OWN, "nonsense;") is None
