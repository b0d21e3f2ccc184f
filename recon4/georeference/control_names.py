"""Exchanged names of surveyed points: which explain what contradicts, and which no test would see.

Two points i and j with each other's name lie at ``p_i``, ``p_j`` in the map and were surveyed at
``s_j``, ``s_i``. Where the others place the map, ``p_i - T s_j`` and ``p_j - T s_i`` vanish. An
exchange that a turn of the map hides, or of points that are nearer than an error that is found,
fits as well as the true names do: data snooping cannot see it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from recon4.errors import GeoreferenceError
from recon4.geometry.se3 import Array
from recon4.georeference.control_fit import (
    ControlFit,
    MeasuredTarget,
    fit_control,
    snoop,
    with_sites,
)
from recon4.georeference.tuning_control import BLUNDERS, CONTROL_FIT

Pair = tuple[int, int]


def exchanged_pair(
    targets: Sequence[MeasuredTarget], fit: ControlFit, *, leveled: bool
) -> tuple[ControlFit, Pair] | None:
    """The two points whose exchange takes all contradictions away, and the fit then.

    Args:
        targets: Control points.
        fit: Of them with the names of the survey.
        leveled: Whether the map's z axis is vertical.

    Returns:
        The exchange that fits best; None if the survey does not contradict itself, if no exchange
        explains it, or if another one explains it as well.
    """
    # Two wrong points hide each other from the tests of single ones, not from the whole misfit.
    large = fit.rmse_m >= BLUNDERS.least_m or fit.sd0 > BLUNDERS.contradicting
    if fit.worst is None and not large:
        return None
    order = sorted(range(len(targets)), key=lambda k: -fit.tests[k].w)[: BLUNDERS.pairs]
    pairs = combinations(sorted(order), 2)
    passed = [
        (tried, pair)
        for pair, tried in _exchanges(targets, pairs, leveled=leveled)
        if _explains(tried, fit, targets)
    ]
    passed.sort(key=lambda one: one[0].rmse_m)
    if not passed or (len(passed) > 1 and _alike(passed[1][0], passed[0][0])):
        return None
    # A single blunder leaves all others in place: an exchange has to explain as much.
    single, failed = snoop(targets, leveled=leveled)
    return None if len(failed) == 1 and not _alike(passed[0][0], single) else passed[0]


def _explains(tried: ControlFit, fit: ControlFit, targets: Sequence[MeasuredTarget]) -> bool:
    """Whether an exchange fits where the survey does not: far better, or without a failed test."""
    extent_m = float(np.linalg.norm(np.ptp([one.p_map for one in targets], axis=0)))
    if tried.rmse_m > min(BLUNDERS.most_m, 0.05 * extent_m):
        return False
    if fit.rmse_m >= BLUNDERS.least_m:
        return tried.rmse_m**2 < BLUNDERS.better * fit.rmse_m**2
    return tried.worst is None and not _alike(fit, tried)


def _alike(one: ControlFit, better: ControlFit) -> bool:
    """Whether a fit is about as good as a better one."""
    return one.rmse_m < BLUNDERS.other * better.rmse_m


def unseen_exchanges(
    targets: Sequence[MeasuredTarget], fit: ControlFit, *, leveled: bool
) -> list[Pair]:
    """Pairs whose names could be exchanged without any test failing.

    Points that many others control are looked at only if an error of half their distance, which
    both points share, is not found.

    Args:
        targets: Control points.
        fit: Of them, which no point contradicts.
        leveled: Whether the map's z axis is vertical.
    """
    if fit.worst is not None:
        return []
    few = len(targets) <= CONTROL_FIT.few_points
    found_m = np.array([test.least_found_m for test in fit.tests])
    p = np.array([one.p_map for one in targets])
    near = [
        (i, j)
        for i, j in combinations(range(len(targets)), 2)
        if few or np.linalg.norm(p[i] - p[j]) < 2.0 * max(found_m[i], found_m[j])
    ]
    return [
        pair
        for pair, tried in _exchanges(targets, near[: CONTROL_FIT.most_pairs], leveled=leveled)
        if tried.worst is None and tried.rmse_m < BLUNDERS.least_m
    ]


def exchanged_among(p_site: Array, off_m: Array, suspects: Sequence[int]) -> list[Pair]:
    """Pairs of points that lie where the other was surveyed.

    Args:
        p_site: Surveyed places [m], (N, 3).
        off_m: Map minus survey [m], (N, 3), where points that agree placed the map; NaN = not
            measured.
        suspects: Rows of points that contradict the others.
    """
    free, found = list(suspects), list[Pair]()
    for i, j in combinations(suspects, 2):
        apart = p_site[i] - p_site[j]
        own = np.nan_to_num(np.concatenate([off_m[i], off_m[j]]))
        other = np.nan_to_num(np.concatenate([off_m[i] + apart, off_m[j] - apart]))
        before, after = float(np.linalg.norm(own)), float(np.linalg.norm(other))
        explains = after**2 < BLUNDERS.better * before**2 and after < BLUNDERS.check_m
        if explains and i in free and j in free:
            found.append((i, j))
            free = [k for k in free if k not in (i, j)]
    return found


def _exchanges(
    targets: Sequence[MeasuredTarget], pairs: Sequence[Pair] | Iterator[Pair], *, leveled: bool
) -> Iterator[tuple[Pair, ControlFit]]:
    """Fits with the names of two points exchanged; those that place no map are left out."""
    for i, j in pairs:
        p_site = np.array([one.p_site for one in targets])
        p_site[[i, j]] = p_site[[j, i]]
        try:
            yield (i, j), fit_control(with_sites(targets, p_site), leveled=leveled)
        except GeoreferenceError:
            continue
