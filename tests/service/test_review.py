"""Deciding about loops over HTTP: what is acknowledged is kept, what is signed is locked."""

import json
import shutil
import sqlite3
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import laspy
import numpy as np
import pytest

from app.review.store import Reviews
from recon4.cli.main import main
from recon4.pipeline import remake
from recon4.recording.formats.poses import read_tum
from recon4.results import RESULTS
from recon4.review.decisions import Decision, DecisionKind, fold
from recon4.review.journal import NAME, append, read_rows
from recon4.review.source import Source
from recon4.store.hashing import hash_file
from tests.g2o_reader import read_g2o
from tests.review_project import LOST, judge, make
from tests.service.running import Running, server_thread

WRONG = {"frame_i": 20, "frame_j": 90}
RIGHT = {"frame_i": 17, "frame_j": 77}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made") / "office"
    make(folder)
    return folder


@dataclass(frozen=True)
class Reviewing:
    """A project of its own on a server all tests share: its helper processes start once."""

    running: Running
    root: Path

    def get(self, path="", **options):
        return self.running.get(self._url(path), **options)

    def post(self, path, **options):
        return self.running.post(self._url(path), **options)

    def _url(self, path):
        return f"/api/projects/{self.root.name}/review{path}"


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    with server_thread(tmp_path_factory.mktemp("served"), worker="tests.review_project") as one:
        yield one


@pytest.fixture
def root(made, running):
    folder = running.root / f"office{len(list(running.root.iterdir()))}"
    shutil.copytree(made, folder)
    return folder


@pytest.fixture
def server(running, root):
    return Reviewing(running, root)


def decide(server, kind, pair, **more):
    return server.post("/decisions", json={"kind": kind, **pair, **more})


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


def test_the_queue_and_a_pair_and_its_points(server):
    queue = server.get("/queue").json()
    first = dict(zip(queue["columns"], queue["rows"][0], strict=True))
    pair = {name: first[name] for name in ("frame_i", "frame_j")}
    facts = server.get("/pair", params=pair).json()
    points = server.get("/points", params=pair).content

    assert {(20, 90), (41, 70)} == {tuple(row[:2]) for row in queue["rows"][:2]}
    assert facts["apart_m"] > 0.4
    assert points[:4] == b"R4PP"
    version, n_i, n_j = np.frombuffer(points[4:16], "<u4")
    xyz = np.frombuffer(points[16:], "<f4").reshape(-1, 3)
    assert version == 1
    assert len(xyz) == n_i + n_j
    assert 3000 < n_i <= 30_000
    assert np.abs(xyz).max() < 12.0  # the room, seen from inside it


def test_the_points_of_both_lie_on_each_other_where_the_graph_says(server):
    facts = server.get("/pair", params=RIGHT).json()
    data = server.get("/points", params=RIGHT).content
    n_i = int(np.frombuffer(data[8:12], "<u4")[0])
    xyz = np.frombuffer(data[16:], "<f4").reshape(-1, 3).astype(float)

    from recon4.review.decisions import pose_of

    moved = pose_of(facts["predicted"]) @ xyz[n_i:]
    from scipy.spatial import cKDTree

    distance_m = cKDTree(xyz[:n_i]).query(moved)[0]
    assert np.median(distance_m) < 0.06


def test_a_pair_of_moments_that_are_no_nodes_is_refused(server):
    answer = server.get("/points", params={"frame_i": 3, "frame_j": 4000})

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


def test_a_predicted_pose_far_off_does_not_become_an_edge(server):
    pair = {"frame_i": 30, "frame_j": 60}

    found = server.post("/align", json={**pair, "T_i_j": [80, 0, 0, 0, 0, 0, 1]}).json()

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


def keys_of(root):
    summary = json.loads((root / "summary.json").read_text())
    return {stage["stage"]: stage["key"] for stage in summary["stages"]}


def make_a_new_map(server, root):
    """As the button does: neither the recording nor an earlier job is needed."""
    answer = server.running.post(f"/api/projects/{root.name}/remake")
    assert answer.status_code == 201
    server.running.wait_state(answer.json()["job"]["id"], "succeeded")


def test_a_project_without_a_map_is_not_processed_again(server, root):
    shutil.rmtree(root)
    make(root, graph_only=True)

    answer = server.running.post(f"/api/projects/{root.name}/remake")

    assert answer.status_code == 404
    assert "no map yet" in answer.json()["detail"]


# -- approval


def approve(server, **more):
    return server.post("/approve", json={"why": "checked against the plan", **more})


