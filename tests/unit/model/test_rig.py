"""Rig files: valid ones are read exactly, invalid ones are rejected with the defect."""

import json

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.model.rig import format_rig, load_rig, parse_rig, rig_presets

ONE = '[[sensor]]\nname = "a"\n'


def test_the_shipped_rigs_can_be_read():
    assert {"4recon", "single-vlp16", "single-hdl32e"} <= set(rig_presets())

    for name in rig_presets():
        assert load_rig(name).sensors


def test_the_vertical_lidar_of_the_4recon_looks_across_the_walking_direction():
    rig = load_rig("4recon")
    T_body_vertical = rig.sensors[1].T_body_sensor

    spin_axis = T_body_vertical.R @ np.array([0.0, 0.0, 1.0])

    assert [s.name for s in rig.sensors] == ["horizontal", "vertical"]
    assert np.allclose(spin_axis, [1.0, 0.0, 0.0])
    assert np.allclose(T_body_vertical.t, [-0.12, 0.0, 0.0])
    assert len(rig.T_body_sensor) == 2


def test_angles_are_degrees_and_may_be_given_as_a_quaternion():
    by_angles = parse_rig(ONE + "rpy_deg = [0, 0, 90]", where="x").sensors[0]
    by_quaternion = parse_rig(
        ONE + "quat_xyzw = [0, 0, 0.7071067811865476, 0.7071067811865476]", where="x"
    ).sensors[0]

    assert np.allclose(by_angles.T_body_sensor.R, by_quaternion.T_body_sensor.R)
    assert np.allclose(by_angles.T_body_sensor @ np.array([1.0, 0, 0]), [0.0, 1.0, 0.0])


@pytest.mark.parametrize("name", ["4recon", "single-vlp16", "single-hdl32e", "wuerzburg"])
def test_a_rig_written_and_read_again_is_the_same(name):
    rig = load_rig(name)

    again = parse_rig(format_rig(rig), where="again")

    assert format_rig(again) == format_rig(parse_rig(format_rig(again), where="twice"))
    for before, after in zip(rig.sensors, again.sensors, strict=True):
        assert np.allclose(before.T_body_sensor.matrix(), after.T_body_sensor.matrix(), atol=1e-15)
        assert (before.name, before.model, before.port) == (after.name, after.model, after.port)
    assert np.allclose(rig.p_body_antenna, again.p_body_antenna)


def test_lever_arm_and_time_offsets_are_kept():
    text = ONE + "time_offset_s = 0.05\n[imu]\nxyz_m = [1, 2, 3]\ntime_offset_s = -0.01\n"

    rig = parse_rig(text + "[gnss]\nlever_arm_m = [0, 0, 0.5]\n", where="x")

    assert (rig.sensors[0].time_offset_s, rig.imu_time_offset_s) == (0.05, -0.01)
    assert isinstance(rig.T_body_imu, SE3)
    assert np.allclose(rig.T_body_imu.t, [1, 2, 3])
    assert np.allclose(rig.p_body_antenna, [0, 0, 0.5])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"x: a rig needs at least one \[\[sensor\]\]"),
        ("sensor = [", "x: not a TOML file"),
        (ONE + "tint = 1", r"x: sensor 0: unknown \['tint'\]; known: "),
        ('[[sensor]]\nname = "a"\nmodel = "VLP-17"', "model must be one of .*got 'VLP-17'"),
        ("[[sensor]]\nport = 1", "x: sensor 0: name must be a text, got None"),
        (ONE + ONE, "sensor names must differ"),
        (ONE + "xyz_m = [1, 2]", r"xyz_m must be 3 finite numbers, got \[1, 2\]"),
        (ONE + "xyz_m = [1, 2, nan]", "xyz_m must be 3 finite numbers"),
        (ONE + "xyz_m = [-120.0, 0, 0]", "x: sensor 0: xyz_m must be within 20 m.*millimeters"),
        (ONE + "[gnss]\nlever_arm_m = [0, 0, 450]", "x: gnss: lever_arm_m must be within 20 m"),
        (ONE + "rpy_deg = [0, 1.5707963, 0]", r"rpy_deg must be in degrees.*\[0.0, 90.0, 0.0\]"),
        (ONE + "[imu]\nrpy_deg = [-3.14159, 0, 0]", r"degrees.*\[-180.0, 0.0, 0.0\]"),
        (ONE + 'rpy_deg = ["a", 0, 0]', "rpy_deg must be 3 finite numbers"),
        (ONE + "quat_xyzw = [0, 0, 0, 2]", "quat_xyzw must have length 1"),
        (ONE + "time_offset_s = true", "time_offset_s must be a finite number, got True"),
        (ONE + "[gnss]\nlever = [0, 0, 0]", r"x: gnss: unknown \['lever'\]"),
        (ONE + "[imu]\nxyz_m = 1", "x: imu: xyz_m must be 3 finite numbers"),
        ("wheels = 4\n" + ONE, r"x: unknown \['wheels'\]"),
    ],
)
def test_an_invalid_rig_is_rejected_with_its_defect(text, message):
    with pytest.raises(ConfigError, match=message):
        parse_rig(text, where="x")


