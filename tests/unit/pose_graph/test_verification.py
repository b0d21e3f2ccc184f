from itertools import permutations

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    Judge,
    Measure,
    PoseGraph,
    Reason,
    Verdict,
    known_history,
    known_judgment,
    relations_of,
)
from recon4.pose_graph.alternative_paths import PathIndex
from recon4.pose_graph.solve import optimize
from recon4.pose_graph.verification import confirmed_again, verify
from recon4.settings import VerificationSettings
from tests.benchmarks.false_loops import inject_random, inject_shifted, office_graph

PATHS_ONLY = VerificationSettings(robust="none")


def line(*loops: tuple[int, int, float], nodes: int = 6, turn: float = 0.0) -> PoseGraph:
    """Steps of 1 m along x, and loops with the given lateral errors [m]."""
    steps = [SE3.from_rpy(0, 0, turn, t=[1.0, 0.0, 0.0])] * (nodes - 1)
    poses = [SE3.identity()]
    for step in steps:
        poses.append(poses[-1] @ step)
    T_map_body = SE3.stack(poses)
    edges = [
        Edge(
            i=k,
            j=k + 1,
            T_i_j=steps[k],
            kind=EdgeKind.ODOMETRY,
            judgments=known_history(Verdict.ACCEPTED),
        )
        for k in range(nodes - 1)
    ]
    for i, j, error in loops:
        T_i_j = poses[i].inverse() @ poses[j]
        T_i_j = SE3(T_i_j.R, T_i_j.t + np.array([0.0, error, 0.0]))
        edges.append(
            Edge(
                i=i,
                j=j,
                T_i_j=T_i_j,
                kind=EdgeKind.LOOP,
                judgments=known_history(Verdict.ACCEPTED),
            )
        )
    rows = np.arange(nodes, dtype=np.int64)
    return PoseGraph(rows, rows, T_map_body, tuple(edges))


def slow_medians(graph: PoseGraph, max_edges: int) -> tuple[np.ndarray, np.ndarray]:
    """The definition, spelled out: all simple paths by trying all sequences of edges."""
    medians, counts = [], []
    for row, asked in enumerate(graph.edges):
        others = [edge for k, edge in enumerate(graph.edges) if k != row]
        errors = []
        for length in range(1, max_edges + 1):
            for walk in permutations(others, length):
                T, nodes = SE3.identity(), [asked.i]
                for edge in walk:
                    if edge.i == nodes[-1]:
                        T, nodes = T @ edge.T_i_j, [*nodes, edge.j]
                    elif edge.j == nodes[-1]:
                        T, nodes = T @ edge.T_i_j.inverse(), [*nodes, edge.i]
                    else:
                        break
                else:
                    if nodes[-1] == asked.j and len(set(nodes)) == len(nodes):
                        errors.append(np.linalg.norm((asked.T_i_j.inverse() @ T).t))
        medians.append(np.median(errors) if errors else np.nan)
        counts.append(len(errors))
    return np.array(medians), np.array(counts)


def test_a_loop_beside_two_steps_is_compared_with_them() -> None:
    graph = line((0, 2, 0.3))

    verified = verify(graph, settings=PATHS_ONLY).graph

    assert verified.edges[5].verification_m == pytest.approx(0.3)
    assert verified.edges[5].paths == 1
    assert verified.edges[5].verdict is Verdict.REJECTED
    assert verified.edges[5].reason is Reason.VERIFICATION


def test_the_edge_is_rejected_above_the_limit_not_below() -> None:
    graph = line((0, 2, 0.09))

    verified = verify(graph, settings=PATHS_ONLY).graph

    assert verified.edges[5].verdict is Verdict.ACCEPTED


@pytest.mark.parametrize("max_edges", [2, 3])
def test_medians_are_those_of_all_simple_paths(max_edges: int) -> None:
    graph = line(
        (0, 2, 0.1), (0, 3, -0.2), (1, 3, 0.3), (1, 4, 0.4), (0, 3, 0.6), nodes=5, turn=0.7
    )

    index = PathIndex.build(graph.relations, nodes=5, max_edges=max_edges)

    medians, counts = slow_medians(graph, max_edges)
    np.testing.assert_array_equal(index.count, counts)
    np.testing.assert_allclose(index.median_m, medians, atol=1e-12)


