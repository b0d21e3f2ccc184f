"""Density and sharpness of a map."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.evaluation.density import PlanePatch, patch_density, surface_density
from recon4.evaluation.sharpness import around, draw_places, sharpness, thin
from recon4.geometry.se3 import SE3, Array


def plane(n: int, *, size_m: float = 3.0, noise_m: float = 0.0, seed: int = 0) -> Array:
    rng = np.random.default_rng(seed)
    p = np.zeros((n, 3))
    p[:, :2] = rng.uniform(0, size_m, (n, 2))
    p[:, 2] = noise_m * rng.normal(size=n)
    return p


def some(points: Array, count: int) -> Array:
    return np.random.default_rng(0).permutation(points)[:count]


def test_points_on_a_patch_are_counted_by_hand() -> None:
    patch = PlanePatch(np.zeros(3), np.array([0.1, 0, 0]), np.array([0, 0.2, 0]), 0.01)
    points = np.array(
        [[0.05, 0.1, 0.0], [0.05, 0.1, 0.009], [0.05, 0.1, 0.02], [0.15, 0.1, 0], [0.05, -0.01, 0]]
    )

    found = patch_density([points[:2], points[2:]], patch)

    assert found.points == 2
    assert found.points_per_cm2 == pytest.approx(2 / 200)


def test_a_patch_turns_with_the_map() -> None:
    T_new_old = SE3.from_rpy(0.4, -0.7, 1.1, t=[3, 4, 5])
    patch = PlanePatch(np.array([1.0, 1, 0]), np.array([1.0, 0, 0]), np.array([0.3, 1, 0]))
    turned = PlanePatch(
        T_new_old @ patch.corner, T_new_old.R @ patch.side_u, T_new_old.R @ patch.side_v
    )

    there = patch_density([T_new_old @ plane(9000, noise_m=0.001)], turned)

    assert there.points == patch_density([plane(9000, noise_m=0.001)], patch).points
    assert there.points == pytest.approx(1000, rel=0.1)


def test_a_patch_without_area_is_refused() -> None:
    patch = PlanePatch(np.zeros(3), np.array([1.0, 0, 0]), np.array([2.0, 0, 0]))

    with pytest.raises(ConfigError, match="expected sides that span an area"):
        patch_density([], patch)


def test_surface_density_of_an_even_plane_is_points_over_area() -> None:
    points = plane(90_000)
    inside = points[np.all(np.abs(points[:, :2] - 1.5) < 1.0, axis=1)][:500]

    found = surface_density(np.array_split(points, 5), inside)

    assert found.median_per_cm2 == pytest.approx(1.0, rel=0.05)
    assert found.low_per_cm2 < found.median_per_cm2 < found.high_per_cm2


def test_thickness_of_a_noisy_plane_is_its_noise() -> None:
    points = plane(40_000, noise_m=0.015)

    found = sharpness(points, places=some(points, 500))

    assert found.plane_thickness_m == pytest.approx(0.015, rel=0.1)
    assert found.planar_places > 450


def test_entropy_of_a_gaussian_ball_is_the_textbook_formula() -> None:
    points = 0.02 * np.random.default_rng(0).normal(size=(20_000, 3))

    found = sharpness(points, places=points[:100], radius_m=1.0, voxel_m=1e-6)

    assert found.entropy == pytest.approx(1.5 * np.log(2 * np.pi * np.e * 0.02**2), abs=0.02)


def test_a_doubled_wall_is_less_sharp() -> None:
    single = plane(40_000, noise_m=0.01)
    double = np.concatenate(
        [plane(20_000, noise_m=0.01), plane(20_000, noise_m=0.01) + np.array([0, 0, 0.08])]
    )

    one = sharpness(single, places=some(single, 500))
    two = sharpness(double, places=some(double, 500))

    assert two.entropy > one.entropy + 0.5
    assert two.plane_thickness_m > 3 * one.plane_thickness_m


def test_the_same_seed_draws_the_same_places() -> None:
    points = plane(20_000, noise_m=0.01)

    first = draw_places([points], rng=np.random.default_rng(7), count=100)

    assert len(first) == 100
    assert first.tolist() == draw_places([points], rng=np.random.default_rng(7), count=100).tolist()


def test_only_points_near_a_place_are_kept_and_all_of_them() -> None:
    points = np.random.default_rng(0).uniform(-5, 5, (20_000, 3))
    places = points[:20]

    kept = np.concatenate(list(around(places, np.array_split(points, 3), radius_m=0.5)))

    distance = np.linalg.norm(points[:, None] - places[None], axis=2).min(axis=1)
    assert {tuple(p) for p in points[distance <= 0.5]} <= {tuple(p) for p in kept}
    assert len(kept) < 0.2 * len(points)


@pytest.mark.parametrize("points", [np.empty((0, 3)), np.zeros((5, 3)), np.eye(3) * 100])
def test_a_map_without_neighborhoods_has_no_figures(points: Array) -> None:
    found = sharpness(points, places=points[:2])

    assert np.isnan(found.entropy)
    assert found.places == 0


def test_thinning_keeps_the_first_point_of_each_voxel_over_chunks() -> None:
    chunks = [np.array([[0.01, 0, 0], [0.05, 0, 0]]), np.array([[0.02, 0, 0], [-0.05, 0, 0]])]

    kept = thin(chunks, voxel_m=0.1)

    assert kept.tolist() == [[0.01, 0, 0], [-0.05, 0, 0]]
