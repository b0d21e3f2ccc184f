"""How fast the server answers while a job runs: ``… server_under_load.py RECORDING [--imu CSV]``.

A real server and worker process the recording; meanwhile health, list and page are asked for,
one after the other. Printed: median and 99th percentile.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
import time
from pathlib import Path

import httpx
import numpy as np

from tests.service.running import end_workers, server_process

PATHS = ("/healthz", "/api/projects", "/", "/api/jobs")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recording", type=Path)
    parser.add_argument("--imu", type=Path)
    parser.add_argument("--rounds", type=int, default=500)
    given = parser.parse_args()
    root = Path(tempfile.mkdtemp(prefix="recon4-load-"))
    try:
        for file in filter(None, (given.recording, given.imu)):
            shutil.copy(file, root)
        measure(root, given)
    finally:
        end_workers(root)
        shutil.rmtree(root, ignore_errors=True)


def measure(root: Path, given: argparse.Namespace) -> None:
    """Start a job, ask while it runs, cancel it."""
    with server_process(root, worker="app.jobs.worker") as (server, _):
        imu = str(root / given.imu.name) if given.imu else ""
        request = {"project": "load", "recordings": [str(root / given.recording.name)], "imu": imu}
        answer = server.post("/api/jobs", json=request)
        assert answer.status_code == 201, answer.text
        job = answer.json()["job"]["id"]
        server.wait(job, lambda view: len(view["status"]["stages"]) >= 2, most_s=300.0)
        taken: dict[str, list[float]] = {path: [] for path in PATHS}
        with httpx.Client(base_url=server.url) as client:
            for n in range(given.rounds):
                for path in PATHS if n % 10 == 0 else PATHS[:1]:
                    began = time.perf_counter()
                    assert client.get(path).status_code == 200
                    taken[path].append(time.perf_counter() - began)
        state = server.get(f"/api/jobs/{job}").json()
        for path, times_s in taken.items():
            p50, p99 = np.percentile(times_s, [50, 99]) * 1e3
            print(f"{path:14} p50 {p50:6.1f} ms  p99 {p99:6.1f} ms  ({len(times_s)} requests)")
        print(f"job {state['job']['state']}, {state['status']['what']}, {state['overall']:.0%}")
        server.post(f"/api/jobs/{job}/cancel")


if __name__ == "__main__":
    main()
