"""Deciding about loops over HTTP: what is acknowledged is kept."""

import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from recon4.review.decisions import Decision, DecisionKind, fold
from recon4.review.journal import append, read_rows
from recon4.review.source import Source
from recon4_app.review.store import Reviews
from tests.review_project import make
from tests.service.review.reviewing import RIGHT, WRONG, decide


def test_a_decision_is_in_the_journal_when_it_is_acknowledged(server, root):
    answer = decide(server, "reject", RIGHT, why="glass wall")

    assert answer.status_code == 201
    (row,) = read_rows(root)
    assert (row.who, row.kind, row.frame_i, row.frame_j, row.why) == (
        *("local", "reject", 17, 77, "glass wall"),
    )
    record = answer.json()
    assert record["standing"][0]["accepted"] is False
    assert (record["in_map"], record["undoable"], record["seq"]) == (False, 1, 1)
    assert server.get("/journal").json()[0]["why"] == "glass wall"


def test_undo_and_redo_and_nothing_left(server):
    decide(server, "reject", RIGHT)

    undone = server.post("/undo", json={}).json()
    again = server.post("/undo", json={})
    redone = server.post("/redo", json={}).json()

    assert (undone["standing"], undone["in_map"]) == ([], True)
    assert again.status_code == 409
    assert "nothing to undo" in again.json()["detail"]
    assert len(redone["standing"]) == 1


def test_an_undo_that_did_not_see_the_last_decision_is_refused(server):
    decide(server, "reject", RIGHT)
    decide(server, "reject", WRONG)

    answer = server.post("/undo", json={"after_seq": 1})

    assert answer.status_code == 409
    assert "meanwhile" in answer.json()["detail"]


def test_two_browsers_at_once_lose_nothing(server, root):
    def click(frame):
        return decide(server, "reject", {"frame_i": frame, "frame_j": frame + 60}).status_code

    with ThreadPoolExecutor(8) as pool:
        codes = list(pool.map(click, range(40)))

    assert codes == [201] * 40
    assert {row.frame_i for row in read_rows(root)} == set(range(40))


def test_a_decision_about_a_pair_that_another_person_decided_meanwhile_is_refused(server, root):
    append(root, Decision(kind=DecisionKind.REJECT, who="rita", pair=(17, 77)))

    late = decide(server, "accept", RIGHT, seen_seq=0)
    other = decide(server, "reject", WRONG, seen_seq=0)
    knowing = decide(server, "accept", RIGHT, seen_seq=1)

    assert late.status_code == 409
    assert "rita decided about this pair meanwhile (reject)" in late.json()["detail"]
    assert (other.status_code, knowing.status_code) == (201, 201)
    assert [row.who for row in read_rows(root)] == ["rita", "local", "local"]


@pytest.mark.parametrize(
    "body",
    [
        {"kind": "bless", **RIGHT},
        {"kind": "accept", "frame_i": 77, "frame_j": 17},
        {"kind": "accept", **RIGHT, "T_i_j": [1.0, 2.0]},
        {"kind": "accept", **RIGHT, "who": "Eva"},
        {"kind": "undo", **RIGHT},
        {"kind": "accept", **RIGHT, "why": "x" * 501},
    ],
)
def test_an_invalid_decision_is_rejected_and_not_stored(server, root, body):
    answer = server.post("/decisions", json=body)

    assert answer.status_code == 422
    assert read_rows(root) == []


def test_the_queue_and_a_pair_and_its_points(unchanged):
    queue = unchanged.get("/queue").json()
    first = dict(zip(queue["columns"], queue["rows"][0], strict=True))
    pair = {name: first[name] for name in ("frame_i", "frame_j")}
    facts = unchanged.get("/pair", params=pair).json()
    points = unchanged.get("/points", params=pair).content

    assert {(20, 90), (41, 70)} == {tuple(row[:2]) for row in queue["rows"][:2]}
    assert facts["apart_m"] > 0.4
    assert points[:4] == b"R4PP"
    assert [one["by"] for one in facts["history"]] == ["search", "robust solve"]
    assert facts["history"][-1]["value"] > facts["history"][-1]["limit"]
    version, n_i, n_j = np.frombuffer(points[4:16], "<u4")
    xyz = np.frombuffer(points[16:], "<f4").reshape(-1, 3)
    assert version == 1
    assert len(xyz) == n_i + n_j
    assert 3000 < n_i <= 30_000
    assert np.abs(xyz).max() < 12.0  # the room, seen from inside it


def test_the_points_of_both_lie_on_each_other_where_the_graph_says(unchanged):
    facts = unchanged.get("/pair", params=RIGHT).json()
    data = unchanged.get("/points", params=RIGHT).content
    n_i = int(np.frombuffer(data[8:12], "<u4")[0])
    xyz = np.frombuffer(data[16:], "<f4").reshape(-1, 3).astype(float)

    from recon4.review.row_contents import pose_of

    moved = pose_of(facts["predicted"]) @ xyz[n_i:]
    from scipy.spatial import cKDTree

    distance_m = cKDTree(xyz[:n_i]).query(moved)[0]
    assert np.median(distance_m) < 0.06


