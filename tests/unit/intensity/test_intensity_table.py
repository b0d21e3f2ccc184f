"""Intensity normalization: V Eq. 2.17 in its standardizing form."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import ConfigError, StoreError
from recon4.geometry.se3 import SE3
from recon4.intensity.diagnostics import Diagnostics, spread
from recon4.intensity.normalize import (
    IntensitySample,
    add_sample,
    learn_intensity,
    sample_windows,
    write_intensity,
)
from recon4.intensity.table import table_of_sums
from recon4.intensity.tuning import INTENSITY_TABLE, IntensityTuning
from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.tile import normalized_intensity
from recon4.settings import MapSettings
from recon4.store.arrays import load_intensity_table, save_intensity_table
from tests.room_walks import Walk, room_walk

SETTINGS = IntensityTuning(max_range_m=10.0, min_count=10, min_contrast=0.0)
COARSE = IntensityTuning(max_range_m=10.0, min_count=20, range_bin_m=0.4, incidence_bin_deg=4.0)
GAINS = np.random.default_rng(9).uniform(0.6, 1.4, (2, 16))


def reflectivity(p_map):
    """Half of the stripes of half a meter reflect three times as much as the others."""
    return np.where((np.floor(2.0 * p_map).sum(axis=1)) % 2 == 0, 0.25, 0.75)


def law(p_map, sensor, ring, incidence_rad, range_m, rng):
    """Gain of the beam, cosine of the incidence, falling with range, noise of 3 %."""
    bright = 200.0 * reflectivity(p_map) * GAINS[sensor, ring]
    bright = bright * (0.3 + 0.7 * np.cos(incidence_rad)) / (1.0 + 0.15 * range_m)
    return np.clip(np.rint(bright * rng.normal(1.0, 0.03, len(p_map))), 0, 255)


def uniform(p_map, sensor, ring, incidence_rad, range_m, rng):
    return law(np.full_like(p_map, [0.6, 0.1, 0.1]), sensor, ring, incidence_rad, range_m, rng)


def sums_of(intensity, ring, incidence_deg, range_m, settings=SETTINGS, sensor=None):
    n = len(intensity)
    sums = np.zeros(
        (2, 16, int(90 / settings.incidence_bin_deg) + 1, int(10 / settings.range_bin_m), 3)
    )
    sample = IntensitySample(
        np.asarray(intensity, np.uint16),
        np.zeros(n, np.uint8) if sensor is None else np.asarray(sensor, np.uint8),
        np.broadcast_to(np.asarray(ring, np.uint8), n).copy(),
        np.broadcast_to(np.deg2rad(incidence_deg).astype(np.float32), n).copy(),
        np.broadcast_to(np.float32(range_m), n).copy(),
        np.zeros(n, np.int64),
    )
    add_sample(sums, sample, settings)
    return sums


def apply(table, intensity, ring, incidence_deg, range_m, sensor=0):
    n = len(intensity)
    columns = {
        "intensity": np.asarray(intensity, np.uint16),
        "sensor": np.full(n, sensor, np.uint8),
        "ring": np.full(n, ring, np.uint8),
        "incidence_rad": np.full(n, np.deg2rad(incidence_deg), np.float32),
        "range_m": np.full(n, range_m, np.float32),
    }
    return normalized_intensity(table, columns)


def test_two_bins_computed_by_hand():
    # Ring 0: 10 and 30 (mean 20, sigma 10). Ring 1: 60 and 100 (mean 80, sigma 20).
    # All: mean 50, sigma sqrt((40² + 20² + 10² + 50²) / 4) = 33.91.
    dark = sums_of([10, 30] * 10, 0, 20.5, 3.05)
    light = sums_of([60, 100] * 10, 1, 20.5, 3.05)

    table = table_of_sums(dark + light, settings=SETTINGS, largest=255.0)

    sigma = np.sqrt(1150.0)
    assert table.target_mean == 50.0
    assert table.target_std == pytest.approx(sigma)
    expected = [50 - sigma, 50 + sigma]
    np.testing.assert_allclose(apply(table, [10, 30], 0, 20.5, 3.05), expected, rtol=1e-5)
    np.testing.assert_allclose(apply(table, [60, 100], 1, 20.5, 3.05), expected, rtol=1e-5)


def test_a_bin_without_deviation_is_only_shifted():
    sums = sums_of([40] * 20, 0, 10, 2.0) + sums_of([0, 200] * 10, 1, 10, 2.0)

    table = table_of_sums(sums, settings=SETTINGS, largest=255.0)

    np.testing.assert_allclose(apply(table, [40, 50, 0], 0, 10, 2.0), [70, 80, 30], rtol=1e-5)


def test_a_bin_of_one_material_is_not_stretched_to_the_contrast_of_all():
    # All: 20 x 39, 20 x 41, 20 x 10, 20 x 70: mean 40, sigma 21.2; the bin itself has sigma 1.
    sums = sums_of([39, 41] * 20, 0, 10, 2.0) + sums_of([10, 70] * 20, 1, 10, 2.0)
    settings = IntensityTuning(max_range_m=10.0, min_count=10, min_contrast=0.5)

    table = table_of_sums(sums, settings=settings, largest=255.0)

    np.testing.assert_allclose(apply(table, [39, 41], 0, 10, 2.0), [38, 42], rtol=1e-5)


@pytest.mark.parametrize(("upper", "limit"), [("raw", 200.0), ("twice_mean", 100.0)])
def test_results_stay_between_zero_and_the_upper_limit(upper, limit):
    settings = IntensityTuning(max_range_m=10.0, min_count=10, min_contrast=0.0, upper=upper)
    sums = sums_of([20, 80] * 20, 0, 10, 2.0)

    table = table_of_sums(sums, settings=settings, largest=200.0)

    np.testing.assert_allclose(apply(table, [0, 255], 0, 10, 2.0), [0.0, limit])


def test_sparse_bins_take_the_next_coarser_one():
    near = sums_of([10, 20] * 10, 0, 10.5, 2.0)
    few = sums_of([200] * 5, 0, 12.5, 2.0)
    elsewhere = sums_of([100, 120] * 10, 3, 80.5, 9.0)

    table = table_of_sums(near + few + elsewhere, settings=SETTINGS, largest=255.0)

    own, merged = (0, 0, 10, 10), (0, 0, 12, 10)
    assert table.level[own] == 0 and table.mean[own] == 15.0
    assert table.level[merged] == 1 and table.mean[merged] == (20 * 15 + 5 * 200) / 25
    assert table.level[0, 0, 80, 40] == len(INTENSITY_TABLE.coarser) - 1
    assert table.level[0, 0, 10, 12] == 2
    assert table.level[1, 5, 10, 10] == len(INTENSITY_TABLE.coarser)
    assert table.mean[1, 5, 10, 10] == pytest.approx(table.target_mean)


def test_points_without_a_normal_have_bins_of_their_own():
    sums = sums_of([10, 20] * 10, 0, np.nan, 2.0) + sums_of([90, 100] * 10, 0, 10, 2.0)

    table = table_of_sums(sums, settings=SETTINGS, largest=255.0)

    assert table.mean[0, 0, -1, 10] == 15.0
    np.testing.assert_allclose(
        apply(table, [10, 20], 0, np.nan, 2.0), apply(table, [90, 100], 0, 10, 2.0), rtol=1e-5
    )


def test_channels_without_a_table_keep_their_raw_values():
    table = table_of_sums(sums_of([10, 20] * 10, 0, 10, 2.0), settings=SETTINGS, largest=99)

    np.testing.assert_array_equal(apply(table, [7, 50], 31, 10, 2.0), [7, 50])
    np.testing.assert_array_equal(apply(table, [7, 50], 0, 10, 2.0, sensor=5), [7, 50])


def test_ranges_and_angles_beyond_the_last_bin_belong_to_it():
    table = table_of_sums(sums_of([10, 20] * 10, 0, 90.0, 50.0), settings=SETTINGS, largest=255.0)

    assert table.level[0, 0, 89, 49] == 0


def test_two_sensors_with_the_same_ring_are_kept_apart():
    sums = sums_of([10, 20] * 10, 4, 10, 2.0) + sums_of([90, 100] * 10, 4, 10, 2.0, sensor=[1] * 20)

    table = table_of_sums(sums, settings=SETTINGS, largest=255.0)

    assert table.mean[0, 4, 10, 10] == 15.0 and table.mean[1, 4, 10, 10] == 95.0


def test_bins_remove_the_dependency_of_means_on_beam_range_and_incidence(tmp_path):
    walk = room_walk(frames=10, points=100_000, noise_m=0.005, intensity=law)

    write_intensity(walk, walk.trajectory, tmp_path, settings=replace(COARSE, method="bins"))

    shown = Diagnostics.load(tmp_path / "diagnostics.npz")
    for name in ("channel", "range", "incidence"):
        count = getattr(shown, f"{name}_count")
        before, after = getattr(shown, f"{name}_before"), getattr(shown, f"{name}_after")
        left = spread(count, after, min_count=2000) / spread(count, before, min_count=2000)
        assert left < 0.1, f"{name}: {left:.3f}"
    assert shown.channel_count.shape == (32,) and shown.incidence_deg[0] == 2.0


def on_carpet(p_map):
    """The floor and the ceiling of `room_walk` but for a border, where no cube meets a wall."""
    low, high = np.array([-2.5, -2.5]), np.array([4.5, 2.5])
    inside = ((p_map[:, :2] > low) & (p_map[:, :2] < high)).all(axis=1)
    return inside & (np.abs(p_map[:, 2] - 0.1) > 1.45)


def carpet(p_map, sensor, ring, incidence_rad, range_m, rng):
    """What is near is dark: a third of the walls."""
    places = np.where(on_carpet(p_map)[:, None], [0.6, 0.6, 0.1], [0.6, 0.1, 0.1])
    return law(places, sensor, ring, incidence_rad, range_m, rng)


def test_near_and_far_objects_are_not_mistaken_for_an_effect_of_range():
    walk = room_walk(frames=20, points=40_000, noise_m=0.005, intensity=carpet)

    _, by_surfaces = learn_intensity(walk, walk.trajectory, settings=COARSE)
    _, by_bins = learn_intensity(walk, walk.trajectory, settings=replace(COARSE, method="bins"))

    for name in ("channel", "range", "incidence"):
        count, same = (getattr(by_surfaces, f"{name}_same{end}") for end in ("_count", ""))
        raw, left = (deviation(curve, count) for curve in same)
        assert left < 0.12 * raw, f"{name}: {left:.3f} of {raw:.3f}"
        if name != "channel":
            assert left < 0.25 * deviation(getattr(by_bins, f"{name}_same")[1], count), name


def deviation(curve, count):
    used = count > 200
    middle = np.average(curve[used], weights=count[used])
    return np.sqrt(np.average((curve[used] - middle) ** 2, weights=count[used]))


def normalized_map(walk, table, folder):
    """Points of the walk's map with raw and normalized intensity."""
    folder.mkdir()
    settings = MapSettings(voxel_m=0.02, normal_cell_m=0.15, surface="raw")
    tiles = list(build_map(MapInputs(walk, walk.trajectory, table), folder, settings=settings))
    columns = [t.read(["intensity", "intensity_normalized"]) for t in tiles]
    fields = ("intensity", "intensity_normalized")
    values = [np.concatenate([c[field] for c in columns]).astype(float) for field in fields]
    return np.concatenate([t.xyz_m() for t in tiles]), *values