def test_removing_edges_gives_the_same_as_starting_without_them() -> None:
    graph, _ = office_graph(np.random.default_rng(1), nodes=80)
    of = graph.relations
    gone = np.random.default_rng(2).choice(np.flatnonzero(~of.protected), 40, replace=False)
    edges = list(graph.edges)
    for row in gone:
        edges[row] = edges[row].judged(known_judgment(Verdict.REJECTED))

    index = PathIndex.build(of, nodes=80, max_edges=3)
    index.remove(gone)

    fresh = PathIndex.build(relations_of(edges), nodes=80, max_edges=3)
    alive = index.alive
    np.testing.assert_array_equal(index.count[alive], fresh.count[alive])
    np.testing.assert_array_equal(index.median_m[alive], fresh.median_m[alive])


def test_an_edge_without_a_path_is_unverified_and_stays() -> None:
    graph = line((0, 5, 0.0), nodes=6)

    verified = verify(graph, settings=PATHS_ONLY).graph

    assert verified.edges[5].verdict is Verdict.UNVERIFIED
    assert verified.edges[5].paths == 0
    assert np.isnan(verified.edges[5].verification_m)
    assert verified.edges[5].in_graph


def test_rejecting_the_worst_edge_first_clears_the_edges_it_affected() -> None:
    # (0, 2) is right, but two of its three paths run over wrong loops.
    graph = line((0, 2, 0.0), (1, 3, 5.0), (0, 3, 2.0), nodes=4)

    result = verify(graph, settings=PATHS_ONLY)

    assert [edge.in_graph for edge in result.graph.edges[3:]] == [True, False, False]
    assert len(result.rounds) > 1


def test_false_edges_far_apart_go_in_one_round() -> None:
    graph = line((0, 2, 1.0), (20, 22, 2.0), nodes=30)

    result = verify(graph, settings=PATHS_ONLY)

    assert result.rounds == ((30, 29),)


def test_odometry_that_disagrees_is_flagged_but_never_rejected() -> None:
    graph = line((0, 2, 0.0), (1, 3, 0.0), (0, 3, 0.0), nodes=4)
    wrong = graph.edges[1].evolve(T_i_j=SE3(np.eye(3), np.array([1.0, 1.0, 0.0])))
    approved = [
        edge.judged(known_judgment(Verdict.ACCEPTED, decided_by="Ada")) for edge in graph.edges[3:]
    ]
    graph = graph.with_edges((graph.edges[0], wrong, graph.edges[2], *approved))

    result = verify(graph, settings=PATHS_ONLY)

    assert 1 in result.flagged
    assert result.rounds == ()
    assert result.graph.edges[1].verdict is Verdict.ACCEPTED
    assert result.graph.edges[1].verification_m == pytest.approx(1.0)


@pytest.mark.parametrize("robust", ["gnc", "cauchy", "none"])
def test_decisions_of_a_person_are_kept(robust: str) -> None:
    stated = np.diag([1e6] * 3 + [1e4] * 3)
    graph = line((0, 2, 3.0), (2, 4, 0.0))
    edges = [edge.evolve(information=stated) for edge in graph.edges]
    edges[5] = edges[5].judged(known_judgment(Verdict.ACCEPTED, decided_by="Ada"))
    edges[6] = edges[6].judged(known_judgment(Verdict.REJECTED, Reason.OPERATOR, decided_by="Ada"))
    settings = VerificationSettings(robust=robust)  # type: ignore[arg-type]

    found = verify(graph.with_edges(tuple(edges)), settings=settings)

    # The loop is wrong by meters with a standard deviation of a centimeter, like the steps.
    assert found.graph.edges[5].chi2 > 1000.0
    assert found.graph.T_map_body.t[2, 1] > 0.5
    assert found.chi2_after > 1000.0
    assert found.graph.edges[5].verdict is Verdict.ACCEPTED
    assert found.outliers == ()
    assert found.graph.edges[6].verdict is Verdict.REJECTED
    assert found.graph.edges[6].reason is Reason.OPERATOR


