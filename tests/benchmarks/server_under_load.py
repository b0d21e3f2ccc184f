"""Phones, clients and a job at once: ``… server_under_load.py RECORDING [--imu CSV] [--rig RIG]``.

A real server processes the recording again and again. Meanwhile the recording is replayed into a
live capture that phones look at, clients read pages, images and the API, and others look at a
map in the viewer. A process of its own asks for ``/healthz`` on new and on kept connections.
Printed: errors, percentiles of ``/healthz`` and of each kind of request, memory of the server.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import multiprocessing
import shutil
import sys
import tempfile
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from multiprocessing.queues import Queue
from multiprocessing.synchronize import Barrier
from pathlib import Path
from typing import Any

import httpx
import msgspec.msgpack
import numpy as np
import psutil
from websockets.asyncio.client import connect

from recon4.live.replay import replay
from recon4.progress import Silent
from tests.loopback import an_address
from tests.project_builder import build_project
from tests.service.running import Running, end_workers, server_process
from tests.service.viser_client import PROTOCOL, camera

MAP = "office"
PATHS = (
    "/", f"/projects/{MAP}/", "/live", "/api/projects", f"/api/projects/{MAP}", "/api/jobs",
    "/api/server", "/api/live", f"/api/projects/{MAP}/thumbnail", f"/api/projects/{MAP}/report",
    f"/api/projects/{MAP}/files/trajectory.tum", "/web/shared/api.js",
)  # fmt: skip
THINK_S = 0.5
"""A client waits so long between two requests [s]."""
PROBE_S = 0.1
WARM_UP_S = 30.0
"""Left out of the slope of the memory [s]."""
HEALTH_P99_S = 0.25


class Ended(Exception):
    """The replay has gone on for long enough."""


@dataclass
class Tally:
    """Counts and latencies of the clients."""

    errors: Counter[str] = field(default_factory=Counter)
    times_s: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    phone_messages: int = 0
    viewer_bytes: int = 0

    @contextlib.contextmanager
    def counting(self, what: str) -> Iterator[None]:
        """Count errors in a block."""
        try:
            yield
        except Exception as error:
            self.errors[f"{what}: {type(error).__name__} {error}"[:120]] += 1


def main() -> None:
    """Measure and print; exit code 1 if there was an error or ``/healthz`` was too slow."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recording", type=Path)
    parser.add_argument("--imu", type=Path)
    parser.add_argument("--rig", default="4recon", help="of the recording")
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--phones", type=int, default=10)
    parser.add_argument("--clients", type=int, default=30, help="the viewers among them")
    parser.add_argument("--viewers", type=int, default=6, help="at most 8 for one person")
    given = parser.parse_args()
    root = Path(tempfile.mkdtemp(prefix="recon4-load-"))
    try:
        for file in filter(None, (given.recording, given.imu)):
            shutil.copy(file, root)
        build_project(root / MAP, points=60_000)
        well = measure(root, given)
    finally:
        end_workers(root)
        shutil.rmtree(root, ignore_errors=True)
    sys.exit(not well)


def measure(root: Path, given: argparse.Namespace) -> bool:
    """Run everything for the given time; whether the requirements held."""
    address, seconds = an_address(), 60.0 * given.minutes
    spawn = multiprocessing.get_context("spawn")
    with server_process(
        root, worker_module="recon4_app.jobs.worker", sensor_bind_address=address
    ) as (
        server,
        process,
    ):
        tally = Tally()
        probes: Queue[tuple[str, list[float]]] = spawn.Queue()
        ready = spawn.Barrier(4)  # they take a while to start, and none of their work is ours
        apart = [
            spawn.Process(target=send, args=(given.recording, address, seconds, ready)),
            *(
                spawn.Process(target=probe, args=(server.url, kept, seconds, ready, probes))
                for kept in (True, False)
            ),
        ]
        for one in apart:
            one.start()
        start_capture(server, given)
        ready.wait()
        until_s = time.monotonic() + seconds
        memory = Memory(process.pid)
        threads = [
            threading.Thread(target=memory.follow, args=(until_s,)),
            threading.Thread(target=keep_a_job, args=(server, root, given, until_s, tally)),
        ]
        for thread in threads:
            thread.start()
        asyncio.run(look_on(server.url, given, until_s, tally))
        health = dict(probes.get(timeout=60.0) for _ in range(2))
        for other in (*apart, *threads):
            other.join()
        with tally.counting("end of the capture"):
            server.post("/api/live/stop").raise_for_status()
            while server.get("/api/live").json()["state"] != "ready":
                time.sleep(0.5)
    return report(tally, health, memory, given)


