"""Phones that look on: what one does or does not do is its own affair, and none gets too much."""

import asyncio
import base64
import json
import time

import numpy as np
import pytest
from fastapi import WebSocket

from app.live import phone as phones
from app.live.capture import Capture
from app.live.phone import Phone
from app.live.store import Captures
from recon4.live.session import CaptureSession
from recon4.model.rig import load_rig

POINTS = 400_000


class Ear:
    """The other end of a WebSocket: hears everything, or stops to listen."""

    def __init__(self, captures, *, stalls=False):
        self.stalls = stalls
        self.told, self.bytes = [], 0
        self._said = asyncio.Queue()
        for message in ({"type": "websocket.connect"}, {"type": "websocket.receive", "text": "{}"}):
            self._said.put_nowait(message)
        scope = {"type": "websocket", "path": "/", "headers": []}
        self.socket = WebSocket(scope, self._said.get, self._hear)
        self.captures = captures

    async def look(self):
        await self.socket.accept()
        await Phone(self.socket, self.captures).serve()

    def leave(self):
        self._said.put_nowait({"type": "websocket.disconnect", "code": 1000})

    async def _hear(self, message):
        if message["type"] == "websocket.accept":
            return
        if self.stalls:
            await asyncio.Event().wait()
        data = message.get("bytes") or message["text"].encode()
        self.bytes += len(data)
        if "text" in message:
            self.told.append(json.loads(message["text"]))


@pytest.fixture
def captures(tmp_path):
    known = Captures(tmp_path)
    known._capture, known._rig = (
        Capture(CaptureSession(project=tmp_path / "walk")),
        load_rig("4recon"),
    )
    return known


def walk(picture, k):
    picture.take({"kind": "pose", "t_ns": k, "p": [float(k), 0.0, 1.0], "lost": False})


def test_one_phone_that_stalls_is_let_go_and_nobody_else_notices(captures, monkeypatch):
    monkeypatch.setattr(phones, "STALLED_S", 0.5)

    async def ten_phones():
        ears = [Ear(captures, stalls=k == 0) for k in range(10)]
        looking = [asyncio.create_task(ear.look()) for ear in ears]
        for k in range(20):
            walk(captures.newest.picture, k)
            await asyncio.sleep(0.05)
        for ear in ears[1:]:
            ear.leave()
        async with asyncio.timeout(20.0):
            return ears, await asyncio.gather(*looking, return_exceptions=True)

    ears, ends = asyncio.run(ten_phones())

    assert isinstance(ends[0], TimeoutError) and ends[1:] == [None] * 9
    for ear in ears[1:]:
        assert len([told for told in ear.told if "pose" in told]) > 5
        assert ear.told[0]["state"] == "recording" and len(ear.told[0]["lidars"]) == 0


def test_the_newest_comes_first_and_all_a_phone_gets_stays_within_two_megabits(captures):
    picture = captures.newest.picture
    voxels = np.zeros((POINTS, 3), np.int16)
    told = {"kind": "points", "generation": 0, "start": 0, "voxel_m": 0.1}
    told["voxels"] = base64.b64encode(voxels.tobytes()).decode()
    told["values"] = base64.b64encode(bytes(POINTS)).decode()
    picture.take(told)

    async def one_phone():
        ear = Ear(captures)
        looking = asyncio.create_task(ear.look())
        began_s = time.monotonic()
        for k in range(20):
            walk(picture, k)
            await asyncio.sleep(0.1)
        ear.leave()
        await looking
        return ear, time.monotonic() - began_s

    ear, seconds = asyncio.run(one_phone())

    assert 300_000 < ear.bytes < phones.BYTES_AT_FIRST + 2e6 / 8 * seconds
    poses = [told["pose"]["p"][0] for told in ear.told if "pose" in told]
    assert poses[-1] == 19.0
