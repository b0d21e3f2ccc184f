"""Real servers for tests, in a thread or in a process that may be killed."""

from __future__ import annotations

import asyncio
import json
import os
import ssl
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

import httpx
import numpy as np
from fastapi import FastAPI
from msgspec import structs

from recon4.system.stopping import StopSignals, end_process
from recon4_app.compute_pool import pool as compute_pool
from recon4_app.jobs.folder import JobFolder
from recon4_app.main import create_app, serve
from recon4_app.network.listen import (
    AnnouncingServer,
    certificate_of,
    listening,
    make_state,
    uvicorn_config,
)
from recon4_app.settings import ServerSettings, recording_folders_from_environment
from tests.deadlines import HANG_S

ROOT = Path(__file__).parents[2]
SLOW = "tests.service.slow_worker"
WITHOUT_TLS = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
"""For requests to a server that speaks none; httpx else reads all authorities for each of them."""


@dataclass(frozen=True)
class Running:
    url: str
    root: Path
    app: FastAPI | None = None

    def get(self, path: str, **options: Any) -> httpx.Response:
        return self._ask("GET", path, **options)

    def post(self, path: str, **options: Any) -> httpx.Response:
        return self._ask("POST", path, **options)

    def _ask(self, method: str, path: str, **options: Any) -> httpx.Response:
        return httpx.request(method, self.url + path, timeout=HANG_S, verify=WITHOUT_TLS, **options)

    def start(self, project: str, recording: Path) -> str:
        answer = self.post("/api/jobs", json={"project": project, "recordings": [str(recording)]})
        assert answer.status_code == 201, answer.text
        return answer.json()["job"]["id"]

    def wait(
        self, job_id: str, met: Callable[[dict[str, Any]], bool], *, max_s: float = HANG_S
    ) -> dict[str, Any]:
        """The first view of the job, from the event stream, that meets a condition."""
        deadline_s = time.monotonic() + max_s
        with httpx.stream(
            "GET", f"{self.url}/api/events", timeout=HANG_S, verify=WITHOUT_TLS
        ) as stream:
            view = self.get(f"/api/jobs/{job_id}").json()  # there is no event for an ended job
            if met(view):
                return view
            for line in stream.iter_lines():
                assert time.monotonic() < deadline_s, "it never came to that"
                if line.startswith("data:"):
                    view = json.loads(line[5:])
                    if view["job"]["id"] == job_id and met(view):
                        return view
        raise AssertionError("the event stream ended")

    def wait_state(self, job_id: str, state: str) -> dict[str, Any]:
        return self.wait(job_id, lambda view: view["job"]["state"] == state)

    def wait_at_gate(self, job_id: str, attempt: int = 1) -> dict[str, Any]:
        return self.wait(
            job_id,
            lambda view: view["status"]["what"] == "Odometry" and view["job"]["attempt"] == attempt,
        )

    def worker_pid(self, job_id: str) -> int:
        return int((self.root / ".recon4" / "jobs" / job_id / "pid").read_text())


def start_no_spare() -> AbstractContextManager[object]:
    """No child is started before it is asked for: most servers would end with one unused.

    It imports for a second of the processor; spares: ``tests/unit/app/test_compute_pool.py``.
    """
    later = structs.replace(compute_pool.POOL_TIMES, spare_after_s=HANG_S)
    return patch.object(compute_pool, "POOL_TIMES", later)


@contextmanager
def server_thread(root: Path, **settings: Any) -> Iterator[Running]:
    """A server on a free port, in this process; with ``lan=True`` one with TLS and login."""
    chosen = ServerSettings(root=root, **settings)
    make_state(chosen)
    certificate = certificate_of(chosen)
    app = create_app(chosen)
    with listening(replace(chosen, host="127.0.0.1", port=0)) as listener, start_no_spare():
        ready = threading.Event()
        server = AnnouncingServer(uvicorn_config(app, certificate), ready.set)
        thread = threading.Thread(target=lambda: asyncio.run(server.serve([listener])))
        thread.start()
        try:
            assert ready.wait(HANG_S)
            scheme = "https" if certificate else "http"
            yield Running(f"{scheme}://127.0.0.1:{listener.getsockname()[1]}", root, app)
        finally:
            server.should_exit = True
            thread.join(HANG_S)
            end_workers(root)
    assert not thread.is_alive()


@contextmanager
def server_process(
    root: Path, worker_module: str = SLOW, *, sensor_bind_address: str = "0.0.0.0"
) -> Iterator[tuple[Running, subprocess.Popen[str]]]:
    """A server in a process of its own."""
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "tests.service.running",
            str(root),
            worker_module,
            sensor_bind_address,
        ],
        stdout=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        env={**os.environ, "RECON4_RECORDINGS": str(root)},
    )
    assert process.stdout is not None
    with process, process.stdout:
        try:
            yield Running(process.stdout.readline().strip().rstrip("/"), root), process
        finally:
            process.terminate()
            process.wait()


def wait_for(met: Callable[[], Any], what: str, *, max_s: float = HANG_S) -> Any:
    """Poll a condition until it is true."""
    deadline_s = time.monotonic() + max_s
    while not (found := met()):
        assert time.monotonic() < deadline_s, what
        time.sleep(0.05)
    return found


def end_workers(root: Path) -> None:
    """A worker outlives its server, but not a test; one that just begins has no number yet."""
    for path in (root / ".recon4" / "jobs").glob("*"):
        wait_for(partial(_ended, JobFolder(path)), f"worker {path.name} ends")


def _ended(folder: JobFolder) -> bool:
    if not folder.alive():
        return True
    folder.kill()
    return False


def recording_with_gate(folder: Path) -> Path:
    """A folder the slow worker takes for a recording; it has one cloud, which the form reads."""
    folder.mkdir(parents=True)
    points = np.random.default_rng(3).uniform(-5.0, 5.0, (200, 4)).astype("<f4")
    (folder / "000000.bin").write_bytes(points.tobytes())
    os.mkfifo(folder / "gate")
    return folder


def open_gate(recording: Path, word: str = "go") -> int:
    """Let the slow worker through; the descriptor keeps the gate open until closed."""
    gate = os.open(recording / "gate", os.O_RDWR)
    os.write(gate, word.encode())
    return gate


def ran(recording: Path) -> list[str]:
    """What the slow worker's stages noted."""
    return (recording / "ran").read_text().split()


def _serve(stop: StopSignals) -> int:
    settings = ServerSettings(
        root=Path(sys.argv[1]),
        port=0,
        recording_folders=recording_folders_from_environment(),
        worker_module=sys.argv[2],
        sensor_bind_address=sys.argv[3],
    )
    with start_no_spare():
        serve(
            settings,
            stop,
            on_ready=lambda url, notes: sys.stdout.write(url + "\n") and sys.stdout.flush(),
        )
    return 0


if __name__ == "__main__":
    end_process(_serve)
