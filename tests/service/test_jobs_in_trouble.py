"""Crashes, memory, disk, too many jobs, a damaged queue: messages of real workers."""

import os
import signal
import subprocess

import httpx
import psutil
import pytest

from tests.deadlines import BUSY_S
from tests.served import served
from tests.service.running import (
    SLOW,
    WITHOUT_TLS,
    open_gate,
    recording_with_gate,
    server_process,
    server_thread,
)


@pytest.fixture
def recording(tmp_path):
    return recording_with_gate(tmp_path / "walk")


server = served(fresh=True, worker_module=SLOW, max_job_attempts=1)


def after_word(server, recording, word):
    """The ended job after the current stage did what the command demands."""
    job = server.start("office", recording)
    server.wait_at_gate(job)
    gate = open_gate(recording, word)
    view = server.wait(job, lambda view: view["job"]["state"] in ("failed", "succeeded"))
    os.close(gate)
    return view["job"]


def test_a_crash_in_native_code_is_reported_with_stage_and_signal(server, recording):
    job = after_word(server, recording, "crash")

    assert "crashed in native code (segmentation fault) [SIGSEGV]" in job["note"]
    assert "in stage odometry (Odometry)" in job["note"]
    log = server.get(f"/api/jobs/{job['id']}/log").text
    assert "Segmentation fault" in log and "slow_worker.py" in log


def test_out_of_memory_is_a_failure_with_a_message_and_affects_no_other_job(server, recording):
    job = after_word(server, recording, "memory")

    assert (job["state"], job["attempt"]) == ("failed", 1)
    assert "out of memory" in job["note"]
    assert server.get("/healthz").status_code == 200


def test_a_full_disk_is_reported_and_the_job_can_be_resumed(server, recording):
    failed = after_word(server, recording, "full")
    again = server.post(f"/api/jobs/{failed['id']}/retry").json()["job"]["id"]
    server.wait_at_gate(again)
    gate = open_gate(recording)
    done = server.wait_state(again, "succeeded")

    os.close(gate)
    assert "no space" in failed["note"] and "nothing that was finished is lost" in failed["note"]
    assert done["status"]["stages"][0]["state"] == "reused"


def test_a_worker_has_no_more_than_it_may(server, recording):
    job = after_word(server, recording, "limits")

    log = server.get(f"/api/jobs/{job['id']}/log").text
    most = int(0.7 * psutil.virtual_memory().total)
    assert "'RLIMIT_CORE': (0, 0)" in log
    assert f"'RLIMIT_DATA': ({most // 10**9}" in log
    assert "NoNewPrivs:\t1" in log or "NoNewPrivs:1" in log


def test_children_of_a_killed_worker_end_with_it(server, recording):
    job = server.start("office", recording)
    server.wait_at_gate(job)
    group = server.worker_pid(job)

    gate = open_gate(recording, "child")
    server.wait_state(job, "failed")

    os.close(gate)
    left = [p for p in psutil.process_iter() if _group(p.pid) == group and p.status() != "zombie"]
    assert left == []


def _group(pid):
    try:
        return os.getpgid(pid)
    except ProcessLookupError:
        return None


def test_a_job_the_disk_has_no_room_for_is_refused_with_figures(tmp_path, recording):
    with server_thread(tmp_path, worker_module=SLOW, free_disk_reserve_bytes=1 << 60) as server:
        answer = server.post("/api/jobs", json={"project": "a", "recordings": [str(recording)]})

    assert answer.status_code == 507
    assert "no space: this job needs about" in answer.json()["detail"]