@pytest.mark.parametrize(("method", "low", "high"), [("surfaces", 2.75, 3.25), ("bins", 1.0, 2.6)])
def test_walls_with_three_times_the_reflectivity_become_three_times_as_bright(
    tmp_path, method, low, high
):
    walk = room_walk(frames=20, points=40_000, noise_m=0.005, intensity=carpet)
    table, _ = learn_intensity(walk, walk.trajectory, settings=replace(COARSE, method=method))

    xyz, _, normalized = normalized_map(walk, table, tmp_path / "map")

    walls = np.abs(xyz[:, 2] - 0.1) < 1.2
    assert low < normalized[walls].mean() / normalized[on_carpet(xyz)].mean() < high


def test_contrast_of_materials_grows_and_a_uniform_room_becomes_even(tmp_path):
    walks = {
        "striped": room_walk(frames=20, points=40_000, noise_m=0.005, intensity=law),
        "uniform": room_walk(frames=5, points=40_000, noise_m=0.005, intensity=uniform),
    }
    learned_from = walks["striped"]
    table, _ = learn_intensity(learned_from, learned_from.trajectory, settings=COARSE)
    figures = {name: normalized_map(walk, table, tmp_path / name) for name, walk in walks.items()}

    xyz, raw, normalized = figures["striped"]
    truth = reflectivity(xyz)
    assert np.corrcoef(truth, normalized)[0, 1] > np.corrcoef(truth, raw)[0, 1] + 0.1
    assert np.corrcoef(truth, normalized)[0, 1] > 0.9
    _, raw, normalized = figures["uniform"]
    assert normalized.std() < 0.5 * raw.std()
    assert raw.max() <= 255 and np.array_equal(raw, np.rint(raw))


