"""Poses that agree best with the edges of a graph. The only place that knows gtsam."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import gtsam
import numpy as np
from scipy.stats import chi2 as chi2_distribution

from recon4.errors import GraphError
from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import PoseGraph
from recon4.pose_graph.checks import check_relations
from recon4.pose_graph.relations import Relations, Rows, relations, squared_residuals

Kernel = Literal["none", "cauchy"]

CAUCHY_SD = 4.0
"""Mahalanobis length at which the Cauchy kernel halves the weight of an edge; 6 exact standard
deviations have a length of 2.4."""
CAUCHY_POSITION_SD = 3.0
"""The same for an absolute position (1.7)."""
_GAUGE = 1e6
"""How much better than the best edge a fixed node is known."""
_MAX_ITERATIONS = 100
_RELATIVE_DECREASE = 1e-7
_GNC_STEP = 2.0
"""Growth of GNC's control parameter a round; gtsam takes 1.4."""
_GNC_INNER_ITERATIONS = 3
_GNC_MAX_ROUNDS = 60
_MAX_NOISE_SCALE = 10.0
"""Edges may be this much noisier (in variance) than they say before they count as outliers."""


@dataclass(frozen=True, slots=True, eq=False)
class PosePriors:
    """Nodes whose pose is known from elsewhere."""

    node: Rows
    """Rows of the nodes, (M,)."""
    T_map_body: SE3
    """Their poses, a batch of M."""
    information: Array
    """Inverse covariance of the tangent in the body, rotation first, (M, 6, 6)."""


@dataclass(frozen=True, slots=True, eq=False)
class PositionPriors:
    """Positions of a point of the body, as GNSS gives them."""

    node: Rows
    """Rows of the nodes, (M,)."""
    p_map: Array
    """Measured positions [m], (M, 3)."""
    p_body: Array
    """Where on the body each was measured (lever arm) [m], (M, 3)."""
    sd_m: Array
    """Standard deviations along the axes of the map [m], (M, 3)."""


Priors = PosePriors | PositionPriors


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """What the optimizer found."""

    T_map_body: SE3
    """Poses of the nodes, a batch of N."""
    chi2: float
    """Sum of the squared residuals over edges used; no weight, no kernel."""
    chi2_before: float
    """The same before."""
    edge_chi2: Array
    """Squared residual of each edge, also of those not used, (E,)."""
    weights: Array
    """What each edge counted for in the end, 0..1; 0 for edges not used, (E,)."""
    iterations: int
    converged: bool
    """Stopped because nothing got better any more."""


def optimize(
    graph: PoseGraph,
    *,
    kernel: Kernel,
    fixed: Sequence[int] = (0,),
    priors: Sequence[Priors] = (),
) -> Solution:
    """Levenberg-Marquardt from the current poses.

    Args:
        graph: Edges with a verdict of rejected are left out.
        kernel: ``cauchy`` makes gross errors of free edges and of positions pull little.
        fixed: Rows of nodes that stay where they are. Empty only if the priors hold the map.
        priors: Poses and positions known from elsewhere.

    Raises:
        GraphError: If the graph cannot be solved (`checks`), or nothing holds it.
    """
    of = relations(graph.edges)
    problem = _Problem.check(graph.T_map_body, of, fixed=fixed, priors=priors)
    weights = of.in_graph.astype(np.float64)
    T_map_body, iterations = problem.solve(
        graph.T_map_body, weights=weights, kernel=kernel, max_iterations=_MAX_ITERATIONS
    )
    edge_chi2 = squared_residuals(T_map_body, of)
    if kernel == "cauchy":
        weights = np.where(of.protected, weights, weights / (1.0 + edge_chi2 / CAUCHY_SD**2))
    return Solution(
        T_map_body=T_map_body,
        chi2=float(edge_chi2[of.in_graph].sum()),
        chi2_before=float(squared_residuals(graph.T_map_body, of)[of.in_graph].sum()),
        edge_chi2=edge_chi2,
        weights=weights,
        iterations=iterations,
        converged=iterations < _MAX_ITERATIONS,
    )