def test_a_pair_of_moments_that_are_no_nodes_is_refused(unchanged):
    answer = unchanged.get("/points", params={"frame_i": 3, "frame_j": 4000})

    assert answer.status_code == 422
    assert "no node" in answer.json()["detail"]


def test_the_effect_names_conflicts_and_moves(server):
    decide(server, "accept", WRONG)

    record = server.get("/effect").json()

    assert [one["pair"] for one in record["conflicts"]] == [[20, 90]]
    assert record["last"]["moves"][0]["moved_m"] > 0.01
    assert record["last"]["chi2_after"] > record["last"]["chi2_before"]


def test_a_pair_is_aligned_and_becomes_an_edge(server, root):
    pair = {"frame_i": 30, "frame_j": 60}
    predicted = list(server.get("/pair", params=pair).json()["predicted"])
    true = predicted.copy()
    predicted[0] += 0.25

    found = server.post("/align", json={**pair, "T_i_j": predicted}).json()
    answer = decide(server, "add", pair, measurement=found["measurement"], why="by hand")

    assert found["converged"]
    assert np.linalg.norm(np.subtract(found["T_i_j"][:3], true[:3])) < 0.03
    assert found["error_m"] < found["limit_m"]
    assert answer.status_code == 201
    assert answer.json()["standing"][0]["measured"]
    record = server.get("/effect").json()
    assert record["edges"][0]["pair"] == [30, 60]
    assert record["missing"] == []


def test_an_unknown_measurement_is_rejected(server, root):
    pair = {"frame_i": 30, "frame_j": 60}

    answer = decide(server, "add", pair, measurement="0" * 24)

    assert answer.status_code == 409
    assert "align the pair again" in answer.json()["detail"]
    assert read_rows(root) == []


def test_a_predicted_pose_far_off_does_not_become_an_edge(unchanged):
    pair = {"frame_i": 30, "frame_j": 60}

    found = unchanged.post("/align", json={**pair, "T_i_j": [80, 0, 0, 0, 0, 0, 1]}).json()

    assert not found["converged"]
    assert found["measurement"] == ""


def test_the_latest_look_wins():
    import asyncio

    class SlowPool:
        def __init__(self):
            self.asked = []

        async def run_interactive(self, lane, terms, function, source, decided, before):
            self.asked.append(decided.key)
            await asyncio.sleep(0)
            return {"key": decided.key}

    def decided(*frames):
        return fold(Decision(kind=DecisionKind.REJECT, who="Eva", pair=(1, f)) for f in frames)

    async def three_at_once():
        pool = SlowPool()
        reviews = Reviews(pool)
        source = Source({"verification": Path("graph")})
        states = [decided(2), decided(2, 3), decided(2, 3, 4)]
        asks = [
            reviews.effect(Path("office"), source, decided=s, before=fold([]), person="Eva")
            for s in states
        ]
        return pool.asked, [s.key for s in states], await asyncio.gather(*asks)

    asked, keys, answers = asyncio.run(three_at_once())

    assert answers[-1] == {"key": keys[-1]}
    assert answers[0] in (None, {"key": keys[0]})
    assert answers[1] is None
    assert keys[1] not in asked


def test_a_project_without_a_map_is_not_processed_again(server, root):
    shutil.rmtree(root)
    make(root, graph_only=True)

    answer = server.running.post(f"/api/projects/{root.name}/remake")

    assert answer.status_code == 404
    assert "no map yet" in answer.json()["detail"]


def test_people_share_the_work_on_a_pair_and_an_approval_waits_for_both(server, root):
    append(root, Decision(kind=DecisionKind.REJECT, who="rita", pair=(17, 77)))
    server.post("/work", json={"kind": "assign", **RIGHT, "assignee": "local"})
    server.post("/work", json={"kind": "comment", **RIGHT, "why": "a glass wall"})
    asked = server.post("/work", json={"kind": "second", **RIGHT}).json()

    (work,) = asked["work"]
    assert (work["assignee"], work["comments"], work["second_by"]) == ("local", 1, "local")
    assert work["waits"] and "second opinion on multiframes 17 and 77" in asked["obstacle"]
    german = server.get("", headers={"Accept-Language": "de"}).json()
    assert "Zweitmeinung zu den Multiframes 17 und 77" in german["obstacle"]
    titles, said = ({f["title"] for f in one["map"]["findings"]} for one in (asked, german))
    assert titles and not titles & said
    assert [one["text"] for one in server.get("/comments", params=RIGHT).json()] == ["a glass wall"]
    agreed = decide(server, "reject", RIGHT, seen_seq=asked["seq"]).json()
    assert (agreed["work"][0]["agreement"], agreed["obstacle"]) == ("agree", "")
    assert agreed["key"] == asked["key"]  # nothing to rebuild
    unknown = server.post("/work", json={"kind": "assign", **RIGHT, "assignee": "nobody"})
    assert unknown.status_code == 400
    assert server.post("/work", json={"kind": "comment", **RIGHT}).status_code == 422
    page = {"page": "abcdefgh", **RIGHT}
    assert server.post("/looking", json=page).json() == []
    (other,) = server.post("/looking", json={"page": "hgfedcba"}).json()
    assert (other["who"], other["frame_i"]) == ("local", 17)
