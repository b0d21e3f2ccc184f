"""Two LiDARs in one topic of a bag: by the frames of their clouds, or by their numbers."""

from types import SimpleNamespace

import numpy as np
import pytest

from recon4.model.rig import parse_rig
from recon4.recording.formats.shared_topics import source_of, sources_of
from recon4.recording.info.describe import describe
from recon4.recording.rigs.choice import RigToComplete, Stream, rig_to_complete
from tests.builders import T0_NS, bag_path, room_cloud
from tests.robot_bags import RobotBag
from tests.unit.recording.point_bags import STEP_NS, read
from tests.warned import derivations

CLOUD = room_cloud(columns_per_turn=90)
SHARED = ["/points#left", "/points#right"]


def write(folder, kind="mcap", frames=("left", "right"), *, clouds=8):
    """Clouds of two sensors in turns; those of the right one are 1 m higher."""
    path = bag_path(folder, kind)
    with RobotBag(path, kind) as bag:
        for k in range(clouds):
            for number, frame in enumerate(frames):
                bag.frame = frame
                higher = {**CLOUD, "z": CLOUD["z"] + np.float32(number)}
                bag.cloud("/points", T0_NS + k * STEP_NS + number, higher)
    return path


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_the_clouds_of_each_frame_are_those_of_one_sensor(kind, tmp_path):
    path = write(tmp_path, kind)
    rig = rig_to_complete([Stream(name, "VLP-16", topic=name) for name in SHARED])
    recording, shots, report = read(path, rig=rig)

    assert [sensor.topic for sensor in recording.rig.sensors] == SHARED
    for row in (0, 1):
        own = [one for one in shots if one.sensor == row]
        assert [len(one) for one in own] == [len(CLOUD["x"])] * 8
        assert np.isclose(np.median(own[0].xyz[:, 2]), np.median(CLOUD["z"]) + row, atol=1e-3)
    assert "/points is of 2 LiDARs: left, right." in derivations(report)


def test_without_a_rig_each_is_named_and_info_writes_both(tmp_path):
    path = write(tmp_path)

    with pytest.raises(RigToComplete, match="2 LiDARs and no rig"):
        read(path)
    rig = parse_rig(describe(path).first_rig, where="rig")
    assert [sensor.topic for sensor in rig.sensors] == SHARED


def test_messages_of_one_frame_are_separated_by_the_number_of_their_lidar():
    header = SimpleNamespace(frame_id="livox_frame")
    messages = [SimpleNamespace(header=header, lidar_id=k % 2 + 1) for k in range(6)]

    sources = [source_of(message) for message in messages]

    assert [str(one) for one in sources_of(sources)] == ["livox_frame.1", "livox_frame.2"]
    assert sources_of(sources[:2] + sources[2::2]) == ()
    assert sources_of([source_of(SimpleNamespace())] * 4) == ()


def test_a_topic_whose_frame_changes_once_is_of_one_sensor(tmp_path):
    path = bag_path(tmp_path, "mcap")
    with RobotBag(path, "mcap") as bag:
        for k in range(6):
            bag.frame = "velodyne" if k else ""
            bag.cloud("/points", T0_NS + k * STEP_NS, CLOUD)
    recording, shots, report = read(path)

    assert [s.topic for s in recording.rig.sensors] == ["/points"] and len(shots) == 6
    assert not any("LiDARs" in text for text in derivations(report))
