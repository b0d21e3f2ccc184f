"""One bad project is one bad card: no file of a project takes the list from the others.

Figures held: 0 answers of 500; every good project is listed; every bad one says which file and why.
"""

import json
import sqlite3

import httpx
import pytest

from tests.project_builder import build_project
from tests.served import served
from tests.service.running import server_thread
from tests.service.tus_client import create

DEEP = "[" * 100_000
DEEP_OBJECT = '{"a":' * 5_000 + "1" + "}" * 5_000
RIGHT_TO_LEFT = "plan\u202egnp.exe"
HIDDEN = {
    "right-to-left override": RIGHT_TO_LEFT,
    "isolate": "a\u2066b",
    "zero width": "ad\u200bmin",
    "soft hyphen": "ad\u00admin",
    "byte order mark": "\ufeffoffice",
    "NUL": "a\0b",
    "escape": "a\x1b[2Jb",
    "line separator": "a\u2028b",
    "half a character": "a\ud800b",
    "too long": "x" * 5_000,
}
BAD_JSON = {
    "deep": DEEP,
    "deep_object": DEEP_OBJECT,
    "surrogate": '{"format": 1, "name": "a\\ud800b"}',
    "no_number": '{"format": 1, "path_length_m": NaN}',
    "infinite": '{"format": 1, "path_length_m": 1e999}',
    "long_number": '{"format": 1, "points": ' + "9" * 10_000 + "}",
    "no_utf8": b'{"format": 1, "name": "\xff"}',
    "no_object": "[1]",
    "empty": "",
}


def projects(root):
    build_project(root / "good", points=20_000)
    for file in ("project", "summary"):
        for kind, text in BAD_JSON.items():
            folder = root / f"{file}-{kind}"
            folder.mkdir()
            (folder / "project.json").write_text('{"format": 1, "name": "fine"}')
            data = text if isinstance(text, bytes) else text.encode()
            (folder / f"{file}.json").write_bytes(data)
    hidden = root / "hidden"
    hidden.mkdir()
    (hidden / "project.json").write_text(json.dumps({"format": 1, "name": RIGHT_TO_LEFT}))
    odd = root / "odd"
    odd.mkdir()
    facts = {"format": 1, "name": {"a": [1]}, "rig": ["x"], "preset": 7}
    (odd / "project.json").write_text(json.dumps(facts))
    (odd / "summary.json").write_text(json.dumps({"path_length_m": 10**400, "points": True}))
    spoil_ledger(root)
    (root / ".recon4" / "trash" / "gone@99999999T999999999999").mkdir(parents=True)


server = served(projects)


def spoil_ledger(root):
    """Columns of another kind, and a text that is no UTF-8."""
    for name, change in {
        "ledger-text": "UPDATE stages SET seconds = 'soon'",
        "ledger-infinite": "UPDATE stages SET seconds = 9e999",
        "ledger-bytes": "UPDATE stages SET finished = CAST(x'ff' AS TEXT)",
    }.items():
        build_project(root / name, with_map=False)
        with sqlite3.connect(root / name / "ledger.sqlite") as db:
            db.execute(change)
        db.close()


def test_good_projects_are_listed_and_bad_ones_have_a_problem(server):
    answer = server.get("/api/projects")
    cards = {card["id"]: card for card in answer.json()}

    assert answer.status_code == 200 and cards["good"]["problem"] == ""
    for file in ("project", "summary"):
        for kind in BAD_JSON:
            problem = cards[f"{file}-{kind}"]["problem"]
            assert problem.startswith(f"{file}.json"), (kind, problem)
    assert "at most 64 levels" in cards["project-deep"]["problem"]
    assert "lone surrogate" in cards["project-surrogate"]["problem"]


def test_invisible_characters_of_a_name_on_disk_are_escaped(server):
    cards = {card["id"]: card for card in server.get("/api/projects").json()}

    assert cards["hidden"]["name"] == "plan<U+202E>gnp.exe"
    assert cards["odd"]["path_length_m"] is None


def test_the_page_of_a_bad_project_answers(server):
    for card in server.get("/api/projects").json():
        answer = server.get(f"/api/projects/{card['id']}")
        assert answer.status_code == 200, (card["id"], answer.text)
        if card["id"].startswith(("project-", "summary-", "ledger-")):
            assert answer.json()["problem"]


def test_a_folder_in_the_trash_with_a_moment_no_calendar_has_is_left_alone(server):
    assert server.get("/api/trash").json() == []


