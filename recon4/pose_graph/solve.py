"""Pose graph optimization; the factors are those of gtsam (`factors`)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import PoseGraph, Relations
from recon4.pose_graph.priors import Kernel, Priors
from recon4.pose_graph.relations import squared_residuals
from recon4.pose_graph.tuning_solve import SOLVE, SolveTuning


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """Result of the optimization."""

    T_map_body: SE3
    """Poses of the nodes, a batch of N."""
    chi2: float
    """Sum of the squared residuals over edges used, without weights and kernel."""
    chi2_before: float
    """The same before the optimization."""
    edge_chi2: Array
    """Squared residual of each edge, also of those not used, (E,)."""
    weights: Array
    """Final weight of each edge, 0..1; 0 for edges not used, (E,)."""
    iterations: int
    converged: bool
    """Whether the cost no longer decreased before the limit of iterations."""
    outlier_limit: float | None = None
    """Squared residual beyond which a free edge has no weight; None = none is an outlier."""


def optimize(
    graph: PoseGraph,
    *,
    kernel: Kernel,
    fixed: Sequence[int] = (0,),
    priors: Sequence[Priors] = (),
    tuning: SolveTuning = SOLVE,
) -> Solution:
    """Optimize the poses by Levenberg-Marquardt, starting at the current ones.

    Args:
        graph: Edges with the verdict rejected are not used.
        kernel: ``cauchy`` limits the influence of gross errors of free edges and of positions.
        fixed: Rows of fixed nodes. Empty only if the priors fix the gauge.
        priors: Priors on poses and positions.
        tuning: When it ends.

    Raises:
        GraphError: If the graph cannot be solved (`checks`), or its gauge is free.
    """
    from recon4.pose_graph.factors import FactorProblem  # loads gtsam

    of = graph.relations
    problem = FactorProblem.check(graph.T_map_body, of, fixed=fixed, priors=priors)
    weights = of.in_graph.astype(np.float64)
    T_map_body, iterations = problem.solve(
        graph.T_map_body, weights=weights, kernel=kernel, tuning=tuning
    )
    solution = solved(graph, of, T_map_body, weights=weights, iterations=iterations)
    if kernel == "none":
        return solution
    softened = weights / (1.0 + solution.edge_chi2 / SOLVE.cauchy_sd**2)
    return replace(solution, weights=np.where(of.protected, weights, softened))


def solved(
    graph: PoseGraph, of: Relations, T_map_body: SE3, *, weights: Array, iterations: int
) -> Solution:
    """Make a `Solution` with its residuals."""
    edge_chi2 = squared_residuals(T_map_body, of)
    return Solution(
        T_map_body=T_map_body,
        chi2=float(edge_chi2[weights > 0.0].sum()),
        chi2_before=float(squared_residuals(graph.T_map_body, of)[of.in_graph].sum()),
        edge_chi2=edge_chi2,
        weights=weights,
        iterations=iterations,
        converged=iterations < SOLVE.max_iterations,
    )


def initialize(graph: PoseGraph) -> SE3:
    """Poses from the edges alone: chordal relaxation of the rotations, then the translations.

    For graphs whose poses are too wrong as a start (foreign files, odometry that lost tracking).

    Raises:
        GraphError: If the graph cannot be solved (`checks`).
    """
    from recon4.pose_graph.factors import FactorProblem  # loads gtsam

    of = graph.relations
    problem = FactorProblem.check(graph.T_map_body, of, fixed=(0,), priors=())
    T_free_body = problem.chordal(of.in_graph.astype(np.float64))
    return graph.T_map_body[0] @ T_free_body[0].inverse() @ T_free_body