def test_an_approval_is_signed_and_every_export_carries_it(server, root):
    answer = approve(server)

    assert answer.status_code == 201, answer.text
    approval = answer.json()["approval"]
    assert (approval["version"], approval["who"], approval["current"]) == (1, "local", True)
    sha = approval["hash"]
    folder = root / "versions" / "1"
    record = json.loads((folder / "approval.json").read_text())
    assert set(record["issued"]) == {*RESULTS, "summary.json"}
    assert record["statement"]["figures"]["points"] > 100_000
    assert json.loads((root / "summary.json").read_text())["approval"]["hash"] == sha
    for name in ("report.html", "trajectory.tum", "odometry.tum", "graph.g2o"):
        assert sha in (root / name).read_text()
    assert json.loads((root / "edges.json").read_text())["approval"]["hash"] == sha
    assert "Not approved" not in (root / "report.html").read_text()
    with laspy.open(root / "map.laz") as file:
        (vlr,) = file.header.vlrs.get_by_id("recon4")
    assert json.loads(vlr.record_data_bytes())["hash"] == sha
    read_g2o(root / "graph.g2o")
    read_tum(root / "trajectory.tum")


@pytest.mark.parametrize("why", ["", "   ok     "])
def test_an_unusable_map_is_not_approved_without_a_reason(server, root, why):
    judge(root, usability="do not use", reasons=[LOST], unobserved=[])

    facts = server.get().json()["map"]
    answer = approve(server, why=why, confirmed=True)

    assert facts["verdict"]["reasons"] == [LOST]
    assert LOST in facts["reason_needed"] and facts["figures"]["multiframes"] == 120
    assert answer.status_code == 409
    assert 'the verdict on this map is "do not use"' in answer.json()["detail"]
    assert not (root / "versions").exists()


def test_the_reason_for_an_unusable_map_is_signed_and_verified(server, root, capsys):
    why = "only the hall is used; it was checked by total station"
    judge(root, usability="do not use", reasons=[LOST], unobserved=[])

    answer = approve(server, why=why)

    assert answer.status_code == 201, answer.text
    assert answer.json()["approval"]["verdict"] == "do not use"
    assert why in (root / "report.html").read_text()
    with laspy.open(root / "map.laz") as file:
        (vlr,) = file.header.vlrs.get_by_id("recon4")
    assert json.loads(vlr.record_data_bytes())["why"] == why
    assert main(["verify", str(root)]) == 0
    assert f'verdict "do not use", reason "{why}"' in capsys.readouterr().out


def test_a_map_that_changed_during_the_login_is_not_signed(server):
    seen = server.get().json()
    server.post("/decisions", json={"kind": "reject", **RIGHT})
    server.post("/undo", json={"after_seq": seen["seq"] + 1})  # the map is the same, but who knows

    late = approve(server, after_seq=seen["seq"], graph=seen["graph"])
    other = approve(server, graph="0" * 64)
    now = approve(server, after_seq=seen["seq"] + 2, graph=seen["graph"])

    assert (late.status_code, other.status_code) == (409, 409)
    assert "look at it again" in late.json()["detail"]
    assert now.status_code == 201, now.text


def test_points_of_an_approved_map_are_those_of_the_draft(server, root):
    before = laspy.read(root / "map.laz")

    approve(server)

    after = laspy.read(root / "map.laz")
    assert np.array_equal(before.points.array, after.points.array)
    assert after.header.point_count == before.header.point_count


@pytest.mark.parametrize("name", ["map.laz", "map.ply"])
def test_an_export_of_an_approved_map_carries_the_approval(server, root, tmp_path, name):
    sha = approve(server).json()["approval"]["hash"]

    assert main(["export", str(root), str(tmp_path / name)]) == 0

    assert sha.encode() in (tmp_path / name).read_bytes()[:4000]


@pytest.mark.parametrize("name", ["s.svg", "s.laz", "s.csv", "s.dxf", "s.tif"])
def test_a_slice_cut_by_command_carries_the_approval(server, root, tmp_path, name):
    sha = approve(server).json()["approval"]["hash"]

    assert main(["slice", str(root), str(tmp_path / name), "--z", "0.5"]) == 0

    found = (tmp_path / name).read_bytes()
    assert sha[:16].encode() in found and b"Not approved" not in found


def test_an_approval_is_not_given_while_decisions_are_not_in_the_map(server):
    decide(server, "reject", RIGHT)

    answer = approve(server)

    assert answer.status_code == 409
    assert "make a new map first" in answer.json()["detail"]


