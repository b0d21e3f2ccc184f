"""Sensors on joints that move by transforms: a 2-D laser that tilts, a LiDAR that turns."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.model.finding_kinds import MOUNT_DOUBTS
from recon4.model.rig import parse_rig
from recon4.recording.clocks.compare import clock_offset_s
from recon4.recording.info.describe import describe
from recon4.recording.lasers.laser2d import is_laser2d
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from recon4.store.line_store import load_lines
from tests.builders import ROOM_M, T0_NS, bag_path
from tests.robot_bags import RobotBag, mount
from tests.unit.recording.ingested import run
from tests.warned import K, derivations, kinds, warned

ANGLES = np.linspace(-2.0, 2.0, 81)
SCANS, SCAN_NS = 60, 50_000_000
POSE_NS = 20_000_000
BODY_AXIS, AXIS_LASER = mount(0.1, z=0.2), mount(0.05)


def pitch_deg(t_ns):
    """The joint tilts to and fro; between two poses it turns nearly evenly."""
    return 40.0 * np.sin(2.0 * np.pi * (t_ns - T0_NS) * 1e-9 / 3.0)


def T_base_laser(t_ns):
    return BODY_AXIS @ mount(pitch=pitch_deg(t_ns)) @ AXIS_LASER


def room_ranges(T, direction):
    """Distances from a pose in the room of `ROOM_M` to its walls, along directions of the pose."""
    d = direction @ T.R.T
    with np.errstate(divide="ignore"):
        return ((ROOM_M / 2 - np.sign(d) * T.t) / np.abs(d)).min(axis=1)


def tilting_bag(
    folder,
    *,
    imu_frame="base_link",
    travel=0.0,
    late_ns=0,
    without=(),
    level=False,
    urdf="",
):
    """A robot that stands in a room: a laser on a joint, an IMU; times without transforms [s].

    With a description, positions tell how the joint moves, in place of transforms.
    """
    path = bag_path(folder, "bag1")
    beams = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
    with RobotBag(path, "bag1") as bag:
        turned = mount(yaw=-90.0 if urdf else 0.0)
        still = [("axis", "laser", turned @ AXIS_LASER), ("base_link", "level", mount(z=0.1))]
        if imu_frame == "laser_imu":
            still.append(("axis", "laser_imu", mount()))
        bag.tf(*still)
        if urdf:
            bag.description(urdf)
        for t_ns in range(T0_NS - POSE_NS, T0_NS + SCANS * SCAN_NS + 2 * POSE_NS, POSE_NS):
            s = (t_ns - T0_NS) * 1e-9
            if urdf:
                motor = (np.deg2rad(pitch_deg(t_ns)) - 0.1) / -0.5
                stated = {"wheel": 9.0 * s, "motor": motor, "broken": np.nan}
                bag.positions("/joint_states", t_ns, stated)
            elif not any(first < s < last for first, last in without):
                moved = mount(travel * s) @ BODY_AXIS @ mount(pitch=pitch_deg(t_ns))
                message = bag.stated([("base_link", "axis", moved)], t_ns=t_ns)
                bag.write("/tf", "tf2_msgs/msg/TFMessage", t_ns + late_ns, message)
            bag.frame = imu_frame
            bag.imu("/imu", t_ns, (0.0, 0.0, 1e-4 * (t_ns % 7)), (0.0, 0.0, 9.81))
        for t_ns in range(T0_NS, T0_NS + SCANS * SCAN_NS, SCAN_NS):
            bag.frame = "laser"
            bag.laser("/scan", t_ns, room_ranges(T_base_laser(t_ns), beams), angles=ANGLES)
            if level:
                bag.frame = "level"
                ranges = room_ranges(mount(z=0.1), beams)
                bag.laser("/level", t_ns, ranges, angles=ANGLES)
    return path


def points_of(store):
    T = store.rig.sensors[0].T_body_sensor
    return np.concatenate([T @ frame.xyz.astype(np.float64) for frame in store])


def off_walls_m(points):
    """Distance of each point from the nearest wall of the room."""
    return np.abs(ROOM_M / 2 - np.abs(points)).min(axis=1)


def test_every_shot_of_a_laser_on_a_joint_lies_where_the_joint_was(tmp_path):
    path = tilting_bag(tmp_path)

    store = run(path, out=tmp_path / "frames")
    points, lines = points_of(store), load_lines(store.folder)

    assert not is_laser2d(path)
    assert store.rig.sensors[0].kind == "profiler"
    assert len(lines) == SCANS and len(points) == SCANS * len(ANGLES)
    assert off_walls_m(points).max() < 2e-3
    expected = np.deg2rad(pitch_deg(lines.t_ns))
    turned = lines.head_rad - lines.head_rad[0]
    np.testing.assert_allclose(np.abs(turned), np.abs(expected - expected[0]), atol=1e-3)


URDF = """<robot name="r">
  <joint name="wheel" type="continuous"><parent link="base_link"/><child link="w"/></joint>
  <joint name="tilt" type="revolute"><parent link="base_link"/><child link="axis"/>
    <origin xyz="0.1 0 0.2" rpy="0 0 1.5707963267948966"/><axis xyz="2 0 0"/>
    <mimic joint="motor" multiplier="-0.5" offset="0.1"/></joint>
