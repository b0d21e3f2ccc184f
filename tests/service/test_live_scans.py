"""Real captures of a 2-D laser and of a backpack with a profiler: processes, phone, project."""

from __future__ import annotations

import asyncio
import json
from dataclasses import replace

import numpy as np
import pytest

from recon4.live.replay import ReplayDatagram
from recon4.model.ports import PORTS
from recon4.model.rig import load_rig
from recon4.pipeline import process
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.backpack import prepare_backpack, simulate_backpack
from recon4.store.frames import FrameStore
from tests.planar_walks import along, furnished_room, scanned, write_carmen
from tests.scan_captures import LASER, capture_server, sending
from tests.served import served
from tests.service.test_live import Phone

server = served(run=capture_server, fresh=True, below="projects", robot=LASER)


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """The log of ten seconds in a furnished room."""
    corners = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0], [3.0, 1.0], [0.0, 1.0]])
    scans = scanned(furnished_room(), along(corners, speed_m_s=1.2)).scans
    path = tmp_path_factory.mktemp("log") / "walk.log"
    write_carmen(path, scans)
    return path


def start(server, rig):
    new = {"project": "walk", "rig": rig, "preset": "indoor"}
    response = server.post("/api/live", json=new)
    assert response.status_code == 201, response.text


def stopped(server, phone):
    assert server.post("/api/live/stop").status_code == 200
    asyncio.run(phone.follow(server, lambda p, message: message.get("state") == "ready"))


def texts(message):
    return [finding["text"] for finding in message.get("findings", [])]


@pytest.mark.study
def test_a_2d_laser_is_mapped_on_the_phone_and_processed_as_its_log(server, log, tmp_path):
    start(server, str(tmp_path / "projects" / "rigs" / "robot.toml"))
    phone = Phone()
    with sending(server, log):
        asyncio.run(phone.follow(server, lambda p, _: "plan" in p.newest and p.path > 5))
    stopped(server, phone)
    project = tmp_path / "projects" / "walk"
    stages = server.get("/api/projects/walk").json()["stages"]

    of_log = process(Sources((log,)), tmp_path / "of-log")
    rig = load_rig(project / "recordings" / "rig.toml")
    of_capture = process(Sources((project / "recordings" / "walk.pcap",), rig), project)
    poses = [read_tum(out / "trajectory.tum").T_a_b for out in (tmp_path / "of-log", project)]

    assert [stage["stage"] for stage in stages] == ["scans_2d"]
    assert phone.newest["pose"]["lost"] is False
    assert phone.newest["gaps"]["well"] > 0.5
    assert of_capture.scans == of_log.scans
    assert of_capture.verdict == of_log.verdict
    np.testing.assert_allclose(poses[0].t, poses[1].t, atol=1e-4)


@pytest.mark.study
def test_bad_scans_are_said_on_the_phone_and_recorded(server, log, tmp_path):
    """Every fifth scan comes twice, every seventh is no JSON, later the clock is set."""
    start(server, str(tmp_path / "projects" / "rigs" / "robot.toml"))
    sent, seen = [], set()

    def alter(datagram):
        sent.append(datagram)
        k = len(sent)
        if k > 50:  # an hour ahead
            stamp, rest = datagram.payload.split(b",", 1)
            t_ns = int(stamp.removeprefix(b'{"t_ns": ')) + 3_600_000_000_000
            datagram = replace(datagram, payload=b'{"t_ns": %d,' % t_ns + rest)
        yield datagram
        if k % 5 == 0:
            yield datagram
        if k % 7 == 0:
            yield replace(datagram, payload=b'{"ranges": [1.0, 2')

    def heard(phone, message):
        seen.update(texts(message))
        said = ("jumped", "repeated in other", "cannot be read")
        return all(any(words in text for text in seen) for words in said)

    phone = Phone()
    with sending(server, log, alter=alter):
        asyncio.run(phone.follow(server, heard))
    stopped(server, phone)
    outcome = json.loads((tmp_path / "projects/walk/live/outcome.json").read_text())

    assert outcome["file"]["datagrams"] == len(sent) + len(sent) // 5 + len(sent) // 7
    assert phone.newest["notes"]["counts"]["clock_jumps"] == 1
    assert phone.newest["notes"]["counts"]["scans"] == len(sent)
    assert phone.newest["pose"]["lost"] is False


@pytest.mark.study
def test_a_laser_that_falls_silent_is_said(server, log, tmp_path):
    start(server, str(tmp_path / "projects" / "rigs" / "robot.toml"))
    began = []

    def for_three_seconds(datagram: ReplayDatagram):
        began.append(datagram.t_ns)
        return (datagram,) if datagram.t_ns - began[0] < 3e9 else ()

    phone = Phone()
    with sending(server, log, alter=for_three_seconds):
        said = (
            "No scanner sends anything for 5 s: check power and cables, and that it sends to "
            "port 8311, 8312 of this computer"
        )
        asyncio.run(phone.follow(server, lambda p, message: said in texts(message)))
    stopped(server, phone)

    assert phone.newest["state"] == "ready"


@pytest.mark.study
def test_a_backpack_with_a_profiler_gives_the_frames_of_its_bag(server, tmp_path):
    walk = tmp_path / "walk"
    rig = load_rig("wuerzburg")
    prepared = prepare_backpack("hall", figure="circle", rig=rig, seconds=8.0, seed=3)
    simulate_backpack(prepared, walk, progress=Silent())
    start(server, "wuerzburg")
    phone = Phone()
    with sending(server, walk / "rosbag2", rig=rig):
        asyncio.run(phone.follow(server, lambda p, _: "plan" in p.newest and len(p.voxels) > 2000))
    stopped(server, phone)
    project = tmp_path / "projects" / "walk"

    ingest(
        Sources((walk / "rosbag2",), rig),
        tmp_path / "of-bag",
        settings=IngestSettings(),
        progress=Silent(),
    )
    (of_capture,) = (project / "artifacts").glob("*/index.npy")
    frames = [FrameStore.open(tmp_path / "of-bag"), FrameStore.open(of_capture.parent)]

    assert phone.newest["pose"]["imu"] is True
    assert phone.newest["pose"]["lost"] is False
    assert len(frames[0]) == len(frames[1]) > 70
    for row in range(len(frames[0])):
        np.testing.assert_array_equal(frames[0][row].xyz, frames[1][row].xyz)
        np.testing.assert_array_equal(frames[0][row].dt_ns, frames[1][row].dt_ns)
    assert PORTS.laser2d in {sender["port"] for sender in phone.newest["status"]["senders"]}
