"""Factors of beam, incidence and range from surfaces seen repeatedly."""

import numpy as np
import pytest

from recon4.intensity.surfaces import Observations, Surfaces, cells_of, learn_surfaces
from recon4.intensity.tuning import IntensityTuning
from recon4.kernels.intensity import surface_equations

SHAPE = (1, 4, 5, 6)
SETTINGS = IntensityTuning(min_count=2)


def made_up(points=40_000, cells=300, *, seed=3, interaction=None):
    """Observations with known factors; far surfaces are bright, so that plain means are wrong."""
    rng = np.random.default_rng(seed)
    parts = [np.exp(rng.uniform(-0.6, 0.6, size)) for size in SHAPE[1:]]
    factor = parts[0][:, None, None] * parts[1][:, None] * parts[2]
    if interaction is not None:
        factor[interaction] *= 1.5
    bright = rng.uniform(500.0, 3000.0, cells)
    order = np.argsort(np.argsort(bright))
    cell = rng.integers(0, cells, points)
    far = order[cell] * SHAPE[3] / cells + rng.uniform(-3, 3, points)
    bins = np.stack(
        [
            rng.integers(0, SHAPE[1], points),
            rng.integers(0, SHAPE[2], points),
            np.clip(far, 0, SHAPE[3] - 1).astype(int),
        ],
        axis=1,
    )
    x = rng.poisson(bright[cell] * factor[tuple(bins.T)])
    return Observations(cell.astype(np.int64), bins.astype(np.int32), x.astype(np.float32)), factor


def shape_of(factor):
    return factor / np.exp(np.log(factor).mean())


@pytest.mark.parametrize("interaction", [None, (1, 2, 3)])
def test_known_factors_are_estimated(interaction):
    seen, factor = made_up(interaction=interaction)

    found = learn_surfaces(seen, SHAPE, settings=SETTINGS)

    np.testing.assert_allclose(shape_of(found.factor[0]), shape_of(factor), rtol=0.02)
    assert found.count.sum() == len(seen)


def test_the_mean_of_all_stays_and_a_place_has_one_brightness():
    seen, _ = made_up()

    found = learn_surfaces(seen, SHAPE, settings=SETTINGS)

    normalized = seen.intensity / found.factor[0][tuple(seen.bins.T)]
    assert normalized.mean() == pytest.approx(seen.intensity.mean(), rel=1e-6)
    expected = found.brightness_of(seen.cell)
    assert np.abs(normalized / expected - 1).mean() < 0.05
    assert found.brightness_of(np.array([-5, 301])).tolist() == [0.0, 0.0]


def test_a_bin_with_few_points_keeps_the_product_of_its_factors():
    seen, _ = made_up(interaction=(1, 2, 3))

    bold, shy = (
        learn_surfaces(seen, SHAPE, settings=IntensityTuning(min_count=n)).factor[0]
        for n in (2, 100_000)
    )

    def excess(f):
        return f[1, 2, 3] * f[0, 0, 0] / (f[1, 0, 0] * f[0, 2, 3])

    assert excess(bold) > 1.2 * excess(shy)


def test_bins_without_points_are_like_their_neighbors():
    seen, _ = made_up()
    near = seen.bins[:, 2] < 4
    few = Observations(seen.cell[near], seen.bins[near], seen.intensity[near])

    found = learn_surfaces(few, SHAPE, settings=SETTINGS)

    np.testing.assert_allclose(found.factor[..., 4], found.factor[..., 5], rtol=1e-3)
    np.testing.assert_allclose(found.factor[..., 4], found.factor[..., 3], rtol=0.05)


@pytest.mark.parametrize("value", [None, 0.0])
def test_without_points_or_with_zeros_only_nothing_changes(value):
    count = 0 if value is None else 10
    seen = Observations(
        np.zeros(count, np.int64), np.zeros((count, 3), np.int32), np.zeros(count, np.float32)
    )

    found = learn_surfaces(seen, SHAPE, settings=SETTINGS)

    np.testing.assert_array_equal(found.factor, 1.0)
    assert isinstance(found, Surfaces)


def test_equations_are_the_derivatives_of_the_likelihood():
    seen, _ = made_up(points=400, cells=20)
    order = np.argsort(seen.cell, kind="stable")
    _, first = np.unique(seen.cell[order], return_index=True)
    starts = np.append(first, len(order))
    parameters = seen.bins[order] + np.array([0, 4, 9], np.int32)
    x = seen.intensity[order] / 1000
    theta = np.random.default_rng(0).normal(0, 0.2, 15)

    def likelihood(at):
        log_q = at[parameters].sum(axis=1)
        per_cell = np.add.reduceat(np.exp(log_q), starts[:-1])
        return (x * log_q).sum() - (np.add.reduceat(x, starts[:-1]) * np.log(per_cell)).sum()

    def gradient(at):
        H, g = np.zeros((15, 15)), np.zeros(15)
        surface_equations(starts, parameters, x, at, H, g)
        return g, H

    g, H = gradient(theta)
    step = 1e-5 * np.eye(15)
    numeric = [(likelihood(theta + e) - likelihood(theta - e)) / 2e-5 for e in step]
    np.testing.assert_allclose(g, numeric, atol=1e-5)
    numeric = [-(gradient(theta + e)[0] - gradient(theta - e)[0]) / 2e-5 for e in step]
    np.testing.assert_allclose(H, numeric, atol=1e-5)


def test_cells_are_cubes_of_the_map_also_below_zero():
    xyz = np.array([[0.1, 0.1, 0.1], [0.24, 0.2, 0.0], [0.26, 0.1, 0.1], [-0.1, 0.1, 0.1]])

    a, b, c, d = cells_of(xyz, 0.25)

    assert a == b
    assert len({a, c, d}) == 3
