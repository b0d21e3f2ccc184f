"""The life of a job, with real workers, kills and servers."""

import os
import signal

import httpx
import psutil
import pytest

from tests.deadlines import HANG_S
from tests.served import served
from tests.service.running import (
    SLOW,
    open_gate,
    ran,
    recording_with_gate,
    server_process,
    server_thread,
    wait_for,
)


@pytest.fixture
def recording(tmp_path):
    return recording_with_gate(tmp_path / "walk")


server = served(fresh=True, worker_module=SLOW)


def test_a_job_runs_reports_its_progress_and_ends(server, recording):
    job = server.start("office", recording)

    waiting = server.wait_at_gate(job)
    gate = open_gate(recording)
    done = server.wait_state(job, "succeeded")

    os.close(gate)
    assert waiting["job"]["state"] == "running"
    assert waiting["fraction"] == 0.0
    assert 0.0 < waiting["run_progress"] < done["run_progress"] == 1.0
    assert [row["stage"] for row in done["status"]["stages"]] == ["frames", "odometry"]
    assert server.get("/api/projects/office").json()["finished"]
    assert "succeeded" in server.get(f"/api/jobs/{job}/log").text


def test_an_error_of_the_recording_is_reported_with_its_message(server, tmp_path):
    (tmp_path / "empty.pcap").write_bytes(b"")

    job = server.start("office", tmp_path / "empty.pcap")
    view = server.wait_state(job, "failed")

    assert view["job"]["note"] == "empty.pcap holds no points; record again"


def test_a_project_has_any_title_and_a_folder_made_from_it(server, recording):
    request = {"title": "Brno, Veveří 2. patro", "recordings": [str(recording)]}

    jobs = [server.post("/api/jobs", json=request).json()["job"] for _ in range(2)]

    assert [job["project"] for job in jobs] == ["brno-veveri-2-patro", "brno-veveri-2-patro-2"]
    server.wait_at_gate(jobs[0]["id"])
    (card,) = server.get("/api/projects").json()
    assert (card["id"], card["name"]) == ("brno-veveri-2-patro", "Brno, Veveří 2. patro")


def test_a_titled_job_that_cannot_start_leaves_no_project(server, tmp_path):
    (tmp_path / "empty.pcap").write_bytes(b"")
    request = {"title": "Hall 3", "recordings": [str(tmp_path / "empty.pcap")]}

    view = server.wait_state(server.post("/api/jobs", json=request).json()["job"]["id"], "failed")

    assert view["resumable"] is False
    assert not (server.root / "hall-3").exists()


def test_a_job_that_cannot_start_leaves_no_project_and_its_name_is_free(server, tmp_path):
    (tmp_path / "empty.pcap").write_bytes(b"")

    job = server.start("office", tmp_path / "empty.pcap")
    view = server.wait_state(job, "failed")

    assert view["resumable"] is False
    assert server.get("/api/projects").json() == []
    assert not (server.root / "office").exists()
    again = {
        "project": "office", "recordings": [str(tmp_path / "empty.pcap")], "only_new": True,
    }  # fmt: skip
    assert server.post("/api/jobs", json=again).status_code == 201


def test_a_killed_worker_is_replaced_and_no_finished_stage_runs_twice(server, recording):
    job = server.start("office", recording)
    server.wait_at_gate(job)

    os.kill(server.worker_pid(job), signal.SIGKILL)
    server.wait_at_gate(job, attempt=2)
    gate = open_gate(recording)
    view = server.wait_state(job, "succeeded")

    os.close(gate)
    assert view["job"]["attempt"] == 2
    assert view["status"]["stages"][0]["state"] == "reused"
    assert ran(recording) == ["frames", "odometry", "odometry", "finished"]


def test_a_worker_that_dies_three_times_is_given_up_with_words(server, recording):
    job = server.start("office", recording)
    for attempt in (1, 2, 3):
        server.wait_at_gate(job, attempt)
        os.kill(server.worker_pid(job), signal.SIGKILL)

    view = server.wait_state(job, "failed")

    assert "died 3 times" in view["job"]["note"]
    assert "[SIGKILL], in stage odometry (Odometry)" in view["job"]["note"]


def test_a_running_job_stops_on_request_and_resumes_as_a_new_one(server, recording):
    job = server.start("office", recording)
    server.wait_at_gate(job)

    server.post(f"/api/jobs/{job}/cancel")
    view = server.wait_state(job, "cancelled")
    again = server.post(f"/api/jobs/{job}/retry").json()["job"]["id"]
    server.wait_at_gate(again)
    gate = open_gate(recording)
    done = server.wait_state(again, "succeeded")

    os.close(gate)
    assert view["job"]["note"] == "stopped on request; what was finished is kept"
    assert done["status"]["stages"][0]["state"] == "reused"


def test_a_worker_that_does_not_stop_is_killed(tmp_path, recording):
    with server_thread(tmp_path, worker_module=SLOW, stop_within_s=0.2) as server:
        job = server.start("office", recording)
        server.wait_at_gate(job)
        os.kill(server.worker_pid(job), signal.SIGSTOP)

        server.post(f"/api/jobs/{job}/cancel")

        assert server.wait_state(job, "cancelled")["job"]["note"] == "stopped on request"


def test_a_worker_without_a_heartbeat_is_killed_and_replaced(tmp_path, recording):
    with server_thread(tmp_path, worker_module=SLOW, hung_after_s=2.5) as server:
        job = server.start("office", recording)
        server.wait_at_gate(job)

        os.kill(server.worker_pid(job), signal.SIGSTOP)
        server.wait_at_gate(job, attempt=2)

        server.post(f"/api/jobs/{job}/cancel")
        server.wait_state(job, "cancelled")