def report(
    tally: Tally, health: dict[str, list[float]], memory: Memory, given: argparse.Namespace
) -> bool:
    """Print; whether the requirements held."""
    print(f"{given.phones} phones, {given.clients} clients, {given.minutes:g} minutes, a job")
    for name, times_s in health.items():
        print(f"/healthz, {name:15} {percentiles(times_s)}")
    for path, times_s in sorted(tally.times_s.items()):
        print(f"{path:40} {percentiles(times_s)}")
    print(f"phones: {tally.phone_messages} messages; viewers: {tally.viewer_bytes / 1e6:.1f} MB")
    print(memory.words())
    print(f"errors: {sum(tally.errors.values())}")
    for what, count in tally.errors.most_common(20):
        print(f"  {count} x {what}")
    slowest = max(float(np.percentile(times_s, 99)) for times_s in health.values())
    return not tally.errors and slowest <= HEALTH_P99_S


def percentiles(times_s: list[float]) -> str:
    """Median, 99th percentile and longest."""
    p50, p99, most = np.percentile(times_s, [50, 99, 100]) * 1e3
    return f"p50 {p50:6.1f} ms  p99 {p99:6.1f} ms  max {most:6.0f} ms  ({len(times_s)} requests)"


def probe(
    url: str, kept: bool, seconds: float, ready: Barrier, out: Queue[tuple[str, list[float]]]
) -> None:
    """Request ``/healthz``, on one connection or on a new one each time."""
    times_s = []
    ready.wait()
    until_s = time.monotonic() + seconds
    headers = {} if kept else {"Connection": "close"}
    with httpx.Client(base_url=url, timeout=30.0, headers=headers) as client:
        while time.monotonic() < until_s:
            began_s = time.perf_counter()
            assert client.get("/healthz").status_code == 200
            times_s.append(time.perf_counter() - began_s)
            time.sleep(PROBE_S)
    out.put(("one connection" if kept else "new connections", times_s))


class Memory:
    """Resident memory of the server."""

    def __init__(self, pid: int) -> None:
        self._process = psutil.Process(pid)
        self.samples: list[tuple[float, float]] = []
        """Seconds since the start, MiB."""

    def follow(self, until_s: float) -> None:
        """Look twice a second."""
        began_s = time.monotonic()
        while time.monotonic() < until_s:
            used = self._process.memory_info().rss / 2**20
            self.samples.append((time.monotonic() - began_s, used))
            time.sleep(0.5)

    def words(self) -> str:
        """Size and slope after the warm-up."""
        late = np.array([one for one in self.samples if one[0] > WARM_UP_S] or self.samples)
        slope = float(np.polyfit(late[:, 0], late[:, 1], 1)[0]) * 60.0
        first, last, most = self.samples[0][1], late[-1, 1], late[:, 1].max()
        return (
            f"memory of the server: {first:.0f} MiB at first, {last:.0f} MiB at the end, at most "
            f"{most:.0f} MiB; slope after {WARM_UP_S:g} s {slope:+.2f} MiB a minute"
        )


