"""An edge keeps every verdict on it: who gave it, why, and by which figure."""

import ast
from pathlib import Path

import pytest

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import (
    CHECKS_OF_THE_GRAPH,
    Edge,
    EdgeKind,
    Judge,
    Judgment,
    Measure,
    Reason,
    Verdict,
    known_history,
)
from tests.source_trees import sources, trees_with

ROOT = Path(__file__).parents[3]
FOUND = Judgment(Judge.SEARCH, Verdict.ACCEPTED, Reason.NONE, Measure.ERROR, 0.02, 0.05)
APART = Judgment(Judge.SEARCH, Verdict.REJECTED, Reason.OVERLAP, Measure.OVERLAP, 0.2, 0.4)
CONTRADICTED = Judgment(
    Judge.VERIFICATION, Verdict.REJECTED, Reason.VERIFICATION, Measure.PATHS, 0.4, 0.1
)
CONFIRMED = Judgment(Judge.VERIFICATION, Verdict.ACCEPTED, Reason.NONE, Measure.PATHS, 0.01, 0.1)
ADA = Judgment(Judge.PERSON, Verdict.ACCEPTED, person="Ada", note="same door")


def edge(*judgments: Judgment) -> Edge:
    return Edge(i=0, j=1, T_i_j=SE3.identity(), kind=EdgeKind.LOOP, judgments=judgments)


def test_a_new_verdict_leaves_the_earlier_ones_in_the_history() -> None:
    judged = edge(FOUND).judged(CONTRADICTED).judged(ADA)

    assert judged.judgments == (FOUND, CONTRADICTED, ADA)
    assert (judged.verdict, judged.reason, judged.decided_by) == (
        Verdict.ACCEPTED, Reason.NONE, "Ada",
    )  # fmt: skip


def test_the_same_verdict_again_only_brings_its_figures_up_to_date() -> None:
    later = Judgment(
        Judge.VERIFICATION, Verdict.REJECTED, Reason.VERIFICATION, Measure.PATHS, 0.3, 0.1
    )

    assert edge(FOUND).judged(CONTRADICTED).judged(later).judgments == (FOUND, later)


def test_the_program_does_not_overrule_a_person_but_another_person_does() -> None:
    eva = Judgment(Judge.PERSON, Verdict.REJECTED, Reason.OPERATOR, person="Eva")
    decided = edge(FOUND).judged(ADA)

    with pytest.raises(ValueError, match="decision of Ada stands"):
        decided.judged(CONTRADICTED)
    assert decided.judged(eva).decided_by == "Eva"


def test_a_registration_that_is_repeated_keeps_the_history_of_its_pair() -> None:
    assert edge(FOUND).after(edge(APART)).judgments == (APART, FOUND)


def test_judging_again_from_before_a_check_puts_its_verdict_back() -> None:
    given = edge(FOUND, CONTRADICTED)
    opened = given.before(CHECKS_OF_THE_GRAPH)

    assert opened.in_graph
    assert opened.judged(CONFIRMED).after(given).judgments == (FOUND, CONTRADICTED, CONFIRMED)
    assert opened.judged(CONTRADICTED).after(given).judgments == given.judgments


def test_a_decision_of_a_person_is_not_taken_back_with_the_checks() -> None:
    decided = edge(FOUND, CONTRADICTED, ADA)

    assert decided.before(CHECKS_OF_THE_GRAPH).judgments == decided.judgments


def test_an_edge_without_a_verdict_and_a_person_without_a_name_do_not_exist() -> None:
    with pytest.raises(ValueError, match="no judgment"):
        edge()
    with pytest.raises(ValueError, match="person"):
        Judgment(Judge.PERSON, Verdict.ACCEPTED)
    with pytest.raises(ValueError, match="search"):
        Judgment(Judge.SEARCH, Verdict.ACCEPTED, person="Ada")


@pytest.mark.parametrize(("verdict", "reason", "person", "judges"), [
    (Verdict.ACCEPTED, Reason.NONE, "auto", [Judge.SEARCH]),
    (Verdict.REJECTED, Reason.OVERLAP, "auto", [Judge.SEARCH]),
    (Verdict.REJECTED, Reason.SEEN_THROUGH, "auto", [Judge.FREE_SPACE]),
    (Verdict.REJECTED, Reason.AMBIGUOUS, "auto", [Judge.PLACES]),
    (Verdict.REJECTED, Reason.VERIFICATION, "auto", [Judge.SEARCH, Judge.VERIFICATION]),
    (Verdict.UNVERIFIED, Reason.NONE, "auto", [Judge.SEARCH, Judge.VERIFICATION]),
    (Verdict.REJECTED, Reason.ROBUST, "auto", [Judge.SEARCH, Judge.ROBUST]),
    (Verdict.REJECTED, Reason.OPERATOR, "Ada", [Judge.PERSON]),
    (Verdict.ACCEPTED, Reason.NONE, "Ada", [Judge.PERSON]),
])  # fmt: skip
def test_of_a_verdict_alone_the_judge_is_known(
    verdict: Verdict, reason: Reason, person: str, judges: list[Judge]
) -> None:
    history = known_history(verdict, reason, person)

    assert [one.by for one in history] == judges
    assert (history[-1].verdict, history[-1].reason) == (verdict, reason)


def test_verdict_reason_and_person_are_stored_in_the_history_alone() -> None:
    stored = set(Edge.__struct_fields__)

    assert "judgments" in stored
    assert not stored & {"verdict", "reason", "decided_by"}
    for name in ("verdict", "reason", "decided_by", "judgments"):
        with pytest.raises((TypeError, AttributeError)):
            edge(FOUND).evolve(**{name: ()})
        with pytest.raises((TypeError, AttributeError)):
            setattr(edge(FOUND), name, ())


def test_no_code_but_the_edge_itself_replaces_its_history() -> None:
    found = []
    for path, tree in trees_with("judgments", sources("recon4", "app")):
        if path == ROOT / "recon4/model/pose_graph.py":
            continue
        for node in ast.walk(tree):
            made = isinstance(node, ast.Call) and "judgments" in [k.arg for k in node.keywords]
            if made and not (isinstance(node.func, ast.Name) and node.func.id == "Edge"):
                found.append(f"{path.relative_to(ROOT)}:{node.lineno}")

    assert found == [], "a verdict is given by Edge.judged"
