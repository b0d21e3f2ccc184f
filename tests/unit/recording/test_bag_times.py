"""Times of bags: messages recorded at time 0, and the time between clouds."""

import numpy as np
import pytest

from recon4.recording.bags.recording import BagRecording
from recon4.recording.info.describe import describe
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, bag_path, room_cloud
from tests.robot_bags import RobotBag
from tests.warned import K, kinds

STEP_NS = 100_000_000


@pytest.fixture
def plain():
    """A revolution without times and rings."""
    table = room_cloud()
    return {name: table[name] for name in ("x", "y", "z", "intensity")}


def opened(path):
    report = ImportReport()
    return BagRecording([path], None, settings=IngestSettings(), report=report), report


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_transforms_recorded_at_time_zero_change_nothing(tmp_path, plain, kind):
    path = bag_path(tmp_path, kind)
    with RobotBag(path, kind) as bag:
        bag.tf(("base_link", "os_lidar", (0, 0, 1, 0, 0, 0, 1)), t_ns=1)
        for k in range(20):
            bag.frame = "os_lidar"
            bag.cloud("/points", T0_NS + k * STEP_NS, room_cloud())
            bag.frame = "map"
            bag.cloud("/registered", T0_NS + k * STEP_NS, plain)

    found, report = opened(path)
    info = describe(path)

    assert [s.topic for s in found.rig.sensors] == ["/points"]
    assert found.seconds == pytest.approx(2.0, abs=0.2)
    assert [s.label for s in info.sensors] == ["/points"]
    assert info.sensors[0].rate_hz == pytest.approx(10.0, rel=0.1)
    assert not {K.SENSOR_NOT_RECORDED, K.TOPIC_UNASSIGNED} & set(kinds(report))


def test_the_time_between_clouds_is_that_of_most_of_them(tmp_path, plain):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        bag.frame = "os_lidar"
        for k in range(20):
            bag.cloud("/points", T0_NS + k * STEP_NS + 2 * 10**9 * (k >= 10), plain)

    found, _ = opened(path)
    shots = [item for item in found.read() if hasattr(item, "ring")]

    # Points without times are spread over one revolution: a pause of the LiDAR is none.
    assert np.ptp(shots[0].t_ns) == pytest.approx(STEP_NS, rel=0.1)


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_a_cloud_recorded_twice_is_used_once(tmp_path, plain, kind):
    path = bag_path(tmp_path, kind)
    with RobotBag(path, kind) as bag:
        bag.frame = "os_lidar"
        for k in (0, 1, 2, 1, 3, 3, 4):
            bag.cloud("/points", T0_NS + k * STEP_NS, plain)

    found, report = opened(path)
    shots = [item for item in found.read() if hasattr(item, "ring") and len(item)]

    assert sum(map(len, shots)) == 5 * len(plain["x"])
    assert report.counts["clouds_duplicate"] == 2
    assert "2 of 5 clouds: recorded twice, the copies dropped" in report.repaired()


def test_parts_of_a_revolution_with_one_stamp_are_no_copies(tmp_path, plain):
    path = bag_path(tmp_path, "db3")
    half = len(plain["x"]) // 2
    with RobotBag(path, "db3") as bag:
        bag.frame = "os_lidar"
        for k in range(5):
            for part in (slice(None, half), slice(half, None)):
                table = {name: column[part] for name, column in plain.items()}
                bag.cloud("/points", T0_NS + k * STEP_NS, table)

    found, report = opened(path)

    assert sum(len(s) for s in found.read() if hasattr(s, "ring")) == 5 * len(plain["x"])
    assert not report.counts["clouds_duplicate"]


def test_topics_recorded_by_another_clock_do_not_hide_the_clouds(tmp_path, plain):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        for k in range(10):
            t_ns = T0_NS + k * STEP_NS
            bag.fix("/fix", t_ns - 3600 * 10**9, 50.0 + 1e-7 * k, 14.0, 300.0)
            bag.frame = "os_lidar"
            bag.cloud("/points", t_ns, plain)
            bag.frame = "map"
            bag.cloud("/registered", t_ns, plain)

    found, _ = opened(path)

    assert [sensor.topic for sensor in found.rig.sensors] == ["/points"]


@pytest.mark.parametrize("kind", ["bag1", "mcap"])
def test_info_says_that_a_clock_goes_back(tmp_path, kind):
    path = bag_path(tmp_path, kind)
    with RobotBag(path, kind) as bag:
        for k in range(40):
            bag.recorded_ns = T0_NS + k * STEP_NS
            bag.cloud("/points", T0_NS + (k - 8 * (k >= 20)) * STEP_NS, room_cloud())

    text = "\n".join(describe(path).lines())

    assert "/points: its clock jumped by -0.800 s; times go on without it" in text
    assert "repaired  1 clocks: jumps, the times go on without them" in text


def test_info_of_a_steady_clock_says_nothing_of_it(tmp_path):
    path = bag_path(tmp_path, "mcap")
    with RobotBag(path, "mcap") as bag:
        for k in range(20):
            bag.cloud("/points", T0_NS + k * STEP_NS, room_cloud())

    assert "goes back" not in "\n".join(describe(path).lines())


@pytest.mark.parametrize("sign", [1, -1], ids=["since the begin", "before the end"])
def test_no_point_of_a_cloud_without_stamp_is_later_than_its_recording(tmp_path, sign):
    path, table = bag_path(tmp_path, "db3"), room_cloud()
    if sign < 0:
        table["time"] = table["time"] - np.float32(1e-9 * STEP_NS)
    with RobotBag(path, "db3") as bag:
        bag.header = lambda _t: bag.make("std_msgs/msg/Header", stamp=bag.time(0), frame_id="x")
        for k in range(1, 9):
            bag.cloud("/points", T0_NS + k * STEP_NS, table)

    found, report = opened(path)
    starts = [item.t_ns[0] for item in found.read() if hasattr(item, "ring")]

    np.testing.assert_allclose(np.array(starts) - T0_NS, np.arange(8) * STEP_NS, atol=1e5)
    assert report.counts["stamps_missing"] == 8
