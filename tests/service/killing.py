"""Kills servers, workers, viewers and pool children in a real run; the run ends all the same.

`run_gated` kills one of them in the middle of each stage, `run` at random moments.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import signal
import subprocess
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TextIO

import httpx
import numpy as np
import psutil
from websockets.exceptions import ConnectionClosed

from recon4_app.jobs.run_progress import AFTER, BEFORE, STAGE_PERCENT
from recon4_app.viewer.pool import socket_folder
from tests.processes import command_of
from tests.service.gated_worker import AT_GATE
from tests.service.running import WITHOUT_TLS, Running, end_workers, server_process, wait_for
from tests.service.viser_client import camera, viewing
from tests.short_capture import QUICK

STAGES = tuple(stage for stage in STAGE_PERCENT if stage not in (BEFORE, AFTER))
IN_A_STAGE = ("worker", "server", "viewer", "pool")
RESULTS = ("trajectory.tum", "odometry.tum", "edges.json", "map.laz", "graph.g2o")
VICTIMS = ("worker", "server", "both")
WITHIN_S = 1800.0
"""For a step of a run on a computer that is busy otherwise."""


@dataclass
class Survived:
    """What a run went through."""

    hits: list[tuple[str, str]] = field(default_factory=list)
    """Who was killed, in which stage."""
    jobs: list[str] = field(default_factory=list)
    """Jobs it took: one that died three times is resumed as another."""


def request_for(root: Path) -> dict[str, Any]:
    """Start a job on the walk in a folder of projects."""
    walk = root / "walk"
    return {
        "project": "office",
        "recordings": [str(walk / "recording.pcap")],
        "rig": "4recon",
        "imu": str(walk / "imu.csv"),
        "settings": list(QUICK),
    }


def row_of_the_matrix(row: int) -> dict[str, str]:
    """Stage -> process killed in it; together the rows cover every process in every stage."""
    return {stage: IN_A_STAGE[(k + row) % len(IN_A_STAGE)] for k, stage in enumerate(STAGES)}


def run_gated(root: Path, request: dict[str, Any], victims: Mapping[str, str]) -> Survived:
    """Run a job to its end; kill a process in the middle of each stage."""
    survived = Survived()
    try:
        with gates(root) as closed:
            while True:
                with server_process(root, worker_module="tests.service.gated_worker") as (
                    server,
                    process,
                ):
                    if not survived.jobs:
                        survived.jobs.append(_started(server, request))
                    if _live_gated(server, process, survived, victims, closed):
                        return survived
    finally:
        end_workers(root)


@contextlib.contextmanager
def gates(root: Path) -> Iterator[dict[str, TextIO]]:
    """A locked file a stage; closing it opens the gate."""
    folder = root / "gates"
    folder.mkdir()
    with contextlib.ExitStack() as stack:
        closed = {stage: stack.enter_context((folder / stage).open("w")) for stage in STAGES}
        for gate in closed.values():
            fcntl.flock(gate, fcntl.LOCK_EX)
        yield closed


def _live_gated(
    server: Running,
    process: subprocess.Popen[str],
    survived: Survived,
    victims: Mapping[str, str],
    closed: dict[str, TextIO],
) -> bool:
    """One server's life; whether the run came to its end in it."""
    while True:
        job = survived.jobs[-1]
        view = server.wait(
            job, lambda view: _is_over(view) or _at_gate(view, closed), max_s=WITHIN_S
        )
        if view["job"]["state"] == "succeeded":
            return True
        if _is_over(view):
            survived.jobs.append(_resumed(server, view))
            continue
        stage = view["status"]["stages"][-1]["stage"]
        survived.hits.append((victims[stage], stage))
        if victims[stage] == "worker":
            _signal(server, job, signal.SIGKILL)
        elif victims[stage] == "viewer":
            _kill_viewer(server, process)
        elif victims[stage] == "pool":
            _kill_pool_child(server, process)
        else:
            process.kill()
            process.wait()
        closed.pop(stage).close()
        if victims[stage] == "server":
            return False


def _at_gate(view: dict[str, Any], closed: Mapping[str, TextIO]) -> bool:
    stages = view["status"]["stages"]
    return view["status"]["what"] == AT_GATE and stages[-1]["stage"] in closed


def _is_over(view: dict[str, Any]) -> bool:
    return view["job"]["state"] not in ("queued", "running")


def _kill_viewer(server: Running, process: subprocess.Popen[str]) -> None:
    """Kill a viewer with a client, and check that the next client gets another one."""
    with viewing(server.url) as client:
        client.send(camera())
        client.until(lambda c: "/grid" in c.nodes)
        children = psutil.Process(process.pid).children()
        (viewer,) = [one for one in children if "recon4_app.viewer.process" in command_of(one)]
        viewer.kill()
        with contextlib.suppress(ConnectionClosed):
            client.until(lambda c: False)
    with viewing(server.url) as client:
        client.send(camera())
        client.until(lambda c: "/grid" in c.nodes)


