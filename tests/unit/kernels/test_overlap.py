import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.kernels.overlap import nearest_ranges
from recon4.registration.overlap import RangeImage, make_range_image, overlap
from recon4.registration.tuning import OverlapTuning

SETTINGS = OverlapTuning()


def sphere(range_m, count=200_000, seed=1):
    d = np.random.default_rng(seed).normal(size=(count, 3))
    return range_m * d / np.linalg.norm(d, axis=1, keepdims=True)


def ring_of(azimuth_deg, range_m, per_bin=6):
    """Points in the middle of a few bins at the horizon."""
    a = np.deg2rad(np.repeat(np.atleast_1d(azimuth_deg) + 1.0, per_bin))
    return range_m * np.stack([np.cos(a), np.sin(a), np.full(len(a), 0.01)], axis=1)


def test_a_bin_holds_its_smallest_range_and_one_with_few_points_is_empty():
    near, far = ring_of(0, 4.0, 1), ring_of(0, 9.0, 4)
    few = ring_of(40, 3.0, 4)

    buffer = nearest_ranges(np.concatenate([near, far, few]), 180, 90, 5)

    assert buffer.shape == (180, 90)
    assert buffer[90, 45] == pytest.approx(4.0, rel=1e-4)
    assert np.count_nonzero(buffer) == 1


def test_straight_up_is_in_the_last_row():
    buffer = nearest_ranges(np.tile([0.0, 0.0, 3.0], (5, 1)), 180, 90, 5)

    assert np.argwhere(buffer).tolist() == [[90, 89]]


def test_points_at_the_origin_have_no_direction():
    assert not nearest_ranges(np.zeros((10, 3)), 180, 90, 5).any()


def test_a_view_overlaps_itself():
    view = make_range_image(sphere(5.0), SETTINGS)

    assert (
        overlap(view, view, SE3.identity(), settings=SETTINGS) > 0.95
    )  # the bins at the poles are small


def test_what_is_behind_the_wall_does_not_overlap():
    inside, outside = (
        make_range_image(sphere(5.0), SETTINGS),
        make_range_image(sphere(12.0), SETTINGS),
    )

    assert overlap(inside, outside, SE3.identity(), settings=SETTINGS) == 0.0
    assert (
        overlap(outside, inside, SE3.identity(), settings=SETTINGS) > 0.95
    )  # the bins at the poles are small


@pytest.mark.parametrize(("range_m", "inside"), [(4.69, 1.0), (4.71, 0.0)])
def test_the_tolerance_is_a_tenth_and_thirty_centimeters(range_m, inside):
    # 4 m * (1 + 0.1) + 0.3 m = 4.70 m (Eq. 2.6 read as A0 no. 2)
    source = make_range_image(ring_of(0, 4.0), SETTINGS)
    target = make_range_image(ring_of(0, range_m), SETTINGS)

    assert overlap(source, target, SE3.identity(), settings=SETTINGS) == inside


def test_points_in_empty_bins_do_not_overlap():
    source = make_range_image(ring_of(0, 4.0), SETTINGS)
    target = make_range_image(np.concatenate([ring_of(0, 4.0), ring_of(90, 4.0)]), SETTINGS)

    assert overlap(source, target, SE3.identity(), settings=SETTINGS) == 0.5


def test_the_four_modes():
    # The source sees all four places, the target one of them.
    source = make_range_image(ring_of([0, 40, 80, 120], 4.0), SETTINGS)
    target = make_range_image(ring_of(0, 4.0), SETTINGS)

    found = {
        mode: overlap(source, target, SE3.identity(), settings=OverlapTuning(mode=mode))
        for mode in ("target", "source", "min", "harmonic")
    }

    assert found == {"target": 1.0, "source": 0.25, "min": 0.25, "harmonic": pytest.approx(0.4)}


def test_the_target_is_moved_into_the_source():
    source = make_range_image(ring_of(0, 4.0), SETTINGS)
    T_source_target = SE3.from_rpy(0, 0, np.pi / 2, t=[0.3, 0.0, 0.0])
    target = make_range_image(T_source_target.inverse() @ ring_of(0, 4.0), SETTINGS)

    assert overlap(source, target, T_source_target, settings=SETTINGS) == 1.0
    assert overlap(source, target, T_source_target.inverse(), settings=SETTINGS) == 0.0
    backward = OverlapTuning(mode="source")
    assert overlap(target, source, T_source_target.inverse(), settings=backward) == 1.0


def test_without_points_nothing_overlaps():
    empty = make_range_image(np.empty((0, 3)), SETTINGS)
    view = RangeImage(ring_of(0, 4.0), make_range_image(ring_of(0, 4.0), SETTINGS).nearest_m)

    assert overlap(view, empty, SE3.identity(), settings=SETTINGS) == 0.0
    assert overlap(empty, view, SE3.identity(), settings=SETTINGS) == 0.0
    assert overlap(empty, empty, SE3.identity(), settings=OverlapTuning(mode="harmonic")) == 0.0
