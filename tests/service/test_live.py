"""A real capture: recorder, mapper, server and phones, fed by a replay of a simulated walk."""

from __future__ import annotations

import asyncio
import json
import re
import threading
from contextlib import contextmanager, suppress

import numpy as np
import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from recon4.live.replay import replay
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.packets.ouster.encode import metadata_json
from tests.ouster_models import nominal_metadata
from tests.scan_captures import capture_server
from tests.served import served

server = served(run=capture_server, fresh=True, below="projects")


class Phone:
    """A client of the stream with the state it has received."""

    def __init__(self):
        self.voxels = np.zeros((0, 3), np.int16)
        self.newest = {}
        self.path = 0
        self.bytes = 0

    async def follow(self, server, met, have=None, seconds=120.0):
        url = server.url.replace("http", "ws") + "/api/live/stream"
        async with asyncio.timeout(seconds):
            async with connect(url, origin=server.url, max_size=None) as socket:
                await socket.send(json.dumps({"have": have} if have else {}))
                async for text in socket:
                    message = json.loads(text)
                    self.bytes += len(text)
                    self.newest |= message
                    if "path" in message:
                        self.path = message["path"]["start"] + len(message["path"]["points"])
                    if "points" in message:
                        data = await socket.recv()
                        self.bytes += len(data)
                        self._take(message["points"], data)
                    if met(self, message):
                        return self

    def _take(self, points, data):
        assert len(data) == 7 * points["count"]
        fresh = np.frombuffer(data, np.int16, 3 * points["count"]).reshape(-1, 3)
        assert points["start"] in (0, len(self.voxels))
        known = self.voxels if points["start"] else self.voxels[:0]
        self.voxels = np.concatenate([known, fresh])


def start(server, project="walk", place="", rig="4recon"):
    new = {"project": project, "rig": rig, "preset": "indoor", "place": place}
    response = server.post("/api/live", json=new)
    assert response.status_code == 201, response.text
    return response.json()


@contextmanager
def sending(server, walk):
    thread = threading.Thread(
        target=replay,
        args=(walk,),
        kwargs={
            "progress": Silent(),
            "target": server.app.state.parts.settings.sensor_bind_address,
        },
    )
    thread.start()
    yield
    thread.join()


def test_a_walk_is_seen_on_the_phone_and_is_a_project_when_it_ends(server, office_recording):
    start(server, place="Town hall")
    phone = Phone()

    with sending(server, office_recording):
        asyncio.run(phone.follow(server, lambda p, message: len(p.voxels) > 5000 and p.path > 10))
        (card,) = server.get("/api/projects").json()
        assert (card["id"], card["name"]) == ("walk", "Town hall")
        named = server.post(
            "/api/live/marks", json={"what": "place", "text": "Town hall,\n2nd floor"}
        )
        assert named.status_code == 201
        assert server.post("/api/live/marks", json={"text": "crack"}).status_code == 201
    assert server.post("/api/live/stop").json()["project"] == "walk"
    asyncio.run(phone.follow(server, lambda p, message: message.get("state") == "ready",
                           have={"project": "walk", "generation": 0, "points": len(phone.voxels),
                                 "path": phone.path, "marks": 0}))  # fmt: skip

    assert phone.newest["marks"]["marks"][-1]["text"] == "crack"
    assert phone.newest["pose"]["imu"] is True
    assert phone.newest["findings"] is not None
    extent_m = np.ptp(phone.voxels, axis=0) * phone.newest["points"]["voxel_m"]
    assert 5.0 < extent_m[0] < 60.0
    assert len(np.unique(phone.voxels, axis=0)) == len(phone.voxels)
    project = server.get("/api/projects/walk").json()
    assert [stage["stage"] for stage in project["stages"]] == ["frames"]
    assert project["name"] == "Town hall, 2nd floor"


def test_a_file_beside_the_rig_file_describes_its_lidar(server):
    metadata = metadata_json(nominal_metadata("OS0-32", profile="LEGACY")).decode()
    (server.root / "backpack.toml").write_text(
        'name = "backpack"\n[[sensor]]\nname = "top"\nmodel = "OS0-32"\n'
    )
    (server.root / "sensor.json").write_text(metadata)

    start(server, rig=str(server.root / "backpack.toml"))
    assert server.post("/api/live/stop").status_code == 200
    asyncio.run(Phone().follow(server, lambda p, message: message.get("state") == "ready"))

    (sensor,) = load_rig(server.root / "walk/recordings/rig.toml").sensors
    assert sensor.description == metadata


def test_packets_of_another_model_are_said_although_no_pose_ever_comes(server, office_recording):
    rig = (office_recording / "rig.toml").read_text("utf-8").replace('"VLP-16"', '"XT32"')
    path = server.root / "rigs" / "other.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(re.sub('address = ".*"', 'address = ""', rig), "utf-8")
    new = {"project": "other", "rig": str(path), "preset": "indoor"}
    assert server.post("/api/live", json=new).status_code == 201

    def said(phone, message):
        return any(
            "of a VLP-16, not of the XT32" in one["text"] for one in phone.newest["findings"]
        )

    phone = Phone()
    with sending(server, office_recording):
        asyncio.run(phone.follow(server, lambda p, m: "findings" in p.newest and said(p, m)))
    assert "pose" not in phone.newest
    server.post("/api/live/stop")
    asyncio.run(Phone().follow(server, lambda p, message: message.get("state") == "ready"))


@pytest.mark.parametrize("greeting", [b"\x00\xff", "", "[", "3", '{"have": [1]}', "[" * 100_000])
def test_an_invalid_greeting_gets_no_map_and_logs_no_error(server, greeting, caplog):
    async def connect_with_greeting():
        url = server.url.replace("http", "ws") + "/api/live/stream"
        async with connect(url, origin=server.url) as socket:
            await socket.send(greeting)
            with suppress(TimeoutError, ConnectionClosed):
                return json.loads(await asyncio.wait_for(socket.recv(), 1.0))["state"]

    state = asyncio.run(connect_with_greeting())

    assert state in (None, "none")
    assert not [record for record in caplog.records if record.levelname == "ERROR"]
    assert server.get("/healthz").status_code == 200


@pytest.mark.parametrize("rig", ["../../pyproject", "/etc/hostname", "underwater"])
def test_a_rig_path_outside_the_allowed_folders_is_refused(server, rig):
    response = server.post("/api/live", json={"project": "walk", "rig": rig})

    assert response.status_code == 422 and "no rig named" in response.json()["detail"]
    assert not (server.root / "walk").exists()