def optimize_gnc(
    graph: PoseGraph,
    *,
    fixed: Sequence[int] = (0,),
    priors: Sequence[Priors] = (),
    probability: float = 0.999,
) -> Solution:
    """Graduated non-convexity with truncated least squares: each edge counts fully or not at all.

    Starts from the convex problem and hardens it round by round (Yang 2020, eqs. 12-14);
    a few iterations a round are enough, as the next round goes on from there. Protected edges
    always count. An edge is an outlier beyond `outlier_limit`.

    Args:
        graph: As for `optimize`.
        fixed: As for `optimize`.
        priors: As for `optimize`.
        probability: Share of correct edges that stay if their information is true.

    Raises:
        GraphError: As `optimize`.
    """
    of = relations(graph.edges)
    problem = _Problem.check(graph.T_map_body, of, fixed=fixed, priors=priors)
    before = float(squared_residuals(graph.T_map_body, of)[of.in_graph].sum())
    free = of.in_graph & ~of.protected
    start = optimize(graph, kernel="cauchy", fixed=fixed, priors=priors)
    limit = outlier_limit(start.edge_chi2[free], probability=probability)
    weights, iterations = of.in_graph.astype(np.float64), start.iterations
    T_map_body = graph.T_map_body
    mu = 0.0
    for _ in range(_GNC_MAX_ROUNDS):
        T_map_body, used = problem.solve(
            T_map_body, weights=weights, kernel="none", max_iterations=_GNC_INNER_ITERATIONS
        )
        iterations += used
        edge_chi2 = squared_residuals(T_map_body, of)
        largest = float(edge_chi2[free].max(initial=0.0))
        mu = mu * _GNC_STEP if mu else limit / max(2.0 * largest - limit, 1e-3 * limit)
        weights[free] = _truncated_weights(edge_chi2[free], limit=limit, mu=mu)
        if np.all((weights < 1e-6) | (weights > 1.0 - 1e-6)):
            break
    weights = np.where(free, (weights > 0.5).astype(np.float64), weights)
    T_map_body, used = problem.solve(
        T_map_body, weights=weights, kernel="none", max_iterations=_MAX_ITERATIONS
    )
    edge_chi2 = squared_residuals(T_map_body, of)
    return Solution(
        T_map_body=T_map_body,
        chi2=float(edge_chi2[weights > 0.0].sum()),
        chi2_before=before,
        edge_chi2=edge_chi2,
        weights=weights,
        iterations=iterations + used,
        converged=used < _MAX_ITERATIONS,
    )


def initialize(graph: PoseGraph) -> SE3:
    """Poses from the edges alone: chordal relaxation of the rotations, then the translations.

    For graphs whose own poses are too far off (files of others, an odometry that got lost).

    Raises:
        GraphError: If the graph cannot be solved (`checks`).
    """
    of = relations(graph.edges)
    problem = _Problem.check(graph.T_map_body, of, fixed=(0,), priors=())
    factors = problem.factors(of.in_graph.astype(np.float64), kernel="none")
    # The chordal method wants a prior as its anchor; it is the last factor of the graph.
    values = gtsam.InitializePose3.initialize(factors)
    T_free_body = _poses(values, len(graph))
    return graph.T_map_body[0] @ T_free_body[0].inverse() @ T_free_body


def outlier_limit(edge_chi2: Array, *, probability: float) -> float:
    """Squared residual beyond which an edge is an outlier.

    The chi-square quantile of six numbers, times how much larger than stated the variance of these
    edges is (from their median, at most tenfold): registrations tend to promise too much.
    """
    ratio = float(np.median(edge_chi2)) / chi2_distribution.median(6) if len(edge_chi2) else 1.0
    return float(chi2_distribution.ppf(probability, 6) * np.clip(ratio, 1.0, _MAX_NOISE_SCALE))


