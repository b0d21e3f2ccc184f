"""Pose graph optimization. The only module that uses gtsam."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import gtsam
import numpy as np

from recon4.errors import GraphError
from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import PoseGraph, Relations, Rows
from recon4.pose_graph.checks import check_relations
from recon4.pose_graph.relations import squared_residuals
from recon4.pose_graph.tuning_solve import SOLVE

Kernel = Literal["none", "cauchy"]


@dataclass(frozen=True, slots=True, eq=False)
class PosePriors:
    """Priors on poses of nodes."""

    node: Rows
    """Rows of the nodes, (M,)."""
    T_map_body: SE3
    """Their poses, a batch of M."""
    information: Array
    """Inverse covariance of the tangent in the body, rotation first, (M, 6, 6)."""


@dataclass(frozen=True, slots=True, eq=False)
class PositionPriors:
    """Priors on positions of a point of the body, for example of a GNSS antenna."""

    node: Rows
    """Rows of the nodes, (M,)."""
    p_map: Array
    """Measured positions [m], (M, 3)."""
    p_body: Array
    """Measured point in the body (lever arm) [m], (M, 3)."""
    sd_m: Array
    """Standard deviations along the axes of the map [m], (M, 3)."""


Priors = PosePriors | PositionPriors


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
) -> Solution:
    """Optimize the poses by Levenberg-Marquardt, starting at the current ones.

    Args:
        graph: Edges with the verdict rejected are not used.
        kernel: ``cauchy`` limits the influence of gross errors of free edges and of positions.
        fixed: Rows of fixed nodes. Empty only if the priors fix the gauge.
        priors: Priors on poses and positions.

    Raises:
        GraphError: If the graph cannot be solved (`checks`), or its gauge is free.
    """
    of = graph.relations
    problem = FactorProblem.check(graph.T_map_body, of, fixed=fixed, priors=priors)
    weights = of.in_graph.astype(np.float64)
    T_map_body, iterations = problem.solve(graph.T_map_body, weights=weights, kernel=kernel)
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
    of = graph.relations
    problem = FactorProblem.check(graph.T_map_body, of, fixed=(0,), priors=())
    factors = problem.factors(of.in_graph.astype(np.float64), kernel="none")
    # The chordal method requires a prior as its anchor; it is the last factor of the graph.
    values = gtsam.InitializePose3.initialize(factors)
    T_free_body = _poses(values, len(graph))
    return graph.T_map_body[0] @ T_free_body[0].inverse() @ T_free_body


@dataclass(frozen=True, slots=True, eq=False)
class FactorProblem:
    """A checked graph as gtsam objects; built once, solved with changing weights."""

    of: Relations
    measured: list[Any]
    """``gtsam.Pose3`` of each edge."""
    always: list[Any]
    """Factors of fixed nodes and poses."""
    positions: list[tuple[int, Array, Array, Array]]
    """Node, position, lever arm, standard deviations."""
    nodes: int

    @staticmethod
    def check(
        T_map_body: SE3, of: Relations, *, fixed: Sequence[int], priors: Sequence[Priors]
    ) -> FactorProblem:
        check_relations(T_map_body, of)
        if not len(fixed) and not priors:
            raise GraphError("the gauge is free: expected a fixed node or a prior, got none")
        best = float(of.information[of.in_graph].max(initial=1.0))
        always = [
            gtsam.PriorFactorPose3(int(node), _pose(T_map_body, node), _gauge(best))
            for node in fixed
        ]
        positions = []
        for prior in priors:
            _check_prior(prior, nodes=len(T_map_body))
            if isinstance(prior, PosePriors):
                always += _pose_factors(prior)
            else:
                rows = zip(prior.node, prior.p_map, prior.p_body, prior.sd_m, strict=True)
                positions += [(int(node), *row) for node, *row in rows]
        measured = [_pose(of.T_i_j, row) for row in range(len(of))]
        return FactorProblem(of, measured, always, positions, len(T_map_body))

    def solve(
        self,
        T_map_body: SE3,
        *,
        weights: Array,
        kernel: Kernel = "none",
        max_iterations: int = SOLVE.max_iterations,
    ) -> tuple[SE3, int]:
        """Optimize from ``T_map_body``; returns the poses and the number of iterations.

        Args:
            T_map_body: Initial poses.
            weights: Factor on the information of each edge, (E,); 0 = not used.
            kernel: As in `optimize`.
            max_iterations: Limit of iterations.

        Raises:
            GraphError: If a number is not finite.
        """
        values = self._values(T_map_body)
        parameters = gtsam.LevenbergMarquardtParams()
        parameters.setMaxIterations(max_iterations)
        parameters.setRelativeErrorTol(SOLVE.relative_decrease)
        parameters.setAbsoluteErrorTol(0.0)
        optimizer = gtsam.LevenbergMarquardtOptimizer(
            self.factors(weights, kernel=kernel), values, parameters
        )
        found = _poses(optimizer.optimize(), self.nodes)
        # With a NaN inside, gtsam leaves the poses unchanged; only the error shows it.
        if not np.isfinite(optimizer.error()) or not np.isfinite(found.t).all():
            raise GraphError("the optimizer met a number that is not finite")
        return found, int(optimizer.iterations())

    def prior_chi2(self, T_map_body: SE3) -> float:
        """Sum of the squared residuals of the priors, without edges and kernel."""
        nothing = self.factors(np.zeros(len(self.of)), kernel="none")
        return 2.0 * float(nothing.error(self._values(T_map_body)))

    def _values(self, T_map_body: SE3) -> Any:
        values = gtsam.Values()
        for node in range(self.nodes):
            values.insert(node, _pose(T_map_body, node))
        return values

    def factors(self, weights: Array, *, kernel: Kernel) -> Any:
        """The ``gtsam.NonlinearFactorGraph`` of the edges with a weight, and of the priors."""
        out = gtsam.NonlinearFactorGraph()
        of, robust = self.of, kernel == "cauchy"
        scaled = of.information * weights[:, None, None]
        i, j = of.i.tolist(), of.j.tolist()
        for row in np.flatnonzero(weights > 1e-9).tolist():
            model = gtsam.noiseModel.Gaussian.Information(scaled[row])
            if robust and not of.protected[row]:
                model = _cauchy(model, SOLVE.cauchy_sd)
            out.add(gtsam.BetweenFactorPose3(i[row], j[row], self.measured[row], model))
        for node, p_map, p_body, sd_m in self.positions:
            model = gtsam.noiseModel.Diagonal.Sigmas(sd_m)
            if robust:
                model = _cauchy(model, SOLVE.cauchy_position_sd)
            out.add(gtsam.GPSFactorArm(node, p_map, p_body, model))
        for factor in self.always:
            out.add(factor)
        return out


def _check_prior(prior: Priors, *, nodes: int) -> None:
    if len(prior.node) and not 0 <= prior.node.min() <= prior.node.max() < nodes:
        raise GraphError(f"a prior names a node outside 0 to {nodes - 1}")
    if isinstance(prior, PosePriors):
        numbers = [prior.T_map_body.R, prior.T_map_body.t, prior.information]
    else:
        numbers = [prior.p_map, prior.p_body, prior.sd_m]
        if np.any(prior.sd_m <= 0.0):
            raise GraphError("a prior has a standard deviation that is not positive")
    if not all(np.isfinite(values).all() for values in numbers):
        raise GraphError("a prior is not finite")


def _pose_factors(prior: PosePriors) -> list[Any]:
    return [
        gtsam.PriorFactorPose3(
            int(node), _pose(prior.T_map_body, row), gtsam.noiseModel.Gaussian.Information(weight)
        )
        for row, (node, weight) in enumerate(zip(prior.node, prior.information, strict=True))
    ]


def _gauge(best: float) -> Any:
    return gtsam.noiseModel.Gaussian.Information(np.eye(6) * best * SOLVE.gauge)


def _cauchy(model: Any, scale: float) -> Any:
    return gtsam.noiseModel.Robust.Create(gtsam.noiseModel.mEstimator.Cauchy.Create(scale), model)


def _pose(T_a_b: SE3, row: int) -> Any:
    return gtsam.Pose3(gtsam.Rot3(T_a_b.R[row]), T_a_b.t[row])


def _poses(values: Any, nodes: int) -> SE3:
    """Poses of keys 0 to N-1; renormalized, because products of rotations drift."""
    rows = gtsam.utilities.extractPose3(values)
    assert len(rows) == nodes
    T_map_body = SE3(rows[:, :9].reshape(-1, 3, 3), rows[:, 9:])
    if not np.isfinite(rows).all():
        return T_map_body
    return SE3.from_quat(T_map_body.quat_xyzw(), T_map_body.t)
