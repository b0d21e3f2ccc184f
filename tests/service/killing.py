"""Kills servers and workers at random moments of a real run, until the run ends all the same."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tests.service.running import Running, end_workers, server_process

RESULTS = ("trajectory.tum", "odometry.tum", "edges.json", "map.laz", "graph.g2o")
VICTIMS = ("worker", "server", "both")
QUICK = ["map.voxel_m=0.1", "graph.node_stride=4", "segments.preserved=2"]
"""Settings that make a short run short."""


@dataclass
class Survived:
    """What a run went through."""

    hits: list[tuple[str, str]] = field(default_factory=list)
    """Who was killed, in which stage."""
    jobs: list[str] = field(default_factory=list)
    """Jobs it took: one that died three times is resumed as another."""


def request_for(root: Path) -> dict[str, Any]:
    """A job on the walk that lies in a folder of projects."""
    walk = root / "walk"
    return {
        "project": "office",
        "recordings": [str(walk / "recording.pcap")],
        "rig": "4recon",
        "imu": str(walk / "imu.csv"),
        "settings": QUICK,
    }


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
            with server_process(root, worker="app.jobs.worker") as (server, process):
                if not survived.jobs:
                    answer = server.post("/api/jobs", json=request)
                    assert answer.status_code == 201, answer.text
                    survived.jobs.append(answer.json()["job"]["id"])
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
        view = server.wait(job, lambda view, moment=moment: _is_due(view, moment), most_s=300.0)
        state = view["job"]["state"]
        if state == "succeeded":
            return True
        if state != "running":  # its worker died three times
            assert "died 3 times" in view["job"]["note"], view["job"]["note"]
            again = server.post(f"/api/jobs/{job}/retry")
            survived.jobs.append(again.json()["job"]["id"])
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
        return view["overall"] >= moment and bool(view["status"]["stages"])
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