def test_one_sensor_and_one_frame_are_enough():
    walk = room_walk(frames=1, points=5000, intensity=law, enabled=(True, False))

    table, shown = learn_intensity(walk, walk.trajectory, settings=SETTINGS)

    assert (table.level[1] == len(INTENSITY_TABLE.coarser)).all()
    assert (table.level[0] < len(INTENSITY_TABLE.coarser)).any()
    assert np.isfinite(shown.all_before).all()


def test_a_recording_without_points_is_rejected():
    walk = room_walk(frames=2)
    empty = Walk([f.take(slice(0, 0)) for f in walk.frames], walk.rig, walk.trajectory)

    with pytest.raises(ConfigError, match="no points to learn from"):
        learn_intensity(empty, walk.trajectory, settings=SETTINGS)
    with pytest.raises(ConfigError, match="no points to learn from"):
        learn_intensity(Walk([], walk.rig, walk.trajectory), walk.trajectory, settings=SETTINGS)


def test_a_table_is_saved_and_loaded(tmp_path):
    table = table_of_sums(sums_of([10, 20] * 10, 0, 10, 2.0), settings=SETTINGS, largest=255.0)

    save_intensity_table(tmp_path / "table.npz", table)
    again = load_intensity_table(tmp_path / "table.npz")

    np.testing.assert_array_equal(again.gain, table.gain)
    np.testing.assert_array_equal(again.offset, table.offset)
    assert (again.upper, again.range_bin_m) == (255.0, 0.2)
    (tmp_path / "table.npz").write_bytes(b"PK not a table")
    with pytest.raises(StoreError, match=r"table\.npz"):
        load_intensity_table(tmp_path / "table.npz")
    with pytest.raises(StoreError, match=r"gone\.npz"):
        load_intensity_table(tmp_path / "gone.npz")


