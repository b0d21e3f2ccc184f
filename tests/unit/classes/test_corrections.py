"""Corrections of classes follow their points into another map, or do not apply."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.classes.corrections import CountedPoints, correction_of, place_correction
from recon4.geometry.se3 import SE3
from recon4.model.class_corrections import Reclassified
from recon4.model.classes import PointClass
from recon4.model.trajectory import Trajectory
from recon4.model.volumes import Box, contains
from recon4.review.decisions import StandingCorrection, correction_id
from recon4.workflows.corrected_classes import corrected, corrections_in
from tests.project_builder import loop_walk

BOX = Box(center_m=(4.0, 1.0, 1.5), size_m=(1.0, 0.02, 2.0))


def a_correction(walk):
    t_ns = walk.t_ns[[20, 30, 300, 310]]  # two visits
    counted = CountedPoints({1: 40}, {1: 40}, t_ns, 0.0)
    what = Reclassified(volume=BOX, to=int(PointClass.MOVING))
    return correction_of(what, counted, walk, map_key="ab")


def bent(walk, shift_m):
    """The second half of a walk elsewhere."""
    t = walk.T_a_b.t + np.linspace(0.0, 1.0, len(walk))[:, None].round() * shift_m
    return Trajectory(walk.t_ns, SE3(walk.T_a_b.R, t))


def test_in_the_same_map_a_volume_stays_where_it_is_bit_by_bit():
    walk = loop_walk()

    placed = place_correction(a_correction(walk), walk)

    assert placed.what.volume == BOX
    assert placed.moved_m < 1e-9


def test_a_volume_follows_points_that_moved_together():
    walk = loop_walk()
    T = SE3.from_rpy(0.01, 0.0, 2.0, t=[500.0, 40.0, -3.0])
    rng = np.random.default_rng(1)
    p = np.array(BOX.center_m) + rng.uniform(-1.0, 1.0, (2000, 3)) * [1.0, 0.02, 2.0]

    placed = place_correction(a_correction(walk), Trajectory(walk.t_ns, T @ walk.T_a_b))

    assert placed.moved_m > 400.0
    np.testing.assert_array_equal(contains(placed.what.volume, T @ p), contains(BOX, p))


@pytest.mark.parametrize(("shift_m", "applies"), [(0.05, True), (0.4, False)])
def test_a_volume_whose_points_moved_apart_does_not_apply(shift_m, applies):
    walk = loop_walk()

    placed = place_correction(a_correction(walk), bent(walk, np.array([0.0, shift_m, 0.0])))

    assert (placed.what is not None) == applies
    assert placed.apart_m == pytest.approx(shift_m / 2.0, abs=0.01)


def test_a_correction_of_times_that_are_gone_does_not_apply_and_is_counted_as_such():
    walk = loop_walk()
    one = a_correction(walk)
    other = replace(one, points=7)
    standing = [
        StandingCorrection(id=correction_id(c), correction=c, who="Eva", why="", time="2026")
        for c in (one, other)
    ]
    short = Trajectory(walk.t_ns[:200], walk.T_a_b[slice(0, 200)])

    gone = corrected(corrections_in(standing, short), ())
    there = corrected(corrections_in(standing, walk), (40, 0))

    assert corrections_in(standing, short).volumes is None
    assert [(c.applied, c.points, c.moved_m) for c in gone] == [(False, 0, None)] * 2
    assert [(c.applied, c.points, c.points_then) for c in there] == [(True, 40, 40), (True, 0, 7)]
