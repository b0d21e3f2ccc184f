"""Phones are independent of each other, and the data rate to each is limited."""

import asyncio
import json
import time

import numpy as np
import pytest
from fastapi import WebSocket
from msgspec import structs

from recon4.live.protocol import Points
from recon4.live.session import CaptureSession
from recon4.model.rig import load_rig
from recon4_app.live import phone as phones
from recon4_app.live.capture import Capture
from recon4_app.live.current_capture import CurrentCapture
from recon4_app.live.phone import Phone
from tests.deadlines import HANG_S
from tests.live_messages import pose

POINTS = 400_000


class Client:
    """The client side of a WebSocket: receives everything, or stalls."""

    def __init__(self, current_capture, *, stalls=False):
        self.stalls = stalls
        self.received, self.bytes = [], 0
        self._incoming = asyncio.Queue()
        for message in ({"type": "websocket.connect"}, {"type": "websocket.receive", "text": "{}"}):
            self._incoming.put_nowait(message)
        scope = {"type": "websocket", "path": "/", "headers": []}
        self.socket = WebSocket(scope, self._incoming.get, self._receive)
        self.current_capture = current_capture

    async def run(self):
        await self.socket.accept()
        await Phone(self.socket, self.current_capture, "en").serve()

    def leave(self):
        self._incoming.put_nowait({"type": "websocket.disconnect", "code": 1000})

    async def _receive(self, message):
        if message["type"] == "websocket.accept":
            return
        if self.stalls:
            await asyncio.Event().wait()
        data = message.get("bytes") or message["text"].encode()
        self.bytes += len(data)
        if "text" in message:
            self.received.append(json.loads(message["text"]))


@pytest.fixture
def current_capture(tmp_path):
    current_capture = CurrentCapture(tmp_path)
    current_capture._capture, current_capture._rig = (
        Capture(CaptureSession(project=tmp_path / "walk")),
        load_rig("4recon"),
    )
    return current_capture


def walk(stream, k):
    stream.take(pose(t_ns=k, p=[float(k), 0.0, 1.0]))


def test_a_phone_that_stalls_is_disconnected_without_effect_on_others(current_capture, monkeypatch):
    monkeypatch.setattr(phones, "PHONE_STREAM", structs.replace(phones.PHONE_STREAM, stalled_s=0.5))

    async def ten_phones():
        clients = [Client(current_capture, stalls=k == 0) for k in range(10)]
        running = [asyncio.create_task(client.run()) for client in clients]
        for k in range(20):
            walk(current_capture.newest.stream, k)
            await asyncio.sleep(0.05)
        for client in clients[1:]:
            client.leave()
        async with asyncio.timeout(HANG_S):
            return clients, await asyncio.gather(*running, return_exceptions=True)

    clients, ends = asyncio.run(ten_phones())

    assert isinstance(ends[0], TimeoutError) and ends[1:] == [None] * 9
    for client in clients[1:]:
        assert len([one for one in client.received if "pose" in one]) > 5
        assert client.received[0]["state"] == "recording" and len(client.received[0]["lidars"]) == 0


def test_the_newest_pose_is_sent_first_and_the_data_rate_stays_within_two_megabits(current_capture):
    stream = current_capture.newest.stream
    voxels = np.zeros((POINTS, 3), np.int16)
    stream.take(Points(0, 0, POINTS, 0.1, voxels.tobytes(), bytes(POINTS)))

    async def one_phone():
        client = Client(current_capture)
        running = asyncio.create_task(client.run())
        began_s = time.monotonic()
        for k in range(20):
            walk(stream, k)
            await asyncio.sleep(0.1)
        client.leave()
        await running
        return client, time.monotonic() - began_s

    client, seconds = asyncio.run(one_phone())

    assert 300_000 < client.bytes < phones.PHONE_STREAM.bytes_at_first + 2e6 / 8 * seconds
    poses = [one["pose"]["p"][0] for one in client.received if "pose" in one]
    assert poses[-1] == 19.0


def test_a_stream_cancelled_while_it_sends_ends(current_capture):
    class SignedOut(Client):
        async def _receive(self, message):
            await super()._receive(message)
            if "text" in message and len(self.received) == 1:
                self.running.cancel()

    async def one_phone():
        client = SignedOut(current_capture)
        client.running = asyncio.create_task(client.run())
        await asyncio.wait({client.running}, timeout=HANG_S)
        return client.running.cancelled(), len(client.received)

    assert asyncio.run(one_phone()) == (True, 1)
