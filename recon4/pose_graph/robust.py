"""The robust solve: truncated least squares, where every edge has the weight 0 or 1.

The cost is the sum of squared residuals, each limited to a maximum. It is not convex, so the solve
begins at several starting points and keeps the lowest cost.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import Flags, PoseGraph, Relations
from recon4.pose_graph.priors import Priors
from recon4.pose_graph.relations import squared_residuals
from recon4.pose_graph.solve import Solution, solved
from recon4.pose_graph.tuning_solve import GRADUAL, NEAR, ROBUST

if TYPE_CHECKING:
    from recon4.pose_graph.factors import FactorProblem


def optimize_gnc(
    graph: PoseGraph,
    *,
    fixed: Sequence[int] = (0,),
    priors: Sequence[Priors] = (),
    probability: float = 0.999,
) -> Solution:
    """Truncated least squares: poses, and weights that are 0 or 1.

    The first start is a Cauchy solve (with positions: the walk without its loops, aligned to them).
    If it rejects more than a few loops, further starts are tried: graduated non-convexity from the
    convex problem (Yang 2020, eqs. 12-14), and the odometry with only one of the largest groups of
    neighboring loops. The latter finds the correct solution if loops are few, isolated and mostly
    false. Protected edges always have the weight 1. The result is reproducible bit for bit.

    Args:
        graph: As for `solve.optimize`.
        fixed: As for `solve.optimize`.
        priors: As for `solve.optimize`.
        probability: Fraction of correct edges that are kept if their information is true.

    Raises:
        GraphError: As `solve.optimize`.
    """
    from recon4.pose_graph.factors import FactorProblem  # loads gtsam

    of = graph.relations
    problem = FactorProblem.check(graph.T_map_body, of, fixed=fixed, priors=priors)
    everything = of.in_graph.astype(np.float64)
    T_cauchy, _ = problem.solve(graph.T_map_body, weights=everything, kernel="cauchy", tuning=NEAR)
    chi2 = squared_residuals(T_cauchy, of)
    limit = outlier_limit(chi2[of.in_graph & ~of.protected], probability=probability)
    best, lowest = None, np.inf
    for T_start in _starts(problem, graph.T_map_body, T_cauchy, limit=limit):
        T_map_body, weights, used = _settle(problem, T_start, limit=limit)
        cost = _truncated_cost(of, squared_residuals(T_map_body, of), limit=limit)
        cost += problem.prior_chi2(T_map_body)
        if cost < lowest * (1.0 - 1e-9):
            best, lowest = (T_map_body, weights, used), cost
        if _is_plain(of, weights):
            break
    assert best is not None
    solution = solved(graph, of, best[0], weights=best[1], iterations=best[2])
    return replace(solution, outlier_limit=limit)


def outlier_limit(edge_chi2: Array, *, probability: float) -> float:
    """Squared residual beyond which an edge is an outlier.

    The chi-square quantile with six degrees of freedom, times the ratio of actual to stated
    variance of these edges (from their median, 1 to 10): registrations tend to be overconfident.
    """
    ratio = float(np.median(edge_chi2)) / _chi2_quantile(0.5) if len(edge_chi2) else 1.0
    return float(_chi2_quantile(probability) * np.clip(ratio, 1.0, ROBUST.max_noise))


def _chi2_quantile(probability: float) -> float:
    """With six degrees of freedom; as scipy.stats, which takes a second to import, computes it."""
    from scipy.special import gammaincinv

    return float(2.0 * gammaincinv(3.0, probability))


def _starts(
    problem: FactorProblem, T_map_body: SE3, T_cauchy: SE3, *, limit: float
) -> Iterator[SE3]:
    of = problem.of
    short = of.in_graph & (of.protected | (np.abs(of.j - of.i) < ROBUST.loop_nodes))
    if problem.positions:  # they constrain the walk without its loops, so this start is first
        yield problem.solve(T_map_body, weights=short.astype(np.float64))[0]
    yield T_cauchy
    yield _graduate(problem, T_map_body, limit=limit)
    for group in _groups(of, of.in_graph & ~short):
        weights = (short | group).astype(np.float64)
        yield problem.solve(T_map_body, weights=weights)[0]


def _graduate(problem: FactorProblem, T_map_body: SE3, *, limit: float) -> SE3:
    """Graduated non-convexity: from the convex problem to the truncated one, round by round."""
    of = problem.of
    free, weights, mu = of.in_graph & ~of.protected, of.in_graph.astype(np.float64), 0.0
    for _ in range(ROBUST.max_rounds):
        T_map_body, _ = problem.solve(T_map_body, weights=weights, tuning=GRADUAL)
        chi2 = squared_residuals(T_map_body, of)[free]
        largest = float(chi2.max(initial=0.0))
        mu = mu * ROBUST.step if mu else limit / max(2.0 * largest - limit, 1e-3 * limit)
        weights[free] = _truncated_weights(chi2, limit=limit, mu=mu)
        if np.all((weights < 1e-6) | (weights > 1.0 - 1e-6)):
            break
    return T_map_body


def _truncated_weights(chi2: Array, *, limit: float, mu: float) -> Array:
    """Weights of GNC with truncated least squares (Yang 2020, eq. 14)."""
    middle = np.sqrt(limit * mu * (mu + 1.0) / np.maximum(chi2, 1e-300)) - mu
    certain = np.where(chi2 <= limit * mu / (mu + 1.0), 1.0, middle)
    return np.where(chi2 >= limit * (mu + 1.0) / mu, 0.0, np.clip(certain, 0.0, 1.0))


def _settle(problem: FactorProblem, T_map_body: SE3, *, limit: float) -> tuple[SE3, Array, int]:
    """Solve with the edges below the limit until this set no longer changes."""
    of = problem.of
    weights, iterations = np.zeros(len(of)), 0
    for _ in range(ROBUST.max_settling):
        fits = of.in_graph & (of.protected | (squared_residuals(T_map_body, of) < limit))
        if np.array_equal(fits, weights > 0.0):
            break
        weights = fits.astype(np.float64)
        T_map_body, used = problem.solve(T_map_body, weights=weights)
        iterations = max(iterations, used)
    return T_map_body, weights, iterations


def _truncated_cost(of: Relations, chi2: Array, *, limit: float) -> float:
    used = np.where(of.protected, chi2, np.minimum(chi2, limit))
    return float(used[of.in_graph].sum())


def _is_plain(of: Relations, weights: Array) -> bool:
    """Whether nearly all loops are inliers, so that no other start can be better."""
    loops = of.in_graph & (np.abs(of.j - of.i) >= ROBUST.loop_nodes)
    return bool((loops & (weights == 0.0)).sum() <= ROBUST.few_outliers * loops.sum())


def _groups(of: Relations, loops: Flags) -> list[Flags]:
    """The largest groups of loops that join the same two stretches of the walk."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    rows = np.flatnonzero(loops)
    if len(rows) == 0:
        return []
    ends = np.stack([of.i[rows], of.j[rows]], 1)
    near = cKDTree(ends).query_pairs(ROBUST.group_nodes, p=np.inf, output_type="ndarray")
    links = coo_array((np.ones(len(near)), (near[:, 0], near[:, 1])), shape=(len(rows), len(rows)))
    _, label = connected_components(links, directed=False)
    size = np.bincount(label)
    largest = np.argsort(-size, kind="stable")[: ROBUST.max_groups]
    groups = []
    for group in largest[2 * size[largest] >= size.max()]:
        chosen = np.zeros(len(of), dtype=np.bool_)
        chosen[rows[label == group]] = True
        groups.append(chosen)
    return groups