</robot>"""
"""The axis is that of `T_base_laser`, seen in a child that is turned; a gear drives it."""


def test_positions_of_a_joint_of_the_robot_description_tilt_a_laser(tmp_path):
    path = tilting_bag(tmp_path, urdf=URDF)

    store = run(path, out=tmp_path / "frames")

    sensor = store.rig.sensors[0]
    assert (sensor.kind, sensor.head_topic) == ("profiler", "/robot_description")
    assert len(points_of(store)) == SCANS * len(ANGLES)
    assert off_walls_m(points_of(store)).max() < 2e-3
    assert store.report["counts"]["joint_positions_invalid"] == SCANS * SCAN_NS // POSE_NS + 3
    text = "\n".join(describe(path).lines())
    assert "base_link -> axis turns by 80° (/joint_states" in text
    again = run(path, out=tmp_path / "again", rig=store.rig)  # the rig file names the description
    np.testing.assert_array_equal(points_of(again), points_of(store))


def test_a_level_laser_beside_it_is_the_2_d_laser(tmp_path):
    path = tilting_bag(tmp_path, level=True)

    recording = open_recording(OpenRequest((path,), None, IngestSettings(), ImportReport()))

    assert [(s.kind, s.topic) for s in recording.rig.sensors] == [
        ("profiler", "/scan"),
        ("laser2d", "/level"),
    ]


def test_info_names_the_kind_of_walk_and_why(tmp_path):
    text = "\n".join(describe(tilting_bag(tmp_path)).lines())

    assert "walk      profiler: every line of /scan lies elsewhere in space, because /tf" in text
    assert "base_link -> axis turns by 80° (/tf" in text


def test_shots_without_a_pose_of_the_joint_are_counted_and_left_out(tmp_path):
    store = run(tilting_bag(tmp_path, without=[(1.0, 1.6)]), out=tmp_path / "frames")

    left_out = store.report["counts"]["lines_without_angle"]
    assert left_out in (12, 13)
    assert len(points_of(store)) == (SCANS - left_out) * len(ANGLES)
    assert off_walls_m(points_of(store)).max() < 2e-3
    assert warned(store.report, K.LINES_WITHOUT_ANGLE, lines=left_out)


def test_transforms_that_are_recorded_late_are_used_and_doubted(tmp_path):
    store = run(tilting_bag(tmp_path, late_ns=700_000_000), out=tmp_path / "frames")

    assert off_walls_m(points_of(store)).max() < 2e-3
    assert len(points_of(store)) == SCANS * len(ANGLES)
    assert warned(store.report, K.JOINT_CLOCK)


@pytest.mark.parametrize(
    "bag",
    [{"travel": 1.0}, {"imu_frame": "laser_imu"}],
    ids=["a body in the world", "its IMU tilts too"],
)
def test_what_is_no_joint_of_the_laser_alone_stays_a_2_d_laser(tmp_path, bag):
    assert is_laser2d(tilting_bag(tmp_path, **bag))


def test_a_rig_file_may_name_transforms_that_move_a_profiler(tmp_path):
    text = 'name = "r"\n[[sensor]]\nname = "p"\nmodel = "generic"\nkind = "profiler"\n'
    text += 'topic = "/scan"\nhead_topic = "/tf"\nxyz_m = [0.0, 0.0, 1.0]\n'
    rig = parse_rig(text, where="rig.toml")

    store = run(tilting_bag(tmp_path), out=tmp_path / "frames", rig=rig)
    assert off_walls_m(points_of(store) - [0.0, 0.0, 1.0]).max() < 2e-3

    still = parse_rig(text.replace('"/scan"', '"/level"'), where="rig.toml")
    (tmp_path / "other").mkdir()
    path = tilting_bag(tmp_path / "other", level=True)
    with pytest.raises(ConfigError, match="expected a joint in /tf that moves its frame level"):
        run(path, out=tmp_path / "none", rig=still)


def test_angles_of_several_joints_without_a_description_are_refused(tmp_path):
    text = 'name = "r"\n[[sensor]]\nname = "p"\nmodel = "generic"\nkind = "profiler"\n'
    text += 'topic = "/scan"\nhead_topic = "/joint_states"\n'

    words = r"expected the angle of one joint, got 3 \(wheel, motor, broken\)"
    with pytest.raises(ConfigError, match=words):
        run(
            tilting_bag(tmp_path, urdf=URDF),
            out=tmp_path / "frames",
            rig=parse_rig(text, where="rig.toml"),
        )


def test_a_lidar_that_turns_on_a_joint_is_placed_in_what_carries_it(tmp_path):
    path = turning_lidar(tmp_path, imu_frame="base_link")

    store = run(path, out=tmp_path / "frames")

    assert off_walls_m(points_of(store)).max() < 5e-3
    assert any("its mount moves, every point is placed in base" in t for t in report_of(store))


def test_a_lidar_that_turns_with_its_imu_is_the_body_itself(tmp_path):
    store = run(turning_lidar(tmp_path, imu_frame="lidar"), out=tmp_path / "frames")

    assert any("turn together" in text for text in report_of(store))
    assert off_walls_m(points_of(store)).max() > 0.5


def report_of(store):
    return derivations(store.report)


def turning_lidar(folder, *, imu_frame):
    """A LiDAR of four rings whose axis lies level and turns about the vertical, in a room."""
    path = bag_path(folder, "bag1")
    columns, up = 50, np.deg2rad([-15.0, -5.0, 5.0, 15.0])
    azimuth = -2 * np.pi * np.arange(columns)[:, None] / columns
    d = np.stack(
        [np.cos(up) * np.cos(azimuth), np.cos(up) * np.sin(azimuth), np.sin(up) + 0 * azimuth],
        axis=2,
    )
    dt_ns = np.arange(columns) * (100_000_000 // columns)
    with RobotBag(path, "bag1") as bag:
        for t_ns in range(T0_NS - POSE_NS, T0_NS + 700_000_000, POSE_NS):
            bag.tf(("base_link", "lidar", lidar_at(t_ns)), topic="/tf", t_ns=t_ns)
            bag.frame = imu_frame
            bag.imu("/imu", t_ns, (0.0, 0.0, 1e-4 * (t_ns % 7)), (0.0, 0.0, 9.81))
        bag.frame = "lidar"
        for t_ns in range(T0_NS, T0_NS + 600_000_000, 100_000_000):
            ranges = [room_ranges(lidar_at(t_ns + dt_ns[k]), d[k]) for k in range(columns)]
            x, y, z = (np.stack(ranges)[:, :, None] * d).reshape(-1, 3).astype(np.float32).T
            table = {"x": x, "y": y, "z": z, "intensity": x * 0 + 9}
            table |= {"ring": np.tile(np.arange(4, dtype=np.uint16), columns)}
            bag.cloud(
                "/points", t_ns, table | {"time": np.repeat(1e-9 * dt_ns, 4).astype(np.float32)}
            )
    return path


def lidar_at(t_ns):
    return mount(0.1, z=0.3, yaw=90.0 * (t_ns - T0_NS) * 1e-9) @ mount(pitch=90)


def test_lags_of_a_joint_on_the_same_clock_say_nothing(tmp_path):
    report = ImportReport()
    recording = open_recording(
        OpenRequest((tilting_bag(tmp_path),), None, IngestSettings(), report)
    )
    list(recording.read())

    assert clock_offset_s("joint", report) == pytest.approx(0.0, abs=0.01)
    assert MOUNT_DOUBTS.isdisjoint(kinds(report))
