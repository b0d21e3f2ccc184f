"""An hour's walk, accelerated: memory, ages, drops and bytes of a capture from start to project.

``python tests/benchmarks/live_soak.py RECORDING --minutes 60 --speed 2`` replays a walk that ends
where it began, again and again while time goes on, to a real recorder; a real server finds the
capture, starts the mapper and serves two phones. A line is printed for every minute of the walk:
memory (RSS) of recorder, mapper and server, age of the poses at the first phone, what was dropped
or thinned, bytes a second to each phone. At the end come growth and percentiles as JSON.

At speed n every process has n times the work of a real walk, and an age of x ms here is what the
operator would wait: real time, not time of the walk. One phone looks from the start, one comes and
goes every minute. An hour of two VLP-16 is 7 GB of capture and 43 GB of frames: where the disk is
smaller, give ``--punch``, which hands the space of frames already written back (holes instead of
points; the project is of no use then).
"""

from __future__ import annotations

import argparse
import asyncio
import json
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import psutil
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from recon4.live.project_files import begin
from recon4.live.session import CaptureSession, stretched
from recon4.model.rig import load_rig
from recon4.store.frames import POINTS
from tests.loopback import an_address
from tests.service.running import server_process

READY_WITHIN_S = 1800.0
_KEPT_BYTES = 64 << 20
"""At the end of the points: still on their way to the disk."""
MIB = 2**20


@dataclass
class Heard:
    """Messages a phone received since the last query."""

    speed: float
    ages_s: list[float] = field(default_factory=list)
    bytes: int = 0
    first_points_s: list[float] = field(default_factory=list)
    newest: dict[str, Any] = field(default_factory=dict)
    words: set[str] = field(default_factory=set)
    """Warnings, N for every number."""

    def receive(self, data: str | bytes) -> None:
        """Take one message."""
        self.bytes += len(data)
        if isinstance(data, bytes):
            return
        message = json.loads(data)
        self.newest |= message
        self.words |= {re.sub(r"\d+(\.\d+)?", "N", w["text"]) for w in message.get("findings", [])}
        if "pose" in message:
            now_ns = stretched(time.time_ns(), self.speed)
            self.ages_s.append((now_ns - message["pose"]["t_ns"]) / 1e9 / self.speed)

    def taken(self) -> tuple[list[float], int]:
        """Ages and bytes since the last time."""
        ages, size = self.ages_s, self.bytes
        self.ages_s, self.bytes = [], 0
        return ages, size


async def look(url: str, heard: Heard, *, for_s: float) -> None:
    """Be a phone for a while; comes back when it is let go."""
    stream = url.replace("http", "ws") + "/api/live/stream"
    end_s = time.monotonic() + for_s
    while time.monotonic() < end_s:
        began_s, points = time.monotonic(), False
        with suppress(ConnectionClosed, TimeoutError, OSError):
            async with connect(stream, origin=url, max_size=None) as socket:
                await socket.send("{}")
                while (left_s := end_s - time.monotonic()) > 0:
                    data = await asyncio.wait_for(socket.recv(), left_s)
                    if isinstance(data, bytes) and not points:
                        points = True
                        heard.first_points_s.append(time.monotonic() - began_s)
                    heard.receive(data)


def processes(project: Path, server: int) -> dict[str, psutil.Process]:
    """Recorder, mapper and server, as far as they run."""
    found = {"server": psutil.Process(server)}
    for process in psutil.process_iter(["cmdline"]):
        words = process.info["cmdline"] or []
        for name in ("recorder", "mapper"):
            if f"recon4.live.{name}.process" in words and str(project) in words:
                found[name] = process
    return found


def memory_mib(project: Path, server: int) -> dict[str, float]:
    """Resident memory of each process [MiB]."""
    found = {}
    for name, process in processes(project, server).items():
        with suppress(psutil.Error):
            found[name] = round(process.memory_info().rss / MIB, 1)
    return found


def punch(folder: Path) -> None:
    """Give the space of points already written back to the disk."""
    path = folder / POINTS
    if path.exists() and (size := path.stat().st_size - _KEPT_BYTES) > 1 << 20:
        some = ["fallocate", "-p", "-o", str(1 << 20), "-l", str(size - (1 << 20)), str(path)]
        subprocess.run(some, check=True)


