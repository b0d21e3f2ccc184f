"""The noise of ranges by which surfaces are fitted."""

from dataclasses import replace

import numpy as np

from recon4.mapping.build import MapInputs, build_map, surface_noise_m
from recon4.model.rig import load_rig
from recon4.settings import MapSettings
from tests.room_walks import room_walk


def points_of(walk, folder, settings):
    folder.mkdir()
    tiles = build_map(MapInputs(walk, walk.trajectory), folder, settings=settings)
    return np.concatenate([tile.xyz_m() for tile in tiles])


def test_a_smaller_noise_of_ranges_smooths_a_noisy_floor_less(tmp_path):
    walk = room_walk(frames=8, points=5000, noise_m=0.01)
    off_m = []
    for noise_m in (0.015, 0.001):
        settings = MapSettings(voxel_m=0.02, range_noise_m=noise_m)
        xyz = points_of(walk, tmp_path / f"{noise_m}", settings)
        floor = (np.abs(xyz[:, 2] + 1.4) < 0.05) & (np.abs(xyz[:, :2]) < 2.0).all(axis=1)
        off_m.append(np.abs(xyz[floor, 2] + 1.4).mean())

    assert off_m[0] < 0.8 * off_m[1]


def test_the_noise_of_surfaces_is_that_of_the_least_exact_lidar_in_use():
    def noise_m(*models):
        sensor = load_rig("single-vlp16").sensors[0]
        used = [replace(sensor, model=model, enabled=model != "OS2-32") for model in models]
        return surface_noise_m(replace(load_rig("single-vlp16"), sensors=tuple(used)))

    assert noise_m("VLP-16") == noise_m("XT32") == noise_m("generic") == 0.015
    assert noise_m("Mid-360") == noise_m("XT32", "Mid-360", "OS2-32") == 0.02


def test_a_map_is_as_with_the_noise_of_its_lidar(tmp_path):
    walk = room_walk(frames=4, noise_m=0.01)
    sensors = tuple(replace(sensor, model="Mid-360") for sensor in walk.rig.sensors)
    walk = replace(walk, rig=replace(walk.rig, sensors=sensors))

    by_model, as_set, other = (
        points_of(walk, tmp_path / f"{noise_m}", MapSettings(range_noise_m=noise_m))
        for noise_m in (0.0, 0.02, 0.015)
    )

    np.testing.assert_array_equal(by_model, as_set)
    assert not np.array_equal(by_model, other)