def _truncated_weights(edge_chi2: Array, *, limit: float, mu: float) -> Array:
    """Yang 2020, eq. 14."""
    middle = np.sqrt(limit * mu * (mu + 1.0) / np.maximum(edge_chi2, 1e-300)) - mu
    certain = np.where(edge_chi2 <= limit * mu / (mu + 1.0), 1.0, middle)
    return np.where(edge_chi2 >= limit * (mu + 1.0) / mu, 0.0, np.clip(certain, 0.0, 1.0))


@dataclass(frozen=True, slots=True, eq=False)
class _Problem:
    """A checked graph in gtsam's terms; built once, solved with changing weights."""

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
    ) -> _Problem:
        check_relations(T_map_body, of)
        if not len(fixed) and not priors:
            raise GraphError("nothing holds the graph: no fixed node and no prior")
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
        return _Problem(of, measured, always, positions, len(T_map_body))

    def solve(
        self, T_map_body: SE3, *, weights: Array, kernel: Kernel, max_iterations: int
    ) -> tuple[SE3, int]:
        """Poses and how many iterations it took."""
        values = gtsam.Values()
        for node in range(self.nodes):
            values.insert(node, _pose(T_map_body, node))
        parameters = gtsam.LevenbergMarquardtParams()
        parameters.setMaxIterations(max_iterations)
        parameters.setRelativeErrorTol(_RELATIVE_DECREASE)
        parameters.setAbsoluteErrorTol(0.0)
        optimizer = gtsam.LevenbergMarquardtOptimizer(
            self.factors(weights, kernel=kernel), values, parameters
        )
        solved = _poses(optimizer.optimize(), self.nodes)
        # A NaN inside gtsam leaves the poses alone and shows in the error only.
        if not np.isfinite(optimizer.error()) or not np.isfinite(solved.t).all():
            raise GraphError("the optimizer met a number that is not finite")
        return solved, int(optimizer.iterations())

    def factors(self, weights: Array, *, kernel: Kernel) -> Any:
        """The ``gtsam.NonlinearFactorGraph`` of the edges that count."""
        out = gtsam.NonlinearFactorGraph()
        of, robust = self.of, kernel == "cauchy"
        scaled = of.information * weights[:, None, None]
        i, j = of.i.tolist(), of.j.tolist()
        for row in np.flatnonzero(weights > 1e-9).tolist():
            model = gtsam.noiseModel.Gaussian.Information(scaled[row])
            if robust and not of.protected[row]:
                model = _cauchy(model, CAUCHY_SD)
            out.add(gtsam.BetweenFactorPose3(i[row], j[row], self.measured[row], model))
        for node, p_map, p_body, sd_m in self.positions:
            model = gtsam.noiseModel.Diagonal.Sigmas(sd_m)
            if robust:
                model = _cauchy(model, CAUCHY_POSITION_SD)
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
            raise GraphError("a prior has a standard deviation that is not above zero")
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
    return gtsam.noiseModel.Gaussian.Information(np.eye(6) * best * _GAUGE)


def _cauchy(model: Any, scale: float) -> Any:
    return gtsam.noiseModel.Robust.Create(gtsam.noiseModel.mEstimator.Cauchy.Create(scale), model)


def _pose(T_a_b: SE3, row: int) -> Any:
    return gtsam.Pose3(gtsam.Rot3(T_a_b.R[row]), T_a_b.t[row])


def _poses(values: Any, nodes: int) -> SE3:
    """Poses of keys 0 to N-1; renormalized, as products of rotations drift."""
    rows = gtsam.utilities.extractPose3(values)
    assert len(rows) == nodes
    T_map_body = SE3(rows[:, :9].reshape(-1, 3, 3), rows[:, 9:])
    if not np.isfinite(rows).all():
        return T_map_body
    return SE3.from_quat(T_map_body.quat_xyzw(), T_map_body.t)