def test_an_unknown_rig_is_rejected_with_the_known_ones():
    with pytest.raises(ConfigError, match=r"no rig named '5recon'; shipped: .*4recon"):
        load_rig("5recon")


@pytest.mark.parametrize("name", ["../../pyproject", "../rigs/4recon", "", "\0", "x" * 5000])
def test_a_name_cannot_address_a_file_elsewhere(name):
    with pytest.raises(ConfigError, match="no rig named"):
        load_rig(name)


@pytest.mark.parametrize("name", ["\0.toml", "x" * 5000 + ".toml"])
def test_a_name_no_file_can_have_is_refused(name):
    with pytest.raises(ConfigError, match="cannot read rig file"):
        load_rig(name)


def test_a_rig_file_that_is_missing_or_not_text_is_refused(tmp_path):
    (tmp_path / "bad.toml").write_bytes(b"\xff\xfe\x00")

    for name in ("missing.toml", "bad.toml"):
        with pytest.raises(ConfigError, match=f"cannot read rig file {name}"):
            load_rig(tmp_path / name)


def test_a_name_cannot_add_to_the_file_it_is_written_into():
    name = 'a"\n[[sensor]]\nname = "b" \\ \x7f ä'
    quoted = json.dumps(name).replace("\x7f", "\\u007f")
    rig = parse_rig(f'name = {quoted}\n[[sensor]]\nname = "x"', where="x")
    again = parse_rig(format_rig(rig), where="x")
    assert again.name == name
    assert [sensor.name for sensor in again.sensors] == ["x"]


def test_the_wuerzburg_rig_has_a_profiler_and_a_2d_laser():
    rig = load_rig("wuerzburg")

    again = parse_rig(format_rig(rig), where="again")

    assert [s.kind for s in again.sensors] == ["laser2d", "profiler"]
    assert again.row_of("profiler") == 1
    assert again.row_of("lidar") is None
    assert again.sensors[1].head_topic == "/profiler/head"
    assert np.allclose(again.sensors[1].T_body_sensor.R @ [1.0, 0, 0], [-1.0, 0, 0])


def test_a_head_of_constant_rate_is_kept():
    rig = parse_rig(ONE + 'kind = "profiler"\nhead_rate_deg_s = -60', where="x")

    again = parse_rig(format_rig(rig), where="again").sensors[0]

    assert np.isclose(again.head_rate_rad_s, -np.pi / 3)
    assert again.model == "generic"


def test_a_rig_of_lidars_is_written_without_kinds():
    assert "kind" not in format_rig(load_rig("4recon"))


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ('kind = "sonar"', "kind must be one of"),
        ('kind = "profiler"\nmodel = "VLP-16"', "for a profiler"),
        ("head_rate_deg_s = 60", "only a profiler has a head"),
        ('kind = "profiler"\nhead_rate_deg_s = 9999', "within ±3600"),
    ],
)
def test_a_wrong_kind_or_head_is_refused(line, text):
    with pytest.raises(ConfigError, match=text):
        parse_rig(ONE + line, where="x")
