"""Pieces of a walk whose relative pose is not known: how they are kept apart and joined."""

import numpy as np
import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.places import ambiguous_places, separate_pieces
from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import Edge, EdgeKind, Reason, Verdict, known_history
from recon4.pose_graph.pieces import joined_pieces, placed, weakened
from tests.unit.pose_graph.graphs import line

PIECES = np.array([0, 0, 0, 1, 1, 1])


def loop(i, j, T_i_j, reason=Reason.NONE):
    verdict = Verdict.REJECTED if reason else Verdict.ACCEPTED
    return Edge(
        i=i,
        j=j,
        T_i_j=T_i_j,
        kind=EdgeKind.LOOP,
        judgments=known_history(verdict, reason),
    )


HERE = SE3.from_rpy(0.0, 0.0, np.pi / 2, t=[7.0, 1.0, 0.0])


def test_an_edge_between_two_pieces_states_nothing_of_the_heading():
    edges = tuple(
        Edge(
            i=k,
            j=k + 1,
            T_i_j=SE3.identity(),
            kind=EdgeKind.ODOMETRY,
            judgments=known_history(Verdict.ACCEPTED),
        )
        for k in range(5)
    )

    weak = weakened(edges, PIECES, np.arange(6) * 10**10)

    assert weak[1] is edges[1]
    sd = np.diag(weak[2].information) ** -0.5
    assert sd[2] == pytest.approx(np.pi)
    assert sd[3] > 10.0  # ten seconds at walking speed


def test_only_an_edge_of_the_graph_joins_pieces():
    graph = line(6)
    rejected = graph.with_edges((loop(0, 4, HERE, Reason.AMBIGUOUS),))
    accepted = graph.with_edges((loop(0, 4, HERE),))

    assert joined_pieces(rejected, PIECES).tolist() == PIECES.tolist()
    assert joined_pieces(accepted, PIECES).tolist() == [0] * 6


def test_a_recognized_place_moves_its_whole_piece():
    graph = line(6)

    moved = placed(graph, PIECES, [loop(0, 4, HERE)]).T_map_body

    np.testing.assert_allclose(moved.t[:3], graph.T_map_body.t[:3])
    np.testing.assert_allclose(moved.t[4], [7.0, 1.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(moved.t[5] - moved.t[4], [0.0, 0.5, 0.0], atol=1e-9)


def results_of(*edges):
    graph = line(6).with_edges(edges)
    return WalkRecord(graph=graph, steps={"piece": PIECES, "t_mid_ns": graph.t_ns})


def test_a_piece_that_nothing_joins_is_announced_with_its_time():
    alone, joined = (separate_pieces(results_of(*edges)) for edges in ((), (loop(0, 4, HERE),)))

    assert [(one.start_s, one.end_s, one.multiframes) for one in alone] == [(1.5, 2.5, 3)]
    assert joined == []


def test_ambiguous_pairs_of_one_place_are_announced_together():
    edges = [loop(0, j, HERE, Reason.AMBIGUOUS) for j in (4, 5)]

    found = ambiguous_places(results_of(*edges).graph)

    assert [(one.start_s, one.end_s, one.pairs) for one in found] == [(2.0, 2.5, 2)]
    assert ambiguous_places(results_of(loop(0, 4, HERE)).graph) == []