def keep_a_job(
    server: Running, root: Path, given: argparse.Namespace, until_s: float, tally: Tally
) -> None:
    """Always have a job that runs; it is cancelled at the end."""
    number = 0
    while time.monotonic() < until_s:
        with tally.counting("job"):
            number += 1
            recording = {"recordings": [str(root / given.recording.name)], "rig": given.rig}
            imu = str(root / given.imu.name) if given.imu else ""
            request = {"project": f"load{number}", "imu": imu, **recording}
            answer = server.post("/api/jobs", json=request)
            answer.raise_for_status()
            job = answer.json()["job"]["id"]
            state = "queued"
            while state in ("queued", "running") and time.monotonic() < until_s:
                time.sleep(1.0)
                state = server.get(f"/api/jobs/{job}").json()["job"]["state"]
            if state not in ("running", "succeeded"):
                raise RuntimeError(f"the job is {state}")
            if state == "running":
                server.post(f"/api/jobs/{job}/cancel").raise_for_status()


def start_capture(server: Running, given: argparse.Namespace) -> None:
    """Start recording the datagrams."""
    capture = {"project": "walk", "rig": given.rig, "preset": "indoor"}
    server.post("/api/live", json=capture).raise_for_status()


def send(recording: Path, address: str, seconds: float, ready: Barrier) -> None:
    """Replay at true speed until the end of the time or of the recording, again and again."""
    ready.wait()
    until_s = time.monotonic() + seconds

    def while_it_lasts(datagram: Any) -> tuple[Any]:
        if time.monotonic() > until_s:
            raise Ended
        return (datagram,)

    with contextlib.suppress(Ended):
        while time.monotonic() < until_s:
            replay(recording, progress=Silent(), target=address, alter=while_it_lasts)


async def look_on(url: str, given: argparse.Namespace, until_s: float, tally: Tally) -> None:
    """All phones and clients."""
    readers = given.clients - given.viewers
    kinds: list[tuple[Callable[..., Any], int]] = [
        (phone, given.phones), (viewer, given.viewers), (reader, readers),
    ]  # fmt: skip
    await asyncio.gather(
        *(look(url, number, until_s, tally) for look, count in kinds for number in range(count))
    )


async def phone(url: str, number: int, until_s: float, tally: Tally) -> None:
    """Look at the live capture; a phone that is cut off is an error."""
    stream = url.replace("http", "ws") + "/api/live/stream"
    with tally.counting("phone"):
        async with connect(stream, origin=url, max_size=None, max_queue=4, proxy=None) as socket:
            await socket.send("{}")
            while (left_s := until_s - time.monotonic()) > 0:
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(socket.recv(), left_s)
                    tally.phone_messages += 1


async def viewer(url: str, number: int, until_s: float, tally: Tally) -> None:
    """Look at a map and move the camera twice a second."""
    stream = url.replace("http", "ws") + f"/projects/{MAP}/viewer"
    options: dict[str, Any] = {"origin": url, "subprotocols": [PROTOCOL], "max_size": None}
    with tally.counting("viewer"):
        async with connect(
            stream, max_queue=16, compression=None, proxy=None, open_timeout=60.0, **options
        ) as socket:
            moving = asyncio.create_task(move(socket, number))
            try:
                while (left_s := until_s - time.monotonic()) > 0:
                    with contextlib.suppress(TimeoutError):
                        tally.viewer_bytes += len(await asyncio.wait_for(socket.recv(), left_s))
            finally:
                moving.cancel()


async def move(socket: Any, number: int) -> None:
    """Walk around."""
    step = 0
    while True:
        angle = 0.1 * step + number
        ahead = (np.cos(angle), np.sin(angle), 0.0)
        await socket.send(msgspec.msgpack.encode(camera((1.0, 1.0, 1.5), ahead=ahead)))
        step += 1
        await asyncio.sleep(THINK_S)


async def reader(url: str, number: int, until_s: float, tally: Tally) -> None:
    """Read pages, images and the API, one after the other."""
    async with httpx.AsyncClient(base_url=url, timeout=30.0) as client:
        turn = number
        while time.monotonic() < until_s:
            path = PATHS[turn % len(PATHS)]
            turn += 1
            with tally.counting(path):
                began_s = time.perf_counter()
                answer = await client.get(path)
                tally.times_s[path].append(time.perf_counter() - began_s)
                answer.raise_for_status()
            await asyncio.sleep(THINK_S)


if __name__ == "__main__":
    main()
