"""One phone that looks at the capture: told what it lacks, as fast as it listens."""

from __future__ import annotations

import asyncio
import json
import time
from dataclasses import asdict
from typing import Any

from fastapi import WebSocket

from app.live.capture import Capture, State
from app.live.health import lidars
from app.live.power import battery_words
from app.live.store import Captures
from app.live.stream_state import BYTES_A_POINT, Cursor
from recon4 import __version__
from recon4.live.findings import rates, words

SHOWN_EVERY_S = 0.05
"""A phone is told at most this often …"""
STILL_HERE_S = 2.0
"""… and at least this often."""
STALLED_S = 30.0
"""A phone that takes nothing for so long is let go; it comes back by itself."""
BYTES_A_SECOND = 220_000
"""1.8 Mbit/s for all a phone is told: points get what is left beside what is newest …"""
BYTES_AT_FIRST = 420_000
"""… after a first look at 60 000 points."""
URGENCY = ("bad", "care", "info")


class Phone:
    """A WebSocket and what its page has."""

    def __init__(self, socket: WebSocket, captures: Captures) -> None:
        self._socket, self._captures = socket, captures
        self._leaving: asyncio.Task[None] | None = None
        self._state: dict[str, Any] = {}
        self._allowance = float(BYTES_AT_FIRST)

    async def serve(self) -> None:
        """Tell it until it leaves.

        The page begins with ``{"have": {"project", "generation", "points", "path", "marks"}}`` of
        an earlier connection, or ``{}``. Then it gets text messages; one that announces ``points``
        is followed by a binary one.

        Raises:
            TimeoutError: If it takes nothing for `STALLED_S`.
            WebSocketDisconnect: If it has gone.
        """
        greeting = await self._greeting()
        if greeting is None:
            return
        have = greeting.get("have")
        self._leaving = asyncio.create_task(self._left())
        try:
            capture = self._captures.newest
            while not self._leaving.done():
                if capture is None:
                    none = {"state": "none", "t": time.time(), "server": __version__}
                    await self._send(none)
                    await self._rest(STILL_HERE_S)
                else:
                    await self._tell(capture, cursor_of(have, capture))
                    have = None
                capture = self._captures.newest
        finally:
            self._leaving.cancel()

    async def _greeting(self) -> dict[str, Any] | None:
        """What it begins with; None if it is no page of ours."""
        try:
            said = json.loads(await asyncio.wait_for(self._socket.receive_text(), STALLED_S))
        except (KeyError, ValueError, RecursionError):  # bytes, no JSON, nested without end
            return None
        return said if isinstance(said, dict) else None

    async def _tell(self, capture: Capture, cursor: Cursor) -> None:
        """Tell of one capture until another one begins or the phone leaves."""
        assert self._leaving is not None
        picture = capture.picture
        before_s = time.monotonic()
        while self._captures.newest is capture and not self._leaving.done():
            version, now_s = picture.version, time.monotonic()
            self._allowance += BYTES_A_SECOND * (now_s - before_s)
            self._allowance, before_s = min(self._allowance, BYTES_AT_FIRST), now_s
            most = max(0, int(self._allowance) // BYTES_A_POINT)
            message, points = picture.lacking(cursor, most=most)
            self._allowance -= len(points)
            await self._send(message | self._changed(state_of(self._captures, capture)))
            if points:
                await asyncio.wait_for(self._socket.send_bytes(points), STALLED_S)
            await self._rest(SHOWN_EVERY_S)
            if picture.complete(cursor):
                await picture.news(version, timeout_s=STILL_HERE_S)

    def _changed(self, state: dict[str, Any]) -> dict[str, Any]:
        """Only what this phone was not told like that before."""
        fresh = {key: value for key, value in state.items() if self._state.get(key) != value}
        self._state = state
        return fresh

    async def _rest(self, seconds: float) -> None:
        """Wait, but not for a phone that has left."""
        assert self._leaving is not None
        await asyncio.wait([self._leaving], timeout=seconds)

    async def _send(self, message: dict[str, Any]) -> None:
        text = json.dumps(message, separators=(",", ":"))
        self._allowance -= len(text)
        await asyncio.wait_for(self._socket.send_text(text), STALLED_S)

    async def _left(self) -> None:
        """Returns when the phone has gone; what it says is not listened to."""
        while (await self._socket.receive())["type"] != "websocket.disconnect":
            pass


def cursor_of(have: Any, capture: Capture) -> Cursor:
    """Where a phone that comes back left off."""
    cursor = Cursor()
    if isinstance(have, dict) and have.get("project") == capture.project:
        for name in ("generation", "points", "path", "marks"):
            value = have.get(name)
            if isinstance(value, int) and 0 <= value < 1 << 31:
                setattr(cursor, name, value)
    return cursor


def state_of(captures: Captures, capture: Capture) -> dict[str, Any]:
    """How the capture stands; what its sensors do only while it listens to them."""
    listens = capture.state in (State.RECORDING, State.PAUSED)
    newest = capture.picture.newest if listens else {}
    battery = captures.power.battery
    said = words(captures.rig, newest, capture.problem)
    said = sorted([*said, *battery_words(battery)], key=lambda word: URGENCY.index(word.level))
    return {
        "project": capture.project,
        "state": capture.state,
        "words": [asdict(word) for word in said],
        "rates": rates(captures.rig, newest["status"]) if "status" in newest else {},
        "lidars": [asdict(one) for one in lidars(captures.rig, newest)],
        "battery": None if battery is None else asdict(battery),
        "server": __version__,
    }
