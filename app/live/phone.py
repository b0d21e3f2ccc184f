"""One phone that looks at the capture: told what it lacks, as fast as it listens."""

from __future__ import annotations

import asyncio
import json
import time
from dataclasses import asdict
from typing import Any

from fastapi import WebSocket

from app.live.capture import Capture
from app.live.picture import Cursor
from app.live.store import Captures
from app.live.words import rates, words

SHOWN_EVERY_S = 0.1
"""A phone is told at most this often …"""
STILL_HERE_S = 2.0
"""… and at least this often."""
STALLED_S = 30.0
"""A phone that takes nothing for so long is let go; it comes back by itself."""
POINTS_A_SECOND = 30_000
"""1.7 Mbit/s for points, so that a phone's link stays free for what is newest …"""
POINTS_AT_FIRST = 60_000
"""… after a first look."""


class Phone:
    """A WebSocket and what its page has."""

    def __init__(self, socket: WebSocket, captures: Captures) -> None:
        self._socket, self._captures = socket, captures
        self._leaving: asyncio.Task[None] | None = None
        self._allowance = float(POINTS_AT_FIRST)

    async def serve(self) -> None:
        """Tell it until it leaves.

        The page begins with ``{"have": {"project", "generation", "points", "path", "marks"}}`` of
        an earlier connection, or ``{}``. Then it gets text messages; one that announces ``points``
        is followed by a binary one.

        Raises:
            TimeoutError: If it takes nothing for `STALLED_S`.
            WebSocketDisconnect: If it has gone.
        """
        said = json.loads(await asyncio.wait_for(self._socket.receive_text(), STALLED_S))
        have = said.get("have") if isinstance(said, dict) else None
        self._leaving = asyncio.create_task(self._left())
        try:
            capture = self._captures.newest
            while not self._leaving.done():
                if capture is None:
                    await self._send({"state": "none", "t": time.time()})
                    await self._rest(STILL_HERE_S)
                else:
                    await self._tell(capture, cursor_of(have, capture))
                    have = None
                capture = self._captures.newest
        finally:
            self._leaving.cancel()

    async def _tell(self, capture: Capture, cursor: Cursor) -> None:
        """Tell of one capture until another one begins or the phone leaves."""
        assert self._leaving is not None
        picture = capture.picture
        before_s = time.monotonic()
        while self._captures.newest is capture and not self._leaving.done():
            version, now_s = picture.version, time.monotonic()
            self._allowance += POINTS_A_SECOND * (now_s - before_s)
            self._allowance, before_s = min(self._allowance, POINTS_AT_FIRST), now_s
            told, points = picture.lacking(cursor, most=int(self._allowance))
            self._allowance -= told.get("points", {}).get("count", 0)
            await self._send(told | state_of(self._captures, capture))
            if points:
                await asyncio.wait_for(self._socket.send_bytes(points), STALLED_S)
            await self._rest(SHOWN_EVERY_S)
            if picture.complete(cursor):
                await picture.news(version, timeout_s=STILL_HERE_S)

    async def _rest(self, seconds: float) -> None:
        """Wait, but not for a phone that has left."""
        assert self._leaving is not None
        await asyncio.wait([self._leaving], timeout=seconds)

    async def _send(self, told: dict[str, Any]) -> None:
        text = json.dumps(told, separators=(",", ":"))
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
    """What is told with every message."""
    newest = capture.picture.newest
    said = words(captures.rig, newest, capture.problem)
    return {
        "project": capture.project,
        "state": capture.state,
        "words": [asdict(word) for word in said],
        "rates": rates(captures.rig, newest.get("status", {})),
    }
