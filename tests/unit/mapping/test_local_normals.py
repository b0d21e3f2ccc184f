"""Normals from the moments of cells."""

import numpy as np
import pytest

from recon4.kernels.moments import smallest_eigenvector
from recon4.kernels.sorting import radix_sort
from recon4.mapping.normals import local_normals


@pytest.mark.parametrize("seed", range(20))
def test_the_closed_form_finds_the_eigenvector_of_lapack(seed):
    points = np.random.default_rng(seed).normal(size=(50, 3)) @ np.diag([1.0, 0.6, 0.05])
    points = points @ np.linalg.qr(np.random.default_rng(seed + 100).normal(size=(3, 3)))[0]
    c = np.cov(points.T)
    values, vectors = np.linalg.eigh(c)

    *found, small, middle, large = smallest_eigenvector(
        c[0, 0], c[1, 1], c[2, 2], c[0, 1], c[0, 2], c[1, 2], 1e-12
    )

    assert abs(np.array(found) @ vectors[:, 0]) == pytest.approx(1.0, abs=1e-9)
    assert (small, middle, large) == pytest.approx(values, rel=1e-6)


def test_a_tilted_plane_has_its_normal_everywhere():
    rng = np.random.default_rng(3)
    normal = np.array([1.0, 2.0, 2.0]) / 3.0
    u = np.cross(normal, [0, 0, 1.0])
    u /= np.linalg.norm(u)
    plane = rng.uniform(-1, 1, (40_000, 2)) @ np.stack([u, np.cross(normal, u)])

    found = local_normals((plane + 5.0).astype(np.float32), 0.1)

    assert np.abs(found.normal @ normal).min() > 0.999
    assert found.support.min() >= 6


def test_axis_parallel_planes_and_rotated_copies_have_equal_normals():
    rng = np.random.default_rng(4)
    flat = np.c_[rng.uniform(0, 1, (5000, 2)), np.zeros(5000)].astype(np.float32)

    for axes in ([0, 1, 2], [2, 0, 1], [1, 2, 0]):
        found = local_normals(np.ascontiguousarray(flat[:, axes]), 0.1)
        np.testing.assert_allclose(np.abs(found.normal[:, axes.index(2)]), 1.0, atol=1e-6)


def test_lines_single_points_and_nothing_have_no_normal():
    line = np.c_[np.linspace(0, 1, 200), np.zeros((200, 2))].astype(np.float32)

    assert not local_normals(line, 0.1).normal.any()
    assert not local_normals(np.full((50, 3), 2.0, np.float32), 0.1).normal.any()
    lonely = local_normals(np.array([[1.0, 2.0, 3.0]], np.float32), 0.1)
    assert not lonely.normal.any() and lonely.support.tolist() == [1]
    assert len(local_normals(np.empty((0, 3), np.float32), 0.1).normal) == 0


def test_support_counts_the_points_of_the_27_cells_around():
    xyz = np.array([[0.05, 0.05, 0.05], [0.15, 0.05, -0.05], [0.35, 0.05, 0.05]], np.float32)

    assert local_normals(xyz, 0.1).support.tolist() == [2, 2, 1]


def test_order_of_points_does_not_matter():
    rng = np.random.default_rng(5)
    xyz = rng.uniform(-1, 1, (5000, 3)).astype(np.float32)
    mixed = rng.permutation(5000)

    a, b = local_normals(xyz, 0.2), local_normals(xyz[mixed], 0.2)

    np.testing.assert_array_equal(a.support[mixed], b.support)
    np.testing.assert_allclose(np.abs(np.sum(a.normal[mixed] * b.normal, axis=1)), 1.0, atol=1e-3)


@pytest.mark.parametrize("bits", [1, 5, 11, 12, 33])
def test_radix_sort_agrees_with_numpy(bits):
    rng = np.random.default_rng(bits)
    keys = (rng.integers(0, 1 << bits, 3000) << 12) | np.arange(3000)

    found = radix_sort(keys.copy(), 12, 12 + bits, np.empty(3000, np.int64))

    np.testing.assert_array_equal(found, np.sort(keys))