def test_one_bad_reference_is_one_bad_row(server):
    folder = server.root / "good" / "slices" / "references"
    for name, text in {"0" * 12: DEEP, "1" * 12: '{"name": "a\\ud800"}', "2" * 12: "{}"}.items():
        (folder / name).mkdir(parents=True)
        (folder / name / "reference.json").write_text(text)

    answer = server.get("/api/projects/good/slices")

    assert answer.status_code == 200, answer.text
    assert [one["kind"] for one in answer.json()["references"]] == ["damaged"] * 3


@pytest.mark.parametrize("name", HIDDEN.values(), ids=HIDDEN)
def test_a_name_with_invisible_characters_is_rejected_with_a_message(server, name):
    """Projects, uploads, references, control points, notes."""
    base = "/api/projects/good"
    point = {"id": name, "xyz_m": [0, 0, 0]}
    requests = [
        ("PATCH", base, {"name": name}),
        ("POST", "/api/uploads", {"name": name, "files": 1, "bytes": 1}),
        ("POST", f"{base}/slices/references", {"path": "/x", "name": name}),
        ("PUT", f"{base}/slices/control", {"points": [point]}),
        ("PUT", f"{base}/slices/control", {"picks": {name: [0, 0, 0]}}),
        ("POST", f"{base}/review/undo", {"why": name}),
    ]
    for method, path, body in requests:
        answer = httpx.request(
            method,
            server.url + path,
            content=json.dumps(body),
            headers={"Content-Type": "application/json", "Origin": server.url},
        )
        assert answer.status_code == 422, (path, answer.text)
        assert answer.json()["detail"], path
        answer.text.encode()


def test_a_name_in_tus_metadata_is_refused_in_words(server):
    for name in (RIGHT_TO_LEFT, "a\u200bb"):
        answer = create(server.url, 1, filename=name)
        assert answer.status_code in (400, 422) and "invisible" in answer.json()["detail"]


def test_a_survey_point_with_a_hidden_name_is_left_out_and_counted():
    from recon4.slices.control_points import read_control

    found = read_control("A,1,2,3\nB\u202e,1,2,3\n".encode())

    assert [point.id for point in found.points] == ["A"]
    assert "line 2" in found.skipped[0] and "U+202E" in found.skipped[0]


def test_an_upload_with_bad_facts_does_not_hide_the_others(tmp_path):
    uploads = tmp_path / ".recon4" / "uploads"
    good = {
        "id": "a" * 12, "name": "walk\u202e", "files": 1, "bytes": 1, "fingerprint": "",
        "by": "anna", "created": "2026-11-22", "folder": "walk-" + "a" * 12, "finished": False,
    }  # fmt: skip
    bad = [DEEP, '{"name": "\\ud800"}', json.dumps(good | {"bytes": "many"}), "{}"]
    for number, text in enumerate([json.dumps(good), *bad]):
        folder = uploads / ("a" * 12 if number == 0 else f"{number:012x}")
        (folder / "parts").mkdir(parents=True)
        (folder / "data").mkdir()
        (folder / "upload.json").write_text(text)

    with server_thread(tmp_path) as running:
        found = running.get("/api/uploads")
        notices = running.get("/api/server").json()["notices"]

    assert [one["name"] for one in found.json()] == ["walk<U+202E>"]
    damaged = [notice for notice in notices if "cannot be resumed" in notice]
    assert len(damaged) == 4
    assert all(f"{number:012x}" in damaged[number - 1] for number in range(1, 5))


def test_one_damaged_row_of_the_queue_is_one_failed_job(tmp_path):
    build_project(tmp_path / "office", with_map=False)
    with server_thread(tmp_path):
        pass
    with sqlite3.connect(tmp_path / ".recon4" / "jobs.sqlite") as db:
        for number, inputs in enumerate(("[1", "{}", '"x"', '{"recordings": 7}'), start=1):
            db.execute(
                "INSERT INTO jobs (number, id, project, inputs, created, state, attempt, started,"
                " finished, note) VALUES (?, ?, 'office', ?, '', 'succeeded', 1, '', '', '')",
                (number, f"{number:012x}", inputs),
            )
    db.close()

    with server_thread(tmp_path) as running:
        answer = running.get("/api/projects/office/jobs")

    assert answer.status_code == 200
    assert ["damaged" in one["job"]["note"] for one in answer.json()] == [True] * 4
