"""Upload speed and memory of the server: ``python tests/benchmarks/uploads.py [--gb 2]``.

A real server process takes a generated stream by tus in chunks of 8 MiB, each durable before it is
answered; then the same twice at a time. Printed: MB/s and how much its memory grew.
"""

from __future__ import annotations

import argparse
import hashlib
import shutil
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import psutil

from tests.service.running import server_process
from tests.service.tus_client import CHUNK, create

CHUNK_BYTES = 8 << 20


def send(url: str, total: int, seed: int) -> tuple[float, str]:
    """Duration [s] and SHA-256 of the sent bytes."""
    block = hashlib.shake_256(bytes([seed])).digest(CHUNK_BYTES)
    location = create(url, total, filename=f"stream-{seed}.bag").headers["Location"]
    digest, offset, began = hashlib.sha256(), 0, time.perf_counter()
    spent_s = 0.0
    with httpx.Client(timeout=120.0) as client:
        while offset < total:
            data = block[: min(CHUNK_BYTES, total - offset)]
            hashed_s = time.perf_counter()
            digest.update(data)
            spent_s += time.perf_counter() - hashed_s
            headers = CHUNK | {"Upload-Offset": str(offset)}
            answer = client.patch(url + location, headers=headers, content=data)
            assert answer.status_code == 204, answer.text
            offset = int(answer.headers["Upload-Offset"])
    return time.perf_counter() - began - spent_s, digest.hexdigest()


def watch(process: psutil.Process, peak: list[int], over: threading.Event) -> None:
    """Keep the largest resident memory."""
    while not over.wait(0.1):
        peak[0] = max(peak[0], process.memory_info().rss)


def sent_by(url: str, total: int, lanes: int) -> tuple[float, list[str]]:
    """Aggregate MB/s and the hashes."""
    began = time.perf_counter()
    with ThreadPoolExecutor(lanes) as pool:
        done = list(pool.map(lambda seed: send(url, total, seed), range(lanes)))
    took_s = max(seconds for seconds, _ in done)
    print(f"  {lanes} at a time: {time.perf_counter() - began:.1f} s in all")
    return lanes * total / took_s / 1e6, [digest for _, digest in done]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--gb", type=float, default=2.0)
    total = int(parser.parse_args().gb * 1e9)
    root = Path(tempfile.mkdtemp(prefix="recon4-uploads-"))
    try:
        with server_process(root) as (server, process):
            measured = psutil.Process(process.pid)
            create(server.url, 0, filename="warm.bag")
            before = measured.memory_info().rss
            peak, over = [before], threading.Event()
            thread = threading.Thread(target=watch, args=(measured, peak, over))
            thread.start()
            for lanes in (1, 2):
                speed, digests = sent_by(server.url, total // lanes, lanes)
                views = server.get("/api/uploads").json()[:lanes]
                there = sorted(file_hash(Path(view["recording"])) for view in views)
                assert there == sorted(digests), "other bytes on disk"
                print(f"  {speed:.0f} MB/s")
                for view in views:
                    shutil.rmtree(Path(view["recording"]).parent)
            over.set()
            thread.join()
            print(f"memory grew by {(peak[0] - before) / (1 << 20):.1f} MiB at most")
    finally:
        shutil.rmtree(root, ignore_errors=True)


def file_hash(path: Path) -> str:
    """SHA-256 of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


if __name__ == "__main__":
    main()
