"""Of several IMUs the one is read whose mount the bag states."""

import pytest

from recon4.recording.bags.recording import BagRecording
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, bag_path, noisy, room_cloud
from tests.robot_bags import RobotBag, mount
from tests.warned import K, warned


def write(folder, *transforms):
    """A LiDAR, the IMU of the robot, and a faster one of a camera; neither has accelerations."""
    path = bag_path(folder, "mcap")
    with RobotBag(path, "mcap") as bag:
        if transforms:
            bag.tf(*transforms)
        for k in range(20):
            t_ns = T0_NS + k * 100_000_000
            bag.frame = "velodyne"
            bag.cloud("/points", t_ns, room_cloud())
            for topic, frame, number in (("/camera/imu", "camera_imu", 25), ("/imu", "chip", 20)):
                bag.frame = frame
                for i in range(number):
                    gyro = noisy((0.0, 0.0, 0.0), number * k + i)
                    bag.imu(topic, t_ns + i * 100_000_000 // number, gyro, (0.0, 0.0, 0.0))
    return path


@pytest.mark.parametrize("is_stated", [True, False])
def test_the_imu_whose_mount_is_stated_is_preferred_to_a_faster_one(tmp_path, is_stated):
    transforms = [(("base_link", name, mount(0.0, 0.0, 0.1))) for name in ("velodyne", "chip")]
    report = ImportReport()

    found = BagRecording(
        [write(tmp_path, *transforms[: 2 * is_stated])],
        None,
        settings=IngestSettings(),
        report=report,
    )

    assert found.imu_topic == ("/imu" if is_stated else "/camera/imu")
    assert warned(report, K.TOPICS_EQUAL) is not is_stated
