"""The calibration methods of both documents."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.entropy import calibrate_by_entropy, entropy_cost
from recon4.calibration.floors import find_inclinations, read_inclinations
from recon4.calibration.gravity_alignment import align_gravity
from recon4.calibration.map_alignment import align_maps
from recon4.calibration.mount_search import axis_rotations, search_mounts, without_others
from recon4.calibration.parameters import Parameters
from recon4.calibration.pose_pairs import (
    MarkerPosePairs,
    average_pairs,
    hand_eye,
    read_pose_pairs,
)
from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.tuning import EntropyTuning
from recon4.calibration.window import cut_window
from recon4.cli.main import main
from recon4.errors import CalibrationError, CorruptFile
from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.rig import format_rig, load_rig
from tests import scanned_room
from tests.unit.calibration.conftest import SETTINGS, mounted

MOUNT = SE3(so3_exp([0.3, -0.2, 0.5]), np.array([0.1, -0.05, 0.2]))


def poses(count=8, seed=1):
    rng = np.random.default_rng(seed)
    return SE3(so3_exp(rng.uniform(-1, 1, (count, 3))), rng.uniform(-5, 5, (count, 3)))


def window_of(walk, rig, rows=range(10, 40)):
    frames = replace(walk, rig=rig)
    return cut_window(frames, walk.truth, rows)


def test_pose_pairs_average_to_the_mount():
    marker = poses()
    noise = SE3.exp(0.002 * np.random.default_rng(2).standard_normal((len(marker.t), 6)))
    found = average_pairs(MarkerPosePairs(marker, marker @ (MOUNT @ noise)))

    assert (MOUNT.inverse() @ found.T_marker_sensor).angle() < 0.002
    np.testing.assert_allclose(found.T_marker_sensor.t, MOUNT.t, atol=0.002)
    assert found.residual_m.max() < 0.01
    assert not found.contradictory


def test_hand_eye_needs_no_common_world():
    marker = poses()
    other_world = SE3(so3_exp([0.0, 0.0, 2.0]), np.array([50.0, -20.0, 3.0]))
    found = hand_eye(MarkerPosePairs(marker, other_world @ (marker @ MOUNT)), before_m=np.zeros(3))

    np.testing.assert_allclose(found.T_marker_sensor.R, MOUNT.R, atol=1e-6)
    np.testing.assert_allclose(found.T_marker_sensor.t, MOUNT.t, atol=1e-6)


def test_hand_eye_is_content_with_small_turns_about_other_axes():
    """As those of a car or of a walk: 2° about the other axes."""
    rng = np.random.default_rng(3)
    turn = np.deg2rad([2.0, 2.0, 120.0]) * rng.uniform(-1, 1, (100, 3))
    marker = SE3(so3_exp(turn), rng.uniform(-5, 5, (100, 3)))
    found = hand_eye(MarkerPosePairs(marker, marker @ MOUNT), before_m=np.zeros(3))

    np.testing.assert_allclose(found.T_marker_sensor.R, MOUNT.R, atol=1e-6)


def test_hand_eye_keeps_the_height_that_a_level_walk_does_not_show():
    rng = np.random.default_rng(3)
    turn = np.deg2rad([2.0, 2.0, 120.0]) * rng.uniform(-1, 1, (60, 3))
    marker = SE3(so3_exp(turn), rng.uniform(-5, 5, (60, 3)))
    noise = SE3(so3_exp(np.deg2rad(0.02) * rng.normal(size=(60, 3))), np.zeros((60, 3)))
    before_m = MOUNT.t + np.array([0.05, -0.05, 0.2])

    found = hand_eye(MarkerPosePairs(marker, marker @ MOUNT @ noise), before_m=before_m)

    ((*_, up),) = found.unknown
    assert abs(up) > 0.999
    np.testing.assert_allclose(found.T_marker_sensor.t[:2], MOUNT.t[:2], atol=0.003)
    assert abs(found.T_marker_sensor.t[2] - before_m[2]) < 0.005
    assert found.sd_m[2] > 0.01 > found.sd_m[:2].max()


def test_hand_eye_refuses_what_noise_hides():
    rng = np.random.default_rng(3)
    turn = np.deg2rad([1.0, 1.0, 120.0]) * rng.uniform(-1, 1, (100, 3))
    marker = SE3(so3_exp(turn), rng.uniform(-0.5, 0.5, (100, 3)))
    noise = SE3(so3_exp(np.deg2rad(0.3) * rng.normal(size=(100, 3))), np.zeros((100, 3)))

    with pytest.raises(CalibrationError, match="two different axes"):
        hand_eye(MarkerPosePairs(marker, marker @ MOUNT @ noise), before_m=np.zeros(3))


def test_hand_eye_refuses_turns_about_one_axis():
    turns = SE3(so3_exp(np.outer(np.arange(6), [0, 0, 0.2])), np.zeros((6, 3)))

    with pytest.raises(CalibrationError, match="two different axes"):
        hand_eye(MarkerPosePairs(turns, turns @ MOUNT), before_m=np.zeros(3))


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("1 2 3", "line 1: expected 14 finite numbers .*, got '1 2 3'"),
        ("# nothing\n", "expected a pair of poses a line"),
        ("0 0 0 0 0 0 2  0 0 0 0 0 0 1", "quaternion of length 1, got 2.000"),
        ("0 0 0 0 0 0 1  0 0 nan 0 0 0 1", "finite numbers"),
        ("0,0,0,0,0,0,1,x,0,0,0,0,0,1", "expected 14 finite numbers .*, got '0,0,0"),
    ],
)
def test_a_wrong_file_of_pairs_is_named(tmp_path, text, match):
    path = tmp_path / "pairs.csv"
    path.write_text(text)

    with pytest.raises(CorruptFile, match=match):
        read_pose_pairs(path)


def test_gravity_and_floor_give_the_rotation_of_the_imu():
    R_body_imu = so3_exp([0.4, -0.3, 1.0])
    tilts = so3_exp(np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.25, 0], [-0.1, 0.1, 0]], float))
    up_body = tilts[:, 2]
    found = align_gravity(-up_body, 9.81 * up_body @ R_body_imu)

    np.testing.assert_allclose(found.R_body_imu, R_body_imu, atol=1e-9)
    assert found.heading_observable
    assert found.residual_rad.max() < 1e-6


def test_one_inclination_leaves_the_heading_open():
    up = np.tile([0.0, 0.0, 1.0], (4, 1))

    assert not align_gravity(up, up).heading_observable
    with pytest.raises(CalibrationError, match="at least 2"):
        align_gravity(up[:1], up[:1])
    with pytest.raises(CalibrationError, match="NaN or zero"):
        align_gravity(up, 0.0 * up)


def test_floor_and_gravity_are_found_where_the_backpack_rests():
    tilt = so3_exp([0.12, -0.08, 0.0])

    def tilted(t_s):
        return SE3(np.broadcast_to(tilt, (len(t_s), 3, 3)), np.zeros((len(t_s), 3)))

    walk = scanned_room.walk(tilted, 8, noise_m=0.01)
    found = find_inclinations(walk, walk.rig)

    assert len(found) == 1
    up_body = tilt.T @ [0.0, 0.0, 1.0]
    assert np.degrees(np.arccos(found.normal_body[0] @ up_body)) < 0.2
    np.testing.assert_allclose(found.force_imu[0] / 9.80665, up_body, atol=1e-3)


def test_picked_inclinations_are_read(tmp_path):
    path = tmp_path / "picked.csv"
    path.write_text("0 0 9.8 0 0 1\n# tilted\n1, 0, 9.7, 0.1, 0, 0.99\n")

    found = read_inclinations(path)
    assert len(found) == 2
    path.write_text("0 0 9.8 0 0\n")
    with pytest.raises(CorruptFile, match="line 1: expected 6 finite numbers"):
        read_inclinations(path)


def test_entropy_is_lowest_where_the_mounts_are_true(dance):
    settings = EntropyTuning(points=6000)
    costs = [
        entropy_cost([window_of(dance, rig)], rig, settings)
        for rig in (dance.rig, mounted(dance.rig, 1, turn_deg=(0.0, 1.0, 0.0)))
    ]
    assert costs[0] < costs[1]


def test_entropy_finds_a_rotation_back(dance):
    wrong = mounted(dance.rig, 1, turn_deg=(0.6, -0.5, 0.4))
    parameters = Parameters.of(wrong, reference=0, lidars=(1,), imu=False)
    only_turns = parameters.fixing(np.array([False] * 3 + [True] * 4))
    found = calibrate_by_entropy(
        [window_of(dance, wrong, range(10, 100))],
        wrong,
        only_turns,
        settings=EntropyTuning(points=4000, evaluations=120),
    )

    before = np.linalg.norm(np.deg2rad([0.6, -0.5, 0.4]))
    after = np.linalg.norm(parameters.between(dance.rig, found.rig)[:3])
    assert after < 0.5 * before
    assert np.all(np.diff(found.costs) <= 0.0)


@pytest.mark.study
def test_two_maps_give_the_mount(dance):
    wrong = mounted(dance.rig, 1, turn_deg=(3.0, -2.0, 2.0), shift_m=(0.05, 0.0, -0.05))
    walk = RecordedWalk(replace(dance, rig=wrong), dance.truth, *np.zeros((2, len(dance)), bool))
    found = align_maps(walk, wrong, 1, reference=0, settings=SETTINGS)

    true = dance.rig.sensors[1].T_body_sensor
    before = (true.inverse() @ wrong.sensors[1].T_body_sensor).angle()
    assert found.windows >= 1
    assert (true.inverse() @ found.T_body_sensor).angle() < 0.4 * before


def test_there_are_24_axis_rotations():
    found = list(axis_rotations())

    assert len({tuple(R.ravel()) for R in found}) == 24
    np.testing.assert_array_equal(found[0], np.eye(3))


def test_a_lidar_upside_down_is_among_the_first_mounts(dance):
    wrong = mounted(dance.rig, 1, turn_deg=(0.0, 180.0, 0.0))
    alone = replace(dance, rig=without_others(wrong, 0))
    window = replace(cut_window(dance, dance.truth, range(20, 50)), recorded_rig=wrong)
    assert alone.rig.sensors[0].enabled
    assert not alone.rig.sensors[1].enabled

    true = dance.rig.sensors[1].T_body_sensor
    ranked = search_mounts([window], wrong, reference=0)
    off = [np.rad2deg((true.inverse() @ r.sensors[1].T_body_sensor).angle()) for r in ranked]
    assert min(off[:3]) < 3.0


def test_the_command_writes_a_mount_from_pairs(tmp_path, capsys):
    marker = poses()
    sensor = marker @ MOUNT
    rows = np.column_stack([marker.t, marker.quat_xyzw(), sensor.t, sensor.quat_xyzw()])
    np.savetxt(tmp_path / "pairs.csv", rows)
    code = main(
        ["--language", "de", "calibrate", str(tmp_path / "pairs.csv"), "--rig", "single-vlp16",
         "--method", "pairs", "--out", str(tmp_path / "new.toml")]
    )  # fmt: skip

    said = capsys.readouterr()
    assert code == 0, said
    assert said.out.startswith("Paar 1: Residuum 0,000° 0,0 mm\n")
    assert "\nEinbau von 'lidar' aus " in said.out
    found = load_rig(tmp_path / "new.toml").sensors[0].T_body_sensor
    np.testing.assert_allclose(found.t, MOUNT.t, atol=1e-6)


def test_the_command_refuses_what_it_does_not_know(tmp_path, capsys):
    (tmp_path / "pairs.csv").write_text("")
    rig = ["--rig", "single-vlp16", "--out", str(tmp_path / "new.toml")]

    assert main(["calibrate", str(tmp_path / "pairs.csv"), *rig, "--method", "magic"]) != 0
    assert "no method named 'magic'" in capsys.readouterr().err
    assert main(["calibrate", str(tmp_path / "pairs.csv"), *rig, "--method", "pairs"]) != 0
    assert not (tmp_path / "new.toml").exists()


def test_a_rig_file_keeps_where_its_values_come_from(tmp_path):
    path = tmp_path / "rig.toml"
    text = format_rig(load_rig("4recon"))
    note = '[calibration]\ndate = "2026-11-22"\nmethod = "joint"\nsd_deg = 0.01\nsd_mm = 0.5\n'
    path.write_text(text + note + "sd_ms = 0.1\n")
    rig = load_rig(path)

    assert rig.calibration.date == "2026-11-22"
    assert rig.calibration.sd_mm == 0.5
    path.write_text(format_rig(rig))
    assert load_rig(path).calibration == rig.calibration
