"""Metrics: who may read them, and that they count what happened."""

import asyncio
import json
import stat

import pytest
from prometheus_client.parser import text_string_to_metric_families
from typer.testing import CliRunner
from websockets.asyncio.client import connect

from recon4.cli.main import app as cli
from tests.served import served
from tests.service.running import (
    SLOW,
    open_gate,
    recording_with_gate,
    wait_for,
)
from tests.service.secure import secure_server

server = served(fresh=True, worker_module=SLOW)


@pytest.fixture(scope="module")
def secure(tmp_path_factory):
    with secure_server(tmp_path_factory.mktemp("projects")) as running:
        yield running


def figures(server, **options):
    """Sample name and labels -> value."""
    answer = server.get("/metrics", **options)
    assert answer.status_code == 200, answer.text
    return {
        (sample.name, *sorted(sample.labels.items())): sample.value
        for family in text_string_to_metric_families(answer.text)
        for sample in family.samples
    }


def token_of(root, *options):
    asked = CliRunner().invoke(cli, ["users", "metrics-token", "--root", str(root), *options])
    assert asked.exit_code == 0, asked.output
    return asked.output.strip()


def test_without_login_whoever_sits_here_reads_them(server):
    answer = server.get("/metrics")

    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/plain; version=")


@pytest.mark.parametrize(
    ("name", "status"), [("vera", 403), ("otto", 403), ("rita", 403), ("anna", 200)]
)
def test_with_login_admins_read_them(secure, name, status):
    with secure.signed_in(name) as client:
        assert client.get("/metrics").status_code == status


def test_a_program_reads_them_with_the_token_and_nothing_else(secure):
    token = token_of(secure.root)
    given = {"Authorization": f"Bearer {token}"}
    with secure.client() as client:
        assert client.get("/metrics").status_code == 401
        assert client.get("/metrics", headers=given).status_code == 200
        assert client.get("/api/projects", headers=given).status_code == 401

    file = secure.root / ".recon4" / "metrics.token"
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert len(token) >= 43, "256 bits"


@pytest.mark.parametrize("wrong", ["", "Bearer", "Bearer x", "Basic {}", "{}", "Bearer {}x"])
def test_a_wrong_token_is_refused(secure, wrong):
    given = {"Authorization": wrong.format(token_of(secure.root))}
    with secure.client() as client:
        assert client.get("/metrics", headers=given).status_code == 401


def test_a_renewed_token_ends_the_one_before(secure):
    before = token_of(secure.root)
    after = token_of(secure.root, "--renew")
    with secure.client() as client:
        statuses = [
            client.get("/metrics", headers={"Authorization": f"Bearer {token}"}).status_code
            for token in (before, after)
        ]

    assert before != after
    assert statuses == [401, 200]


@pytest.mark.parametrize("content", ["\n", "x\n"])
def test_a_token_file_without_a_real_token_admits_no_caller(tmp_path, content):
    with secure_server(tmp_path) as server, server.client() as client:
        (tmp_path / ".recon4" / "metrics.token").write_text(content)
        answer = client.get("/metrics", headers={"Authorization": "Bearer x"})

    assert answer.status_code == 401


def test_requests_are_counted_by_route_template_however_many_paths_are_asked_for(server):
    for number in range(50):
        server.get(f"/api/projects/made-up-{number}")
        server.get(f"/made/up/{number}")
        server.get(f"/web/made-up-{number}.js")
    found = figures(server)

    routes = {dict(key[1:])["route"] for key in found if key[0] == "recon4_http_responses_total"}
    assert routes == {"/api/projects/{project_id}", "(none)", "/web"}
    assert found[of_route("recon4_http_responses_total", "/api/projects/{project_id}", 404)] == 50
    assert found[of_route("recon4_http_response_start_seconds_count", "(none)")] == 50


def of_route(name, route, status=None):
    labels = [("method", "GET"), ("route", route)]
    return (name, *labels, ("status", str(status))) if status else (name, *labels)


def test_made_up_methods_share_one_label(server):
    for number in range(5):
        server._ask(f"MADEUP{number}", "/api/projects")
    methods = {dict(key[1:]).get("method") for key in figures(server)}

    assert not [method for method in methods if method and "MADEUP" in method]


def test_jobs_and_the_seconds_of_their_stages_are_counted(server, tmp_path):
    recording = recording_with_gate(tmp_path / "walk.pcap")
    job = server.start("office", recording)
    server.wait_at_gate(job)
    running = figures(server)
    gate = open_gate(recording)
    server.wait_state(job, "succeeded")
    done = figures(server)

    assert running["recon4_jobs", ("state", "running")] == 1
    assert done["recon4_jobs", ("state", "running")] == 0
    assert done["recon4_jobs", ("state", "succeeded")] == 1
    stages = {
        key[1][1]: value for key, value in done.items() if key[0] == "recon4_stage_runs_total"
    }
    assert stages, "a run has stages"
    assert set(stages.values()) == {1.0}
    again = figures(server)
    assert {k: v for k, v in again.items() if "stage" in k[0]} == {
        k: v for k, v in done.items() if "stage" in k[0]
    }, "counted once, however often they are read"
    assert gate


def test_a_queue_has_a_length(server, tmp_path):
    recordings = [recording_with_gate(tmp_path / f"walk{number}.pcap") for number in range(3)]
    jobs = [server.start(f"office{number}", path) for number, path in enumerate(recordings)]
    server.wait_at_gate(jobs[0])

    assert figures(server)["recon4_queue_length",] == 2


def test_open_streams_and_websockets_are_counted_and_come_back_to_zero(server):
    async def look():
        url = server.url.replace("http", "ws")
        async with connect(f"{url}/api/live/stream", origin=server.url, proxy=None):
            return await asyncio.to_thread(figures, server)

    key = "recon4_websockets_open", ("route", "/api/live/stream")
    assert asyncio.run(look())[key] == 1
    wait_for(lambda: figures(server)[key] == 0, "the stream is counted as closed")


def test_the_state_of_the_server_is_there(server):
    found = figures(server)
    names = {key[0] for key in found}

    assert names >= {
        "recon4_uptime_seconds", "recon4_disk_free_bytes", "recon4_live_captures",
        "recon4_queue_length", "recon4_log_records_suppressed_total",
        "recon4_connections_accepted_total", "process_resident_memory_bytes", "process_open_fds",
    }  # fmt: skip
    assert 0 < found["recon4_disk_free_bytes",] < found["recon4_disk_total_bytes",]


def test_the_packets_of_a_live_capture_are_counted(server):
    """With a capture's messages as its recorder and reader send them."""
    from recon4.live.protocol import FileState
    from recon4.live.session import CaptureSession
    from recon4_app.live.capture import Capture
    from tests.live_messages import notes, status

    capture = Capture(CaptureSession(project=server.root / "walk"))
    file = FileState(dropped=5, datagrams=600)
    capture.stream.take(status(kernel_drops=3, skipped_in_pauses=4, file=file))
    capture.stream.take(notes(counts={"packets_missing": 7}))
    server.app.state.parts.current_capture._capture = capture
    found = figures(server)
    server.app.state.parts.current_capture._capture = None

    assert found["recon4_live_captures",] == 1
    assert found["recon4_live_packets_dropped", ("reason", "kernel")] == 3
    assert found["recon4_live_packets_dropped", ("reason", "disk")] == 5
    assert found["recon4_live_packets_recorded",] == 600
    assert found["recon4_live_packets_read", ("what", "packets_missing")] == 7


def test_they_are_not_part_of_the_description_of_the_api(server):
    assert "/metrics" not in json.dumps(server.get("/openapi.json").json()["paths"])
