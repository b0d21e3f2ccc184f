"""Multiframes that do not observe the motion, among others that do."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from recon4.geometry.se3 import TRANSLATION, Array
from recon4.pose_graph.carried_motion import (
    CarriedMotion,
    bounds_by_neighbors,
    by_others,
    load_carried_motion,
)
from recon4.pose_graph.known_errors import KnownErrors
from recon4.pose_graph.tuning_solve import LONE
from recon4.pose_graph.uncertainty import PoseUncertainty, pose_uncertainty
from tests.unit.pose_graph.test_uncertainty import NOT_LONE, SURE, chain

COUNT = 40


def bounds(unseen: Sequence[int], *, lost: Sequence[int] = (), aside_m: float = 0.0) -> Array:
    """Of a body at 1 m/s, the 20th of whose multiframes at 10 Hz lies aside by ``aside_m``."""
    observed, followed = np.ones(COUNT, bool), np.ones(COUNT, bool)
    observed[[*unseen, *lost]], followed[list(lost)] = False, False
    p_m = 0.1 * np.arange(COUNT)[:, None] * [1.0, 0.0, 0.0]
    p_m[20, 1] += aside_m
    return bounds_by_neighbors(observed, followed, t_ns=100_000_000 * np.arange(COUNT), p_odom=p_m)


@pytest.mark.parametrize("aside_m", [0.0, 0.03])
def test_neighbors_bound_a_lone_multiframe_by_how_far_it_lies_aside(aside_m: float) -> None:
    found = bounds([20], aside_m=aside_m)

    assert np.flatnonzero(np.isfinite(found[:, 0, 0])).tolist() == [20]
    own_m = np.sqrt(found[20, 2, 2])
    assert 0.004 < own_m < 0.012
    expected = np.diag([0.0, aside_m**2, 0.0]) + own_m**2 * np.eye(3)
    np.testing.assert_allclose(found[20], expected, atol=1e-9)


def by_fine_steps(t_s: Array, p_m: Array, known: NDArray[np.bool_]) -> tuple[Array, Array]:
    """The same by covariances of positions, with accelerations of 5 ms in place of 0.1 s."""
    fine_s = np.arange(t_s[0], t_s[-1], 0.005) + 0.0025
    apart = np.abs(fine_s[:, None] - fine_s) / LONE.changes_s
    moved = 0.005 * np.maximum(t_s[:, None] - fine_s, 0.0)
    straight = np.stack([np.ones_like(t_s), t_s], axis=1)
    K = straight @ straight.T + LONE.speeds_up_m_s2**2 * moved @ np.exp(-apart) @ moved.T
    gain = K[:, known] @ np.linalg.inv(
        K[np.ix_(known, known)] + LONE.known_m**2 * np.eye(int(known.sum()))
    )
    return gain @ p_m[known], np.diag(K - gain @ K[known])


@pytest.mark.parametrize("unseen", [1, 2, 4, 8])
def test_the_path_by_others_is_that_of_an_acceleration_that_soon_changes(unseen: int) -> None:
    t_s = 0.1 * np.arange(30)
    p_m = np.outer(np.where(t_s > 1.2, 0.65 * (t_s - 1.2) ** 2, 0.0), [1.0, 0.0, -0.5])
    known = (t_s < 0.95) | (t_s > 0.95 + 0.1 * unseen)

    path, variance = by_others(t_s, p_m, known)

    expected, fine = by_fine_steps(t_s, p_m, known)
    np.testing.assert_allclose(path[~known], expected[~known], atol=0.002)
    np.testing.assert_allclose(np.sqrt(variance[~known]), np.sqrt(fine[~known]), rtol=0.15)


@pytest.mark.parametrize(
    ("unseen", "lost", "lone"),
    [
        ([20, 21], [], [20, 21]),
        (range(16, 24), [], list(range(16, 24))),
        (range(16, 26), [], []),  # too long: the local map no longer reaches across
        (range(1, COUNT, 2), [], []),  # now and then a tunnel seems to be observed
        ([0], [], []),
        ([COUNT - 1], [], []),
        ([20], [21], []),  # the doors of an elevator open
        ([20], [22], [20]),
    ],
)
def test_only_where_those_around_observe_the_motion(
    unseen: Sequence[int], lost: Sequence[int], lone: list[int]
) -> None:
    found = bounds(unseen, lost=lost)

    assert np.flatnonzero(np.isfinite(found[:, 0, 0])).tolist() == lone


def stated(bound_m: float) -> PoseUncertainty:
    """Of 14 nodes, the 8th of which observes no shift, and states 20 cm as its edge does."""
    graph = chain(14, sd=np.repeat([1e-3, 0.005], 3))
    wide = np.diag(np.repeat([1e-3, 0.2], 3) ** -2.0)
    edges = [e.evolve(information=wide) if e.i == 6 else e for e in graph.edges]
    bound, cov, observed = NOT_LONE.copy(), SURE.copy(), np.ones(14, bool)
    bound[7], observed[7] = bound_m**2 * np.eye(3), False
    cov[7, TRANSLATION, TRANSLATION] = 0.2**2 * np.eye(3)
    carried = CarriedMotion(np.zeros((14, 3, 3)), graph.T_map_body.R, observed, cov, bound)
    found = pose_uncertainty(replace(graph, edges=tuple(edges)), known=KnownErrors(carried=carried))
    assert found is not None
    return found


def test_the_error_of_a_lone_multiframe_does_not_add_up_along_the_walk() -> None:
    """One at a turn of a corridor stated 40 cm for itself and for all that came after it."""
    lone, unknown = stated(0.04), stated(np.nan)

    assert lone.sd_m[7] == pytest.approx(0.04, abs=0.01)
    assert max(lone.sd_m[6], lone.sd_m[8]) < 0.01
    assert min(unknown.sd_m[7], unknown.sd_m[8], unknown.sd_m[13]) > 0.15


def test_neighbors_that_say_less_than_the_filter_change_nothing() -> None:
    assert stated(0.5).sd_m[7] == pytest.approx(0.2, abs=0.03)


def test_lone_multiframes_are_found_in_an_odometry(tmp_path: Path) -> None:
    columns = {name: np.zeros(COUNT, bool) for name in ("lost", "bridged", "stationary")}
    weak_sd_m = np.full(COUNT, 0.004)
    weak_sd_m[20] = 100.0
    np.savez(
        tmp_path / "steps.npz",
        **columns,
        converged=np.ones(COUNT, bool),
        weak_sd_m=weak_sd_m,
        weak_motion_sd_m=np.zeros(COUNT),
        weak_direction=np.zeros((COUNT, 3)),
        piece=np.zeros(COUNT, np.int64),
        quat_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (COUNT, 1)),
        motion_cov=np.tile(np.eye(6), (COUNT, 1, 1)),
        t_mid_ns=100_000_000 * np.arange(COUNT),
        t_m=np.zeros((COUNT, 3)),
    )

    found = load_carried_motion(tmp_path)

    assert found is not None
    assert not found.observed[20]
    assert np.flatnonzero(np.isfinite(found.bounds[:, 0, 0])).tolist() == [20]
    assert found.observed_between(np.array([18, 20, 22])).all()
