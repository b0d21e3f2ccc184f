"""Processes of a capture that die: what was recorded is whole, and becomes a project."""

from __future__ import annotations

import json
import os
import secrets
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import contextmanager, suppress
from pathlib import Path

import httpx
import numpy as np
import pytest

from recon4.live.replay import replay
from recon4.live.session import load_session
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.ingest import ingest
from recon4.settings import preset
from recon4.simulation.simulate import simulate
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    out = tmp_path_factory.mktemp("walk")
    simulate("office", out, seconds=14.0, seed=3, bag=False, progress=Silent())
    return out


def process_of(module, project):
    """Process id of a part of a capture."""
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                words = (folder / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            if module.encode() in words and str(project).encode() in words:
                return int(folder.name)
    return None


def wait_for(met, what, seconds=60.0):
    end_s = time.monotonic() + seconds
    while not (found := met()):
        assert time.monotonic() < end_s, what
        time.sleep(0.1)
    return found


def hear_frame(project, frame_id):
    """Listen to the mapper until it has mapped a multiframe."""
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
                told = json.loads(line)
                if told["kind"] == "pose" and told["frame_id"] >= frame_id:
                    return
    raise AssertionError(f"multiframe {frame_id} was never mapped")


@pytest.fixture
def project(tmp_path):
    """Folder of a capture whose processes end with the test."""
    project = tmp_path / "projects" / "walk"
    project.parent.mkdir()
    yield project
    for module in ("recon4.live.recorder", "recon4.live.mapper"):
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
            with httpx.Client(base_url=url.rstrip("/"), timeout=60.0) as client:
                yield client
        finally:
            process.kill()


def test_mapper_server_and_recorder_die_and_nothing_recorded_is_lost(tmp_path, walk, project):
    root = project.parent
    address = ".".join(["127", *(str(secrets.randbelow(250) + 2) for _ in range(3))])
    sending = threading.Thread(
        target=replay, args=(walk,), kwargs={"progress": Silent(), "target": address}
    )
    with serving(root, address) as server:
        new = {"project": "walk", "rig": "4recon", "preset": "indoor"}
        answer = server.post("/api/live", json=new)
        assert answer.status_code == 201, answer.text
        sending.start()
        hear_frame(project, 3)
        mapper = process_of("recon4.live.mapper", project)
        os.kill(mapper, signal.SIGKILL)
        hear_frame(project, 20)
        again = process_of("recon4.live.mapper", project)

    with serving(root, address) as server:
        assert server.get("/api/live").json()["state"] == "recording"
        hear_frame(project, 40)
        os.kill(process_of("recon4.live.recorder", project), signal.SIGKILL)
        state = wait_for(
            lambda: (s := server.get("/api/live").json())["state"] == "ready" and s, "not ready"
        )
    sending.join()

    assert again != mapper
    assert any("the recorder died" in word["text"] for word in state["words"])
    assert json.loads((project / "live" / "outcome.json").read_text())["why"] == "the recorder died"
    live = FrameStore.open(read_artifacts(project)["frames"])
    ingest(
        [project / "recordings" / "walk.pcap"],
        tmp_path / "later",
        rig=load_rig(project / "recordings" / "rig.toml"),
        imu=None,
        gnss=None,
        settings=preset("indoor").ingest,
        progress=Silent(),
    )
    later = FrameStore.open(tmp_path / "later")
    assert len(live) == len(later) > 30
    for a, b in zip(live, later, strict=True):
        np.testing.assert_array_equal(a.xyz, b.xyz)
