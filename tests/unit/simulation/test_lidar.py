from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.tuning import SURFACES
from recon4.model.rig import load_rig
from recon4.recording.packets.velodyne.models import MODELS
from recon4.simulation.lidar import LidarModel
from tests.unit.simulation.rooms import PERFECT, SENSOR, around, fire, still, straight, walls

TABLES = MODELS["VLP-16"]


def returns(shots):
    """Range [m], azimuth, elevation [rad], beam height [m] of the shots that came back."""
    hit = shots.distance > 0
    shape = shots.distance.shape
    return (
        0.002 * shots.distance[hit],
        shots.turn_rad[hit],
        np.broadcast_to(TABLES.elevation_rad, shape)[hit],
        np.broadcast_to(TABLES.height_m, shape)[hit],
    )


def test_a_wall_is_seen_at_the_range_geometry_says():
    shots = fire(PERFECT, walls(8.0), still())

    range_m, azimuth, elevation, _ = returns(shots)

    expected = 8.0 / (np.cos(elevation) * np.cos(azimuth))
    assert len(range_m) > 10_000
    assert np.abs(range_m - expected).max() <= 0.0011  # half a step of 2 mm, and float32


def test_beams_leave_the_sensor_at_their_own_heights():
    builder = MeshBuilder()
    builder.quad([-60, -60, 0], [120, 0, 0], [0, 120, 0], reflectivity=0.5)
    shots = fire(PERFECT, around(builder), still(height_m=1.5))

    range_m, _, elevation, height = returns(shots)

    # The beam one degree down would meet the floor beyond its edge.
    assert len(np.unique(elevation)) == 7
    expected = (1.5 + height) / np.sin(-elevation)
    near = range_m < 20.0
    assert np.abs(range_m - expected)[near].max() <= 0.0012


def test_every_shot_is_fired_at_its_own_time():
    shots = fire(PERFECT, walls(8.0), still(), packets=2)

    flat = shots.t_ns.reshape(-1, 16)

    assert np.all(np.diff(flat, axis=1) == 2_304)
    assert np.all(np.diff(flat[:, 0]) == 55_296)
    turned = np.diff(np.unwrap(shots.turn_rad.ravel())) / np.diff(1e-9 * shots.t_ns.ravel())
    np.testing.assert_allclose(turned, 20.0 * np.pi, rtol=1e-6)


def test_a_moving_sensor_sees_a_wall_come_nearer_within_a_revolution():
    speed = 1.4
    shots = fire(PERFECT, walls(8.0), straight(speed), packets=76)

    range_m, azimuth, elevation, _ = returns(shots)
    t_s = 1e-9 * shots.t_ns[shots.distance > 0]

    x_in_map = speed * t_s + range_m * np.cos(elevation) * np.cos(azimuth)
    frozen = speed * t_s[0] + range_m * np.cos(elevation) * np.cos(azimuth)
    assert np.abs(x_in_map - 8.0).max() < 0.002
    assert np.abs(frozen - 8.0).max() > 0.1


def test_the_mounting_turns_and_shifts_the_shots():
    vertical = load_rig("4recon").sensors[1]
    shots = fire(PERFECT, walls(8.0), still(), sensor=vertical)

    range_m, _, elevation, height = returns(shots)

    # The spin axis points ahead and the sensor sits 12 cm behind the body.
    expected = (8.12 - height) / np.sin(elevation)
    assert len(range_m) > 6_000
    np.testing.assert_allclose(range_m, expected, atol=0.0015)


def test_range_noise_has_the_stated_deviation_and_no_bias():
    model = replace(PERFECT, range_sd_m=0.015)
    shots = fire(model, walls(8.0), still())

    range_m, azimuth, elevation, _ = returns(shots)
    error = range_m - 8.0 / (np.cos(elevation) * np.cos(azimuth))

    assert abs(error.mean()) < 0.0005
    assert error.std() == pytest.approx(0.015, rel=0.03)


