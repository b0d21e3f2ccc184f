"""A capture with faults: processes that die, datagrams that are lost, late or wrong.

The recording is complete and becomes a project, and the operator gets a warning.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import httpx
import numpy as np
import pytest

from recon4.errors import StoreError
from recon4.live.replay import ReplayDatagram, replay
from recon4.live.session import load_session
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.ingest import ingest
from recon4.recording.packets.velodyne.models import DATA_SIZE
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import preset
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts
from recon4.units import HOUR_US
from recon4_app.errors import Conflict
from recon4_app.live.current_capture import CurrentCapture
from tests.deadlines import HANG_S
from tests.loopback import an_address
from tests.service.running import wait_for


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    out = tmp_path_factory.mktemp("walk")
    simulate(prepare("office", seconds=14.0, seed=3), out, bag=False, progress=Silent())
    return out


def process_of(module, project):
    """Process id of a part of a capture."""
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                arguments = (folder / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            if module.encode() in arguments and str(project).encode() in arguments:
                return int(folder.name)
    return None


def wait_for_frame(project, frame_id):
    """Wait until the mapper has mapped a multiframe."""
    path = str(load_session(project).socket("mapper"))

    def connected():
        link = socket.socket(socket.AF_UNIX)
        link.settimeout(60.0)
        if link.connect_ex(path) == 0:
            return link
        return link.close()

    end_s = time.monotonic() + 60.0
    while time.monotonic() < end_s:
        link = wait_for(connected, "no mapper listens")
        with link, link.makefile("r") as lines, suppress(ConnectionError):  # it was just killed
            for line in lines:
                message = json.loads(line)
                if message["kind"] == "pose" and message["frame_id"] >= frame_id:
                    return
    raise AssertionError(f"multiframe {frame_id} was never mapped")


@pytest.fixture
def project(tmp_path):
    """Folder of a capture whose processes end with the test."""
    project = tmp_path / "projects" / "walk"
    project.parent.mkdir()
    yield project
    for module in ("recon4.live.recorder.process", "recon4.live.mapper.process"):
        if left := process_of(module, project):
            os.kill(left, signal.SIGKILL)


@contextmanager
def serving(root, address):
    """``recon4 serve`` until it is killed."""
    command = ["serve", str(root), "--port", "0", "--live-address", address]
    with subprocess.Popen(
        [sys.executable, "-m", "recon4", *command], stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            url = process.stdout.readline().split()[2]
            with httpx.Client(base_url=url.rstrip("/"), timeout=HANG_S) as client:
                yield client
        finally:
            process.kill()


def start(server):
    new = {"project": "walk", "rig": "4recon", "preset": "indoor"}
    answer = server.post("/api/live", json=new)
    assert answer.status_code == 201, answer.text


@pytest.mark.study
def test_mapper_server_and_recorder_die_and_nothing_recorded_is_lost(tmp_path, walk, project):
    root = project.parent
    address = an_address()
    sending = threading.Thread(
        target=replay, args=(walk,), kwargs={"progress": Silent(), "target": address}
    )
    with serving(root, address) as server:
        start(server)
        sending.start()
        wait_for_frame(project, 3)
        mapper = process_of("recon4.live.mapper.process", project)
        os.kill(mapper, signal.SIGKILL)
        wait_for_frame(project, 20)
        again = process_of("recon4.live.mapper.process", project)

    with serving(root, address) as server:
        assert server.get("/api/live").json()["state"] == "recording"
        wait_for_frame(project, 40)
        os.kill(process_of("recon4.live.recorder.process", project), signal.SIGKILL)
        state = wait_for(
            lambda: (s := server.get("/api/live").json())["state"] == "ready" and s, "not ready"
        )
    sending.join()

    assert again != mapper
    assert any("the recorder died" in one["text"] for one in state["findings"])
    assert json.loads((project / "live" / "outcome.json").read_text())["why"] == "the recorder died"
    live = FrameStore.open(read_artifacts(project)["frames"])
    recordings = project / "recordings"
    sources = Sources((recordings / "walk.pcap",), load_rig(recordings / "rig.toml"))
    ingest(sources, tmp_path / "later", settings=preset("indoor").ingest, progress=Silent())
    later = FrameStore.open(tmp_path / "later")
    assert len(live) == len(later) > 30
    for a, b in zip(live, later, strict=True):
        np.testing.assert_array_equal(a.xyz, b.xyz)


@dataclass
class FaultyNetwork:
    """Network from the sensors to the recorder, with one fault after the other."""

    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(7))
    first_ns: int = 0
    held: list[ReplayDatagram] = field(default_factory=list)
    fixes: int = 0

    def __call__(self, one: ReplayDatagram) -> Iterator[ReplayDatagram]:
        self.first_ns = self.first_ns or one.t_ns
        at_s = (one.t_ns - self.first_ns) / 1e9
        yield from self.packets(one, at_s) if one.port in (2368, 2369) else (one,)
        if at_s > 0.2 * self.fixes:
            self.fixes += 1
            yield from self.others(one, at_s)

    def packets(self, one: ReplayDatagram, at_s: float) -> Iterator[ReplayDatagram]:
        silent = 5.5 <= at_s < 8.0 or (one.port == 2369 and at_s < 5.0)
        lost = 8.0 <= at_s < 9.5 and self.rng.random() < 0.3
        if silent or lost:
            return
        if one.port == 2369:
            one = self.without_pps(one)
        if 11.0 <= at_s < 12.5:
            self.held.append(one)
            if len(self.held) == 8:
                yield from (self.held[k] for k in self.rng.permutation(8))
                self.held.clear()
            return
        yield one
        if 9.5 <= at_s < 11.0:
            yield one

    def without_pps(self, one: ReplayDatagram) -> ReplayDatagram:
        """The stamp of a sensor that counts from when it was switched on."""
        stamp_us = int.from_bytes(one.payload[1200:1204], "little") + 1_234_500_000
        stamp = (stamp_us % HOUR_US).to_bytes(4, "little")
        return replace(one, payload=one.payload[:1200] + stamp + one.payload[1204:])

    def others(self, one: ReplayDatagram, at_s: float) -> Iterator[ReplayDatagram]:
        """A receiver whose position jumps by 50 m, and foreign devices."""
        lat_deg = 49.2 + (50.0 / 111_195.0 if at_s > 6.0 else 0.0)
        fix = json.dumps({"lat_deg": lat_deg, "lon_deg": 16.6, "quality": 4}).encode()
        yield ReplayDatagram(one.t_ns, "127.0.0.1", 8310, fix)
        if at_s > 12.0:
            for size in (DATA_SIZE, 300):
                yield ReplayDatagram(one.t_ns, "127.9.9.9", 2368, self.rng.bytes(size))


@pytest.mark.study
def test_every_network_fault_gives_a_warning_and_all_datagrams_are_recorded(walk, project):
    address, sent, texts = an_address(), [], set()

    def send():
        sent.append(replay(walk, progress=Silent(), target=address, alter=FaultyNetwork()))

    sending = threading.Thread(target=send)
    with serving(project.parent, address) as server:
        start(server)
        sending.start()
        while sending.is_alive():
            texts |= {one["text"] for one in server.get("/api/live").json()["findings"]}
            sending.join(0.25)
        server.post("/api/live/stop").raise_for_status()
        wait_for(lambda: server.get("/api/live").json()["state"] == "ready", "not ready")

    for pattern in (
        r"vertical LiDAR silent for \d+ s",
        r"No LiDAR sends anything for \d+ s: check power and cables, and that it sends to .*",
        r"vertical: its clock is .* s off the recorder's and no GPS drives it.*",
        r"\d+ % of the data packets: never arrived: check cable and recorder",
        r"\d+ % of the data packets: received twice, the copies dropped",
        r"\d+ % of the data packets: out of order, sorted",
        r"Foreign traffic on port 2368 from 127\.9\.9\.9",
        r"GNSS jumped by 50 m: the map does not use it",
    ):
        assert any(re.fullmatch(pattern, text) for text in texts), (pattern, sorted(texts))
    batches = read_pcap(project / "recordings" / "walk.pcap", ImportReport())
    assert sum(len(batch) for batch in batches) == sent[0]
    frames = FrameStore.open(read_artifacts(project)["frames"])
    assert len(frames) > 80
    assert frames.report["counts"]["packets_duplicate"] > 1000


@pytest.mark.study
def test_a_capture_that_cannot_start_leaves_nothing_and_one_that_ends_reports_why(project):
    address = an_address()

    async def run():
        current_capture = CurrentCapture(project.parent)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind((address, 2369))
            with pytest.raises(Conflict, match=r"vertical.*is another recorder"):
                await current_capture.start("walk", load_rig("4recon"), address=address)
        left = project.exists()
        capture = await current_capture.start(
            "walk", load_rig("4recon"), address=address, least_free_bytes=1 << 62
        )
        while not capture.over:
            await capture.stream.news(capture.stream.version, timeout_s=0.5)
        with pytest.raises(StoreError, match="project walk exists already"):
            await current_capture.start("walk", load_rig("4recon"), address=address)
        await capture.leave()
        for module in ("recon4.live.recorder.process", "recon4.live.mapper.process"):
            await asyncio.to_thread(wait_for, lambda m=module: not process_of(m, project), module)
        await asyncio.sleep(0.1)  # the event loop reaps them
        return left, "; ".join(capture.problems)

    left, problem = asyncio.run(run())

    assert not left
    assert problem.startswith("The recording ended by itself: the disk is nearly full")
