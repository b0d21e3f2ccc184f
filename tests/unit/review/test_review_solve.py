"""The graph after the decisions."""

import numpy as np
import pytest

from recon4.findings.review_problems import problem_findings
from recon4.model.pose_graph import EdgeKind, Reason, Verdict, known_judgment
from recon4.pose_graph.verification import verify
from recon4.review.apply import apply_decisions, rows_by_pair
from recon4.review.decisions import Decision, DecisionKind, fold
from recon4.review.row_contents import Measurement, numbers_of
from recon4.review.solve import difference, review, review_figures
from recon4.review.tuning import CHANGES
from recon4.settings import GraphSettings, Settings, VerificationSettings
from tests.said import texts
from tests.unit.review.graphs import LOOP, truth, two_rounds


def frames(i, j):
    return (5 * i + 2, 5 * j + 2)


def standing(*decisions):
    return fold(decisions).standing


def accept(i, j, **more):
    return Decision(kind=DecisionKind.ACCEPT, who="Eva", pair=frames(i, j), **more)


def reject(i, j, **more):
    return Decision(kind=DecisionKind.REJECT, who="Eva", pair=frames(i, j), **more)


def measured(i, j, *, kind=DecisionKind.ADD, off_m=(0.0, 0.0, 0.0)):
    T = truth()
    T_i_j = numbers_of(T[i].inverse() @ T[j])
    T_i_j = (*(a + b for a, b in zip(T_i_j[:3], off_m, strict=True)), *T_i_j[3:])
    measurement = Measurement(
        T_i_j=T_i_j, information=tuple(LOOP.ravel()), overlap=0.6, error_m=0.01, limit_m=0.05,
        degeneracy=0.1, iterations=7,
    )  # fmt: skip
    return Decision(kind=kind, who="Eva", pair=frames(i, j), measurement=measurement)


@pytest.fixture(scope="module")
def verified():
    return verify(two_rounds(), settings=Settings().verification).graph


def at(graph, i, j):
    return graph.edges[rows_by_pair(graph)[frames(i, j)]]


def said(reviewed):
    """Problems of a review in words."""
    return texts(problem_findings(review_figures(reviewed, 1, chi2_before=None)))


def farthest_m(before, after):
    return np.linalg.norm(after.T_map_body.t - before.T_map_body.t, axis=1).max()


def test_no_decision_changes_nothing(verified):
    found = review(verified, (), settings=Settings())

    np.testing.assert_allclose(found.graph.T_map_body.t, verified.T_map_body.t, atol=1e-6)
    assert [e.verdict for e in found.graph.edges] == [e.verdict for e in verified.edges]
    assert found.conflicts == ()


def test_a_rejected_loop_is_out_by_the_operators_name(verified):
    found = review(verified, standing(reject(3, 32)), settings=Settings())

    edge = at(found.graph, 3, 32)
    assert (edge.verdict, edge.reason, edge.decided_by) == (
        Verdict.REJECTED,
        Reason.OPERATOR,
        "Eva",
    )


def test_an_accepted_loop_stays_in_although_it_does_not_fit_and_is_named():
    wrong = (10, 40, (1.5, 0.0, 0.0))
    graph = verify(two_rounds(wrong=[wrong]), settings=Settings().verification).graph
    assert at(graph, 10, 40).verdict is Verdict.REJECTED

    found = review(graph, standing(accept(10, 40)), settings=Settings())

    assert at(found.graph, 10, 40).in_graph
    (conflict,) = found.conflicts
    assert conflict.pair == frames(10, 40)
    assert conflict.chi2 > conflict.limit
    assert 0.1 < conflict.residual_m < 1.6
    assert any(str(frames(10, 40)[0]) in text for text in said(found))


def test_a_pair_that_never_converged_has_nothing_to_accept(verified):
    edges = list(verified.edges)
    row = next(k for k, e in enumerate(edges) if (e.i, e.j) == (3, 32))
    edges[row] = (
        edges[row]
        .evolve(converged=False)
        .judged(known_judgment(Verdict.REJECTED, Reason.NOT_CONVERGED))
    )

    found = review(verified.with_edges(tuple(edges)), standing(accept(3, 32)), settings=Settings())

    assert not at(found.graph, 3, 32).in_graph
    assert [one.pair for one in found.missing] == [frames(3, 32)]


def test_rejecting_the_one_wrong_loop_brings_the_walk_back():
    """Where the program does not judge, a lone loop bends the walk."""
    plain = Settings(verification=VerificationSettings(robust="none"))
    wrong = (5, 50, (2.0, 0.0, 0.0))
    graph = verify(two_rounds(loops=False, wrong=[wrong]), settings=plain.verification).graph
    bent_m = np.abs(graph.T_map_body.t - truth().t).max()

    found = review(graph, standing(reject(5, 50)), settings=plain)

    straight_m = np.abs(found.graph.T_map_body.t - truth().t).max()
    assert bent_m > 1.0
    assert straight_m < 0.1
    moved = difference(graph, found.graph)
    assert moved.moves[0].moved_m == pytest.approx(
        np.linalg.norm(found.graph.T_map_body.t - graph.T_map_body.t, axis=1).max()
    )
    assert moved.edges_after == moved.edges_before - 1