def test_jobs_wait_for_their_turn_and_a_project_has_one_at_a_time(server, tmp_path, recording):
    first = server.start("office", recording)
    second = server.start("staircase", recording_with_gate(tmp_path / "other"))
    server.wait_at_gate(first)

    refused = server.post("/api/jobs", json={"project": "office", "recordings": [str(recording)]})
    waiting = server.get(f"/api/jobs/{second}").json()
    early = server.get("/projects/staircase/map/", headers={"Accept": "text/html"})
    cancelled = server.post(f"/api/jobs/{second}/cancel").json()
    twice = server.post(f"/api/jobs/{second}/cancel")

    assert refused.status_code == 409
    assert "already has a job" in refused.json()["detail"]
    assert waiting["job"]["state"] == "queued"
    assert (early.status_code, early.headers["location"]) == (303, "/projects/staircase/")
    assert cancelled["job"]["state"] == "cancelled"
    assert twice.status_code == 409
    server.post(f"/api/jobs/{first}/cancel")
    server.wait_state(first, "cancelled")


@pytest.mark.study
def test_a_worker_outlives_a_killed_server_and_is_adopted_by_the_next(tmp_path, recording):
    with server_process(tmp_path) as (server, process):
        job = server.start("office", recording)
        server.wait_at_gate(job)
        pid = server.worker_pid(job)
        process.kill()
        process.wait()

    with server_thread(tmp_path, worker_module=SLOW) as server:
        server.wait_at_gate(job)
        gate = open_gate(recording)
        view = server.wait_state(job, "succeeded")
        os.close(gate)

    assert view["job"]["attempt"] == 1
    assert server.worker_pid(job) == pid
    assert ran(recording) == ["frames", "odometry", "finished"]


def test_what_happened_while_no_server_ran_is_found_out(tmp_path, recording):
    with server_process(tmp_path) as (server, process):
        job = server.start("office", recording)
        server.wait_at_gate(job)
        process.kill()
        process.wait()
    os.kill(server.worker_pid(job), signal.SIGKILL)

    with server_thread(tmp_path, worker_module=SLOW) as server:
        server.wait_at_gate(job, attempt=2)
        gate = open_gate(recording)
        server.wait_state(job, "succeeded")
        os.close(gate)

    assert ran(recording) == ["frames", "odometry", "odometry", "finished"]


@pytest.mark.study
def test_the_server_answers_before_a_job_that_takes_all_processors(tmp_path, recording):
    with (
        server_process(tmp_path) as (server, process),
        httpx.Client(base_url=server.url, timeout=HANG_S) as client,
    ):
        job = server.start("office", recording)
        server.wait_at_gate(job)
        gate = open_gate(recording, "busy")
        wait_for(lambda: "busy" in ran(recording), "all processors are taken")
        answers = [client.get("/healthz").status_code for _ in range(50)]
        still = client.get(f"/api/jobs/{job}").json()["job"]["state"]
        niceness = [one.nice() for one in psutil.Process(server.worker_pid(job)).children()]
        of_server = psutil.Process(process.pid).nice()
        (recording / "idle").touch()
        server.wait_state(job, "succeeded")
        os.close(gate)

    assert (set(answers), still) == ({200}, "running")
    assert len(niceness) == os.cpu_count()
    # How fast is measured by tests/benchmarks/server_under_load.py.
    assert min(niceness) >= min(of_server + 10, 19), niceness


def test_a_new_project_does_not_take_the_name_of_another(server, recording):
    (server.root / "office").mkdir()
    request = {"project": "office", "recordings": [str(recording)], "only_new": True}

    answer = server.post("/api/jobs", json=request)

    assert answer.status_code == 409
    assert "choose another name" in answer.json()["detail"]
    assert server.get("/api/jobs").json() == []


@pytest.mark.parametrize(
    ("change", "status", "words"),
    [
        ({"project": "../evil"}, 422, "pattern"),
        ({"project": ""}, 422, "give project or title"),
        ({"project": "", "title": " "}, 422, "give project or title"),
        ({"title": "Office\u202e"}, 422, "invisible characters"),
        ({"recordings": ["/etc/passwd"]}, 403, "may only lie in"),
        ({"recordings": ["walk/../../.."]}, 403, "may only lie in"),
        ({"recordings": []}, 422, "at least 1"),
        ({"recordings": ["{folder}/" + "x" * 300]}, 404, "no such file or folder"),
        ({"recordings": ["{folder}/a\0b"]}, 404, "no such file or folder"),
        ({"preset": "underwater"}, 422, "no preset named 'underwater'"),
        ({"rig": "/etc/passwd"}, 403, "may only lie in"),
        ({"settings": ["map.voxel_m=tiny"]}, 422, "voxel_m"),
        ({"settings": ["map.nothing=1"]}, 422, "no setting 'map.nothing'"),
        ({"surprise": 1}, 422, "Extra inputs"),
    ],
)
def test_a_wrong_request_is_refused_with_the_reason(server, recording, change, status, words):
    request = {"project": "office", "recordings": [str(recording)]} | change
    named = [path.format(folder=recording.parent) for path in request["recordings"]]

    answer = server.post("/api/jobs", json=request | {"recordings": named})

    assert answer.status_code == status
    assert words in answer.json()["detail"]
    assert answer.json()["error"]
    assert server.get("/api/jobs").json() == []
