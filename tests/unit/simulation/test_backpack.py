"""The simulated Wuerzburg backpack: head motion, line timing, carrier, counts of L Table 1."""

import json
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3, so3_exp
from recon4.kernels.carrier import carrier_range
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.simulation.backpack import measured_seconds, prepare_backpack, simulate_backpack
from recon4.simulation.figures import FIGURES
from recon4.simulation.profiler import HeadModel


@pytest.fixture(scope="module")
def setup():
    return prepare_backpack("hall", seed=3, figure="circle", seconds=5.0)


def test_the_head_sweeps_back_and_forth_without_a_jump():
    head = HeadModel()
    t_s = np.arange(0.0, 24.0, 0.001)

    angle = head.angle_rad(t_s)

    assert np.isclose(angle.min(), -0.75 * np.pi, atol=1e-4)
    assert np.isclose(angle.max(), 0.75 * np.pi, atol=1e-4)
    assert np.isclose(head.angle_rad(np.array([6.0]))[0], 0.75 * np.pi)  # a sweep takes 6 s
    speed = np.diff(angle) / 0.001
    assert np.abs(np.diff(speed)).max() < 0.02  # brakes and starts, does not jump
    assert np.isclose(np.abs(speed).max(), 1.5 * np.pi / 5.7, atol=1e-3)


def test_a_shot_at_the_carrier_ends_at_his_surface():
    shot = np.zeros((3, 5))
    shot[1, 0] = np.pi  # away from him
    shot[2, 1] = np.deg2rad(80.0)  # above him
    carrier = np.array([1.0, 0.0, 0.25, -1.0, 0.2])
    out = np.empty(3)

    carrier_range(shot, np.eye(3), np.zeros(3), carrier, out)

    assert np.isclose(out[0], 0.75)
    assert np.isinf(out[1])
    assert np.isinf(out[2])


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_has_the_lines_and_points_of_the_table(name):
    figure = FIGURES[name]
    setup = prepare_backpack("hall", seed=1, figure=name)

    lines, _ = next(iter(measured_seconds(setup)))

    per_line = np.isfinite(lines.range_m).sum() / len(lines.t_ns)
    assert setup.walk.seconds == figure.seconds
    assert setup.profiler.model.lines_hz * figure.seconds == pytest.approx(figure.line_scans)
    assert per_line == pytest.approx(figure.points_per_line, rel=0.1)  # of one second only


def test_the_shots_of_a_line_hit_the_walls_from_the_pose_of_their_time(setup):
    lines, scans = next(iter(measured_seconds(setup)))
    model, sensor = setup.profiler.model, setup.profiler.sensor
    t_s = 1e-9 * lines.t_ns[:, None] + setup.profiler.shot_s * np.arange(model.shots)
    elevation = np.linspace(model.lowest_rad, model.highest_rad, model.shots)
    azimuth = model.head.angle_rad(t_s + setup.profiler.head_s)
    direction = np.stack(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth),
         np.broadcast_to(np.sin(elevation), azimuth.shape)], axis=-1,
    )  # fmt: skip
    p_sensor = lines.range_m[..., None] * direction
    seen = lines.range_m > 1.5
    T_map_body = setup.walk.poses(t_s[seen])

    p_map = T_map_body @ (sensor.T_body_sensor @ p_sensor[seen])

    distance = setup.surroundings.scene.distance(p_map)
    assert np.percentile(distance, 99) < 0.02
    assert len(scans) == 24


def test_the_carrier_is_seen_at_the_end_of_a_sweep(setup):
    nearest = [np.nanmin(lines.range_m) for lines, _ in measured_seconds(setup)]

    assert min(nearest) < 0.6
    assert max(nearest) > 1.5


def test_the_recording_holds_bag_truth_and_counts(setup, tmp_path):
    simulate_backpack(
        setup, tmp_path / "walk", progress=Silent(), degradations={"packet-loss": 0.3}
    )

    about = json.loads((tmp_path / "walk/world.json").read_text())
    truth = read_tum(tmp_path / "walk/truth.tum")
    ispace = read_tum(tmp_path / "walk/ispace.tum")
    away = SE3(ispace.T_a_b.R, ispace.T_a_b.t - truth.at(ispace.t_ns).t).t
    assert 200 < about["counts"]["line_scans"] < 480  # of 515, some are lost
    assert len(ispace) == 5 * 40 + 1
    assert 1e-6 < np.linalg.norm(away, axis=1).max() < 0.00026
    assert (tmp_path / "walk/rosbag2/metadata.yaml").is_file()


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"world": "hall", "figure": "star"}, "no figure named"),
        ({"world": "office", "figure": "eight"}, "no free floor"),
        ({"world": "hall", "seconds": 2.0}, "5 s to"),
    ],
)
def test_what_cannot_be_walked_is_refused(arguments, text):
    with pytest.raises(ConfigError, match=text):
        prepare_backpack(seed=1, **arguments)


def test_a_rig_of_lidars_is_refused():
    with pytest.raises(ConfigError, match="expected a profiler"):
        prepare_backpack("hall", seed=1, rig=load_rig("4recon"))


def test_a_2d_laser_upside_down_sweeps_the_other_way(setup):
    over = SE3(so3_exp(np.array([np.pi, 0.0, 0.0])), np.zeros(3))
    laser = setup.laser2d
    mount = replace(laser.sensor, T_body_sensor=laser.sensor.T_body_sensor @ over)
    said_upright = replace(laser, model=replace(laser.model, upside_down=True))
    said_as_it_is = replace(laser, sensor=mount)

    found, expected = (
        one.measure(range(20, 22), setup.walk, setup.surroundings, rng=np.random.default_rng(1))
        for one in (said_upright, said_as_it_is)
    )

    assert np.nanmedian(np.abs(found.range_m - expected.range_m)) < 0.02  # the noise differs
    upright = laser.measure(
        range(20, 22), setup.walk, setup.surroundings, rng=np.random.default_rng(1)
    )
    assert np.nanmedian(np.abs(found.range_m - upright.range_m)) > 0.1
