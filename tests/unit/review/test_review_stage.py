"""The stage between verification and refine."""

import json

import numpy as np
import pytest

from recon4.findings.review_problems import problem_findings
from recon4.geometry.se3 import SE3
from recon4.model.plain import to_plain
from recon4.model.pose_graph import Judge, Reason, Verdict, known_judgment
from recon4.pose_graph.files import load_graph, save_graph
from recon4.pose_graph.verification import verify
from recon4.progress import Silent
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, read_decided
from recon4.review.preview import preview
from recon4.review.queue import COLUMNS, alternative_paths, queue_json, queue_rows
from recon4.review.source import Source
from recon4.settings import Settings
from recon4.settings.reads import ReadsNothing
from recon4.store.project import Project, read_artifacts
from recon4.store.stage import Input, Stage, StageRunner
from recon4.workflows import stages
from tests.unit.review.graphs import two_rounds


def _searched(context, *, graph):
    save_graph(context.out, graph)


SEARCH = Stage("graph", 1, ReadsNothing, _searched)


@pytest.fixture
def run(tmp_path):
    """The graph's stages of a project, as the pipeline runs them."""
    root = tmp_path / "office"

    def go():
        with Project.open(root) as project:
            runner = StageRunner(project, Settings(), Silent())
            wrong = [(10, 40, (1.5, 0.0, 0.0))]
            searched = runner.run(SEARCH, graph=Input("two rounds", two_rounds(wrong=wrong)))
            runner.run(stages.VERIFICATION, graph=searched)
            decided = read_decided(root)
            if decided:
                inputs = {"decisions": Input(decided.key, decided.standing)}
                verified = runner.runs["verification"].artifact
                runner.run(stages.REVIEW, graph=verified, **inputs)
            else:
                runner.skip(stages.REVIEW)
            return runner.runs

    go.root = root
    return go


def reject(i, j):
    return Decision(kind=DecisionKind.REJECT, who="Eva", pair=(5 * i + 2, 5 * j + 2))


def test_decisions_make_a_graph_of_their_own_and_undoing_them_finds_the_old_one(run):
    before = run()
    append(run.root, reject(3, 32))
    with_decision = run()
    append(run.root, Decision(kind=DecisionKind.UNDO, who="Eva"))

    after = run()

    assert "review" not in before
    assert with_decision["review"].figures.decisions == 1
    assert "review" not in after
    assert after["verification"].artifact.key == before["verification"].artifact.key
    assert "review" not in read_artifacts(run.root)


def test_the_same_decisions_again_find_the_same_artifact(run):
    run()
    append(run.root, reject(3, 32))
    first = run()["review"]
    append(run.root, Decision(kind=DecisionKind.UNDO, who="Eva"))
    append(run.root, reject(3, 32))

    again = run()["review"]

    assert again.artifact.key == first.artifact.key
    assert again.reused


def test_review_json_names_what_happened(run):
    run()
    append(run.root, Decision(kind=DecisionKind.ACCEPT, who="Eva", why="seen", pair=(52, 202)))
    append(run.root, reject(0, 20))

    found = run()["review"]

    record = json.loads((found.artifact.folder / "review.json").read_text())
    assert [one["pair"] for one in record["conflicts"]] == [[52, 202]]
    assert record["missing"] == [[2, 102]]
    assert record["moves"][0]["moved_m"] > 0.01
    assert record["chi2_after"] > record["chi2_before"]
    assert {one["why"] for one in record["decisions"]} == {"seen", ""}
    assert found.figures.conflicts == 1
    assert len(problem_findings(found.figures)) == 2


def test_the_preview_has_the_result_of_the_stage(run):
    run()
    before = read_decided(run.root)
    append(run.root, Decision(kind=DecisionKind.ACCEPT, who="Eva", pair=(52, 202)))
    decided = read_decided(run.root)

    quick = preview(Source.of(run.root), decided, before)

    artifact = run()["review"].artifact.folder
    record = json.loads((artifact / "review.json").read_text())
    fields = to_plain(quick)
    assert fields["all"] == {name: record[name] for name in fields["all"]}
    assert fields["conflicts"] == record["conflicts"]
    assert fields["last"] == fields["all"]
    assert quick.edges[0].pair == (52, 202)
    assert quick.edges[0].chi2 == pytest.approx(record["conflicts"][0]["chi2"])


