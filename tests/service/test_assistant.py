"""``recon4 mcp`` as an assistant uses it: the SDK's own client, a process, a server with login."""

import base64
import hashlib
import json
import sys
from contextlib import ExitStack

import anyio
import pytest
from anyio.from_thread import start_blocking_portal
from mcp import Client, StdioServerParameters

from tests.deadlines import HANG_S
from tests.project_builder import build_project, write_summary
from tests.service.running import ROOT
from tests.service.secure import PASSWORD, secure_server

DOUBLE = {
    "kind": "TIME-GAP",
    "level": "check",
    "title": "Gap",
    "text": "The recording has a gap.",
    "span_s": [3.0, 5.0],
}


class Assistant:
    """Calls tools from a test that is no coroutine."""

    def __init__(self, portal, client):
        self._portal, self._client = portal, client
        self.progress = []

    def __call__(self, tool, **arguments):
        found = self.answer(tool, **arguments)
        assert not found.is_error, found.content[0].text
        return found.structured_content

    def refused(self, tool, **arguments):
        found = self.answer(tool, **arguments)
        assert found.is_error
        return found.content[0].text

    def answer(self, tool, **arguments):
        return self._portal.call(self._answer, tool, arguments)

    async def _answer(self, tool, arguments):
        async def note(done, total, message):
            self.progress.append(done)

        with anyio.fail_after(HANG_S):
            return await self._client.call_tool(tool, arguments, progress_callback=note)

    def tools(self):
        return {tool.name: tool for tool in self._portal.call(self._client.list_tools).tools}


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=20_000)
    build_project(root / "other", points=1000)
    summary = json.loads((root / "other" / "summary.json").read_text())
    summary |= {"findings": [DOUBLE], "settings": {"map": {"voxel_m": 0.05}}}
    summary["verdict"] = {"usability": "check", "reasons": ["The recording has a gap."]}
    write_summary(root / "other", summary)
    with secure_server(root, worker_module="tests.service.finishing_worker") as running:
        yield running


@pytest.fixture(scope="module")
def downloads(tmp_path_factory):
    return tmp_path_factory.mktemp("downloads")


@pytest.fixture(scope="module")
def assistant(server, downloads):
    certificate = server.root / ".recon4" / "tls" / "certificate.pem"
    options = ["--certificate", str(certificate), "--allow-write"]
    url = server.url.replace("https://", "https://rita@")
    command = StdioServerParameters(
        command=sys.executable,
        args=["-m", "recon4", "mcp", url, *options, "--downloads", str(downloads)],
        env={"RECON4_PASSWORD": PASSWORD},
        cwd=ROOT,
    )
    with ExitStack() as stack:
        portal = stack.enter_context(start_blocking_portal())
        client = stack.enter_context(portal.wrap_async_context_manager(Client(command)))
        yield Assistant(portal, client)
    # the process signed out when its standard input ended
    assert server.running.app.state.parts.access.sessions.all(person="rita") == []


def test_projects_are_listed_and_read_with_verdict_and_findings(assistant, server):
    listed = assistant("list_projects", search="OTH")
    summary = assistant("project_summary", project="other")

    assert (listed["total"], listed["projects"][0]["usability"]) == (1, "check")
    assert summary["verdict"]["usability"] == "check"
    assert [one["kind"] for one in summary["findings"]] == ["TIME-GAP"]
    assert summary["findings"][0]["span_s"] == [3.0, 5.0]
    assert summary["figures"]["edges.accepted"] == 108
    assert summary["page"] == f"{server.url}/projects/other/"


def test_a_finding_is_explained_from_the_catalog(assistant):
    assert "TIME-GAP" in assistant("explain_finding")["result"]
    assert "Detected:" in assistant("explain_finding", code="time-gap")["result"]
    assert "similar: TIME-GAP" in assistant.refused("explain_finding", code="TIME-GAPS")


def test_two_runs_are_compared_by_what_differs(assistant):
    found = assistant("compare_runs", first="office", second="other")

    assert found["verdicts"] == ["good", "check"]
    assert found["figures"] == [{"name": "points", "first": 20_000, "second": 1000}]
    assert found["settings"] == [{"name": "map.voxel_m", "first": None, "second": 0.05}]
    (gap,) = found["findings"]
    assert (gap["kind"], gap["first"], len(gap["second"])) == ("TIME-GAP", [], 1)