def test_verifying_twice_is_verifying_once() -> None:
    clean, _ = office_graph(np.random.default_rng(3), nodes=100)
    graph = inject_shifted(clean, np.random.default_rng(4), 5)

    once = verify(graph, settings=VerificationSettings()).graph
    twice = verify(once, settings=VerificationSettings()).graph

    assert [edge.verdict for edge in twice.edges] == [edge.verdict for edge in once.edges]
    assert [edge.reason for edge in twice.edges] == [edge.reason for edge in once.edges]
    assert [edge.judgments for edge in twice.edges] == [edge.judgments for edge in once.edges]


def test_the_history_has_the_figures_that_decided() -> None:
    edge = verify(line((0, 2, 0.3)), settings=PATHS_ONLY).graph.edges[5]

    search, paths = edge.judgments
    assert (search.by, search.verdict) == (Judge.SEARCH, Verdict.ACCEPTED)
    assert (paths.by, paths.verdict, paths.reason, paths.measure) == (
        Judge.VERIFICATION, Verdict.REJECTED, Reason.VERIFICATION, Measure.PATHS,
    )  # fmt: skip
    assert (paths.value, paths.limit) == (pytest.approx(0.3), PATHS_ONLY.limit_m)


def test_an_edge_that_is_right_after_all_was_rejected_in_its_history() -> None:
    # The second measurement of (0, 2) agrees with the steps.
    graph = line((0, 2, 0.3))
    once = verify(graph, settings=PATHS_ONLY).graph
    T = once.edges[5].T_i_j
    right = once.edges[5].evolve(T_i_j=SE3(T.R, np.array([2.0, 0.0, 0.0])))

    again = verify(once.with_edges((*once.edges[:5], right)), settings=PATHS_ONLY).graph.edges[5]

    assert [(one.by, one.verdict) for one in again.judgments] == [
        (Judge.SEARCH, Verdict.ACCEPTED),
        (Judge.VERIFICATION, Verdict.REJECTED),
        (Judge.VERIFICATION, Verdict.ACCEPTED),
    ]


@pytest.mark.parametrize("reason", [Reason.VERIFICATION, Reason.ROBUST])
def test_edges_rejected_by_an_earlier_verification_are_verified_again(reason: Reason) -> None:
    graph = line((0, 2, 0.0), (2, 4, 0.0))
    refused = graph.edges[5].judged(known_judgment(Verdict.REJECTED, reason))
    unregistered = graph.edges[6].judged(known_judgment(Verdict.REJECTED, Reason.OVERLAP))
    graph = graph.with_edges((*graph.edges[:5], refused, unregistered))

    edges = verify(graph, settings=VerificationSettings()).graph.edges

    assert (edges[5].verdict, edges[5].reason) == (Verdict.ACCEPTED, Reason.NONE)
    assert (edges[6].verdict, edges[6].reason) == (Verdict.REJECTED, Reason.OVERLAP)


def test_an_edge_a_person_accepted_needs_no_path() -> None:
    graph = line((0, 4, 0.0))
    graph = graph.with_edges(
        (
            *graph.edges[:5],
            graph.edges[5].judged(known_judgment(Verdict.ACCEPTED, decided_by="Ada")),
        )
    )

    edge = verify(graph, settings=VerificationSettings()).graph.edges[5]

    assert edge.paths == 0
    assert edge.verdict is Verdict.ACCEPTED


def test_without_a_robust_solve_only_paths_reject_a_loop() -> None:
    stated = np.diag([1e6] * 3 + [1e4] * 3)
    graph = line((0, 4, 1.5))
    graph = graph.with_edges(tuple(edge.evolve(information=stated) for edge in graph.edges))

    found = verify(graph, settings=PATHS_ONLY)
    plain = found.graph.edges[5]
    robust = verify(graph, settings=VerificationSettings()).graph.edges[5]

    assert plain.verdict is Verdict.UNVERIFIED
    assert found.chi2_after == pytest.approx(optimize(graph, kernel="none").chi2)
    assert found.chi2_after < 0.99 * optimize(graph, kernel="cauchy").chi2
    assert (robust.verdict, robust.reason) == (Verdict.REJECTED, Reason.ROBUST)