@pytest.mark.study
def test_room_is_asked_for_again_when_the_turn_comes(tmp_path):
    """The real worker: what was free when the job was taken may be gone."""
    (tmp_path / "walk.pcap").write_bytes(b"no capture")
    with server_process(tmp_path, worker_module="recon4_app.jobs.worker") as (server, process):
        job = server.start("office", tmp_path / "walk.pcap")
        first = server.wait_state(job, "failed")
        request = tmp_path / ".recon4" / "jobs" / job / "request.json"
        request.write_text(request.read_text().replace("2147483648", str(1 << 60)))
        worker = [process.args[0], "-m", "recon4_app.jobs.worker", str(request.parent)]
        subprocess.run(worker, check=True, capture_output=True)
        full = server.get(f"/api/jobs/{job}").json()

    outcome = (request.parent / "outcome.json").read_text()
    assert first["remedy"] is None
    assert full["remedy"]["page"] == "/storage"
    assert "walk.pcap" in first["job"]["note"]
    assert "no space: this job needs about" in outcome


def test_more_jobs_than_may_wait_are_refused(tmp_path, recording):
    with server_thread(tmp_path, worker_module=SLOW, max_waiting_jobs=1) as server:
        first = server.start("a", recording)
        server.wait_at_gate(first)
        second = server.start("b", recording)
        third = server.post("/api/jobs", json={"project": "c", "recordings": [str(recording)]})
        server.post(f"/api/jobs/{second}/cancel")
        server.post(f"/api/jobs/{first}/cancel")
        server.wait_state(first, "cancelled")

    assert third.status_code == 429
    assert "1 jobs wait already" in third.json()["detail"]


def test_a_damaged_queue_is_replaced_by_its_newest_backup_with_a_notice(tmp_path, recording):
    with server_thread(tmp_path, worker_module=SLOW) as server:
        job = server.start("office", recording)
        server.wait_at_gate(job)
        server.post(f"/api/jobs/{job}/cancel")
        server.wait_state(job, "cancelled")
    state = tmp_path / ".recon4"
    copy = next((state / "backups").glob("jobs-*.sqlite"))
    copy.unlink()
    with server_thread(tmp_path, worker_module=SLOW):
        pass  # makes today's backup again, with the job in it
    damage(state / "jobs.sqlite")

    with server_thread(tmp_path, worker_module=SLOW) as server:
        status = server.get("/api/server").json()
        jobs = server.get("/api/jobs").json()

    assert "The list of jobs was damaged" in status["notices"][0]
    assert "no longer listed" in status["notices"][0]
    assert [view["job"]["id"] for view in jobs] == [job]
    assert list(state.glob("jobs.sqlite.damaged-*"))


def damage(path):
    data = bytearray(path.read_bytes())
    for page in range(1, len(data) // 4096):
        data[page * 4096 : page * 4096 + 64] = os.urandom(64)
    path.write_bytes(data)
    for suffix in ("-wal", "-shm"):
        path.with_name(path.name + suffix).unlink(missing_ok=True)


def test_asked_to_end_the_server_ends_soon_and_without_complaint(tmp_path, recording, capfd):
    with server_process(tmp_path) as (server, process):
        job = server.start("office", recording)
        server.wait_at_gate(job)

        with httpx.stream("GET", f"{server.url}/api/events", verify=WITHOUT_TLS) as page:
            assert page.status_code == 200
            process.send_signal(signal.SIGTERM)

            assert process.wait(10.0 + BUSY_S) == 0
    assert capfd.readouterr().err == "recon4: stopped by SIGTERM\n"
    with server_thread(tmp_path, worker_module=SLOW) as server:
        server.post(f"/api/jobs/{job}/cancel")
        assert server.wait_state(job, "cancelled")["job"]["attempt"] == 1


@pytest.mark.parametrize("word", ["hang", "hang in C"])
def test_a_worker_whose_work_hangs_is_killed_and_its_note_names_the_stage(
    tmp_path, recording, word
):
    with server_thread(
        tmp_path, worker_module=SLOW, max_job_attempts=1, hung_after_s=3.0
    ) as server:
        job = server.start("office", recording)
        server.wait_at_gate(job)
        gate = open_gate(recording, word)
        ended = server.wait_state(job, "failed")["job"]
        log = server.get(f"/api/jobs/{job}/log").text
        os.close(gate)

    assert "made no progress for 3 s and was killed, in stage odometry (Odometry)" in ended["note"]
    assert "slow_worker.py" in log and "hang_in_" in log