def test_a_job_is_started_watched_and_its_result_fetched(assistant, server, downloads):
    (server.root / "walk.pcap").write_bytes(b"any")
    (entry,) = [
        one
        for one in assistant("browse_recordings", folder=str(server.root))["result"]
        if one["name"] == "walk.pcap"
    ]
    job = {"recordings": [entry["path"]], "project": "new"}

    started = assistant("start_job", job=job)
    at_once = assistant("watch_job", job=started["job"]["id"], wait_s=0.0)
    ended = assistant("watch_job", job=started["job"]["id"], wait_s=HANG_S)
    fetched = [assistant("download_export", project="new", file="trajectory.tum") for _ in range(2)]

    assert at_once["job"]["state"] in ("queued", "running")
    assert ended["job"]["state"] == "succeeded" and assistant.progress
    assert "already: choose another name" in assistant.refused("start_job", job=job)
    names = [one["path"].rpartition("/")[2] for one in fetched]
    assert names == ["new-trajectory.tum", "new-trajectory-2.tum"]
    data = (downloads / "new-trajectory.tum").read_bytes()
    assert data == (server.root / "new" / "trajectory.tum").read_bytes()
    assert hashlib.sha256(data).hexdigest() == fetched[0]["sha256"]
    assert sorted(path.name for path in downloads.iterdir()) == sorted(names)
    with server.signed_in("anna") as admin:
        entries = admin.get("/api/audit").json()["entries"]
    assert ("rita", "start job") in {(one["person"], one["action"]) for one in entries}


def test_files_are_listed_and_others_refused_by_name(assistant):
    listed = assistant("list_exports", project="office")

    assert "report.html" in [one["name"] for one in listed["files"]]
    assert "map.e57" in listed["written_on_request"]
    assert "expected one of" in assistant.refused(
        "download_export", project="office", file="passwd.txt"
    )
    assert "404" in assistant.refused("project_summary", project="nothing")
    assert "pattern" in assistant.refused("project_summary", project="../../etc")


def test_a_file_of_the_map_is_exported_once_and_fetched(assistant, server, downloads):
    fetched = [assistant("download_export", project="office", file="map.xyz") for _ in range(2)]

    assert fetched[0]["sha256"] == fetched[1]["sha256"]
    assert len((downloads / "office-map.xyz").read_text().splitlines()) == 20_000 + 1
    with server.signed_in("rita") as rita:
        (listed,) = rita.get("/api/projects/office/exports").json()
    assert (listed["file"], listed["person"]) == ("map.xyz", "rita")
    refused = assistant.refused(
        "download_export", project="office", file="map.xyz", crs="EPSG:25832"
    )
    assert "cannot be put into EPSG:25832" in refused


def test_a_slice_is_an_image_with_its_scale(assistant):
    image, about = assistant.answer("slice_image", project="office").content

    assert image.mime_type == "image/png" and base64.b64decode(image.data)[1:4] == b"PNG"
    assert "cm a pixel" in about.text
    ends_m = [[0.0, 5.0], [16.0, 5.0]]
    upright = assistant.answer("slice_image", project="office", ends_m=ends_m).content[1].text
    assert upright.startswith("azimuth 90.0°")


def test_a_loop_is_decided_with_a_reason_unless_another_person_was_faster(assistant, server):
    pair = assistant("list_loops", project="office", most=1)["pairs"][0]
    frames = {name: pair[name] for name in ("frame_i", "frame_j")}
    asked = {"project": "office", "pair": [*frames.values()], "kind": "reject"}
    asked["why"] = "the walls of two rooms look alike"
    with server.signed_in("anna") as admin:
        path = "/api/projects/office/review/decisions"
        admin.post(path, json={"kind": "accept", **frames}).raise_for_status()

    refused = assistant.refused("decide_loop", **asked, seen_decisions=0)
    decided = assistant("decide_loop", **asked, seen_decisions=1)
    undone = assistant("undo_decision", project="office", why="tried", seen_decisions=2)

    assert "409" in refused and "anna" in refused
    assert decided["seq"] == 2 and not decided["in_map"]
    assert (undone["seq"], undone["undoable"]) == (3, 1)


def test_an_ended_session_is_begun_again(assistant, server):
    sessions = server.running.app.state.parts.access.sessions
    for session in sessions.all(person="rita"):
        sessions.end(session.id)

    assert assistant("list_projects")["total"] >= 2


def test_the_tools_say_what_they_change_and_none_approves(assistant):
    tools = assistant.tools()
    looking = {name for name, tool in tools.items() if tool.annotations.read_only_hint}

    assert {"start_job", "resume_job", "rebuild_map", "cancel_job"} <= tools.keys() - looking
    assert {"list_projects", "watch_job", "slice_image", "compare_runs"} <= looking
    assert not [name for name in tools if "approve" in name]
    assert all(tool.description for tool in tools.values())
    assert [name for name, tool in tools.items() if not tool.output_schema] == ["slice_image"]
