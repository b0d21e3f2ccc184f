"""What a bag states about its frames: tf_static, tf, a robot description, and nonsense."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import CorruptFile
from recon4.recording.formats.bags import Bag
from recon4.recording.formats.urdf import urdf_joints
from recon4.recording.limits import LIMITS
from recon4.recording.mounts import transform_messages
from recon4.recording.mounts.transform_messages import read_frames
from recon4.recording.report import ImportReport
from tests.builders import T0_NS, bag_path
from tests.robot_bags import TF1, TF2, RobotBag, mount
from tests.warned import derivations

KINDS = ("bag1", "db3", "mcap")
URDF = """<?xml version="1.0"?>
<robot name="r" xmlns:xacro="http://ros.org/xacro">
  <link name="base_link"><visual><origin xyz="9 9 9"/></visual></link>
  <joint name="a" type="fixed"><parent link="base_link"/><child link="lidar"/>
    <origin xyz="0.1 0 0.5" rpy="3.14159265 0 0"/></joint>
  <joint name="b" type="revolute"><parent link="base_link"/><child link="arm"/></joint>
  <joint name="c" type="fixed"><parent link="lidar"/><child link="imu"/></joint>
</robot>"""


def frames_of(path, wanted=("base_link", "lidar")):
    report = ImportReport()
    with Bag([path], report) as bag:
        return read_frames(bag, list(wanted), report), report


def bag_of(folder, *transforms, kind="db3"):
    path = bag_path(folder, kind)
    with RobotBag(path, kind) as bag:
        bag.tf(*transforms)
    return path


def assert_mount(found, expected):
    assert found is not None
    np.testing.assert_allclose(found.matrix(), expected.matrix(), atol=1e-7)


@pytest.mark.parametrize("kind", KINDS)
def test_static_transforms_of_every_kind_of_bag_are_read(tmp_path, kind):
    path = bag_of(tmp_path, ("base_link", "lidar", mount(0.1, roll=180)), kind=kind)

    frames, report = frames_of(path)

    assert_mount(frames.T_a_b("base_link", "lidar"), mount(0.1, roll=180))
    assert report.findings == [] and derivations(report) == []


def test_transforms_of_early_ros_1_and_slashes_before_names_are_read(tmp_path):
    path = bag_path(tmp_path, "bag1")
    with RobotBag(path, "bag1") as bag:
        for k in range(3):
            bag.tf(("/base_link", "/lidar", mount(0.1)), topic="/tf", t_ns=T0_NS + k, kind=TF1)

    assert_mount(frames_of(path)[0].T_a_b("base_link", "lidar"), mount(0.1))


def test_of_tf_only_what_does_not_change_counts(tmp_path):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        for k in range(20):
            bag.tf(
                ("odom", "base_link", mount(0.1 * k)),
                ("base_link", "lidar", mount(0.2)),
                ("base_link", "head", mount(yaw=k)),
                ("map", "odom", mount()),
                topic="/tf",
                t_ns=T0_NS + k,
            )

    frames, _ = frames_of(path)

    assert_mount(frames.T_a_b("base_link", "lidar"), mount(0.2))
    for moving in ("odom", "head", "map"):
        assert frames.T_a_b("base_link", moving) is None


def test_a_transform_that_tf_states_once_is_a_mount(tmp_path):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        bag.tf(("base_link", "lidar", mount(0.2)), topic="/tf")
        bag.tf(("odom", "base_link", mount(0.1)), topic="/tf")

    frames, _ = frames_of(path)

    assert_mount(frames.T_a_b("base_link", "lidar"), mount(0.2))
    assert frames.T_a_b("base_link", "odom") is None


def test_tf_is_not_read_where_static_transforms_say_it_all(tmp_path):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        bag.tf(("base_link", "lidar", mount(0.1)))
        for k in range(3):
            bag.tf(("base_link", "lidar", mount(0.9)), topic="/tf", t_ns=T0_NS + k)

    frames, _ = frames_of(path)

    assert_mount(frames.T_a_b("base_link", "lidar"), mount(0.1))


def test_the_last_of_contradictory_static_transforms_is_used_and_counted(tmp_path):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        for x in (0.1, 0.1, 0.4):
            bag.tf(("base_link", "lidar", mount(x)))

    frames, report = frames_of(path)

    assert_mount(frames.T_a_b("base_link", "lidar"), mount(0.4))
    assert frames.path("base_link", "lidar")[0].disputed
    assert report.counts["transforms_contradictory"] == 1


def test_fixed_joints_of_a_description_are_read(tmp_path):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        bag.description(URDF)

    frames, _ = frames_of(path)

    assert_mount(frames.T_a_b("base_link", "imu"), mount(0.1, z=0.5, roll=180))
    assert frames.T_a_b("base_link", "arm") is None


@pytest.mark.parametrize(
    "broken",
    [
        URDF.replace("<robot", '<!DOCTYPE r [<!ENTITY a "b">]><robot', 1),
        URDF.replace("0.1 0 0.5", "0.1 0"),
        URDF.replace("0.1 0 0.5", "nan 0 0"),
        URDF.replace("<parent", '<axis xyz="0 1"/><parent', 1),
        URDF.replace("<parent", '<mimic joint="b" multiplier="x"/><parent', 1),
        URDF[:200],
        "<a>" * 100,
        "",
    ],
)
def test_a_description_that_is_not_plain_and_sound_is_refused(tmp_path, broken):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        bag.description(broken)
    with pytest.raises(CorruptFile):
        urdf_joints(broken)

    frames, report = frames_of(path)

    assert len(frames) == 0
    assert report.counts["robot_descriptions_refused"] == 1
    assert "robot description is not read" in derivations(report)[0]


def arm_at(folder, positions, *, urdf=URDF, more=()):
    """Frames of a robot whose arm is at some positions [rad]."""
    path = bag_path(folder, "db3")
    with RobotBag(path, "db3") as bag:
        bag.description(urdf)
        for k, position in enumerate(positions):
            bag.positions("/joint_states", T0_NS + k, {"b": position})
        for k, transform in enumerate(more):
            bag.tf(transform, topic="/tf", t_ns=T0_NS + k)
    return frames_of(path, ("base_link", "arm"))


def test_a_joint_that_is_held_in_one_position_is_a_mount(tmp_path):
    frames, _ = arm_at(tmp_path, [0.5, 0.5004, 0.5])

    assert_mount(frames.T_a_b("base_link", "arm"), mount(roll=np.rad2deg(0.5)))
    assert frames.joints_above("arm") == []


def test_a_joint_that_turns_about_a_level_axis_tilts_by_its_whole_range(tmp_path):
    frames, _ = arm_at(tmp_path, [0.1, 0.5, -3.0])
    (joint,) = frames.joints_above("arm")

    assert frames.T_a_b("base_link", "arm") is None
    assert joint.tilt_rad == pytest.approx(3.1, abs=0.03)
    assert (joint.source, joint.named_by) == ("/joint_states", "/robot_description")


def test_transforms_of_a_joint_count_before_its_positions(tmp_path):
    moved = [("base_link", "arm", mount(roll=k)) for k in (0, 10, 20)]
    (joint,) = arm_at(tmp_path, [0.0, 1.0], more=moved)[0].joints_above("arm")

    assert (joint.source, joint.driven) == ("/tf", None)


def test_a_joint_without_an_axis_or_positions_is_no_mount(tmp_path):
    frames, report = arm_at(tmp_path, [np.inf, np.nan, 1e300])
    assert frames.T_a_b("base_link", "arm") is None and frames.joints_above("arm") == []
    assert report.counts["joint_positions_invalid"] == 3

    (tmp_path / "axis").mkdir()
    no_axis = URDF.replace('<child link="arm"/>', '<child link="arm"/><axis xyz="0 0 0"/>')
    frames, report = arm_at(tmp_path / "axis", [0.0, 1.0], urdf=no_axis)
    assert frames.joints_above("arm") == [] and report.counts["transforms_invalid"] == 1
    assert "expected a name, an axis" in derivations(report)[0]


NONSENSE = {
    "no parent": ("", "lidar", mount()),
    "no child": ("base_link", "/", mount()),
    "itself": ("lidar", "/lidar", mount()),
    "not a number": ("base_link", "lidar", (np.nan, 0, 0, 0, 0, 0, 1)),
    "infinite": ("base_link", "lidar", (0, np.inf, 0, 0, 0, 0, 1)),
    "no quaternion": ("base_link", "lidar", (0, 0, 0, 0, 0, 0, 0)),
    "not of length 1": ("base_link", "lidar", (0, 0, 0, 0, 0, 0.5, 1)),
    "too far": ("base_link", "lidar", (1e6, 0, 0, 0, 0, 0, 1)),
}


@pytest.mark.parametrize("what", NONSENSE)
def test_transforms_that_make_no_sense_are_left_out_and_counted(tmp_path, what):
    path = bag_of(tmp_path, NONSENSE[what], ("base_link", "imu", mount(0.3)))

    frames, report = frames_of(path)

    assert frames.T_a_b("base_link", "lidar") is None
    assert_mount(frames.T_a_b("base_link", "imu"), mount(0.3))
    assert report.counts["transforms_invalid"] == 1
    assert "left out" in derivations(report)[0]


def test_a_quaternion_that_is_rounded_is_used(tmp_path):
    path = bag_of(tmp_path, ("base_link", "lidar", (0, 0, 0, 1.001, 0, 0, 0)))

    assert_mount(frames_of(path)[0].T_a_b("base_link", "lidar"), mount(roll=180))


def test_cycles_and_more_transforms_than_any_robot_has_end(tmp_path):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        bag.tf(("a", "b", mount(1)), ("b", "c", mount(1)), ("c", "a", mount(1)))
        for first in range(0, LIMITS.frame_pairs + 1000, 1000):
            many = [
                (f"n{k}", f"n{k + 1}", (0, 0, 0, 0, 0, 0, 1.0)) for k in range(first, first + 1000)
            ]
            bag.tf(*many, kind=TF2)

    frames, report = frames_of(path, ("n0", "n50"))

    assert frames.connected(["n0", "n50"])
    assert len(frames.contradictions()) == 1
    assert report.counts["transforms_beyond_limit"] == 1003


def test_a_flood_of_repeated_transforms_ends(tmp_path, monkeypatch):
    few = replace(transform_messages.LIMITS, transforms=100)
    monkeypatch.setattr(transform_messages, "LIMITS", few)
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        for k in range(60):
            bag.tf(("base_link", "lidar", mount(0.01 * k)), ("base_link", "imu", mount(1)))

    frames, report = frames_of(path)

    assert_mount(frames.T_a_b("base_link", "lidar"), mount(0.49))
    assert "its first 100 transforms are read" in derivations(report)[0]
