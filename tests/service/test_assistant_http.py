"""The tools over HTTP: the SDK's own client, access tokens, a server with login."""

import os
import subprocess
import sys
from contextlib import ExitStack

import httpx2
import pytest
from anyio.from_thread import start_blocking_portal
from mcp import Client
from mcp.client.streamable_http import streamable_http_client

from recon4_app.assistant.tuning import ASSISTANT
from tests.deadlines import HANG_S
from tests.project_builder import build_project
from tests.service.running import ROOT, server_thread
from tests.service.secure import secure_server
from tests.service.test_assistant import Assistant

HELLO = {"jsonrpc": "2.0", "id": 1, "method": "tools/list", "params": {}}
TAKES = {"Accept": "application/json, text/event-stream"}
WRITING = {"start_job", "resume_job", "cancel_job", "rebuild_map", "decide_loop", "undo_decision"}


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=1000)
    with secure_server(root, worker_module="tests.service.finishing_worker") as running:
        yield running


@pytest.fixture(scope="module")
def portal():
    with start_blocking_portal() as portal:
        yield portal


def token_of(server, name, **asked):
    with server.signed_in(name) as person:
        made = person.post("/api/me/tokens", json={"label": "helper", **asked})
        assert made.status_code == 201, made.text
        return made.json()["token"]


def bearer(token):
    return {"Authorization": f"Bearer {token}"}


@pytest.fixture
def connected(server, portal):
    """Connects the client of the SDK, in the older protocol with a handshake or the newer one."""
    with ExitStack() as stack:

        def connect(token, mode="auto"):
            http = httpx2.AsyncClient(verify=server.trust(), headers=bearer(token), timeout=HANG_S)
            stack.enter_context(portal.wrap_async_context_manager(http))
            transport = streamable_http_client(f"{server.url}/mcp", http_client=http)
            client = Client(transport, mode=mode)
            opened = stack.enter_context(portal.wrap_async_context_manager(client))
            return Assistant(portal, opened)

        yield connect


def audit_of(server):
    with server.signed_in("anna") as admin:
        entries = admin.get("/api/audit").json()["entries"]
    return [(one["person"], one["action"], one["object"], one["outcome"]) for one in entries]


@pytest.mark.parametrize("mode", ["legacy", "auto"])
def test_a_token_of_a_viewer_only_looks(server, connected, mode):
    assistant = connected(token_of(server, "rita"), mode)

    assert not WRITING & assistant.tools().keys()
    assert assistant("list_projects")["total"] == 1
    assert (
        assistant("project_summary", project="office")["page"] == f"{server.url}/projects/office/"
    )
    assert "403" in assistant.refused("browse_recordings")


@pytest.mark.study
def test_a_job_is_started_and_watched_with_progress(server, connected):
    (server.root / "walk.pcap").write_bytes(b"any")
    assistant = connected(token_of(server, "otto", role="operator"))
    job = {"recordings": [str(server.root / "walk.pcap")], "project": "new"}

    started = assistant("start_job", job=job)
    ended = assistant("watch_job", job=started["job"]["id"], wait_s=HANG_S)

    assert ended["job"]["state"] == "succeeded" and assistant.progress
    entries = audit_of(server)
    started = [what for who, action, what, _ in entries if (who, action) == ("otto", "start job")]
    assert started and started[0].endswith("(access token helper)")
    assert ("otto", "assistant", "start_job (access token helper)", "done") in entries


def test_a_file_is_downloaded_with_the_same_token(server, connected):
    token = token_of(server, "vera")
    assistant = connected(token)

    found = assistant("export_address", project="office", file="trajectory.tum")["url"]

    with server.client() as stranger:
        assert stranger.get(found).status_code == 401
        fetched = stranger.get(found, headers=bearer(token))
    assert fetched.content == (server.root / "office" / "trajectory.tum").read_bytes()


def test_the_client_of_the_documentation_lists_the_verdicts(server):
    certificate = server.root / ".recon4" / "tls" / "certificate.pem"
    program = str(ROOT / "examples" / "mcp_client.py")
    environment = os.environ | {"RECON4_TOKEN": token_of(server, "vera")}

    ended = subprocess.run(
        [sys.executable, program, f"{server.url}/mcp", "--certificate", str(certificate)],
        env=environment,
        capture_output=True,
        text=True,
        timeout=HANG_S,
    )

    assert ended.returncode == 0, ended.stderr
    assert "office: good" in ended.stdout