def test_edges_give_mixed_ranges_only_through_the_opening_of_the_beam():
    builder = MeshBuilder()
    builder.quad([3.0, -0.5, -5], [0, 1.0, 0], [0, 0, 10], reflectivity=0.5)
    builder.quad([3.4, -50, -50], [0, 100, 0], [0, 0, 100], reflectivity=0.5)
    scene = around(builder)

    def between(model):
        range_m, azimuth, elevation, _ = returns(fire(model, scene, still(), packets=300))
        depth = range_m * np.cos(elevation) * np.cos(azimuth)
        edge = np.abs(np.abs(3.0 * np.tan(azimuth)) - 0.5) < 0.02
        return np.mean((depth[edge] > 3.02) & (depth[edge] < 3.38))

    assert between(PERFECT) == 0.0
    assert 0.02 < between(replace(PERFECT, divergence_rad=0.003)) < 0.5


def test_dark_and_distant_surfaces_are_lost():
    model = replace(LidarModel(), carrier=False)

    def share(distance_m, reflectivity):
        shots = fire(model, walls(distance_m, reflectivity=reflectivity), still())
        ahead = np.cos(shots.turn_rad) > 0.97
        return np.mean(shots.distance[ahead] > 0)

    assert share(5.0, 0.1) > 0.98
    assert 0.2 < share(50.0, 0.1) < 0.6
    assert share(50.0, 0.8) > 0.95
    assert share(95.0, 0.05) < 0.1
    assert share(112.0, 0.9) == 0.0


def test_glass_answers_only_when_hit_squarely():
    shots = fire(PERFECT, walls(3.0, reflectivity=0.5 * SURFACES.glass), still())

    _, azimuth, elevation, _ = returns(shots)

    assert (np.cos(azimuth) * np.cos(elevation)).min() >= 0.95


def test_returns_nearer_than_the_sensor_can_measure_are_lost():
    near = fire(PERFECT, walls(0.3, half_width_m=0.1), still())
    assert np.count_nonzero(near.distance) == 0


def test_the_person_hides_what_is_in_front_of_the_vertical_sensor():
    vertical = load_rig("4recon").sensors[1]
    builder = MeshBuilder()
    builder.quad([-60, -60, 0], [120, 0, 0], [0, 120, 0], reflectivity=0.5)
    scene = around(builder)

    free = fire(PERFECT, scene, still(), sensor=vertical)
    carried = fire(replace(PERFECT, carrier=True), scene, still(), sensor=vertical)

    assert np.all(carried.distance[free.distance == 0] == 0)
    lost = (free.distance > 0) & (carried.distance == 0)
    elevation = np.broadcast_to(TABLES.elevation_rad, lost.shape)
    assert 0.02 < lost.sum() / np.count_nonzero(free.distance) < 0.4
    assert np.all(elevation[lost] > 0.0)  # its positive beams look forward


def test_intensity_tells_paint_from_plaster_and_falls_with_incidence():
    def seen(reflectivity):
        shots = fire(PERFECT, walls(4.0, reflectivity=reflectivity), still())
        square = shots.intensity[np.cos(shots.turn_rad) > 0.995]
        slanted = shots.intensity[np.abs(np.cos(shots.turn_rad) - 0.5) < 0.02]
        return np.median(square), np.median(slanted[slanted > 0])

    (dark, _), (plaster, slanted), (retro, _) = seen(0.12), seen(0.55), seen(2.2)

    assert dark < 0.3 * plaster
    assert slanted < 0.75 * plaster
    assert plaster < 101 < retro


def test_beams_differ_in_gain_and_the_truth_does_not():
    shots = fire(replace(PERFECT, gain_spread=0.25), walls(4.0), still())

    ahead = np.cos(shots.turn_rad[:, :, 0]) > 0.99
    means = shots.intensity[ahead].mean(axis=0)

    assert means.max() / means.min() > 1.2
    assert set(np.unique(shots.reflectivity[ahead])) == {50}


def test_the_truth_is_there_exactly_where_something_came_back():
    shots = fire(LidarModel(), walls(8.0), still())

    assert np.array_equal(shots.reflectivity > 0, shots.distance > 0)
    assert SENSOR.model == "VLP-16"
