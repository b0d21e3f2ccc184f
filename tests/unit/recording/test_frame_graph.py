"""Transforms between frames: paths, cycles, several parents, contradictions."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.locales.numbers import mount_text, number_functions
from recon4.recording.mounts.frame_graph import FrameGraph, StatedTransform, mount_value
from tests.robot_bags import mount


def graph(*stated):
    return FrameGraph([StatedTransform(*one, "/tf_static") for one in stated])


def assert_same(found, expected):
    assert found is not None
    np.testing.assert_allclose(found.matrix(), expected.matrix(), atol=1e-12)


def test_a_path_up_and_down_gives_the_transform_between_two_frames():
    a, b, c = mount(1, 2, 3, roll=180), mount(0.5, yaw=90), mount(z=0.2, pitch=30)
    frames = graph(("base_link", "mast", a), ("mast", "lidar", b), ("base_link", "imu", c))

    assert_same(frames.T_a_b("base_link", "lidar"), a @ b)
    assert_same(frames.T_a_b("imu", "lidar"), c.inverse() @ a @ b)
    assert_same(frames.T_a_b("lidar", "imu"), (c.inverse() @ a @ b).inverse())
    assert [one.child for one in frames.path("mast", "lidar")] == ["lidar"]
    assert {one.child for one in frames.path("imu", "lidar")} == {"mast", "lidar", "imu"}


def test_frames_that_nothing_connects_have_no_transform():
    frames = graph(("a", "b", mount(1)), ("c", "d", mount(2)))

    assert frames.T_a_b("a", "c") is None
    assert frames.T_a_b("a", "unknown") is None
    assert_same(frames.T_a_b("unknown", "unknown"), SE3.identity())
    assert not frames.connected(["a", "d"])


def test_a_cycle_that_closes_is_no_contradiction():
    turn = mount(1, yaw=120)
    frames = graph(("a", "b", turn), ("b", "c", turn), ("c", "a", (turn @ turn).inverse()))

    assert_same(frames.T_a_b("a", "c"), turn @ turn)
    assert frames.contradictions() == []
    assert frames.top_of("a") in "abc"


def test_a_second_parent_that_says_something_else_is_a_contradiction():
    frames = graph(
        ("base_link", "chassis", mount(z=1)),
        ("base_link", "laser", mount(x=1)),
        ("chassis", "laser", mount(x=1.5)),
    )

    assert [(one.parent, one.child) for one in frames.contradictions()] == [("chassis", "laser")]


def test_the_frame_of_the_robot_is_found_whatever_its_namespace():
    frames = graph(
        ("map", "r1/base_footprint", mount()),
        ("r1/base_footprint", "r1/base_link", mount(z=0.1)),
        ("r1/base_link", "laser", mount()),
        ("camera", "camera_optical", mount()),
    )

    assert frames.body_of("laser") == "r1/base_link"
    assert frames.body_of("camera") == ""
    assert frames.top_of("camera_optical") == "camera"
    assert frames.top_of("laser") == "r1/base_footprint"


def test_ten_thousand_frames_in_a_row_are_connected():
    frames = graph(*((f"f{k}", f"f{k + 1}", mount(0.01)) for k in range(10_000)))

    assert frames.T_a_b("f0", "f10000").t[0] == pytest.approx(100.0)


def test_a_mount_reads_as_people_write_it():
    value = mount_value(mount(0.1, -0.0001, 2, roll=180, yaw=-90))
    text = mount_text(value)

    assert text == "xyz 0.100 0.000 2.000 m, roll 180.0 pitch 0.0 yaw -90.0°"
    assert number_functions("de")["MOUNT"](value).startswith("xyz 0,100 0,000 2,000 m, roll 180,0")
    assert mount_text(" ".join(value.split()[:3])) == "xyz 0.100 0.000 2.000 m"
    assert mount_text(text) == text, "that of an earlier version"


@pytest.mark.parametrize("pitch", [90.0, -90.0])
def test_the_mount_of_a_vertical_lidar_has_no_yaw(pitch):
    text = mount_text(mount_value(mount(pitch=pitch, roll=30, yaw=-10)))
    roll = 30 + 10 * np.sign(pitch)

    assert text.endswith(f"roll {roll:.1f} pitch {pitch:.1f} yaw 0.0°")
