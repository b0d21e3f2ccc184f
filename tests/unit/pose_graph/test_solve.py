import numpy as np
import pytest

from recon4.errors import GraphError
from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    PoseGraph,
    Reason,
    Verdict,
    known_history,
    known_judgment,
    relations_of,
)
from recon4.pose_graph.checks import check_relations
from recon4.pose_graph.priors import PosePriors, PositionPriors
from recon4.pose_graph.relations import reverse, squared_residuals
from recon4.pose_graph.robust import optimize_gnc, outlier_limit
from recon4.pose_graph.solve import initialize, optimize
from tests.benchmarks.false_loops import inject_random, office_graph


def edge(i: int, j: int, T_i_j: SE3, **changes: object) -> Edge:
    kind = EdgeKind.ODOMETRY if j == i + 1 else EdgeKind.LOOP
    made = Edge(i=i, j=j, T_i_j=T_i_j, kind=kind, judgments=known_history(Verdict.ACCEPTED))
    return made.evolve(**changes)


def shift(x_m: float) -> SE3:
    return SE3(np.eye(3), np.array([x_m, 0.0, 0.0]))


def graph_of(T_map_body: SE3, *edges: Edge) -> PoseGraph:
    rows = np.arange(len(T_map_body), dtype=np.int64)
    return PoseGraph(rows, rows * 500_000_000, T_map_body, edges)


def triangle() -> PoseGraph:
    """Two steps of 1 m, and a third edge that measures 2.3 m for both."""
    T = SE3.stack([shift(0.0), shift(1.0), shift(2.0)])
    return graph_of(T, edge(0, 1, shift(1.0)), edge(1, 2, shift(1.0)), edge(0, 2, shift(2.3)))


def test_a_contradiction_of_30_cm_is_shared_by_three_edges() -> None:
    solution = optimize(triangle(), kernel="none")

    np.testing.assert_allclose(solution.T_map_body.t[:, 0], [0.0, 1.1, 2.2], atol=1e-6)
    np.testing.assert_allclose(solution.edge_chi2, 0.01, atol=1e-6)
    assert solution.chi2 == pytest.approx(0.03, abs=1e-6)
    assert solution.chi2_before == pytest.approx(0.09, abs=1e-9)
    assert solution.converged


def test_information_weights_the_edges() -> None:
    graph = triangle()
    sure = graph.edges[2].evolve(information=1e6 * np.eye(6))

    solution = optimize(graph.with_edges((*graph.edges[:2], sure)), kernel="none")

    np.testing.assert_allclose(solution.T_map_body.t[:, 0], [0.0, 1.15, 2.3], atol=1e-4)


def test_the_order_of_information_is_rotation_first() -> None:
    weak_x = np.diag([1.0, 1.0, 1.0, 1e-6, 1.0, 1.0])
    graph = triangle()
    edges = (graph.edges[0].evolve(information=weak_x), *graph.edges[1:])

    solution = optimize(graph.with_edges(edges), kernel="none")

    np.testing.assert_allclose(solution.T_map_body.t[:, 0], [0.0, 1.3, 2.3], atol=1e-4)


def test_rejected_edges_do_not_count_but_are_measured() -> None:
    graph = triangle()
    rejected = graph.edges[2].judged(known_judgment(Verdict.REJECTED, Reason.OVERLAP))

    solution = optimize(graph.with_edges((*graph.edges[:2], rejected)), kernel="none")

    np.testing.assert_allclose(solution.T_map_body.t[:, 0], [0.0, 1.0, 2.0], atol=1e-9)
    assert solution.weights.tolist() == [1.0, 1.0, 0.0]
    assert solution.edge_chi2[2] == pytest.approx(0.09)


def test_moving_the_whole_graph_moves_the_whole_solution() -> None:
    graph, _ = office_graph(np.random.default_rng(1), nodes=40)
    T_c_map = SE3.from_rpy(0.1, -0.2, 2.0, t=[100.0, -50.0, 7.0])

    here = optimize(graph, kernel="none")
    there = optimize(graph.with_poses(T_c_map @ graph.T_map_body), kernel="none")

    moved = T_c_map @ here.T_map_body
    np.testing.assert_allclose(there.T_map_body.t, moved.t, atol=1e-5)
    assert there.chi2 == pytest.approx(here.chi2, rel=1e-6)


