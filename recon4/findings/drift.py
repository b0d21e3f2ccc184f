"""Drift of the odometry, and its correction by loop closures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.findings.walk_record import WalkRecord
from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict
from recon4.model.trajectory import Trajectory

_LOOPS = {EdgeKind.LOOP, EdgeKind.MANUAL}


@dataclass(frozen=True, slots=True, eq=False)
class DriftClosed:
    """Odometry compared with the final trajectory, aligned at the first pose."""

    t_s: Array
    """Times from the start of the walk [s], (N,)."""
    moved_m: Array
    """Distance between final and odometry positions [m], (N,)."""
    T_map_odom: SE3
    """Aligns the first poses."""
    loop_before_m: Array
    """Residual of each accepted loop closure to the odometry [m], (L,)."""
    loop_after_m: Array
    """Residual of the same loop closures to the final poses [m], (L,)."""

    @property
    def end_m(self) -> float:
        """Correction of the last pose [m]."""
        return float(self.moved_m[-1])

    @property
    def largest_m(self) -> float:
        """The largest correction [m]."""
        return float(self.moved_m.max())


def drift_closed(
    odometry: Trajectory, final: Trajectory, graph: PoseGraph | None
) -> DriftClosed | None:
    """Compare both at the final times covered by the odometry; None if there are none."""
    covered = (final.t_ns >= odometry.t_ns[0]) & (final.t_ns <= odometry.t_ns[-1])
    if not covered.any():
        return None
    final = final[covered]
    T_odom_body = odometry.at(final.t_ns)
    T_map_odom = final.T_a_b[0] @ T_odom_body[0].inverse()
    moved_m = np.linalg.norm((T_map_odom @ T_odom_body).t - final.T_a_b.t, axis=1)
    edges = accepted_loops(graph, final) if graph is not None else []
    return DriftClosed(
        t_s=(final.t_ns - final.t_ns[0]) / 1e9,
        moved_m=moved_m,
        T_map_odom=T_map_odom,
        loop_before_m=_residuals(edges, graph, odometry),
        loop_after_m=_residuals(edges, graph, final),
    )


def accepted_loops(graph: PoseGraph, within: Trajectory) -> list[Edge]:
    """Accepted loop closures between nodes covered by the trajectory."""
    inside = (graph.t_ns >= within.t_ns[0]) & (graph.t_ns <= within.t_ns[-1])
    return [
        edge
        for edge in graph.edges
        if edge.kind in _LOOPS
        and edge.verdict is Verdict.ACCEPTED
        and inside[[edge.i, edge.j]].all()
    ]


def _residuals(edges: list[Edge], graph: PoseGraph | None, trajectory: Trajectory) -> Array:
    """``|trans(T_ij^-1 T_i^-1 T_j)|`` of each edge [m], (L,)."""
    if graph is None or not edges:
        return np.empty(0)
    T_i = trajectory.at(graph.t_ns[[edge.i for edge in edges]])
    T_j = trajectory.at(graph.t_ns[[edge.j for edge in edges]])
    T_i_j = SE3.stack(edge.T_i_j for edge in edges)
    return np.asarray(np.linalg.norm((T_i_j.inverse() @ (T_i.inverse() @ T_j)).t, axis=1))


def closed_drift(results: WalkRecord) -> DriftClosed | None:
    """How far the pose graph moved the odometry; None without both trajectories."""
    if results.odometry is None or results.final is None or not len(results.odometry):
        return None
    return drift_closed(results.odometry, results.final, results.graph)
