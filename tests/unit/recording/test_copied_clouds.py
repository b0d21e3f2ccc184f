"""What one LiDAR measured is read once, and LiDARs that cannot be read are named."""

import numpy as np
import pytest
from rosbags.typesys import get_types_from_msg

from recon4.errors import ConfigError, EmptyRecording
from recon4.recording.bags.recording import BagRecording
from recon4.recording.info.describe import describe
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, bag_path, noisy, room_cloud
from tests.robot_bags import RobotBag, mount
from tests.warned import K, derivations, warned, words

STEP_NS = 100_000_000
CLOUDS = 12


def write(folder, *sources, transforms=()):
    path = bag_path(folder, "mcap")
    with RobotBag(path, "mcap") as bag:
        if transforms:
            bag.tf(*transforms)
        for k in range(CLOUDS):
            for source in sources:
                source(bag, T0_NS + k * STEP_NS, k)
    return path


def measured(k, *, turned=None):
    """The cloud of a LiDAR at a time: other numbers each time, as noise makes them."""
    table = room_cloud(start_turn=0.01 * k)
    if turned is not None:
        xyz = np.column_stack([table[axis] for axis in "xyz"]) @ turned.R.T + turned.t
        table |= dict(zip("xyz", xyz.astype(np.float32).T, strict=True))
    return table


def lidar(topic="/points", frame="os_lidar", *, every=1, turned=None):
    def add(bag, t_ns, k):
        if k % every == 0:
            bag.frame = frame
            bag.cloud(topic, t_ns, measured(k, turned=turned))

    return add


def opened(path):
    report = ImportReport()
    return BagRecording([path], None, settings=IngestSettings(), report=report), report


def read_topics(path):
    return [sensor.topic for sensor in opened(path)[0].rig.sensors]


@pytest.mark.parametrize("every", [1, 2, 10])
def test_a_relayed_or_throttled_lidar_is_read_once(tmp_path, every):
    path = write(tmp_path, lidar("/a/points", every=every), lidar("/points"))

    found, report = opened(path)

    assert [sensor.topic for sensor in found.rig.sensors] == ["/points"]
    assert any("not /a/points. It is a copy of /points." in text for text in derivations(report))


def test_a_lidar_in_the_frame_of_the_robot_again_is_read_once_as_measured(tmp_path):
    T_base_lidar = mount(0.1, 0.0, 0.5, pitch=20.0)
    path = write(
        tmp_path,
        lidar("/base_points", "base_link", turned=T_base_lidar),
        lidar("/velodyne_points", "velodyne"),
        transforms=[("base_link", "velodyne", T_base_lidar)],
    )

    assert read_topics(path) == ["/velodyne_points"]


def test_two_lidars_with_common_stamps_are_both_there(tmp_path):
    other = mount(0.5, 0.3, 0.0)

    def rear(bag, t_ns, k):
        bag.frame = "rear"
        bag.cloud("/rear/points", t_ns, measured(k + 40, turned=other))

    with pytest.raises(ConfigError, match="2 LiDARs and no rig"):
        opened(write(tmp_path, lidar("/front/points", "front"), rear))


def registered(bag, t_ns, k):
    bag.frame = "map"
    table = room_cloud(start_turn=0.3)
    bag.cloud("/cloud_registered", t_ns, {axis: table[axis][:3000] for axis in "xyz"})


@pytest.mark.parametrize("child", ["", "os_lidar", "body"])
def test_odometry_in_the_frame_of_the_only_lidar_makes_no_map_of_it(tmp_path, child):
    def odometry(bag, t_ns, k):
        bag.frame = "os_lidar"
        bag.odometry("/odom", t_ns, 0.1 * k, child=child)

    assert read_topics(write(tmp_path, lidar(), odometry, registered)) == ["/points"]


