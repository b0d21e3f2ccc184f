"""Mounts of LiDARs, IMU and antenna by the transforms of a bag, alone and against a rig file."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.model.rig import Rig, RigCalibration, Sensor
from recon4.recording.info.describe import describe
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, bag_path, room_cloud
from tests.robot_bags import RobotBag, mount, write_walk
from tests.warned import K, derivations, kinds, warned, words

IMU_MOUNT = mount(0.02, -0.03, 0.05, roll=180, yaw=90)
OUSTER = (("os_sensor", "os_lidar", mount(z=0.036, yaw=180)), ("os_sensor", "os_imu", IMU_MOUNT))


def opened(path, rig=None):
    report = ImportReport()
    return open_recording(OpenRequest((path,), rig, IngestSettings(), report)).rig, report


def said(report):
    return " | ".join([*derivations(report), words(report)])


def assert_mount(found, expected, **tolerance):
    np.testing.assert_allclose(found.matrix(), expected.matrix(), **({"atol": 1e-7} | tolerance))


def rig_of(T_body_imu=None, T_body_other=None, **fields):
    lidar = Sensor(
        name="front", model="generic", T_body_sensor=SE3.identity(), topic="/os_lidar/points"
    )
    other = replace(lidar, name="rear", topic="/rear/points")
    if T_body_other is not None:
        other = replace(other, T_body_sensor=T_body_other)
    known = {
        "T_body_imu": T_body_imu or SE3.identity(),
        "p_body_antenna": np.zeros(3),
        "sensors": (lidar, other) if T_body_other is not None else (lidar,),
        "imu_time_offset_s": 0.0,
        "gnss_time_offset_s": 0.0,
    }
    return Rig(name="ours", **(known | fields))


# -- one LiDAR


@pytest.mark.parametrize("prefixed", ["robot1/{}", "/robot1/{}", "a/b/{}"])
@pytest.mark.parametrize("of_messages", [True, False])
def test_a_prefix_of_frames_alone_makes_no_other_frame(tmp_path, prefixed, of_messages):
    lidar, imu = (prefixed.format(name) for name in ("os_lidar", "os_imu"))
    transforms = OUSTER
    if not of_messages:
        transforms = [(prefixed.format(a), prefixed.format(b), T) for a, b, T in OUSTER]
        lidar, imu = "os_lidar", "os_imu"

    rig, report = opened(write_walk(tmp_path, transforms, lidars=(lidar,), imu=imu))

    assert_mount(rig.T_body_imu, OUSTER[0][2].inverse() @ IMU_MOUNT)
    assert "its frame" in said(report)


def test_a_frame_that_may_be_one_of_several_is_said_and_not_used(tmp_path):
    transforms = [(f"{r}/os_sensor", f"{r}/{b}", T) for r in "ab" for _, b, T in OUSTER]

    rig, report = opened(write_walk(tmp_path, transforms, imu="os_imu"))

    assert_mount(rig.T_body_imu, SE3.identity())
    assert "is not certain: one of a/os_lidar, b/os_lidar" in said(report)


def test_two_lidars_that_mean_one_frame_are_not_put_at_one_place(tmp_path):
    path = write_walk(tmp_path, OUSTER, lidars=("a/os_lidar", "b/os_lidar"))

    with pytest.raises(ConfigError, match="do not connect their frames"):
        opened(path)


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_the_mount_of_the_imu_comes_from_the_transforms(tmp_path, kind):
    rig, report = opened(write_walk(tmp_path, OUSTER, kind=kind, imu="os_imu"))

    assert_mount(rig.T_body_imu, OUSTER[0][2].inverse() @ IMU_MOUNT)
    assert_mount(rig.sensors[0].T_body_sensor, SE3.identity())
    assert "Mount of the IMU from /tf_static: os_lidar -> os_imu xyz" in said(report)
    assert report.findings == []


def test_the_lever_arm_of_the_antenna_comes_from_the_transforms(tmp_path):
    antenna = ("os_lidar", "gps", mount(-0.1, 0.0, 0.4))

    rig, report = opened(write_walk(tmp_path, [antenna], gnss="gps"))

    np.testing.assert_allclose(rig.p_body_antenna, [-0.1, 0.0, 0.4])
    assert "Mount of the GNSS antenna from /tf_static" in said(report)


def test_without_transforms_nothing_is_changed_or_said(tmp_path):
    rig, report = opened(write_walk(tmp_path, imu="os_imu", gnss="gps"))

    assert_mount(rig.T_body_imu, SE3.identity())
    assert not rig.p_body_antenna.any()
    assert "tf" not in said(report) and "mount" not in said(report).lower()
    assert report.findings == []


def test_an_upside_down_lidar_has_the_axes_of_the_robot(tmp_path):
    robot = [("base_link", "os_lidar", mount(0.2, 0, 1, roll=180)), ("base_link", "imu", mount())]

    rig, report = opened(write_walk(tmp_path, robot, imu="imu", gnss="base_link"))

    assert_mount(rig.sensors[0].T_body_sensor, mount(roll=180))
    assert_mount(rig.T_body_imu, mount(-0.2, 0, -1))
    np.testing.assert_allclose(rig.p_body_antenna, [-0.2, 0, -1], atol=1e-12)
    assert "the axes of base_link" in said(report)


def test_frames_that_transforms_do_not_know_are_said(tmp_path):
    robot = [("base_link", "velodyne", mount(z=1))]

    rig, report = opened(write_walk(tmp_path, robot, imu="imu_link"))

    assert_mount(rig.T_body_imu, SE3.identity())
    assert "do not connect os_lidar and imu_link" in said(report)


def test_a_placeholder_of_zeros_is_said_to_be_one(tmp_path):
    rig, report = opened(write_walk(tmp_path, [("os_lidar", "imu", mount())], imu="imu"))

    assert_mount(rig.T_body_imu, SE3.identity())
    assert "a placeholder?" in said(report)
    assert report.findings == []


def test_an_imu_that_is_too_far_away_is_not_used(tmp_path):
    rig, report = opened(write_walk(tmp_path, [("os_lidar", "imu", mount(50))], imu="imu"))

    assert_mount(rig.T_body_imu, SE3.identity())
    assert warned(report, K.MOUNT_FAR)


def test_a_mount_stated_in_two_ways_is_a_warning(tmp_path):
    twice = [("os_lidar", "imu", mount(0.1)), ("os_lidar", "imu", mount(0.1, yaw=90))]

    rig, report = opened(write_walk(tmp_path, twice, imu="imu"))

    assert_mount(rig.T_body_imu, mount(0.1, yaw=90))
    assert warned(report, K.MOUNT_DISPUTED, source="/tf_static")


def test_a_second_parent_of_a_sensor_that_disagrees_is_a_warning(tmp_path):
    robot = [("os_lidar", "imu", mount()), ("os_lidar", "box", mount(1)), ("box", "imu", mount(1))]

    _, report = opened(write_walk(tmp_path, robot, imu="imu"))

    assert warned(report, K.MOUNT_LOOP)


def test_contradictions_elsewhere_on_the_robot_are_only_counted(tmp_path):
    robot = [("os_lidar", "imu", mount(0.1)), ("arm", "hand", mount()), ("arm", "hand", mount(1))]

    _, report = opened(write_walk(tmp_path, robot, imu="imu"))

    assert report.findings == []
    assert report.counts["transforms_contradictory"] == 1


@pytest.mark.parametrize("frame", ["map", "/odom", "base_link"])
def test_points_in_a_frame_that_is_none_of_a_sensor_are_said(tmp_path, frame):
    _, report = opened(write_walk(tmp_path, lidars=(frame,)))

    assert "already" in said(report) or "frame of the robot" in said(report)


# -- several LiDARs


def test_several_lidars_are_mounted_as_the_transforms_say(tmp_path):
    front, rear = mount(0.3, z=1), mount(-0.3, z=0.8, pitch=90)
    robot = [
        ("base_link", "front", front),
        ("base_link", "rear", rear),
        ("base_link", "imu", IMU_MOUNT),
    ]
    path = write_walk(tmp_path, robot, lidars=("front", "rear"), imu="imu")

    rig, report = opened(path)

    assert [sensor.topic for sensor in rig.sensors] == ["/front/points", "/rear/points"]
    assert_mount(rig.sensors[0].T_body_sensor, front)
    assert_mount(rig.sensors[1].T_body_sensor, rear)
    assert_mount(rig.T_body_imu, IMU_MOUNT)
    assert "the body is the frame base_link" in said(report)
    text = "\n".join(describe(path).lines())
    assert "Mount of the LiDAR /rear/points from /tf_static: base_link -> rear xyz -0.300" in text
    assert "rig:" not in text
    assert "/tf_static: transforms between frames" in text


def test_transforms_win_over_a_preset_chosen_by_names(tmp_path):
    robot = [("base", "horizontal", mount(z=1)), ("base", "vertical", mount(pitch=90))]

    rig, _ = opened(write_walk(tmp_path, robot, lidars=("horizontal", "vertical")))

    assert_mount(rig.sensors[0].T_body_sensor, mount(z=1))


@pytest.mark.parametrize(
    ("transforms", "why"),
    [
        ((), "the bag has no transforms"),
        ((("base_link", "a", mount(z=1)),), "do not connect their frames"),
        ((("base_link", "a", mount()), ("base_link", "b", mount())), "a placeholder"),
        ((("base_link", "a", mount()), ("base_link", "b", mount(90))), "far from"),
    ],
)
def test_several_lidars_that_nobody_places_need_a_rig_and_the_error_says_why(
    tmp_path, transforms, why
):
    with pytest.raises(ConfigError, match=why):
        opened(write_walk(tmp_path, transforms, lidars=("a", "b")))


def test_a_mount_that_moves_as_a_body_in_the_world_is_none(tmp_path):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        for k in range(10):
            bag.tf(
                ("base_link", "a", mount(z=1)),
                ("base_link", "b", mount(0.3 * k, yaw=5 * k)),
                topic="/tf",
                t_ns=T0_NS + k,
            )
            for name in "ab":
                bag.frame = name
                bag.cloud(f"/{name}", T0_NS + k, room_cloud())

    with pytest.raises(ConfigError, match="do not connect their frames"):
        opened(path)


# -- against a rig file


def test_a_rig_that_agrees_is_not_accused(tmp_path):
    path = write_walk(tmp_path, [("os_lidar", "imu", mount(0.1, yaw=90))], imu="imu")
    rig, report = opened(path, rig_of(mount(0.11, yaw=90.5)))

    assert_mount(rig.T_body_imu, mount(0.11, yaw=90.5))
    assert report.findings == []


def test_a_rig_that_contradicts_the_transforms_is_used_and_announced(tmp_path):
    path = write_walk(tmp_path, [("os_lidar", "imu", mount(0.1, yaw=90))], imu="imu")
    rig, report = opened(path, rig_of(mount(0.15)))

    assert_mount(rig.T_body_imu, mount(0.15))
    assert kinds(report) == [K.MOUNT_CONTRADICTED]
    text = words(report)
    assert "IMU relative to front" in text
    assert "xyz 0.150 0.000 0.000 m, roll 0.0 pitch 0.0 yaw 0.0° in the rig" in text
    assert "yaw 90.0° in /tf_static of the bag (os_lidar -> imu)" in text
    assert "90.0° and 5.0 cm" in text


def test_lidars_are_compared_in_pairs_whatever_the_body_is(tmp_path):
    robot = [("base_link", "os_lidar", mount(z=2)), ("base_link", "rear", mount(-0.5, z=2))]
    path = write_walk(tmp_path, robot, lidars=("os_lidar", "rear"))

    _, agreeing = opened(path, rig_of(T_body_other=mount(-0.5)))
    _, differing = opened(path, rig_of(T_body_other=mount(-0.5, roll=180)))

    assert agreeing.findings == []
    assert warned(differing, K.MOUNT_CONTRADICTED, part="rear", other="front", angle_rad=np.pi)


def test_a_calibrated_rig_may_differ_from_the_drawing(tmp_path):
    path = write_walk(tmp_path, [("os_lidar", "imu", mount(0.1))], imu="imu")
    calibrated = RigCalibration(date="2026-01-01", method="joint", sd_deg=0.1, sd_mm=3.0, sd_ms=0.1)

    _, report = opened(path, rig_of(mount(0.13, yaw=2), calibration=calibrated))
    assert report.findings == []
    _, report = opened(path, rig_of(mount(0.13, yaw=5), calibration=calibrated))
    assert kinds(report) == [K.MOUNT_CONTRADICTED]


def test_a_placeholder_accuses_no_rig_file(tmp_path):
    path = write_walk(tmp_path, [("os_lidar", "imu", mount())], imu="imu")

    _, report = opened(path, rig_of(mount(0.2, yaw=90)))

    assert report.findings == []
    assert "a placeholder?" in said(report)


def test_the_antenna_is_compared_by_its_place_alone(tmp_path):
    path = write_walk(tmp_path, [("os_lidar", "gps", mount(0.0, z=0.4, yaw=90))], gnss="gps")

    _, same = opened(path, rig_of(p_body_antenna=np.array([0.0, 0.0, 0.4])))
    _, other = opened(path, rig_of(p_body_antenna=np.array([0.0, 0.0, 0.1])))

    assert same.findings == []
    assert warned(other, K.MOUNT_CONTRADICTED, part="GNSS antenna", distance_m=0.3)
