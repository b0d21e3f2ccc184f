"""Thickness of planar surfaces, with how much of the map is planar."""

import numpy as np
import pytest

from recon4.evaluation.thickness import plane_thickness
from tests.unit.slices.room_map import wall, write_map


@pytest.fixture
def rng():
    return np.random.default_rng(4)


def made(folder, p, offset_m=None):
    offset = np.zeros_like(p) if offset_m is None else offset_m
    return write_map(folder, p, raw_offset_m=offset)


def test_the_thickness_is_the_noise_across_a_wall(rng, tmp_path):
    p, _ = wall(rng, 60_000, x_m=1.05, sigma_m=0.012)

    found = plane_thickness(made(tmp_path / "map", p))

    assert found.p50_m == pytest.approx(0.012, rel=0.1)
    assert found.p50_m < found.p95_m < 0.02
    assert found.planar_coverage > 0.9


def test_fitted_points_are_thin_and_the_same_as_measured_thick(rng, tmp_path):
    p, _ = wall(rng, 60_000, x_m=1.05, sigma_m=0.001)
    offset = np.zeros_like(p)
    offset[:, 0] = 0.015 * rng.standard_normal(len(p))

    tiles = made(tmp_path / "map", p, offset)

    assert plane_thickness(tiles).p50_m == pytest.approx(0.001, rel=0.1)
    assert plane_thickness(tiles.as_measured()).p50_m == pytest.approx(0.015, rel=0.1)


def test_what_is_not_planar_lowers_the_coverage_only(rng, tmp_path):
    p, _ = wall(rng, 40_000, x_m=1.05, sigma_m=0.01)
    leaves = rng.uniform([2.0, 0.0, 0.0], [3.0, 2.0, 2.0], (200_000, 3))

    found = plane_thickness(made(tmp_path / "map", np.concatenate([p, leaves])))

    assert found.p50_m == pytest.approx(0.01, rel=0.1)
    assert 0.1 < found.planar_coverage < 0.5


def test_the_thickest_place_comes_first(rng, tmp_path):
    thin, _ = wall(rng, 40_000, x_m=1.05, sigma_m=0.005)
    thick, _ = wall(rng, 40_000, x_m=11.25, sigma_m=0.02)

    places = plane_thickness(made(tmp_path / "map", np.concatenate([thin, thick]))).thickest

    assert len(places) == 2
    assert places[0].middle_m[0] == pytest.approx(11.25, abs=0.02)
    assert places[0].p50_m > 3 * places[1].p50_m


def test_a_map_without_points_has_no_thickness(tmp_path):
    found = plane_thickness(made(tmp_path / "map", np.empty((0, 3))))

    assert (found.p50_m, found.p95_m, found.planar_coverage, found.thickest) == (None,) * 3 + ((),)
