"""Every pair tried is kept, whatever became of it."""

import math

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    PoseGraph,
    Reason,
    Verdict,
    known_history,
    known_judgment,
)


def edge(verdict: Verdict, reason: Reason = Reason.NONE) -> Edge:
    return Edge(
        i=0,
        j=1,
        T_i_j=SE3.identity(),
        kind=EdgeKind.LOOP,
        judgments=known_history(verdict, reason),
    )


def test_only_a_rejected_edge_is_out_of_the_graph():
    in_graph = {verdict: edge(verdict).in_graph for verdict in Verdict}

    assert in_graph == {Verdict.ACCEPTED: True, Verdict.UNVERIFIED: True, Verdict.REJECTED: False}


def test_values_that_were_not_measured_are_nan():
    tried = edge(Verdict.ACCEPTED)

    assert all(math.isnan(v) for v in (tried.overlap, tried.error_m, tried.verification_m))


def test_changing_an_edge_makes_a_new_one():
    tried = edge(Verdict.ACCEPTED)

    rejected = tried.judged(known_judgment(Verdict.REJECTED, Reason.VERIFICATION))

    assert (tried.verdict, rejected.verdict) == (Verdict.ACCEPTED, Verdict.REJECTED)
    assert str(rejected.reason) == "verification median > limit"


def test_a_graph_keeps_its_nodes_when_edges_or_poses_change():
    graph = PoseGraph(np.array([0, 5]), np.array([10, 20]), SE3.identity(2), ())

    with_edges = graph.with_edges((edge(Verdict.REJECTED),))
    moved = with_edges.with_poses(SE3(np.stack([np.eye(3)] * 2), np.ones((2, 3))))

    assert len(moved) == 2
    assert len(moved.edges) == 1
    relations = moved.relations
    assert moved.with_poses(graph.T_map_body).relations is relations, "as arrays only once"
    assert moved.with_edges(()).relations is not relations
    assert moved.T_map_body.t.tolist() == [[1, 1, 1], [1, 1, 1]]
    assert graph.edges == ()
