"""Streams the capture to one phone: what it lacks, as fast as it receives."""

from __future__ import annotations

import asyncio
import time
from typing import Any

import msgspec
from fastapi import WebSocket

from recon4 import __version__
from recon4.live.findings import findings, rates
from recon4.live.newest_messages import Newest
from recon4.locales.coded import as_coded
from recon4.locales.languages import ENGLISH
from recon4.untrusted.typed import decoded
from recon4_app.live.capture import Capture, State
from recon4_app.live.current_capture import CurrentCapture
from recon4_app.live.health import lidars
from recon4_app.live.phone_message import CaptureState, NoCapture, PhoneMessage
from recon4_app.live.power import battery_findings
from recon4_app.live.stream_state import Cursor
from recon4_app.live.tuning import PHONE_STREAM, STREAM

URGENCY = ("error", "warning", "info")


class Greeting(msgspec.Struct, frozen=True):
    """The first message of a page."""

    have: Any = None
    """What it has of an earlier connection, see `cursor_of`."""


class Phone:
    """A WebSocket of a page, and the state the page has received."""

    def __init__(self, socket: WebSocket, current_capture: CurrentCapture, language: str) -> None:
        self._socket, self._current_capture = socket, current_capture
        self._language = language
        self._disconnected: asyncio.Task[None] | None = None
        self._state: CaptureState | None = None
        self._allowance = float(PHONE_STREAM.bytes_at_first)

    async def serve(self) -> None:
        """Send messages until the page disconnects.

        The page starts with ``{"have": {"project", "generation", "points", "path", "marks"}}`` of
        an earlier connection, or ``{}``. Then it receives text messages; one with ``points`` is
        followed by a binary one.

        Raises:
            TimeoutError: If it receives nothing for `PHONE_STREAM.stalled_s`.
            WebSocketDisconnect: If it is disconnected.
        """
        greeting = await self._greeting()
        if greeting is None:
            return
        have = greeting.have
        self._disconnected = asyncio.create_task(self._wait_for_disconnect())
        try:
            capture = self._current_capture.newest
            while not self._disconnected.done():
                if capture is None:
                    await self._send(NoCapture(t=time.time(), server=__version__))
                    await self._rest(PHONE_STREAM.still_here_s)
                else:
                    await self._stream(capture, cursor_of(have, capture))
                    have = None
                capture = self._current_capture.newest
        finally:
            self._disconnected.cancel()

    async def _greeting(self) -> Greeting | None:
        """The first message of the page; None if it is not a JSON object."""
        try:
            async with asyncio.timeout(PHONE_STREAM.stalled_s):
                said = await self._socket.receive_text()
            return decoded(said, Greeting)
        except (
            KeyError,
            ValueError,
            msgspec.MsgspecError,
            RecursionError,
        ):  # binary, not JSON, or nested too deeply
            return None

    async def _stream(self, capture: Capture, cursor: Cursor) -> None:
        """Stream one capture until another one begins or the phone disconnects."""
        assert self._disconnected is not None
        stream = capture.stream
        before_s = time.monotonic()
        while self._current_capture.newest is capture and not self._disconnected.done():
            version, now_s = stream.version, time.monotonic()
            self._allowance += PHONE_STREAM.bytes_a_second * (now_s - before_s)
            self._allowance, before_s = min(self._allowance, PHONE_STREAM.bytes_at_first), now_s
            most = max(0, int(self._allowance) // STREAM.bytes_a_point)
            message, points = stream.lacking(cursor, most=most)
            self._allowance -= len(points)
            state = state_of(self._current_capture, capture, self._language)
            message.add_changes(self._state, state)
            self._state = state
            await self._send(message)
            if points:
                async with asyncio.timeout(PHONE_STREAM.stalled_s):
                    await self._socket.send_bytes(points)
            await self._rest(PHONE_STREAM.shown_every_s)
            if stream.complete(cursor):
                await stream.news(version, timeout_s=PHONE_STREAM.still_here_s)

    async def _rest(self, seconds: float) -> None:
        """Wait, at most until the phone disconnects."""
        assert self._disconnected is not None
        await asyncio.wait([self._disconnected], timeout=seconds)

    async def _send(self, message: PhoneMessage | NoCapture) -> None:
        data = msgspec.json.encode(message)
        self._allowance -= len(data)
        async with asyncio.timeout(PHONE_STREAM.stalled_s):
            await self._socket.send_text(data.decode())

    async def _wait_for_disconnect(self) -> None:
        """Wait until the phone disconnects; its messages are ignored."""
        while (await self._socket.receive())["type"] != "websocket.disconnect":
            pass


def cursor_of(have: Any, capture: Capture) -> Cursor:
    """Cursor of a phone that reconnects, from the state it reports."""
    cursor = Cursor()
    if isinstance(have, dict) and have.get("project") == capture.project:
        for name in ("generation", "points", "path", "marks"):
            value = have.get(name)
            if isinstance(value, int) and 0 <= value < 1 << 31:
                setattr(cursor, name, value)
    return cursor


def state_of(
    current_capture: CurrentCapture, capture: Capture, language: str = ENGLISH
) -> CaptureState:
    """State of the capture; rates and warnings of the sensors only while it records."""
    records = capture.state in (State.RECORDING, State.PAUSED)
    newest = capture.stream.newest if records else Newest()
    battery = current_capture.power.battery
    problem = "; ".join(as_coded(one).said(language) for one in capture.problems)
    found = findings(current_capture.rig, newest, problem, language=language)
    found += capture.stream.so_far.findings(records=records, language=language)
    found += battery_findings(battery, language)
    found = sorted(found, key=lambda one: URGENCY.index(one.level))
    return CaptureState(
        project=capture.project,
        state=capture.state,
        findings=found,
        rates={} if newest.status is None else rates(current_capture.rig, newest.status),
        lidars=lidars(current_capture.rig, newest),
        battery=battery,
        server=__version__,
    )