def _kill_pool_child(server: Running, process: subprocess.Popen[str]) -> None:
    """Kill the child that answers a page, and see that the next request is answered."""

    def ask() -> int:
        recording = server.root / "walk" / "recording.pcap"
        return httpx.get(
            server.url + "/api/look",
            params={"path": str(recording)},
            timeout=120.0,  # the child imports everything first, perhaps on a busy computer
            verify=WITHOUT_TLS,
        ).status_code

    def children() -> list[psutil.Process]:
        below = psutil.Process(process.pid).children(recursive=True)
        return [one for one in below if "recon4_app.compute_pool.child" in command_of(one)]

    with ThreadPoolExecutor(1) as thread:
        answer = thread.submit(ask)
        pool = wait_for(children, "the compute pool has a child")
        for child in pool:
            child.kill()
        psutil.wait_procs(pool, timeout=10.0)
        assert answer.result() in (200, 503)  # 200: it had answered already
    assert ask() == 200


def orphans(root: Path) -> list[psutil.Process]:
    """Processes that servers on a folder started and that live on, 5 s after the last of them."""
    found = []
    for one in psutil.process_iter():
        with contextlib.suppress(psutil.Error):
            if one.pid != os.getpid() and one.environ().get("RECON4_RECORDINGS") == str(root):
                found.append(one)
    return psutil.wait_procs(found, timeout=5.0)[1]


def leftover_files(root: Path) -> list[str]:
    """Unfinished files, sockets and records of children below a folder of projects."""
    patterns = (".tmp-*", "buckets-*", "room", "children/*")
    found = [path for pattern in patterns for path in root.rglob(pattern)]
    sockets = socket_folder(root / ".recon4")
    return sorted(map(str, [*found, *(sockets.iterdir() if sockets.is_dir() else [])]))


def _started(server: Running, request: dict[str, Any]) -> str:
    answer = server.post("/api/jobs", json=request)
    assert answer.status_code == 201, answer.text
    return answer.json()["job"]["id"]


def _resumed(server: Running, view: dict[str, Any]) -> str:
    """Another job after one whose worker died three times."""
    assert "died 3 times" in view["job"]["note"], view["job"]["note"]
    return server.post(f"/api/jobs/{view['job']['id']}/retry").json()["job"]["id"]


def run(root: Path, request: dict[str, Any], *, kills: int, seed: int) -> Survived:
    """Run a job to its end; kills fall evenly into the whole run, at random within their share.

    While no server runs the worker is held still: a short run would else be over before the next.
    """
    rng = np.random.default_rng(seed)
    survived = Survived()
    victims = rng.permutation([VICTIMS[k % len(VICTIMS)] for k in range(kills)]).tolist()
    plan = [((k + rng.random()) / kills, victim) for k, victim in enumerate(victims)]
    try:
        while True:
            with server_process(root, worker_module="recon4_app.jobs.worker") as (server, process):
                if not survived.jobs:
                    survived.jobs.append(_started(server, request))
                if _live(server, process, survived, plan):
                    return survived
    finally:
        end_workers(root)


def _live(
    server: Running,
    process: subprocess.Popen[str],
    survived: Survived,
    plan: list[tuple[float, str]],
) -> bool:
    """One server's life; whether the run came to its end in it."""
    _signal(server, survived.jobs[-1], signal.SIGCONT)
    while True:
        job = survived.jobs[-1]
        moment = plan[0][0] if plan else 2.0
        view = server.wait(job, lambda view, moment=moment: _is_due(view, moment), max_s=WITHIN_S)
        state = view["job"]["state"]
        if state == "succeeded":
            return True
        if state != "running":  # its worker died three times
            survived.jobs.append(_resumed(server, view))
            continue
        _, victim = plan.pop(0)
        _signal(server, job, signal.SIGSTOP if victim == "server" else signal.SIGKILL)
        survived.hits.append((victim, view["status"]["stages"][-1]["stage"]))
        if victim in ("server", "both"):
            process.kill()
            process.wait()
            return False


def _signal(server: Running, job: str, what: signal.Signals) -> None:
    with contextlib.suppress(ProcessLookupError, FileNotFoundError):
        os.killpg(server.worker_pid(job), what)


def _is_due(view: dict[str, Any], moment: float) -> bool:
    state = view["job"]["state"]
    if state == "running":
        return view["run_progress"] >= moment and bool(view["status"]["stages"])
    return state != "queued"


def results(project: Path) -> dict[str, bytes]:
    """The bytes of a project's results."""
    return {name: (project / name).read_bytes() for name in RESULTS}


def artifacts(project: Path) -> dict[str, dict[str, str]]:
    """Artifact -> file -> hash, from the manifests."""
    found = {}
    for path in (project / "artifacts").glob("*/manifest.json"):
        files = json.loads(path.read_text())["files"]
        found[path.parent.name] = {name: one["sha256"] for name, one in files.items()}
    return found


def completed(root: Path, survived: Survived) -> dict[str, int]:
    """Stage -> how often a worker ran it to its end."""
    counts: dict[str, int] = {}
    for job in survived.jobs:
        lines = (root / ".recon4" / "jobs" / job / "events.jsonl").read_bytes().splitlines()
        for line in lines:
            with contextlib.suppress(ValueError):
                event = json.loads(line)
                if event.get("kind") == "stage" and event.get("state") == "done":
                    counts[event["stage"]] = counts.get(event["stage"], 0) + 1
    return counts