def test_a_false_loop_has_little_weight_with_cauchy_and_none_with_gnc() -> None:
    clean, truth = office_graph(np.random.default_rng(2), nodes=120)
    graph = inject_random(clean, np.random.default_rng(3), 10)

    plain = optimize(graph, kernel="none")
    cauchy = optimize(graph, kernel="cauchy")
    truncated = optimize_gnc(graph)

    def worst(T_map_body: SE3) -> float:
        return float(np.linalg.norm(T_map_body.t - truth.t, axis=1).max())

    assert worst(plain.T_map_body) > 0.3
    assert worst(cauchy.T_map_body) < 0.1
    assert worst(truncated.T_map_body) < 0.05
    assert truncated.weights[-10:].max() == 0.0
    assert truncated.weights[:-10].mean() > 0.99


def test_protected_edges_count_fully_whatever_the_kernel() -> None:
    T = SE3.stack([shift(0.0), shift(1.0)])
    stated = 1e4 * np.eye(6)
    odometry = edge(0, 1, shift(1.0), information=stated)
    loop = edge(0, 1, shift(2.0), information=stated, kind=EdgeKind.LOOP)

    cauchy = optimize(graph_of(T, odometry, loop), kernel="cauchy")
    truncated = optimize_gnc(graph_of(T, odometry, loop))

    assert cauchy.T_map_body.t[1, 0] < 1.01
    assert cauchy.weights[0] == 1.0
    assert cauchy.weights[1] < 0.01
    assert truncated.weights.tolist() == [1.0, 0.0]


def test_protected_edges_stay_in_gnc_even_where_two_loops_contradict_them() -> None:
    T = SE3.stack([shift(0.0), shift(1.0)])
    stated = 1e4 * np.eye(6)
    odometry = edge(0, 1, shift(1.0), information=stated)
    loops = [edge(0, 1, shift(1.3), information=stated, kind=EdgeKind.LOOP) for _ in range(20)]

    solution = optimize_gnc(graph_of(T, odometry, *loops))

    assert solution.weights[0] == 1.0


def test_the_same_graph_gives_the_same_bits() -> None:
    graph = inject_random(
        office_graph(np.random.default_rng(4), nodes=60)[0], np.random.default_rng(5), 5
    )

    first, second = optimize_gnc(graph), optimize_gnc(graph)

    np.testing.assert_array_equal(first.T_map_body.t, second.T_map_body.t)
    np.testing.assert_array_equal(first.T_map_body.R, second.T_map_body.R)


def test_poses_from_edges_alone_end_at_the_same_optimum() -> None:
    graph, _ = office_graph(np.random.default_rng(6), nodes=60)
    lost = graph.with_poses(SE3.identity(60))

    started = graph.with_poses(initialize(lost))

    solution = optimize(started, kernel="none")
    expected = optimize(
        graph.with_poses(graph.T_map_body[0].inverse() @ graph.T_map_body), kernel="none"
    )
    np.testing.assert_allclose(solution.T_map_body.t, expected.T_map_body.t, atol=1e-4)


def test_overconfident_edges_increase_the_outlier_limit_up_to_tenfold() -> None:
    exact = outlier_limit(np.full(9, 5.348), probability=0.999)

    assert exact == pytest.approx(22.46, abs=0.01)
    assert outlier_limit(np.full(9, 4 * 5.348), probability=0.999) == pytest.approx(
        4 * exact, rel=1e-3
    )
    assert outlier_limit(np.full(9, 1e6), probability=0.999) == pytest.approx(10 * exact)
    assert outlier_limit(np.zeros(0), probability=0.999) == pytest.approx(exact)