def test_only_a_token_opens_the_address(server):
    with server.client() as stranger, server.signed_in("anna") as admin:
        closed = stranger.post("/mcp", json=HELLO, headers=TAKES)
        wrong = stranger.post("/mcp", json=HELLO, headers=TAKES | bearer("x" * 43))
        cookie = admin.post("/mcp", json=HELLO, headers=TAKES)

    assert [one.status_code for one in (closed, wrong, cookie)] == [401, 401, 401]
    assert closed.headers["WWW-Authenticate"] == "Bearer"
    assert cookie.json()["code"] == "token-needed"


def test_a_page_of_another_site_and_a_large_message_are_refused(server):
    headers = TAKES | bearer(token_of(server, "vera"))
    with server.client(headers=headers) as assistant:
        elsewhere = assistant.post("/mcp", json=HELLO, headers={"Origin": "https://evil.example"})
        other_host = assistant.post("/mcp", json=HELLO, headers={"Host": "evil.example"})
        large = assistant.post("/mcp", json=HELLO | {"pad": "x" * ASSISTANT.max_message_bytes})

    assert elsewhere.json()["code"] == "other-site"
    assert other_host.json()["code"] == "other-host"
    assert large.status_code == 413


def test_no_session_can_be_fixed_or_taken_over(server):
    chosen = {"Mcp-Session-Id": "chosen-by-a-stranger"}
    with server.client(headers=TAKES | bearer(token_of(server, "vera"))) as assistant:
        listed = assistant.post("/mcp", json=HELLO, headers=chosen)
        opened = assistant.get("/mcp", headers=chosen)
        ended = assistant.delete("/mcp", headers=chosen)

    assert listed.status_code == 200 and "mcp-session-id" not in listed.headers
    assert (opened.status_code, ended.status_code) == (405, 405)


def test_a_token_ends_with_its_session_and_on_the_day(server):
    token = token_of(server, "vera", label="leaver")
    with server.client(headers=bearer(token)) as program, server.signed_in("vera") as person:
        assert program.get("/api/projects").status_code == 200
        (mine,) = [
            one["session"]["id"]
            for one in person.get("/api/me/sessions").json()
            if one["session"]["access_token"] == "leaver"
        ]
        person.delete(f"/api/me/sessions/{mine}").raise_for_status()
        assert program.get("/api/projects").status_code == 401


def test_a_program_signs_nothing_and_makes_no_tokens(server):
    token = token_of(server, "rita", role="reviewer")
    approval = {"why": "because an assistant says so", "key": "0" * 64}
    with server.client(headers=bearer(token)) as program:
        signed = program.post("/api/projects/office/review/approve", json=approval)
        more = program.post("/api/me/tokens", json={"label": "child"})
        people = program.get("/api/people")
    cookie = {"Cookie": f"__Host-sid={token}"}
    with server.client(headers=cookie) as browser, server.signed_in("rita") as person:
        as_cookie = browser.get("/api/projects")
        above = person.post("/api/me/tokens", json={"label": "root", "role": "admin"})
        session = person.cookies["__Host-sid"]
    with server.client(headers=bearer(session)) as stolen:
        as_bearer = stolen.get("/api/projects")

    assert signed.json()["error"] == "SignInAgain"
    assert more.json()["code"] == "token-may-not"
    assert people.status_code == 403
    assert (as_cookie.status_code, as_bearer.status_code) == (401, 401)
    assert above.json()["code"] == "token-role"


def test_without_login_everything_is_read_only(tmp_path, portal):
    build_project(tmp_path / "office", points=1000)
    with server_thread(tmp_path) as running:
        client = Client(f"{running.url}/mcp")
        with portal.wrap_async_context_manager(client) as opened:
            assistant = Assistant(portal, opened)
            assert not WRITING & assistant.tools().keys()
            assert assistant("list_projects")["total"] == 1
