"""Projects, results and pages over HTTP."""

import json
import socket

import httpx
import pytest

from recon4.errors import StoreError
from recon4.store.atomic import write_json
from recon4.store.seal import changing
from recon4.system.stopping import StopSignals
from recon4_app.main import serve
from recon4_app.network.listen import listening
from recon4_app.settings import ServerSettings
from tests.project_builder import build_project
from tests.served import served
from tests.service.running import server_process, server_thread


def projects(root):
    build_project(root / "office", points=20_000)
    build_project(root / "half", with_map=False)
    (root / "not a project").mkdir()
    (root / "broken").mkdir()
    (root / "broken" / "project.json").write_text("{")
    (root / "broken" / "ledger.sqlite").write_bytes(b"no database" * 100)


server = served(projects)


def test_the_list_shows_every_project_also_a_damaged_one(server):
    found = {project["id"]: project for project in server.get("/api/projects").json()}

    assert found.keys() == {"office", "half", "broken"}
    assert found["office"]["finished"] and not found["half"]["finished"]
    assert found["office"]["path_length_m"] == 58.2 and found["half"]["path_length_m"] is None
    assert found["office"]["has_map"] and not found["half"]["has_map"]


def test_the_verdict_on_a_map_stands_on_its_card(tmp_path):
    for name, usability in (("ruined", "do not use"), ("fine", "good"), ("odd", ["?"])):
        build_project(tmp_path / name, points=1000)
        summary = json.loads((tmp_path / name / "summary.json").read_text())
        verdict = {"usability": usability, "reasons": ["The LiDAR observes nothing."]}
        with changing(tmp_path / name, "summary.json", compared=False):
            write_json(tmp_path / name / "summary.json", summary | {"verdict": verdict})
    with server_thread(tmp_path) as running:
        cards = {card["id"]: card["usability"] for card in running.get("/api/projects").json()}

    assert cards == {"ruined": "do not use", "fine": "good", "odd": ""}


def test_a_project_lists_its_stages_also_a_damaged_one(server):
    found = {
        name: server.get(f"/api/projects/{name}").json() for name in ("office", "half", "broken")
    }

    assert [row["stage"] for row in found["office"]["stages"]] == [
        "odometry",
        "verification",
        "level",
        "map",
    ]
    assert found["half"]["viewable"] and not found["half"]["has_map"]
    assert not found["broken"]["viewable"]


def test_a_result_is_downloaded_as_an_attachment(server):
    answer = server.get("/api/projects/office/files/trajectory.tum")

    assert answer.text.startswith("0 0 0")
    assert answer.headers["content-type"] == "application/octet-stream"
    assert answer.headers["content-disposition"] == 'attachment; filename="office-trajectory.tum"'


def test_the_picture_shows_the_map_and_a_project_without_one_has_none(server):
    image = server.get("/api/projects/office/thumbnail")

    assert image.content.startswith(b"\x89PNG")
    assert server.get("/api/projects/half/thumbnail").status_code == 404


def test_errors_have_a_message(server):
    answer = server.get("/api/projects/nowhere")

    assert answer.status_code == 404
    assert answer.json() == {
        "error": "NotFound",
        "detail": "no project 'nowhere'",
        "code": "project-unknown",
        "values": {"name": "nowhere"},
    }


def test_an_error_is_said_in_the_language_of_who_reads_it(server):
    german = server.get("/api/projects/nowhere", headers={"Accept-Language": "de-AT,en;q=0.5"})
    chosen = server.get(
        "/api/projects/nowhere", headers={"Accept-Language": "de", "Cookie": "recon4_language=en"}
    )

    assert german.json()["detail"] == "kein Projekt 'nowhere'"
    assert german.json()["code"] == chosen.json()["code"] == "project-unknown"
    assert chosen.json()["detail"] == "no project 'nowhere'"


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("/projects/nowhere/", "no project &#x27;nowhere&#x27;"),
        ("/projects/%3Cb%3E/", "no project &#x27;&lt;b&gt;&#x27;"),
        ("/no/such/page", "no such address"),
    ],
)
def test_a_browser_gets_an_error_page(server, path, words):
    page = server.get(path, headers={"Accept": "text/html,*/*"})
    program = server.get(path)

    assert page.status_code == program.status_code == 404
    assert page.headers["content-type"].startswith("text/html")
    assert words in page.text and "All projects" in page.text
    assert set(program.json()) <= {"error", "detail", "code", "values"}


def test_folders_come_before_files_and_hidden_ones_not_at_all(server):
    entries = server.get("/api/recordings", params={"folder": str(server.root / "office")}).json()

    assert [entry["name"] for entry in entries][:1] == ["artifacts"]
    assert not any(entry["name"].startswith(".") for entry in entries)


def test_every_route_is_in_the_api_description(server):
    paths = server.get("/openapi.json").json()["paths"]

    assert {"/api/projects", "/api/jobs", "/api/jobs/{job_id}/cancel", "/api/events"} <= set(paths)
    for methods in paths.values():
        for operation in methods.values():
            assert operation.get("description"), operation["operationId"]


def test_the_api_description_has_permissions_and_errors(server):
    described = server.get("/openapi.json").json()

    paths = described["paths"]
    assert paths["/api/projects"]["get"]["x-needs"] == ["look"]
    assert paths["/api/jobs"]["post"]["x-needs"] == ["look", "process"]
    assert paths["/api/people"]["get"]["x-needs"] == ["administer"]
    assert paths["/api/login"]["post"]["x-needs"] == []
    assert "HTTPValidationError" not in str(described)
    records = described["components"]["schemas"]
    assert records["NewJob"]["properties"]["imu"]["description"].startswith("CSV file")
    assert records["ProjectView"]["properties"]["finished"]["description"] == (
        "Whether a run has finished."
    )
    assert server.get("/openapi.json").json() == described


@pytest.mark.study
def test_two_servers_do_not_share_a_folder(tmp_path):
    with server_process(tmp_path) as (server, _):
        assert httpx.get(f"{server.url}/healthz").status_code == 200

        with pytest.raises(StoreError, match="another server runs"):
            serve(ServerSettings(root=tmp_path, port=0), StopSignals())


def test_answers_are_not_held_back_by_the_network(tmp_path):
    """Where the protocol is not named, asyncio leaves 40 ms of Nagle's delay in each answer."""
    with listening(ServerSettings(root=tmp_path, port=0)) as listener:
        assert listener.proto == socket.IPPROTO_TCP


def test_a_port_in_use_is_reported(tmp_path):
    with server_thread(tmp_path) as server, pytest.raises(StoreError, match="is in use"):
        (tmp_path / "other").mkdir()
        port = int(server.url.rsplit(":", 1)[1])
        serve(ServerSettings(root=tmp_path / "other", port=port), StopSignals())