def test_the_queue_is_ordered_by_influence_and_always_the_same(run):
    run()

    record = json.loads(queue_json(Source.of(run.root)))

    rows = [dict(zip(COLUMNS, row, strict=True)) for row in record["rows"]]
    influence = [row["influence_m"] for row in rows if row["measured"]]
    assert influence == sorted(influence, reverse=True)
    assert (rows[0]["frame_i"], rows[0]["frame_j"]) == (52, 202)
    assert rows[0]["verdict"] == "rejected"
    assert rows[0]["verification_m"] > 1.0  # of rejected pairs too
    assert all(row["kind"] != "odometry" for row in rows)
    assert queue_json(Source.of(run.root)) == queue_json(Source.of(run.root))


def test_pairs_without_a_registration_that_holds_come_last():
    """However far their meaningless pose would throw the map."""
    graph = two_rounds(wrong=[(10, 40, (1.5, 0.0, 0.0))])
    far, weak = (0.0, 90.0, 0.0), (0.0, 5.0, 0.0)
    loop = graph.edges[-1]

    def rejected_pair(i, j, reason, overlap, off_m):
        T = SE3(loop.T_i_j.R, loop.T_i_j.t + off_m)
        pair = loop.evolve(
            i=i, j=j, T_i_j=T, overlap=overlap, converged=reason is not Reason.NOT_CONVERGED
        )
        return pair.judged(known_judgment(Verdict.REJECTED, reason))

    more = (
        rejected_pair(1, 50, Reason.NOT_CONVERGED, 0.6, far),
        rejected_pair(2, 50, Reason.OVERLAP, 0.4, far),
        rejected_pair(3, 50, Reason.NOT_CONVERGED, 0.7, far),
        rejected_pair(4, 50, Reason.ERROR, 0.8, weak),
    )

    rows = queue_rows(graph.with_edges(graph.edges + more), settings=Settings())

    assert rows[0][:2] == (52, 202)
    assert [row[:2] for row in rows[-4:]] == [(22, 252), (17, 252), (7, 252), (12, 252)]
    assert [row.measured for row in rows[-4:]] == [True, False, False, False]
    assert rows[-4].influence_m > 1.0
    assert [row.influence_m for row in rows[-3:]] == [None] * 3


def test_alternative_paths_one_by_one_have_the_median_of_the_verification():
    graph = verify(two_rounds(), settings=Settings().verification).graph
    rows = {row[:2]: row for row in queue_rows(graph, settings=Settings())}
    edge = next(e for e in graph.edges if (e.i, e.j) == (3, 32))

    paths = alternative_paths(graph, 3, 32, T_i_j=edge.T_i_j, settings=Settings())

    assert len(paths) == edge.paths == rows[17, 162].paths
    assert np.median([path.residual_m for path in paths]) == pytest.approx(edge.verification_m)
    assert all(path.frames[0] == 17 and path.frames[-1] == 162 for path in paths)


def test_the_reviewed_graph_keeps_every_pair_that_was_tried(run):
    verified = load_graph(run()["verification"].artifact.folder)
    append(run.root, reject(3, 32))

    reviewed = load_graph(run()["review"].artifact.folder)

    assert len(reviewed.edges) == len(verified.edges)
    assert sum(e.verdict is Verdict.REJECTED for e in reviewed.edges) == 1 + sum(
        e.verdict is Verdict.REJECTED for e in verified.edges
    )


def test_the_history_of_a_pair_has_the_program_and_then_the_person(run):
    pair = reject(3, 32).pair
    run()
    before = Source.of(run.root).history(pair)
    append(run.root, reject(3, 32))
    run()

    after = Source.of(run.root).history(pair)

    assert [one.by for one in before] == [Judge.SEARCH, Judge.VERIFICATION]
    assert after[:-1] == before
    last = after[-1]
    assert (last.by, last.person, last.verdict) == (Judge.PERSON, "Eva", Verdict.REJECTED)
    assert Source.of(run.root).history((1, 2)) == ()


def test_settings_are_those_the_graph_was_made_with(run):
    run()

    assert Source.of(run.root).settings.verification == Settings().verification
