"""2-D lasers that are mounted upside down, tilted or aside, by tf or by a rig file."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se2 import between, compose, from_se3
from recon4.model.finding import Level
from recon4.model.finding_kinds import MOUNT_DOUBTS
from recon4.model.rig import Rig, Sensor
from recon4.model.usability import Usability
from recon4.pipeline import process
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.info.describe import describe
from recon4.recording.lasers.laser2d import read_laser_recording
from recon4.recording.lasers.mount import mount_of_rig, mounted_scans
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.slam2d.stage import import_scans
from tests.builders import T0_NS, bag_path
from tests.planar_walks import cast, furnished_room
from tests.robot_bags import RobotBag, mount
from tests.warned import K, derivations, kinds, warned, words

ANGLES = np.deg2rad(np.linspace(-130.0, 140.0, 181))
STEP_NS = 100_000_000
ROBOT = np.stack([np.linspace(-1.0, 1.0, 60), np.zeros(60), np.linspace(0.0, 2.0, 60)], axis=1)
"""Poses of the robot."""


LASER = Sensor(name="laser", model="generic", kind="laser2d", T_body_sensor=mount())


def walk_bag(folder, T_base_laser, *, odometry=True, tf=True, kind="db3", **frames):
    """A robot with a laser that is level or upside down; tf says how it is mounted.

    Its scans are in the frame ``laser``, its odometry of the frame ``child``.
    """
    path = bag_path(folder, kind)
    x, y, _ = T_base_laser.t
    yaw = np.arctan2(T_base_laser.R[1, 0], T_base_laser.R[0, 0])
    lasers = compose(ROBOT, np.array([x, y, yaw])[None])
    seen = ANGLES if T_base_laser.R[2, 2] > 0 else -ANGLES
    with RobotBag(path, kind) as bag:
        if tf:
            bag.tf(("base_footprint", "base_link", mount(z=1)))
            bag.tf(("base_link", "laser", T_base_laser))
        for k, (robot, laser) in enumerate(zip(ROBOT, lasers, strict=True)):
            t_ns = T0_NS + k * STEP_NS
            bag.frame = frames.get("laser", "laser")
            bag.laser("/scan", t_ns, cast(furnished_room(), laser, seen, 30.0), angles=ANGLES)
            bag.frame = frames.get("child", "base_link")
            if odometry:
                bag.walk("/odom", t_ns, robot)
    return path, lasers


def mounted(path, by_rig=None):
    report = ImportReport()
    rig = mount_of_rig(by_rig) if by_rig is not None else None
    return mounted_scans(read_laser_recording([path], report), rig, report=report), report


def said(report):
    return " | ".join([*derivations(report), words(report)])


def assert_on_walls(scans, lasers):
    """The returns, placed by the true poses of the laser, lie on the walls of the room."""
    for k in (0, 30, 59):
        points = scans.points(k)
        bearings = np.arctan2(points[:, 1], points[:, 0])
        expected = cast(furnished_room(), lasers[k], bearings, 30.0)
        np.testing.assert_allclose(np.linalg.norm(points, axis=1), expected, atol=1e-3)


MOUNTS = {
    "upright": mount(0.2, 0.1, 0.3, yaw=30),
    "rolled by 180": mount(0.2, 0.1, 0.3, roll=180),
    "pitched by 180": mount(-0.2, 0.0, 0.3, pitch=180),
    "rolled and turned": mount(0.3, -0.1, 0.3, roll=180, yaw=-120),
    "backward": mount(-0.3, 0.0, 0.3, yaw=180),
}


@pytest.mark.parametrize("name", MOUNTS)
@pytest.mark.parametrize("kind", ["bag1", "mcap"])
def test_scans_and_odometry_are_those_of_the_laser_seen_from_above(tmp_path, name, kind):
    path, lasers = walk_bag(tmp_path, MOUNTS[name], kind=kind)

    found, report = mounted(path)

    assert_on_walls(found.scans, lasers)
    np.testing.assert_allclose(found.scans.odometry, lasers, atol=1e-6)
    assert ("upside down" in said(report)) == (MOUNTS[name].R[2, 2] < 0)
    assert report.findings == []


def test_info_says_how_the_laser_is_mounted(tmp_path):
    path, _ = walk_bag(tmp_path, MOUNTS["rolled by 180"])

    text = "\n".join(describe(path).lines())

    assert "The laser is upside down" in text
    assert "/tf_static: base_link -> laser xyz 0.200 0.100 0.300 m, roll 180.0" in text


def test_without_transforms_nothing_is_turned_or_accused(tmp_path):
    path, lasers = walk_bag(tmp_path, MOUNTS["upright"], tf=False)

    found, report = mounted(path)

    assert_on_walls(found.scans, lasers)
    np.testing.assert_allclose(found.scans.odometry, ROBOT, atol=1e-6)
    assert report.findings == [] and "tf" not in said(report)
    assert "the odometry is taken as its own" in said(report)


def test_a_frame_that_the_transforms_do_not_know_is_said(tmp_path):
    path, _ = walk_bag(tmp_path, MOUNTS["upright"], laser="laser_frame")

    found, report = mounted(path)

    assert found.mount is None
    assert "do not say how its frame laser_frame is mounted" in said(report)
    assert report.findings == []


def joint_bag(folder, kind, *transforms):
    """A level laser; ``/tf`` states transforms, each a parent, child and mount of the scan k."""
    path = bag_path(folder, kind)
    with RobotBag(path, kind) as bag:
        bag.frame = "laser"
        for k, laser in enumerate(ROBOT):
            t_ns = T0_NS + k * STEP_NS
            stated = [(parent, child, mounted_at(k)) for parent, child, mounted_at in transforms]
            bag.tf(*stated, topic="/tf", t_ns=t_ns)
            bag.laser("/scan", t_ns, cast(furnished_room(), laser, ANGLES, 30.0), angles=ANGLES)
    return path


@pytest.mark.parametrize("kind", ["bag1", "mcap"])
def test_a_mount_that_only_tf_repeats_is_read(tmp_path, kind):
    path = joint_bag(
        tmp_path,
        kind,
        ("odom", "base_link", lambda k: mount(0.1 * k)),
        ("base_link", "laser", lambda k: mount(z=0.3, roll=180)),
    )

    found, report = mounted(path)

    assert found.mount is not None and found.mount.is_upside_down
    assert "The laser is upside down" in said(report)
    assert MOUNT_DOUBTS.isdisjoint(kinds(report))


@pytest.mark.parametrize("tf", ["directly", "by a part between"])
def test_a_laser_that_tilts_on_a_joint_is_doubted(tmp_path, tf):
    laser, axis = ("laser", "spare") if tf == "directly" else ("axis", "laser")
    path = joint_bag(
        tmp_path,
        "bag1",
        ("base_link", laser, lambda k: mount(pitch=40 * np.sin(k / 10))),
        (laser, axis, lambda k: mount(0.1)),
    )

    _, report = mounted(path)

    assert kinds(report) == [K.LASER_ON_JOINT]
    assert warned(report, K.LASER_ON_JOINT, parent="base_link", child=laser, source="/tf")
    assert report.findings[0].values["tilt_rad"] == pytest.approx(np.deg2rad(40.0), abs=0.01)


@pytest.mark.parametrize(
    ("parent", "moved"),
    [
        ("base_link", lambda k: mount(yaw=3 * k)),
        ("base_link", lambda k: mount(pitch=0.05 * k)),
        ("map", lambda k: mount(0.1 * k, roll=10 * np.sin(k / 10))),
    ],
    ids=["turns level", "shakes a little", "pose in the world"],
)
def test_a_joint_that_keeps_the_laser_level_is_not_accused(tmp_path, parent, moved):
    path = joint_bag(tmp_path, "bag1", (parent, "laser", moved))

    assert mounted(path)[1].findings == []


def test_a_robot_that_tilts_as_a_whole_is_no_joint(tmp_path):
    path = joint_bag(
        tmp_path,
        "bag1",
        ("base_stabilized", "base_link", lambda k: mount(pitch=8 * np.sin(k / 10))),
        ("base_link", "laser", lambda k: mount(z=0.3)),
    )

    assert mounted(path)[1].findings == []


def test_odometry_of_another_frame_of_the_robot_is_moved_from_there(tmp_path):
    path, _ = walk_bag(tmp_path, MOUNTS["rolled by 180"], child="laser")

    found, _ = mounted(path)

    np.testing.assert_allclose(found.scans.odometry, ROBOT, atol=1e-6)


@pytest.mark.parametrize("pitch", [20.0, 200.0])
def test_a_tilted_laser_is_announced(tmp_path, pitch):
    path, _ = walk_bag(tmp_path, mount(pitch=pitch), odometry=False)

    found, report = mounted(path)

    assert found.tilt_deg == pytest.approx(20.0)
    assert kinds(report) == [K.LASER_TILTED]
    assert warned(report, K.LASER_TILTED, tilt_rad=float(np.deg2rad(20.0)), child="laser")
    assert "states its mount: xyz 0.000 0.000 0.000 m, roll " in words(report)


def test_a_laser_that_leans_a_little_is_not_accused(tmp_path):
    path, _ = walk_bag(tmp_path, mount(roll=2.0), odometry=False)

    assert mounted(path)[1].findings == []


def test_a_rig_file_wins_over_the_transforms_and_the_contradiction_is_said(tmp_path):
    path, lasers = walk_bag(tmp_path, MOUNTS["upright"], odometry=False)

    found, report = mounted(path, MOUNTS["rolled by 180"])
    agreeing, quiet = mounted(path, mount(z=5.0))

    np.testing.assert_allclose(found.scans.points(0)[:, 1], -agreeing.scans.points(0)[:, 1])
    assert_on_walls(agreeing.scans, lasers)
    assert quiet.findings == []
    assert warned(report, K.LASER_CONTRADICTED, angle_rad=np.pi)
    text = words(report)
    assert "used: xyz 0.200 0.100 0.300 m, roll 180.0" in text and "says: xyz" in text


def test_a_rig_file_mounts_the_laser_of_a_bag_without_transforms(tmp_path):
    path, lasers = walk_bag(tmp_path, MOUNTS["rolled and turned"], tf=False)

    found, report = mounted(path, MOUNTS["rolled and turned"])

    assert_on_walls(found.scans, lasers)
    np.testing.assert_allclose(found.scans.odometry, lasers, atol=1e-6)
    assert report.findings == []


def test_odometry_that_turns_against_the_stated_mount_is_a_contradiction(tmp_path):
    path, _ = walk_bag(tmp_path, MOUNTS["upright"], tf=False)
    (tmp_path / "out").mkdir()
    wrong = mount(0.2, 0.1, 0.3, roll=180, yaw=30)

    figures = import_scans(
        [path],
        tmp_path / "out",
        settings=IngestSettings(),
        laser=replace(LASER, T_body_sensor=wrong),
        progress=Silent(),
    )

    assert figures.mirrored and figures.stated["by_rig"].startswith("0.200000 0.100000 0.300000 ")
    assert figures.doubts == () and figures.mount == ""


@pytest.mark.parametrize("name", ["rolled by 180", "backward"])
def test_the_plan_of_a_mounted_laser_is_that_of_the_room_and_good(tmp_path, name):
    path, lasers = walk_bag(tmp_path, MOUNTS[name])

    summary = process(Sources((path,)), tmp_path / "map")

    poses = from_se3(read_tum(tmp_path / "map" / "trajectory.tum").T_a_b)
    moved = between(lasers, compose(lasers[0], between(poses[0], poses)))
    assert np.abs(moved).max() < 0.02
    assert summary.verdict.usability is Usability.GOOD
    assert {one.level for one in summary.findings} == {Level.GOOD}


def test_the_verdict_names_a_rig_file_that_contradicts_the_bag(tmp_path):
    path, _ = walk_bag(tmp_path, MOUNTS["rolled by 180"], odometry=False)

    summary = process(Sources((path,), rig_of(mount())), tmp_path / "map")
    again = process(Sources((path,)), tmp_path / "map")

    assert summary.verdict.usability is Usability.CHECK
    assert "contradict each other about the laser" in summary.verdict.reasons[0]
    assert again.verdict.usability is Usability.GOOD


def test_a_plan_by_a_steep_laser_is_not_to_be_used(tmp_path):
    path, _ = walk_bag(tmp_path, mount(pitch=80.0), odometry=False)

    summary = process(Sources((path,)), tmp_path / "map")

    assert summary.verdict.usability is Usability.DO_NOT_USE
    assert "tilted by 80.0°" in summary.verdict.reasons[0]


def rig_of(T_body_laser):
    laser = Sensor(
        name="laser", model="generic", kind="laser2d", topic="/scan", T_body_sensor=T_body_laser
    )
    return Rig(
        name="ours",
        sensors=(laser,),
        T_body_imu=mount(),
        imu_time_offset_s=0.0,
        p_body_antenna=np.zeros(3),
        gnss_time_offset_s=0.0,
    )