@pytest.mark.parametrize("robust", ["gnc", "cauchy"])
def test_after_the_robust_solve_poses_and_paths_are_those_of_the_edges_that_stayed(
    robust: str,
) -> None:
    clean, _ = office_graph(np.random.default_rng(5), nodes=150)
    graph = inject_random(clean, np.random.default_rng(6), 20)
    settings = VerificationSettings(robust=robust, limit_m=1.5)  # type: ignore[arg-type]

    result = verify(graph, settings=settings)

    assert len(result.outliers) > 0
    fresh = PathIndex.build(result.graph.relations, nodes=len(graph), max_edges=3)
    kept = np.array([edge.in_graph for edge in result.graph.edges])
    counts = np.array([edge.paths for edge in result.graph.edges])
    np.testing.assert_array_equal(counts[kept], fresh.count[kept])
    again = optimize(result.graph, kernel="none")
    assert result.chi2_after == pytest.approx(again.chi2, rel=1e-6)


@pytest.mark.parametrize("robust", ["gnc", "cauchy"])
def test_the_robust_solve_rejects_a_false_loop_without_paths(robust: str) -> None:
    clean, truth = office_graph(np.random.default_rng(5), nodes=150)
    graph = inject_random(clean, np.random.default_rng(6), 8)
    settings = VerificationSettings(robust=robust)  # type: ignore[arg-type]

    result = verify(graph, settings=settings)

    assert not any(edge.in_graph for edge in result.graph.edges[-8:])
    assert all(result.graph.edges[row].reason is Reason.ROBUST for row in result.outliers)
    assert len(result.outliers) > 0
    for row in result.outliers:
        last = result.graph.edges[row].judgments[-1]
        assert (last.by, last.measure) == (Judge.ROBUST, Measure.CHI2)
        assert last.value > last.limit > 0.0
    assert result.chi2_after < result.chi2_before
    assert np.linalg.norm(result.graph.T_map_body.t - truth.t, axis=1).max() < 0.05


def test_an_edge_without_its_last_path_becomes_unverified() -> None:
    graph = verify(line((0, 4, 0.0), (0, 2, 0.0), (2, 4, 0.0)), settings=PATHS_ONLY).graph
    edges = list(graph.edges)
    edges[6] = edges[6].judged(known_judgment(Verdict.REJECTED, Reason.ROBUST))

    one_gone = confirmed_again(graph.with_edges(tuple(edges)), settings=PATHS_ONLY).edges
    edges[7] = edges[7].judged(known_judgment(Verdict.REJECTED, Reason.ROBUST))
    both_gone = confirmed_again(graph.with_edges(tuple(edges)), settings=PATHS_ONLY).edges
    edges[5] = edges[5].judged(known_judgment(Verdict.ACCEPTED, decided_by="Ada"))
    decided = confirmed_again(graph.with_edges(tuple(edges)), settings=PATHS_ONLY).edges

    # (0, 4) is confirmed by (0, 2, 4), (0, 1, 2, 4) and (0, 2, 3, 4).
    assert (graph.edges[5].paths, one_gone[5].paths, both_gone[5].paths) == (3, 1, 0)
    assert one_gone[5].verdict is Verdict.ACCEPTED
    assert both_gone[5].verdict is Verdict.UNVERIFIED
    assert np.isnan(both_gone[5].verification_m)
    assert decided[5].verdict is Verdict.ACCEPTED
    assert both_gone[6].reason is Reason.ROBUST


def test_the_cycle_variant_counts_the_edge_itself_as_a_path_without_error() -> None:
    graph = line((0, 2, 0.3))

    result = verify(graph, settings=VerificationSettings(variant="cycle", robust="none"))

    assert result.graph.edges[5].verification_m == pytest.approx(0.15)


def test_the_cycle_variant_knows_triangles_only() -> None:
    graph = line((0, 3, 0.3))

    result = verify(graph, settings=VerificationSettings(variant="cycle", robust="none"))

    assert result.graph.edges[5].paths == 0
    assert result.graph.edges[5].verdict is Verdict.UNVERIFIED


def test_the_record_is_plain_json_and_names_the_rejected() -> None:
    import json

    record = json.loads(json.dumps(verify(line((0, 2, 0.3)), settings=PATHS_ONLY).to_json()))

    assert record["edges"] == {"accepted": 0, "rejected": 1, "unverified": 5}
    assert record["rounds"][0][0]["nodes"] == [0, 2]


def test_a_graph_without_loops_is_fine() -> None:
    result = verify(line(), settings=VerificationSettings())

    assert all(edge.verdict is Verdict.UNVERIFIED for edge in result.graph.edges)
    assert result.rounds == ()
