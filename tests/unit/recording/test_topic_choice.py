"""Several topics of a kind in a bag: the best is read by its content, the others are named."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.model.rig import format_rig, load_rig, parse_rig
from recon4.recording.bags.recording import BagRecording
from recon4.recording.info.describe import describe
from recon4.recording.lasers.laser2d import read_laser2d, read_laser_recording
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.unit.recording.ingested import run
from tests.unit.recording.topic_bags import (
    STEP_NS,
    camera,
    cloud,
    fix,
    imu,
    lidar,
    plain,
    scan,
    write,
)
from tests.warned import K, derivations, warned


def opened(path, rig=None, **settings):
    report = ImportReport()
    found = BagRecording([path], rig, settings=IngestSettings(**settings), report=report)
    return found, report


# -- IMU


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_an_imu_is_preferred_to_the_faster_gyroscope_of_a_camera(tmp_path, kind):
    path = write(
        tmp_path,
        lidar(),
        imu("/camera/gyro/sample", "camera_gyro_optical_frame", rate_hz=400, forces=False),
        imu("/imu/data", "imu_link"),
        kind=kind,
    )

    found, report = opened(path)

    assert found.imu_topic == "/imu/data"
    assert any(
        "not /camera/gyro/sample. It has no accelerometer." in text for text in derivations(report)
    )
    assert report.findings == []


LESSER = {
    "no gyroscope": {"turns": False},
    "accelerations are": {"gravity": 0.2},
    "20 samples a second": {"rate_hz": 20},
    "of the recording": {"until": 5},
}


@pytest.mark.parametrize("why", LESSER)
def test_an_imu_with_a_fault_is_not_chosen_and_the_fault_is_said(tmp_path, why):
    options = {"rate_hz": 400} | LESSER[why]
    path = write(tmp_path, lidar(), imu("/a", "a", **options), imu("/b", "b"))

    found, report = opened(path)

    assert found.imu_topic == "/b"
    assert any(text.startswith("IMU: /b") and why in text for text in derivations(report))


def test_the_imu_of_the_lidar_is_preferred_to_a_faster_one(tmp_path):
    path = write(
        tmp_path,
        lidar("/ouster/points", "os_sensor/os_lidar"),
        imu("/ouster/imu", "os_sensor/os_imu"),
        imu("/zed/imu", "zed_imu_link", rate_hz=400),
    )

    found, report = opened(path)

    assert found.imu_topic == "/ouster/imu"
    assert report.findings == []
    assert any("not /zed/imu. By frame and name" in text for text in derivations(report))


def test_a_choice_between_equals_is_a_warning_that_names_the_setting(tmp_path):
    path = write(tmp_path, lidar(), imu("/left/imu", "left"), imu("/right/imu", "right"))

    _, report = opened(path)

    (found,) = report.findings
    assert found.kind is K.TOPICS_EQUAL
    assert (found.values["setting"], found.values["table"]) == ("ingest.imu_topic", "imu")
    assert "/right/imu" in found.values["rivals"]


def test_raw_and_filtered_samples_of_one_imu_are_no_warning(tmp_path):
    path = write(tmp_path, lidar(), imu("/imu/data", "imu"), imu("/imu/data_raw", "imu"))

    found, report = opened(path)

    assert found.imu_topic == "/imu/data"
    assert report.findings == []
    assert any("not /imu/data_raw" in text for text in derivations(report))


def test_gyroscope_and_accelerometer_of_two_topics_are_one_imu(tmp_path):
    path = write(
        tmp_path,
        lidar(),
        imu("/camera/gyro/sample", "camera_gyro_optical_frame", rate_hz=200, forces=False),
        imu("/camera/accel/sample", "camera_accel_optical_frame", turns=False),
    )

    store = run(path, out=tmp_path / "o")

    assert any("/camera/accel/sample are joined" in text for text in derivations(store.report))
    assert len(store.imu) >= 395
    assert np.isfinite(store.imu.accel_m_s2).all()
    assert store.imu.accel_m_s2[:, 2] == pytest.approx(9.81, abs=0.01)
    assert not warned(store.report, K.ACCELEROMETER_MISSING)


def test_a_setting_names_the_imu(tmp_path):
    path = write(tmp_path, lidar(), imu("/a", "a"), imu("/b", "b"))

    assert opened(path, imu_topic="/a")[0].imu_topic == "/a"
    assert opened(path, imu_topic="/b")[0].imu_topic == "/b"
    with pytest.raises(
        ConfigError, match=r"ingest.imu_topic: '/c' is not in the recording.*/a, /b"
    ):
        opened(path, imu_topic="/c")


def test_a_rig_file_names_the_imu_and_the_positions(tmp_path):
    path = write(tmp_path, lidar(), imu("/a", "a"), imu("/b", "b"), fix("/x"), fix("/y"))
    text = (
        'name = "r"\n[[sensor]]\nname = "s"\nmodel = "VLP-16"\n'
        '[imu]\ntopic = "/a"\n[gnss]\ntopic = "/x"\n'
    )
    rig = parse_rig(text, where="r")

    found, report = opened(path, rig)

    assert (found.imu_topic, found.fix_topic) == ("/a", "/x")
    assert report.findings == []
    again = parse_rig(format_rig(rig), where="r")
    assert (again.imu_topic, again.gnss_topic) == ("/a", "/x")
    assert opened(path, rig, imu_topic="/b")[0].imu_topic == "/b"


def test_an_imu_that_the_rig_names_and_the_bag_lacks_is_not_replaced(tmp_path):
    path = write(tmp_path, lidar(), imu("/a", "a"))
    text = 'name = "r"\n[[sensor]]\nname = "s"\nmodel = "VLP-16"\n[imu]\ntopic = "/z"\n'

    found, report = opened(path, parse_rig(text, where="r"))

    assert found.imu_topic == ""
    assert warned(report, K.TOPIC_NOT_RECORDED, topic="/z", table="imu", there="/a")


def test_rigs_without_topics_are_written_as_before():
    assert "[imu]\nxyz_m" in (text := format_rig(load_rig("4recon")))
    assert text.split("[imu]")[1].count("topic") == 0


# -- positions and poses


def test_a_receiver_with_fixes_is_preferred_to_one_without(tmp_path):
    path = write(
        tmp_path,
        lidar(),
        fix("/a/fix", status=-1),
        fix("/b/fix", moves=0.0),
        fix("/c/fix"),
        fix("/gps/filtered"),
    )

    found, report = opened(path)

    assert found.fix_topic == "/c/fix"
    text = " ".join(text for text in derivations(report) if text.startswith("GNSS"))
    assert "not /a/fix. It has no fix in 20 messages." in text
    assert "not /b/fix. Its position never changes." in text
    assert "not /gps/filtered. By its name it is the output of a filter." in text


def test_the_receiver_with_the_better_fixes_is_read(tmp_path):
    path = write(tmp_path, lidar(), fix("/a", status=0), fix("/b", status=2), fix("/c", status=0))

    assert opened(path)[0].fix_topic == "/b"
    assert opened(path, gnss_topic="/a")[0].fix_topic == "/a"


def test_poses_that_never_change_are_not_chosen(tmp_path):
    def still(bag, t_ns, k):
        bag.odometry("/a", t_ns, 1.0)
        bag.odometry("/a", t_ns + 1000, 1.0)

    def walk(bag, t_ns, k):
        bag.odometry("/b", t_ns, 0.1 * k)

    path = write(tmp_path, lidar(), still, walk)
    found, report = opened(path)

    assert found.odometry_topic == "/b"
    assert report.findings == []
    assert opened(path, odometry_topic="/a")[0].odometry_topic == "/a"


# -- 2-D lasers


def test_a_laser_is_preferred_to_the_scans_of_a_depth_camera(tmp_path):
    path = write(
        tmp_path,
        scan("/camera/scan", view_deg=58.0),
        scan("/camera/scan", view_deg=58.0),
        scan("/silent", far_m=np.inf),
        scan("/scan"),
    )
    report = ImportReport()

    found = read_laser2d([path], report)

    assert np.rad2deg(90 * found.angle_step_rad) == pytest.approx(270.0)
    text = " ".join(text for text in derivations(report) if text.startswith("2-D laser"))
    assert "/scan (frame laser) is read, not /camera/scan. Its view has 58°." in text
    assert "not /silent. It has no returns." in text
    named = read_laser2d(
        [path], ImportReport(), settings=IngestSettings(lidar_topic="/camera/scan")
    )
    assert np.rad2deg(90 * named.angle_step_rad) == pytest.approx(58.0)
    by_rig = read_laser_recording([path], ImportReport(), topic="/camera/scan").scans
    assert np.rad2deg(90 * by_rig.angle_step_rad) == pytest.approx(58.0)


# -- LiDARs


def robot(tmp_path, *more):
    return write(
        tmp_path,
        lidar("/velodyne_points", "velodyne"),
        cloud("/cloud_registered", "camera_init", plain()),
        cloud("/lio_sam/mapping/map_local", "odom", plain()),
        cloud("/camera/depth/color/points", "camera_depth_optical_frame", camera()),
        cloud("/velodyne_points_filtered", "velodyne", plain(700)),
        cloud("/cloud_registered_body", "body", plain(), late_ns=STEP_NS // 2),
        *more,
    )


def test_the_only_cloud_as_measured_is_the_lidar_and_the_others_are_named(tmp_path):
    found, report = opened(robot(tmp_path))

    assert [s.topic for s in found.rig.sensors] == ["/velodyne_points"]
    said = [text for text in derivations(report) if text.startswith("LiDAR: /velodyne_points is")]
    assert len(said) == 5
    for words in (
        "/cloud_registered. It is in the fixed frame camera_init",
        "/lio_sam/mapping/map_local. It is in the fixed frame odom",
        "/camera/depth/color/points. It is of a depth camera",
        "/velodyne_points_filtered. It is a copy of /velodyne_points",
        "/cloud_registered_body. It is in the frame of the robot, body",
    ):
        assert words in " ".join(said)
    assert report.findings == []


def test_info_says_the_same(tmp_path):
    info = describe(robot(tmp_path))

    assert [sensor.label for sensor in info.sensors] == ["/velodyne_points"]
    assert any("/cloud_registered. It is in the fixed frame" in text for text in derivations(info))
    assert not any("rig" in text for text in info.missing)


def test_the_frame_of_the_odometry_is_fixed_whatever_its_name(tmp_path):
    def walk(bag, t_ns, k):
        bag.frame = "start"
        bag.odometry("/odom", t_ns, 0.1 * k)

    path = write(tmp_path, lidar(), cloud("/map_cloud", "start", plain()), walk)

    assert [s.topic for s in opened(path)[0].rig.sensors] == ["/points"]


def test_a_registered_cloud_alone_is_read_and_said(tmp_path):
    found, report = opened(write(tmp_path, cloud("/cloud_registered", "odom", plain())))

    assert [s.topic for s in found.rig.sensors] == ["/cloud_registered"]
    assert any("placed them already" in text for text in derivations(report))


def test_two_lidars_of_unknown_mounts_end_with_what_to_paste(tmp_path):
    path = robot(tmp_path, lidar("/rear/points", "rear_lidar"))

    with pytest.raises(ConfigError) as error:
        opened(path)

    text = str(error.value)
    assert "2 LiDARs and no rig" in text
    assert "/rear/points VLP-16, frame rear_lidar, 57" in text
    assert "--set ingest.lidar_topic=" in text
    skeleton = text[text.index('name = "my rig"') :]
    rig = parse_rig(skeleton, where="pasted")
    assert {s.topic for s in rig.sensors} == {"/velodyne_points", "/rear/points"}
    assert {s.topic for s in opened(path, rig)[0].rig.sensors} == {s.topic for s in rig.sensors}


def test_of_several_lidars_the_one_with_rings_and_times_is_proposed(tmp_path):
    path = write(tmp_path, cloud("/a/depth", "cam", plain()), lidar("/z/points", "velodyne"))

    with pytest.raises(ConfigError, match=r"--set ingest\.lidar_topic=/z/points"):
        opened(path)


def test_a_setting_names_the_only_lidar(tmp_path):
    path = robot(tmp_path, lidar("/rear/points", "rear_lidar"))

    for topic in ("/rear/points", "/cloud_registered"):
        found, _ = opened(path, lidar_topic=topic)
        assert [s.topic for s in found.rig.sensors] == [topic]
    with pytest.raises(ConfigError, match=r"ingest\.lidar_topic: '/x' is not in the recording"):
        opened(path, lidar_topic="/x")