def test_what_the_program_dropped_only_for_a_wrong_edge_comes_back():
    """Two loops contradict each other and nothing else decides; the operator does."""
    graph = two_rounds(loops=False, wrong=[(5, 34, (0.0, 0.0, 0.0)), (6, 35, (0.9, 0.0, 0.0))])
    verified = verify(graph, settings=Settings().verification).graph
    kept = [e for e in verified.edges if e.kind is EdgeKind.LOOP and e.in_graph]
    assert len(kept) < 2

    wrong_out = review(verified, standing(reject(6, 35)), settings=Settings()).graph

    assert at(wrong_out, 5, 34).in_graph
    assert not at(wrong_out, 6, 35).in_graph


def test_a_replaced_measurement_is_what_counts(verified):
    found = review(
        verified, standing(measured(3, 32, kind=DecisionKind.REPLACE, off_m=(0.02, 0.0, 0.0))),
        settings=Settings(),
    )  # fmt: skip

    edge = at(found.graph, 3, 32)
    assert edge.kind is EdgeKind.LOOP
    assert edge.iterations == 7
    np.testing.assert_allclose(
        edge.T_i_j.t, at(verified, 3, 32).T_i_j.t + np.array([0.02, 0, 0]), atol=0.02
    )


def test_an_added_loop_is_manual_and_pulls(verified):
    drifting = verify(two_rounds(loops=False, noise=0.02), settings=Settings().verification).graph
    before_m = np.linalg.norm(drifting.T_map_body.t[45] - truth().t[45])

    found = review(drifting, standing(measured(0, 45)), settings=Settings())

    edge = at(found.graph, 0, 45)
    assert (edge.kind, edge.decided_by, edge.in_graph) == (EdgeKind.MANUAL, "Eva", True)
    assert np.linalg.norm(found.graph.T_map_body.t[45] - truth().t[45]) < 0.2 * before_m


def test_decisions_about_pairs_that_are_gone_are_counted_and_named(verified):
    gone = [reject(0, 20), accept(9, 55)]
    elsewhere = Decision(kind=DecisionKind.REJECT, who="Eva", pair=(2, 999_999))

    found = review(verified, standing(*gone, elsewhere), settings=Settings())

    assert {one.pair for one in found.missing} == {frames(0, 20), frames(9, 55), (2, 999_999)}
    assert any(text.startswith("3 decisions") for text in said(found))


def test_a_pair_that_was_never_registered_cannot_be_accepted(verified):
    edges = list(verified.edges)
    row = rows_by_pair(verified)[frames(3, 32)]
    edges[row] = edges[row].judged(known_judgment(Verdict.REJECTED, Reason.OVERLAP))

    applied = apply_decisions(verified.with_edges(tuple(edges)), standing(accept(3, 32)))

    assert [one.pair for one in applied.missing] == [frames(3, 32)]
    assert not applied.graph.edges[row].in_graph


def test_an_edge_that_measures_something_else_than_was_seen_is_named(verified):
    seen = at(verified, 3, 32).T_i_j
    other = numbers_of(seen)
    other = (other[0] + 2 * CHANGES.changed_m, *other[1:])

    same = apply_decisions(verified, standing(accept(3, 32, T_i_j=numbers_of(seen))))
    changed = apply_decisions(verified, standing(accept(3, 32, T_i_j=other)))

    assert same.changed == ()
    assert [one.pair for one in changed.changed] == [frames(3, 32)]


def test_odometry_is_not_decided_about(verified):
    applied = apply_decisions(verified, standing(reject(4, 5)))

    assert [one.pair for one in applied.missing] == [frames(4, 5)]
    assert all(e.in_graph for e in applied.graph.edges if e.kind is EdgeKind.ODOMETRY)


def test_modes_without_verification_are_solved_all_the_same(verified):
    settings = Settings(graph=GraphSettings(mode="overlap"))

    found = review(verified, standing(reject(3, 32)), settings=settings)

    assert not at(found.graph, 3, 32).in_graph


def test_the_same_decisions_give_the_same_bits(verified):
    chosen = standing(reject(3, 32), measured(0, 45), accept(6, 35))

    a, b = (review(verified, chosen, settings=Settings()).graph for _ in range(2))

    assert np.array_equal(a.T_map_body.t, b.T_map_body.t)


@pytest.mark.parametrize("decision", [accept(3, 32), reject(10, 40)])
def test_a_decision_that_confirms_a_verdict_changes_no_bit_of_the_poses(decision):
    wrong = [(10, 40, (1.5, 0.0, 0.0))]
    before = verify(two_rounds(wrong=wrong), settings=Settings().verification).graph

    confirmed = review(before, standing(decision), settings=Settings()).graph
    other = review(before, standing(reject(5, 34)), settings=Settings()).graph
    both = review(before, standing(reject(5, 34), decision), settings=Settings()).graph

    assert "Eva" in {edge.decided_by for edge in confirmed.edges}
    for expected, found in ((before, confirmed), (other, both)):
        np.testing.assert_array_equal(found.T_map_body.t, expected.T_map_body.t)
        np.testing.assert_array_equal(found.T_map_body.R, expected.T_map_body.R)
    assert farthest_m(before, other) > 1e-6


def test_the_poses_by_the_edges_alone_are_those_of_the_robust_solve(verified):
    decided = standing(reject(5, 34), reject(8, 37), accept(3, 32))
    robust = verify(
        apply_decisions(verified, decided).graph, settings=Settings().verification
    ).graph

    found = review(verified, decided, settings=Settings()).graph

    assert farthest_m(robust, found) < 1e-6 < farthest_m(verified, found)