@pytest.mark.parametrize("why", ["no body", "IMU", "tf"])
def test_odometry_in_the_frame_of_a_lidar_takes_it_for_no_map_beside_another(tmp_path, why):
    other = mount(0.5, 0.3, 0.0)

    def odometry(bag, t_ns, k):
        bag.frame = "front"
        bag.odometry("/odom", t_ns, 0.1 * k, child="" if why == "no body" else "body")
        if why == "IMU":
            imu(bag, t_ns, k)

    def rear(bag, t_ns, k):
        bag.frame = "rear"
        bag.cloud("/rear/points", t_ns, measured(k + 40, turned=other))

    transforms = [("base_link", "front", mount(0.0, 0.0, 1.0)), ("base_link", "rear", other)]
    path = write(
        tmp_path,
        lidar("/front/points", "front"),
        rear,
        odometry,
        transforms=transforms if why == "tf" else (),
    )

    if why == "tf":
        assert set(read_topics(path)) == {"/front/points", "/rear/points"}
    else:
        with pytest.raises(ConfigError, match="2 LiDARs and no rig"):
            opened(path)


# -- messages of drivers


def driver(kind, topic="/livox/lidar"):
    def add(bag, t_ns, k):
        if kind not in bag.store.types:
            bag.store.register(get_types_from_msg("uint8[] buf\n", kind))
        bag.write(topic, kind, t_ns, bag.make(kind, buf=np.zeros(9, np.uint8)))

    return add


def imu(bag, t_ns, k):
    bag.imu("/imu", t_ns, *(noisy((0.0, 0.0, z), k) for z in (0.0, 9.81)))


@pytest.mark.parametrize(
    ("kind", "remedy"),
    [
        ("cepton_messages/msg/Points", "play the bag back through the driver"),
        ("cepton_messages/msg/CeptonPacket", "play the bag back through the driver"),
        ("point_cloud_interfaces/msg/CompressedPointCloud2", "point_cloud_transport"),
        ("innovusion/msg/InnovusionScan", "play the bag back through the driver"),
    ],
)
def test_a_lidar_in_messages_of_its_driver_is_named_with_the_remedy(tmp_path, kind, remedy):
    path = write(tmp_path, driver(kind), imu)

    with pytest.raises(EmptyRecording) as error:
        opened(path)

    for text in (str(error.value), words(describe(path)).replace("Play", "play")):
        assert f"/livox/lidar is of a LiDAR, but {kind.replace('/msg/', '/')} is not read" in text
        assert remedy in text
        assert "PointCloud2" in text


def test_a_bag_without_any_lidar_says_which_topics_are_read(tmp_path):
    with pytest.raises(EmptyRecording) as error:
        opened(write(tmp_path, imu))

    assert "topics: /imu (sensor_msgs/msg/Imu); read are sensor_msgs/PointCloud2" in str(
        error.value
    )


def camera(bag, t_ns, k):
    v, u = np.mgrid[-20:20, -30:30] / 40.0
    axes = {"x": 2.0 * u, "y": 2.0 * v, "z": np.full(u.shape, 2.0), "rgb": np.zeros(u.shape)}
    bag.frame = "camera_depth_optical_frame"
    table = {name: axis.astype(np.float32).ravel() for name, axis in axes.items()}
    bag.cloud("/camera/points", t_ns, table)


@pytest.mark.parametrize("others", [(camera,), (registered,), (camera, registered)])
def test_no_camera_or_map_stands_in_for_a_lidar_that_is_not_read(tmp_path, others):
    path = write(tmp_path, driver("cepton_messages/msg/Points"), *others)

    with pytest.raises(EmptyRecording, match=r"play the bag back.*ingest\.lidar_topic"):
        opened(path)

    topic = "/camera/points" if camera in others else "/cloud_registered"
    settings = IngestSettings(lidar_topic=topic)
    found = BagRecording([path], None, settings=settings, report=ImportReport())
    assert [sensor.topic for sensor in found.rig.sensors] == [topic]


def test_a_lidar_in_messages_of_its_driver_beside_one_that_is_read_is_no_warning(tmp_path):
    _, report = opened(write(tmp_path, driver("cepton_messages/msg/Points"), lidar()))

    assert not warned(report, K.DRIVER_UNREAD)
    assert any("/livox/lidar is of a LiDAR" in text for text in derivations(report))