def test_an_approval_is_not_given_while_a_job_waits(server, root):
    job = {"project": root.name, "recordings": [str(root / "project.json")]}
    assert server.running.post("/api/jobs", json=job).status_code == 201

    answer = approve(server)

    assert answer.status_code == 409
    assert "job" in answer.json()["detail"]


def test_conflicts_are_confirmed_with_a_reason_or_not_at_all(root, server):
    append(root, Decision(kind=DecisionKind.ACCEPT, who="Eva", pair=(20, 90)))
    make(root)

    refused = approve(server)
    without_reason = approve(server, confirmed=True, why=" ")
    confirmed = approve(server, confirmed=True)

    assert [refused.status_code, without_reason.status_code] == [409, 409]
    assert "do not fit" in refused.json()["detail"]
    assert confirmed.status_code == 201
    statement = json.loads((root / "versions/1/approval.json").read_text())["statement"]
    assert statement["figures"]["conflicts"] == 1
    assert statement["why"] == "checked against the plan"


def slice_of(server, root, **changes):
    asked = json.dumps({"cut": {"kind": "horizontal", "z_m": 0.5}} | changes)
    return server.running.get(
        f"/api/projects/{root.name}/slices/export.csv", params={"ask": asked}
    ).text


def test_a_later_map_does_not_change_an_approved_version(server, root, capsys):
    sha = approve(server).json()["approval"]["hash"]
    approved = f"map:{keys_of(root)['map']}"
    files = sorted((root / "versions" / "1").iterdir())
    before = {path.name: hash_file(path) for path in files}
    decide(server, "reject", RIGHT)

    make_a_new_map(server, root)
    record = server.get().json()
    stages = json.loads((root / "summary.json").read_text())["stages"]
    assert [one["stage"] for one in stages if one["reused"]] == [
        *("frames", "odometry", "graph", "verification"),
    ]
    assert record["in_map"]
    assert sha in slice_of(server, root, source=approved)
    assert sha not in slice_of(server, root)
    second = approve(server).json()["approval"]

    assert {path.name: hash_file(path) for path in files} == before
    assert record["approval"]["current"] is False
    assert (second["version"], second["current"]) == (2, True)
    assert main(["verify", str(root)]) == 0
    assert "version 1, approved by local" in capsys.readouterr().out


def test_undoing_everything_finds_the_approved_results_again(server, root):
    sha = approve(server).json()["approval"]["hash"]
    decide(server, "reject", RIGHT)
    make(root)
    assert sha not in (root / "report.html").read_text()

    server.post("/undo", json={})
    remake(root)  # which finds what `make` left, as it makes the same

    assert sha in (root / "report.html").read_text()
    assert json.loads((root / "summary.json").read_text())["approval"]["hash"] == sha
    assert main(["verify", str(root)]) == 0


def forge_row(root):
    db = sqlite3.connect(root / NAME)
    db.execute("DROP TRIGGER no_change")
    db.execute("UPDATE journal SET who = 'Jan' WHERE seq = 1")
    db.commit()
    db.close()


def change_statement(root):
    path = root / "versions/1/approval.json"
    record = json.loads(path.read_text())
    record["statement"]["figures"]["points"] += 1
    overwrite(path, json.dumps(record).encode())


def change_result(root):
    path = root / "versions/1/edges.json"
    overwrite(path, path.read_bytes().replace(b"loop", b"lo0p", 1))


def change_issued(root):
    path = root / "versions/1/approval.json"
    record = json.loads(path.read_text())
    change_result(root)
    record["issued"]["edges.json"] = hash_file(root / "versions/1/edges.json")
    overwrite(path, json.dumps(record).encode())


def add_version(root):
    shutil.copytree(root / "versions/1", root / "versions/2")


def overwrite(path, data):
    path.chmod(0o644)
    path.write_bytes(data)


@pytest.mark.parametrize(
    ("forge", "words"),
    [
        (forge_row, "row 1 (reject by Jan) was changed"),
        (change_statement, "the statement is not the one in the journal"),
        (change_result, "edges.json has other bytes"),
        (change_issued, "the signature is not valid"),
        (add_version, "versions/2 is in no row of the journal"),
    ],
)
def test_verify_finds_every_change(server, root, capsys, forge, words):
    decide(server, "reject", RIGHT)
    server.post("/undo", json={})
    approve(server)
    assert main(["verify", str(root)]) == 0

    forge(root)

    assert main(["verify", str(root)]) == 1
    assert words in capsys.readouterr().out


def test_an_interrupted_approval_does_not_block_the_next_one(server, root):
    (root / "versions" / "1").mkdir(parents=True)

    answer = approve(server)

    assert answer.json()["approval"]["version"] == 1
    assert main(["verify", str(root)]) == 0
