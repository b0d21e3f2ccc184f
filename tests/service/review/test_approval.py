"""Approval over HTTP: what is signed is locked."""

import json
import shutil
import sqlite3

import laspy
import pytest

from recon4.cli.main import main
from recon4.pipeline import remake
from recon4.recording.formats.poses import read_tum
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import NAME, append
from recon4.store.atomic import write_json
from recon4.store.hashing import hash_file
from recon4.store.project import SUMMARY, read_artifacts
from recon4.store.seal import changing
from recon4.workflows.map_results import RESULTS
from tests.g2o_reader import read_g2o
from tests.review_project import LOST, judge, make
from tests.service.review.reviewing import RIGHT, Reviewing, decide, keys_of, make_a_new_map

# -- approval


def approve(server, **more):
    return server.post("/approve", json={"why": "checked against the plan", **more})


@pytest.fixture(scope="module")
def approved(made, running):
    """A project with an approved version, for tests that do not change it; and its hash."""
    root = running.root / "approved"
    shutil.copytree(made, root)
    server = Reviewing(running, root)
    decide(server, "reject", RIGHT)
    server.post("/undo", json={})
    return root, approve(server).json()["approval"]["hash"]


def test_an_approval_is_signed_and_every_export_carries_it(server, root):
    answer = approve(server)

    assert answer.status_code == 201, answer.text
    approval = answer.json()["approval"]
    assert (approval["version"], approval["who"], approval["kind"]) == (1, "local", "approved")
    sha = approval["hash"]
    folder = root / "versions" / "1"
    record = json.loads((folder / "approval.json").read_text())
    assert set(record["issued"]) == {*RESULTS, "summary.json"}
    assert record["statement"]["figures"]["points"] > 100_000
    assert [one["serial"] for one in record["statement"]["figures"]["rig_origin"]["sensors"]]
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
    assert before.points.array.tobytes() == after.points.array.tobytes()  # NaN too
    assert after.header.point_count == before.header.point_count


@pytest.mark.parametrize("name", ["map.laz", "map.ply"])
def test_an_export_of_an_approved_map_carries_the_approval(approved, tmp_path, name):
    root, sha = approved

    assert main(["export", str(root), str(tmp_path / name)]) == 0

    assert sha.encode() in (tmp_path / name).read_bytes()[:4000]


@pytest.mark.parametrize("name", ["s.svg", "s.laz", "s.csv", "s.dxf", "s.tif"])
def test_a_slice_cut_by_command_carries_the_approval(approved, tmp_path, name):
    root, sha = approved

    assert main(["slice", str(root), str(tmp_path / name), "--z", "0.5"]) == 0

    found = (tmp_path / name).read_bytes()
    assert sha[:16].encode() in found and b"Not approved" not in found


def test_an_approval_is_not_given_while_decisions_are_not_in_the_map(server):
    decide(server, "reject", RIGHT)

    answer = approve(server)

    assert answer.status_code == 409
    assert "rebuild the map first" in answer.json()["detail"]


def test_an_approval_is_not_given_while_a_job_waits(server, root):
    job = {"project": root.name, "recordings": [str(root / "project.json")]}
    assert server.running.post("/api/jobs", json=job).status_code == 201

    answer = approve(server)

    assert answer.status_code == 409
    assert "job" in answer.json()["detail"]


def accept_conflict(root):
    """A decision that does not fit, taken into the project; its map is the earlier one."""
    append(root, Decision(kind=DecisionKind.ACCEPT, who="Eva", pair=(20, 90)))
    make(root, graph_only=True)
    with changing(root, SUMMARY, compared=False):
        summary = json.loads((root / SUMMARY).read_text("utf-8"))
        reviewed = {"stage": "review", "key": read_artifacts(root)["review"].name}
        summary["stages"].append(summary["stages"][0] | reviewed)
        (root / SUMMARY).unlink()
        write_json(root / SUMMARY, summary)


def test_conflicts_are_confirmed_with_a_reason_or_not_at_all(root, server):
    accept_conflict(root)

    refused = approve(server)
    without_reason = approve(server, confirmed=True, why=" ")
    confirmed = approve(server, confirmed=True)

    assert [refused.status_code, without_reason.status_code] == [409, 409]
    assert "1 accepted loop closure does not fit" in refused.json()["detail"]
    assert confirmed.status_code == 201
    statement = json.loads((root / "versions/1/approval.json").read_text())["statement"]
    assert statement["figures"]["conflicts"] == 1
    assert statement["why"] == "checked against the plan"


def slice_of(server, root, **changes):
    asked = json.dumps({"plane": {"kind": "horizontal", "z_m": 0.5}} | changes)
    return server.running.get(
        f"/api/projects/{root.name}/slices/export.csv", params={"ask": asked}
    ).text


@pytest.mark.study
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
        *("frames", "odometry", "graph", "verification", "intensity", "classes", "map"),
    ]  # the decision hardly moves the map, which stays where it was: a draft with the same points
    assert record["in_map"]
    assert sha in slice_of(server, root, source=approved)
    assert sha not in slice_of(server, root)
    second = approve(server).json()["approval"]

    assert {path.name: hash_file(path) for path in files} == before
    assert record["approval"]["text"] == "Draft: changed since version 1"
    assert (second["version"], second["kind"]) == (2, "approved")
    assert main(["verify", str(root)]) == 0
    assert "version 1, approved by local" in capsys.readouterr().out


@pytest.mark.study
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


def test_verify_finds_nothing_where_nothing_was_changed(approved, capsys):
    assert main(["verify", str(approved[0])]) == 0
    assert "version 1, approved by local" in capsys.readouterr().out


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
def test_verify_finds_every_change(approved, tmp_path, capsys, forge, words):
    root = shutil.copytree(approved[0], tmp_path / "forged")

    forge(root)

    assert main(["verify", str(root)]) == 1
    assert words in capsys.readouterr().out


def test_an_interrupted_approval_does_not_block_the_next_one(server, root):
    (root / "versions" / "1").mkdir(parents=True)

    answer = approve(server)

    assert answer.json()["approval"]["version"] == 1
    assert main(["verify", str(root)]) == 0
