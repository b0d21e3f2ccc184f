"""What the queue is ordered by."""

import numpy as np

from recon4.kernels.selected_inverse import entries, selected_inverse
from recon4.model.pose_graph import EdgeKind, Verdict, known_judgment
from recon4.pose_graph.solve import optimize
from recon4.review.influence import ARM_M, influence_m
from tests.unit.review.graphs import two_rounds


def solved(graph):
    return graph.with_poses(optimize(graph, kernel="none").T_map_body)


def really_moved_m(graph, row, *, verdict):
    """Change of the relative pose when an edge changes sides and everything is solved again."""
    edges = list(graph.edges)
    edges[row] = edges[row].judged(known_judgment(verdict))
    after = solved(graph.with_edges(tuple(edges)))
    i, j = edges[row].i, edges[row].j
    before_ij = graph.T_map_body[i].inverse() @ graph.T_map_body[j]
    after_ij = after.T_map_body[i].inverse() @ after.T_map_body[j]
    xi = (before_ij.inverse() @ after_ij).log()
    return np.linalg.norm(xi[3:]) + ARM_M * np.linalg.norm(xi[:3])


def test_influence_of_an_edge_in_the_graph_is_what_leaving_it_out_moves():
    graph = solved(two_rounds(wrong=[(10, 40, (0.05, 0.02, 0.0))]))
    row = len(graph.edges) - 1

    found = influence_m(graph, np.arange(len(graph.edges)) == row)

    expected = really_moved_m(graph, row, verdict=Verdict.REJECTED)
    assert expected > 0.001
    np.testing.assert_allclose(found[row], expected, rtol=0.05)


def test_influence_of_a_rejected_edge_is_what_taking_it_in_moves():
    graph = two_rounds(wrong=[(10, 40, (0.05, 0.02, 0.0))])
    row = len(graph.edges) - 1
    edges = list(graph.edges)
    edges[row] = edges[row].judged(known_judgment(Verdict.REJECTED))
    graph = solved(graph.with_edges(tuple(edges)))

    found = influence_m(graph, np.arange(len(edges)) == row)

    expected = really_moved_m(graph, row, verdict=Verdict.ACCEPTED)
    np.testing.assert_allclose(found[row], expected, rtol=0.05)


def test_a_wrong_loop_comes_before_all_right_ones():
    graph = solved(two_rounds(wrong=[(10, 40, (0.3, 0.0, 0.0))]))
    asked = np.array([edge.kind is EdgeKind.LOOP for edge in graph.edges])

    found = influence_m(graph, asked)

    assert np.nanargmax(found) == len(graph.edges) - 1
    assert np.isnan(found[~asked]).all()


def test_a_loop_alone_that_agrees_has_no_influence():
    graph = solved(two_rounds(loops=False, noise=0.0, wrong=[(10, 40, (0.0, 0.0, 0.0))]))
    row = len(graph.edges) - 1

    assert influence_m(graph, np.arange(row + 1) == row)[row] < 1e-6


def test_asking_for_nothing_gives_nothing():
    graph = two_rounds()

    assert np.isnan(influence_m(graph, np.zeros(len(graph.edges), np.bool_))).all()


def test_the_selected_inverse_is_the_inverse():
    rng = np.random.default_rng(3)
    J = rng.standard_normal((12, 12)) * (rng.random((12, 12)) < 0.3)
    A = J @ J.T + 5 * np.eye(12)
    L = np.linalg.cholesky(A)
    d = np.diag(L) ** 2
    L = L / np.diag(L)
    rows = [np.arange(j, 12) for j in range(12)]
    start = np.cumsum([0, *(len(r) for r in rows)])
    row = np.concatenate(rows)
    lower = np.concatenate([L[r, j] for j, r in enumerate(rows)])

    inverse = selected_inverse(start, row, lower, d)

    a, b = np.meshgrid(np.arange(12), np.arange(12), indexing="ij")
    found = entries(start, row, inverse, a.ravel(), b.ravel()).reshape(12, 12)
    np.testing.assert_allclose(found, np.linalg.inv(A), atol=1e-12)


def test_an_entry_that_is_not_stored_is_not_a_number():
    start, row = np.array([0, 1, 2]), np.array([0, 1])

    found = entries(start, row, np.ones(2), np.array([0, 1]), np.array([1, 1]))

    assert np.isnan(found[0])
    assert found[1] == 1.0