@contextmanager
def recording(root: Path, given: argparse.Namespace) -> Iterator[CaptureSession]:
    """A recorder that runs, as an operator without a server would have started it."""
    address = an_address()
    session = begin(
        root / "walk", load_rig(given.rig), address=address, speed=given.speed,
        least_free_bytes=1 << 30,
    )  # fmt: skip
    command = [sys.executable, "-m", "recon4.live.recorder.process", str(session.project)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            assert process.stdout.readline() == "ready\n"
            yield session
        finally:
            process.terminate()


@contextmanager
def replaying(session: CaptureSession, given: argparse.Namespace) -> Iterator[None]:
    """The sensors, in a process of their own."""
    command = [sys.executable, "-m", "recon4", "replay", str(given.recording)]
    command += ["--to", session.address, "--speed", str(given.speed), "--times", "100000"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        try:
            yield
        finally:
            process.terminate()


class Soak:
    """One run; a row a minute of the walk."""

    def __init__(
        self, given: argparse.Namespace, session: CaptureSession, url: str, server: int
    ) -> None:
        self.given, self.session, self.url, self.server = given, session, url, server
        self.first, self.second = Heard(given.speed), Heard(given.speed)
        self.rows: list[dict[str, Any]] = []
        self.ages_s: list[float] = []

    async def run(self) -> None:
        """Look on for all minutes."""
        minute_s = 60.0 / self.given.speed
        whole_s = self.given.minutes * minute_s
        looking = asyncio.create_task(look(self.url, self.first, for_s=whole_s))
        for minute in range(1, self.given.minutes + 1):
            coming = asyncio.create_task(look(self.url, self.second, for_s=0.8 * minute_s))
            await asyncio.sleep(minute_s)
            await coming
            await asyncio.to_thread(self._note, minute, minute_s)
        await looking

    def _note(self, minute: int, seconds: float) -> None:
        if self.given.punch:
            punch(self.session.folder / "frames")
        (ages, size), _ = self.first.taken(), self.second.taken()
        self.ages_s += ages
        newest = self.first.newest
        status, pose = newest.get("status", {}), newest.get("pose", {})
        file = status.get("file", {})
        row = {
            "minute": minute,
            **memory_mib(self.session.project, self.server),
            "age_p50_ms": _percentile_ms(ages, 50),
            "age_p95_ms": _percentile_ms(ages, 95),
            "poses_per_s": round(len(ages) / seconds, 1),
            "kernel_drops": status.get("kernel_drops"),
            "dropped": file.get("dropped"),
            "frames": pose.get("frame_id"),
            "thinned": pose.get("thinned"),
            "lost": pose.get("lost"),
            "relocated": pose.get("relocated"),
            "kB_per_s_phone": round(size / seconds / 1e3, 1),
            "MB_per_s_file": round(file.get("written_bytes", 0) / 1e6 / (minute * seconds), 2),
            "longest_sync_s": round(file.get("longest_sync_s", 0.0), 2),
            "gap_count": len(newest.get("gaps", {}).get("gaps", [])),
            "points": newest.get("points", {}).get("total"),
        }
        self.rows.append(row)
        print(json.dumps(row), flush=True)

    def stop(self) -> float:
        """Stop the recording; seconds until the project is ready."""
        began_s = time.monotonic()
        httpx.post(f"{self.url}/api/live/stop", timeout=60.0).raise_for_status()
        while httpx.get(f"{self.url}/api/live", timeout=60.0).json()["state"] != "ready":
            assert time.monotonic() - began_s < READY_WITHIN_S, "never ready"
            time.sleep(0.1)
        return time.monotonic() - began_s

    def figures(self, ready_s: float) -> dict[str, Any]:
        """The reported figures."""
        walk_s = 60.0 * self.given.minutes
        last = self.rows[-1]
        return {
            "speed": self.given.speed,
            "minutes": self.given.minutes,
            "age_p50_ms": _percentile_ms(self.ages_s, 50),
            "age_p95_ms": _percentile_ms(self.ages_s, 95),
            "poses": len(self.ages_s),
            "frames": last["frames"],
            "thinned": last["thinned"],
            "drops": (last["kernel_drops"] or 0) + (last["dropped"] or 0),
            "kB_per_s_phone_of_walk": round(
                sum(row["kB_per_s_phone"] for row in self.rows)
                * (60.0 / self.given.speed) / walk_s, 1,
            ),
            "first_points_s": _spread(self.second.first_points_s),
            "memory_MiB": {
                name: self._growth(name) for name in ("recorder", "mapper", "server")
            },
            "stop_to_ready_s": round(ready_s, 1),
            "words": sorted(self.first.words),
        }  # fmt: skip

    def _growth(self, name: str) -> dict[str, float | None]:
        """After a tenth of the walk, in its middle, at its end; growth of the second half."""
        seen = [row[name] for row in self.rows if name in row]
        if not seen:
            return {}
        early, middle, end = seen[len(seen) // 10], seen[len(seen) // 2], seen[-1]
        return {
            "early": early,
            "middle": middle,
            "end": end,
            "most": max(seen),
            "second_half_percent": round(100.0 * (end - middle) / middle, 1),
        }


def _percentile_ms(ages_s: list[float], percent: int) -> int | None:
    return round(1000 * float(np.percentile(ages_s, percent))) if ages_s else None


def _spread(seconds: list[float]) -> list[float]:
    """Median and longest."""
    return [round(float(np.median(seconds)), 2), round(max(seconds), 2)] if seconds else []


def main() -> None:
    """Print a row a minute, and the figures."""
    ask = argparse.ArgumentParser(description=__doc__)
    ask.add_argument("recording", type=Path)
    ask.add_argument("--minutes", type=int, default=60, help="of the walk")
    ask.add_argument("--speed", type=float, default=2.0)
    ask.add_argument("--rig", default="4recon")
    ask.add_argument("--folder", type=Path, help="where the project goes for the time")
    ask.add_argument("--punch", action="store_true", help="give the frames' space back at once")
    given = ask.parse_args()
    with (
        tempfile.TemporaryDirectory(dir=given.folder) as folder,
        recording(Path(folder), given) as session,
        server_process(Path(folder)) as (server, process),
    ):
        soak = Soak(given, session, server.url, process.pid)
        with replaying(session, given):
            asyncio.run(soak.run())
        ready_s = soak.stop()
        print(json.dumps(soak.figures(ready_s), indent=1))


if __name__ == "__main__":
    main()
