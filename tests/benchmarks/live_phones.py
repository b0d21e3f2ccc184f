"""Ten phones look at a walk, one of them stalls: ages, bytes and memory at the server's edge.

``python -m tests.benchmarks.live_phones RECORDING [--seconds 60]`` starts a server, its recorder
and mapper on this computer, replays a recording at true speed and, some seconds after the walk
began, looks on with Python clients.
An age is from the end of a multiframe on the sensors' clock to its pose at the client.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import socket
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import psutil
from websockets.asyncio.client import connect

from recon4.live.replay import replay
from recon4.progress import Silent
from tests.loopback import an_address

PHONES = 10
STALLS_AFTER_S = 5.0


class Ended(Exception):
    """The replay has gone on for long enough."""


class Phone:
    """Measurements of one phone."""

    def __init__(self, stalls: bool) -> None:
        self.stalls = stalls
        self.ages_s: list[float] = []
        self.bytes: list[tuple[float, int]] = []
        self.first_points_s = float("nan")

    async def look(self, url: str, until_s: float) -> None:
        """Until a time; one that stalls stops reading."""
        began_s = time.monotonic()
        stream = url.replace("http", "ws") + "/api/live/stream"
        async with connect(stream, origin=url, max_size=None, max_queue=2) as socket:
            await socket.send("{}")
            while time.monotonic() < until_s:
                if self.stalls and time.monotonic() - began_s > STALLS_AFTER_S:
                    await asyncio.sleep(until_s - time.monotonic())
                    return
                data = await socket.recv()
                self.bytes.append((time.monotonic() - began_s, len(data)))
                if isinstance(data, bytes):
                    self.first_points_s = np.fmin(self.first_points_s, self.bytes[-1][0])
                else:
                    self._receive_message(json.loads(data))

    def _receive_message(self, message: dict[str, Any]) -> None:
        if "pose" in message:
            self.ages_s.append(time.time() - message["pose"]["t_ns"] / 1e9)

    def figures(self) -> dict[str, float]:
        """Percentiles [ms] and rates after the first five seconds."""
        later = [(t_s, size) for t_s, size in self.bytes if t_s > STALLS_AFTER_S]
        span_s = later[-1][0] - later[0][0] if later else float("nan")
        ages = np.array(self.ages_s[20:]) * 1000
        return {
            "first points s": round(self.first_points_s, 2),
            "age p50 ms": round(float(np.percentile(ages, 50))),
            "age p95 ms": round(float(np.percentile(ages, 95))),
            "Mbit/s": round(8e-6 * sum(size for _, size in later) / span_s, 2),
            "poses a second": round(len(self.ages_s) / self.bytes[-1][0], 1),
        }


async def watch(url: str, seconds: float, *, stalled: bool) -> list[Phone]:
    """Ten phones at once."""
    phones = [Phone(stalls=stalled and k == 0) for k in range(PHONES)]
    until_s = time.monotonic() + seconds
    await asyncio.gather(*(phone.look(url, until_s) for phone in phones))
    return phones


def main() -> None:
    """Print a line a phase."""
    ask = argparse.ArgumentParser(description=__doc__)
    ask.add_argument("recording", type=Path)
    ask.add_argument("--seconds", type=float, default=20.0, help="of each phase")
    ask.add_argument("--after", type=float, default=16.0, help="seconds of the walk")
    given = ask.parse_args()
    given.address = an_address()
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    serve = [sys.executable, "-m", "recon4", "serve", "--port", str(port)]
    url = f"http://127.0.0.1:{port}"
    with (
        tempfile.TemporaryDirectory() as folder,
        subprocess.Popen([*serve, "--live-address", given.address, folder]) as process,
    ):
        wait_for(url)
        measure(url, psutil.Process(process.pid), given)
        httpx.post(f"{url}/api/live/stop", timeout=30.0)
        while httpx.get(f"{url}/api/live").json()["state"] != "ready":
            time.sleep(0.2)
        process.terminate()


def wait_for(url: str) -> None:
    """Until the server answers."""
    while True:
        try:
            httpx.get(f"{url}/healthz")
            return
        except httpx.TransportError:
            time.sleep(0.1)


def measure(url: str, process: psutil.Process, given: argparse.Namespace) -> None:
    """Both phases on one walk."""
    capture = {"project": "walk", "rig": "4recon", "preset": "indoor"}
    answer = httpx.post(f"{url}/api/live", json=capture, timeout=60.0)
    answer.raise_for_status()
    end_s = time.monotonic() + given.after + 2 * given.seconds + 2.0

    def while_it_lasts(datagram: Any) -> tuple[Any]:
        if time.monotonic() > end_s:
            raise Ended
        return (datagram,)

    def send() -> None:
        try:
            quiet, target = Silent(), given.address
            replay(given.recording, progress=quiet, target=target, alter=while_it_lasts)
        except Ended:
            return

    sending = threading.Thread(target=send)
    sending.start()
    time.sleep(given.after)
    for name, stalled in (("ten phones", False), ("one of them stalled", True)):
        before = process.memory_info().rss
        phones = asyncio.run(watch(url, given.seconds, stalled=stalled))
        grown = (process.memory_info().rss - before) / 2**20
        listening = [phone.figures() for phone in phones if not phone.stalls]
        worst = {key: max(one[key] for one in listening) for key in listening[0]}
        median = {key: float(np.median([one[key] for one in listening])) for key in listening[0]}
        print(f"{name}: median {median}, worst {worst}, server grew by {grown:.1f} MiB")
    sending.join()


if __name__ == "__main__":
    main()