@pytest.mark.parametrize("frames", [1, 5, 10, 99, 100, 101, 5000, 36_000])
def test_samples_lie_inside_the_walk_and_are_few(frames):
    windows = sample_windows(frames, 40)

    rows = [k for window in windows for k in window]
    assert min(rows) >= 0 and max(rows) < frames
    assert all(1 <= len(window) <= 10 for window in windows)
    assert len(windows) <= 40
    if frames >= 1000:
        assert max(rows) > 0.95 * frames


def test_rotating_the_world_changes_nothing():
    walk = room_walk(frames=20, points=5000, intensity=law)
    turned = Walk(walk.frames, walk.rig, walk.trajectory)
    T_world_map = SE3.from_rpy(0.0, 0.0, np.pi / 2, t=[1000.0, 2000.0, 30.0])
    turned.trajectory = type(walk.trajectory)(
        walk.trajectory.t_ns, T_world_map @ walk.trajectory.T_a_b
    )

    a, _ = learn_intensity(walk, walk.trajectory, settings=SETTINGS)
    b, _ = learn_intensity(turned, turned.trajectory, settings=SETTINGS)

    assert a.target_mean == b.target_mean
    both = (a.level <= 2) & (b.level <= 2)
    assert np.abs(a.mean - b.mean)[both].mean() < 1.0
