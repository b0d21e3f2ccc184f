"""Volumes in a map: which points they contain, and how they are led into another map."""

import math

import msgspec
import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.model.volumes import Box, Brush, Prism, Sphere, Volume, bounds_of, contains, moved

LEVEL = {"u": (1.0, 0.0, 0.0), "v": (0.0, 1.0, 0.0)}
TURNED = {"u": (0.6, 0.8, 0.0), "v": (-0.8, 0.6, 0.0)}
VOLUMES = [
    Box(center_m=(1.0, 2.0, 3.0), size_m=(2.0, 4.0, 1.0), **TURNED),
    Sphere(center_m=(1.0, 2.0, 3.0), radius_m=1.5),
    Prism(
        origin_m=(1.0, 2.0, 3.0),
        u=(0.6, 0.8, 0.0),
        v=(0.0, 0.0, 1.0),
        polygon_m=((-1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (0.0, 0.0), (-1.0, 1.0)),
        low_m=-0.5,
        high_m=1.0,
    ),
    Brush(path_m=((1.0, 2.0, 3.0), (2.0, 3.0, 3.0), (4.0, 0.0, 1.0)), radius_m=1.2),
    Brush(
        path_m=((1.0, 2.0, 3.0), (1.6, 2.8, 4.0), (1.6, 2.8, 4.0)),
        radius_m=1.4,
        across=(0.8, -0.6, 0.0),
        thick_m=2.0,
    ),
]


def test_a_turned_box_has_what_its_edges_enclose():
    box = VOLUMES[0]
    u, v, w = np.array([box.u, box.v, (0.0, 0.0, 1.0)])
    ends = [(0.99, 1.99, 0.49), (1.01, 0.0, 0.0), (0.0, 2.01, 0.0), (0.0, 0.0, -0.51)]

    p = np.array([np.array(box.center_m) + a * u + b * v + c * w for a, b, c in ends])

    assert contains(box, p).tolist() == [True, False, False, False]


def test_a_prism_has_what_its_polygon_encloses_as_far_as_its_ends():
    prism = VOLUMES[2]
    normal = np.cross(prism.u, prism.v)
    places = [(-0.9, 0.9, 0.0), (0.5, 0.2, 0.9), (0.0, 0.2, 0.0), (0.5, -0.5, -0.6)]

    p = np.array(prism.origin_m) + np.array(places) @ np.array([prism.u, prism.v, normal])

    assert contains(prism, p).tolist() == [True, True, False, False]


def test_a_brush_paints_along_its_path_but_not_from_one_surface_to_another():
    path = ((0.0, 0.0, 0.0), (0.0, 0.18, 0.0), (0.0, 0.18, 2.0))
    p = np.array([[0.09, 0.09, 0.0], [0.0, 0.18, 1.0], [0.0, 0.1, 2.04], [0.06, -0.09, 0.0]])

    painted = contains(Brush(path_m=path, radius_m=0.1), p)

    assert painted.tolist() == [True, False, True, False]


def test_a_brush_on_a_slice_is_as_deep_as_it():
    brush = Brush(path_m=((1.0, 2.0, 1.5),), radius_m=0.3, across=(0.0, 0.0, 1.0), thick_m=0.5)
    p = np.array([[1.29, 2.0, 1.74], [1.0, 2.0, 1.76], [1.31, 2.0, 1.5], [1.0, 1.71, 1.26]])

    assert contains(brush, p).tolist() == [True, False, False, True]


@pytest.mark.parametrize("volume", VOLUMES)
def test_a_volume_in_another_map_has_the_same_points(volume):
    rng = np.random.default_rng(3)
    p = rng.uniform(-2.0, 6.0, (4000, 3))
    T = SE3.from_rpy(0.2, -0.1, 1.3, t=[100.0, -20.0, 3.0])
    inside = contains(volume, p)

    after = moved(volume, T)

    assert 20 < inside.sum() < 2000
    np.testing.assert_array_equal(contains(after, T @ p), inside)
    low, high = bounds_of(volume)
    assert np.all(p[inside] >= low) and np.all(p[inside] <= high)
    assert msgspec.convert(msgspec.to_builtins(after), Volume) == after


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda: Box(center_m=(0.0, math.nan, 0.0), size_m=(1.0, 1.0, 1.0)), "finite"),
        (lambda: Box(center_m=(0.0, 0.0, 0.0), size_m=(1.0, 0.0, 1.0)), "not empty"),
        (lambda: Box(center_m=(0.0,) * 3, size_m=(1.0,) * 3, u=(1.0, 1.0, 0.0)), "right angle"),
        (lambda: Sphere(center_m=(0.0, 0.0, 0.0), radius_m=math.inf), "not empty"),
        (lambda: Sphere(center_m=(1e9, 0.0, 0.0), radius_m=1.0), "finite"),
        (lambda: Prism(polygon_m=((0.0, 0.0), (1.0, 0.0)), low_m=0.0, high_m=1.0), "3 to 500"),
        (
            lambda: Prism(
                polygon_m=((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)), low_m=0.0, high_m=1.0
            ),
            "do not cross",
        ),
        (
            lambda: Prism(polygon_m=((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), low_m=0.0, high_m=1.0),
            "do not cross",
        ),
        (lambda: Brush(path_m=(), radius_m=0.1), "1 to 2000 places"),
        (lambda: Brush(path_m=((0.0, 0.0, 0.0),), radius_m=0.0), "not empty"),
        (lambda: Brush(path_m=((0.0,) * 3,), radius_m=0.1, thick_m=1.0), "on a slice"),
        (
            lambda: Brush(path_m=((0.0,) * 3,), radius_m=0.1, across=(0.0, 0.0, 0.0), thick_m=1.0),
            "length 1",
        ),
        (
            lambda: Prism(polygon_m=((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)), low_m=1.0, high_m=1.0),
            "not empty",
        ),
    ],
)
def test_what_is_no_volume_is_refused_with_the_reason(make, why):
    with pytest.raises(ConfigError, match=why):
        make()