def test_a_reversed_relation_has_the_same_residual() -> None:
    rng = np.random.default_rng(7)
    root = rng.normal(size=(6, 6))
    T_i_j = SE3.exp(rng.normal(size=6))
    T_map_body = SE3.exp(rng.normal(size=(2, 6)))
    T_j_i, information = reverse(T_i_j, root @ root.T)

    forth = squared_residuals(
        T_map_body, relations_of([edge(0, 1, T_i_j, information=root @ root.T)])
    )
    back = squared_residuals(T_map_body, relations_of([edge(1, 0, T_j_i, information=information)]))

    np.testing.assert_allclose(back, forth, rtol=1e-9)


def test_a_position_with_a_lever_arm_places_the_body() -> None:
    T = SE3.stack([shift(0.0), shift(1.0)])
    graph = graph_of(T, edge(0, 1, shift(1.0)))
    arm = np.array([0.0, 0.0, 0.5])
    prior = PositionPriors(
        node=np.array([0, 1]),
        p_map=np.array([[5.0, 3.0, 0.5], [6.0, 3.0, 0.5]]),
        p_body=np.tile(arm, (2, 1)),
        sd_m=np.full((2, 3), 0.1),
    )
    upright = PosePriors(np.array([0]), T[:1], np.diag([1e4, 1e4, 1e-6, 1e-6, 1e-6, 1e-6])[None])

    solution = optimize(graph, kernel="none", fixed=(), priors=(prior, upright))

    np.testing.assert_allclose(solution.T_map_body.t, [[5, 3, 0], [6, 3, 0]], atol=1e-4)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"T_i_j": SE3(np.eye(3), np.array([np.nan, 0, 0]))}, "edge 2 .* not a finite rigid"),
        ({"T_i_j": SE3(2 * np.eye(3), np.zeros(3))}, "edge 2 .* not a finite rigid"),
        ({"information": np.zeros((6, 6))}, "edge 2 .* positive definite"),
        ({"information": np.diag([1.0, 1, 1, 1, 1, -1])}, "edge 2 .* positive definite"),
        ({"information": np.full((6, 6), np.inf)}, "edge 2 .* not finite"),
        ({"i": 2}, "edge 2 .* itself"),
        ({"j": 3}, "edge 2 joins nodes 0 and 3; there are nodes 0 to 2"),
    ],
)
def test_an_invalid_edge_is_reported_with_its_row(change: dict[str, object], message: str) -> None:
    graph = triangle()
    bad = graph.with_edges((*graph.edges[:2], graph.edges[2].evolve(**change)))

    with pytest.raises(GraphError, match=message):
        optimize(bad, kernel="none")


def test_a_bad_edge_that_is_rejected_does_no_harm() -> None:
    graph = triangle()
    nan = SE3(np.eye(3), np.full(3, np.nan))
    bad = graph.edges[2].evolve(T_i_j=nan).judged(known_judgment(Verdict.REJECTED))

    solution = optimize(graph.with_edges((*graph.edges[:2], bad)), kernel="none")

    assert solution.chi2 == pytest.approx(0.0, abs=1e-12)


def test_a_graph_in_two_parts_is_refused() -> None:
    graph = triangle()

    with pytest.raises(GraphError, match=r"1 of 3 nodes cannot be reached .* first is node 2"):
        optimize(graph.with_edges(graph.edges[:1]), kernel="none")


def test_a_pose_that_is_not_finite_is_refused() -> None:
    graph = triangle()
    T = SE3(graph.T_map_body.R, graph.T_map_body.t * [[1], [np.nan], [1]])

    with pytest.raises(GraphError, match="pose of node 1"):
        optimize(graph.with_poses(T), kernel="none")


def test_a_graph_with_a_free_gauge_is_refused() -> None:
    with pytest.raises(GraphError, match="gauge is free"):
        optimize(triangle(), kernel="none", fixed=())


def test_two_edges_between_the_same_nodes_are_allowed_and_reported() -> None:
    graph = triangle()
    twice = graph.with_edges((*graph.edges, graph.edges[2]))

    duplicates = check_relations(twice.T_map_body, twice.relations)

    assert duplicates == [(0, 2)]
