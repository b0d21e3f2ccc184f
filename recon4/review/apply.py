"""Applies the decisions of a review to a pose graph."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.model.edge_columns import EdgeColumns
from recon4.model.plain import finite_or_none
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    Judge,
    Judgment,
    Measure,
    PoseGraph,
    Reason,
    Verdict,
)
from recon4.review.decisions import Pair, Standing
from recon4.review.row_contents import Measurement, pose_of
from recon4.review.tuning import CHANGES


@dataclass(frozen=True, slots=True, eq=False)
class Applied:
    """A graph with the decisions applied."""

    graph: PoseGraph
    """Not yet solved again."""
    missing: tuple[Standing, ...]
    """Decisions without effect: their pair is not in this graph, or was never registered."""
    changed: tuple[Standing, ...]
    """Decisions in effect about edges that differ from the pose the reviewer saw."""


def apply_decisions(graph: PoseGraph, standing: Sequence[Standing]) -> Applied:
    """Accept, reject, replace or add the edge of each decision."""
    row_of = rows_by_pair(graph)
    node_of = {int(frame): node for node, frame in enumerate(graph.frame_ids)}
    edges, decided, added = EdgeColumns.of(graph.edges), dict[int, Edge](), list[Edge]()
    missing, changed = [], []
    for one in standing:
        row = row_of.get(one.pair)
        if row is not None:
            edge = decided.get(row, edges[row])
            if one.measurement is None and one.accepted and not is_measured(edge):
                missing.append(one)
                continue
            if one.measurement is None and _differs(edge, one):
                changed.append(one)
            decided[row] = _decided(edge, one)
        elif one.measurement is not None and all(frame in node_of for frame in one.pair):
            i, j = (node_of[frame] for frame in one.pair)
            judged = (_judgment(one),)
            manual = Edge(
                i=i, j=j, T_i_j=one.measurement.motion(), kind=EdgeKind.MANUAL, judgments=judged
            )
            added.append(_measured(manual, one.measurement))
        else:
            missing.append(one)
    graph = graph.with_edges(edges.replaced(decided, added))
    return Applied(graph, tuple(missing), tuple(changed))


def rows_by_pair(graph: PoseGraph) -> dict[Pair, int]:
    """Row of the edge of each pair that can be reviewed: all except odometry."""
    return {
        (int(graph.frame_ids[edge.i]), int(graph.frame_ids[edge.j])): row
        for row, edge in enumerate(graph.edges)
        if edge.kind is not EdgeKind.ODOMETRY
    }


def is_measured(edge: Edge) -> bool:
    """Whether the edge was registered; else its pose is predicted only and cannot be accepted."""
    return edge.converged and edge.reason is not Reason.OVERLAP


def _decided(edge: Edge, one: Standing) -> Edge:
    if one.measurement is not None:
        edge = _measured(edge, one.measurement)
    return edge.judged(_judgment(one))


def _judgment(one: Standing) -> Judgment:
    """The decision as a verdict; the figure is that of the person's own registration."""
    measured = one.measurement
    return Judgment(
        Judge.PERSON,
        Verdict.ACCEPTED if one.accepted else Verdict.REJECTED,
        Reason.NONE if one.accepted else Reason.OPERATOR,
        Measure.ERROR if measured else Measure.NONE,
        finite_or_none(measured.error_m) if measured else None,
        finite_or_none(measured.limit_m) if measured else None,
        person=one.who,
        note=one.why,
    )


def _measured(edge: Edge, measured: Measurement) -> Edge:
    return edge.evolve(
        T_i_j=measured.motion(),
        information=measured.matrix(),
        overlap=measured.overlap,
        error_m=measured.error_m,
        limit_m=measured.limit_m,
        degeneracy=measured.degeneracy,
        iterations=measured.iterations,
        converged=True,
    )


def _differs(edge: Edge, one: Standing) -> bool:
    if not one.T_i_j:
        return False
    apart = pose_of(one.T_i_j).inverse() @ edge.T_i_j
    return bool(np.linalg.norm(apart.t) > CHANGES.changed_m or apart.angle() > CHANGES.changed_rad)
