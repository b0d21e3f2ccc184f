"""Jobs of a server whose parts workers of Dask make: progress, log, cancel, deaths."""

from __future__ import annotations

import os
import signal

import httpx
import psutil
import pytest

from recon4.executors.chosen import ChosenWorkers, store_choice
from tests.ordered_maps import bytes_of, make_map
from tests.served import served
from tests.service.ordering_map_worker import AGAIN
from tests.service.running import WITHOUT_TLS, Running, wait_for

server = served(worker_module="tests.service.ordering_map_worker")


def start(server: Running, project: str, title: str = "") -> str:
    recording = server.root / "walk.log"
    recording.touch()
    job = {"project": project, "recordings": [str(recording)], "title": title}
    answer = server.post("/api/jobs", json=job)
    assert answer.status_code == 201, answer.text
    return answer.json()["job"]["id"]


def choose(server: Running, **chosen: object) -> None:
    store_choice(server.root / ".recon4", ChosenWorkers(**chosen))


def processes_of(server: Running, project: str) -> list[str]:
    """Command lines of what still works for a project."""
    folder = str(server.root / project)
    found = [process.info["cmdline"] or [] for process in psutil.process_iter(["cmdline"])]
    return [" ".join(words) for words in found if folder in words]


def working(view, *, made: int = 0) -> bool:
    """Whether a worker makes a part after this number of others."""
    return any(one["part"] and one["made"] >= made for one in view["workers"]["workers"])


@pytest.mark.study
def test_workers_make_the_tiles_and_a_cancelled_job_leaves_no_order_running(server, tmp_path):
    choose(server, count=1)
    job = start(server, "made", AGAIN)
    maps = server.root / "made" / "artifacts"
    at_work = server.wait(job, lambda view: working(view, made=1) and (maps / "map1").exists())

    (worker,) = at_work["workers"]["workers"]
    assert (worker["failed"], at_work["workers"]["problem"]) == (0, "")
    assert any("recon4.orders.maker" in line for line in processes_of(server, "made"))
    assert f"workers: {worker['name']} makes parts" in server.get(f"/api/jobs/{job}/log").text
    assert bytes_of(maps / "map0") == bytes_of(make_map(tmp_path, None))

    server.post(f"/api/jobs/{job}/cancel")

    view = server.wait_state(job, "cancelled")
    assert view["job"]["reason"]["code"] == "job-stopped"  # in order, not killed
    wait_for(lambda: not processes_of(server, "made"), "nothing works for it")


def test_an_administrator_chooses_workers(server):
    def put(**choice) -> httpx.Response:
        url = f"{server.url}/api/workers"
        origin = {"Origin": server.url}
        return httpx.put(url, json=choice, headers=origin, verify=WITHOUT_TLS)

    chosen = put(scheduler="tls://north:8786", dashboard="http://north:8787/status")
    refused = put(scheduler="tcp://north:8786")

    assert chosen.status_code == 200, chosen.text
    assert (refused.status_code, refused.json()["code"]) == (422, "workers-scheduler-malformed")
    now = server.get("/api/workers").json()
    assert now["scheduler"] == "tls://north:8786"
    assert not now["has_certificates"]
    assert now["folder"] == str(server.root / ".recon4" / "cluster")


@pytest.mark.study
def test_a_job_without_its_workers_is_made_by_this_computer(server):
    choose(server, scheduler="tls://127.0.0.1:1")

    job = start(server, "alone")
    view = server.wait_state(job, "succeeded")

    assert view["workers"]["workers"] == []
    assert "no such certificate" in view["workers"]["problem"]
    assert "this computer makes all parts" in server.get(f"/api/jobs/{job}/log").text


@pytest.mark.study
@pytest.mark.parametrize("victim", ["worker", "parent"])
def test_a_job_goes_on_after_a_death(victim, server, tmp_path):
    choose(server, count=1)
    job = start(server, "killed", AGAIN)
    server.wait(job, lambda view: working(view, made=1))

    worker = server.worker_pid(job)
    os.kill(worker if victim == "worker" else psutil.Process(worker).ppid(), signal.SIGKILL)

    view = server.wait(job, lambda view: view["job"]["attempt"] == 2)
    assert "SIGKILL" in view["job"]["note"]
    server.wait(job, lambda view: working(view, made=1))
    server.post(f"/api/jobs/{job}/cancel")
    server.wait_state(job, "cancelled")
    wait_for(lambda: not processes_of(server, "killed"), "nothing works for it")
