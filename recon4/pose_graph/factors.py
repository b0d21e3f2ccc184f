"""A pose graph as factors of gtsam. The only module that uses it.

`solve` imports this when it solves: gtsam takes a tenth of a second, which the server, the viewer
and those who only read a graph do without.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import gtsam
import numpy as np

from recon4.errors import GraphError
from recon4.geometry.se3 import ARM_M, SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.pose_graph import Relations
from recon4.pose_graph.checks import check_relations
from recon4.pose_graph.priors import Kernel, PosePriors, Priors, TargetPriors
from recon4.pose_graph.tuning_solve import SOLVE, SolveTuning


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
            raise GraphError(CodedText("graph-gauge"))
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
            elif isinstance(prior, TargetPriors):
                always += _target_factors(prior)
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
        tuning: SolveTuning = SOLVE,
    ) -> tuple[SE3, int]:
        """Optimize from ``T_map_body``; returns the poses and the number of iterations.

        Args:
            T_map_body: Initial poses.
            weights: Factor on the information of each edge, (E,); 0 = not used.
            kernel: As in `optimize`.
            tuning: When it ends.

        Raises:
            GraphError: If a number is not finite.
        """
        values = self._values(T_map_body)
        parameters = gtsam.LevenbergMarquardtParams()
        parameters.setMaxIterations(tuning.max_iterations)
        parameters.setRelativeErrorTol(tuning.relative_decrease)
        parameters.setAbsoluteErrorTol(0.0)
        optimizer = gtsam.LevenbergMarquardtOptimizer(
            self.factors(weights, kernel=kernel), values, parameters
        )
        values = _stepped(optimizer, tuning) if tuning.last_step_m else optimizer.optimize()
        found = _poses(values, self.nodes)
        # With a NaN inside, gtsam leaves the poses unchanged; only the error shows it.
        if not np.isfinite(optimizer.error()) or not np.isfinite(found.t).all():
            raise GraphError(CodedText("graph-not-finite"))
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

    def chordal(self, weights: Array) -> SE3:
        """Chordal relaxation: poses from the edges and one fixed node; node 0 is at the origin."""
        # The method requires a prior as its anchor; it is the last factor of the graph.
        values = gtsam.InitializePose3.initialize(self.factors(weights, kernel="none"))
        return _poses(values, self.nodes)

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


def _stepped(optimizer: Any, tuning: SolveTuning) -> Any:
    """The values after an iteration that moves no pose by more than ``tuning`` asks for."""
    before = gtsam.utilities.extractPose3(optimizer.values())
    while optimizer.iterations() < tuning.max_iterations:
        optimizer.iterate()
        after = gtsam.utilities.extractPose3(optimizer.values())
        turn_rad = np.linalg.norm((after - before)[:, :9], axis=1) / np.sqrt(2.0)
        step_m = np.linalg.norm((after - before)[:, 9:], axis=1) + ARM_M * turn_rad
        if not step_m.max() > tuning.last_step_m:  # nor if it is not a number
            break
        before = after
    return optimizer.values()


def _check_prior(prior: Priors, *, nodes: int) -> None:
    if len(prior.node) and not 0 <= prior.node.min() <= prior.node.max() < nodes:
        raise GraphError(CodedText("graph-prior-node", nodes=nodes - 1))
    if isinstance(prior, PosePriors):
        numbers = [prior.T_map_body.R, prior.T_map_body.t, prior.information]
    elif isinstance(prior, TargetPriors):
        numbers = [prior.p_map, prior.p_body, prior.information]
    else:
        numbers = [prior.p_map, prior.p_body, prior.sd_m]
        if np.any(prior.sd_m <= 0.0):
            raise GraphError(CodedText("graph-prior-deviation"))
    if not all(np.isfinite(values).all() for values in numbers):
        raise GraphError(CodedText("graph-prior-finite"))


def _pose_factors(prior: PosePriors) -> list[Any]:
    return [
        gtsam.PriorFactorPose3(
            int(node), _pose(prior.T_map_body, row), gtsam.noiseModel.Gaussian.Information(weight)
        )
        for row, (node, weight) in enumerate(zip(prior.node, prior.information, strict=True))
    ]


def _target_factors(prior: TargetPriors) -> list[Any]:
    rows = zip(prior.node, prior.p_map, prior.p_body, prior.information, strict=True)
    return [
        gtsam.GPSFactorArm(int(node), p_map, p_body, gtsam.noiseModel.Gaussian.Information(weight))
        for node, p_map, p_body, weight in rows
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
