"""The one capture of this computer: its two processes, and what they say."""

from __future__ import annotations

import asyncio
import logging
from enum import StrEnum
from pathlib import Path
from typing import Any

from app.errors import Conflict
from app.live.stream_state import StreamState
from app.settings import worker_environment
from recon4.errors import ConfigError
from recon4.live.ipc.line_client import STARTS_WITHIN_S, LineClient, linked, started
from recon4.live.project_files import discard
from recon4.live.session import CaptureSession

log = logging.getLogger(__name__)

_MAPPER_STARTS = 5
"""A mapper that died so often is given up; the recording goes on."""


class State(StrEnum):
    """Where a capture is."""

    RECORDING = "recording"
    PAUSED = "paused"
    FINISHING = "finishing"
    """The recorder has ended, the mapper catches up."""
    READY = "ready"
    """The project can be processed."""


class Capture:
    """Starts, follows and steers one capture. Its processes outlive the server."""

    def __init__(self, session: CaptureSession) -> None:
        self.session = session
        self.picture = StreamState()
        self.state = State.RECORDING
        self.problem = ""
        """Why the map does not grow, in words; empty = it does."""
        self._recorder: LineClient | None = None
        self._tasks: list[asyncio.Task[None]] = []
        self._mapper_starts = 0
        self._ended_because = ""
        """Why the recording ended, if nobody stopped it."""

    @property
    def project(self) -> str:
        """Name of the project's folder."""
        return self.session.project.name

    @property
    def over(self) -> bool:
        """Whether both processes have ended."""
        return self.state is State.READY

    async def start(self) -> None:
        """Start both processes.

        Raises:
            Conflict: If the recorder cannot start, in its own words; nothing is left of it.
        """
        try:
            await started(self.session, "recorder", env=worker_environment())
        except ConfigError as error:
            await asyncio.to_thread(discard, self.session)
            raise Conflict(str(error)) from None
        await self.follow()

    async def follow(self) -> None:
        """Follow the processes, also those an earlier server started."""
        hearing = asyncio.Event()
        self._tasks = [
            asyncio.create_task(self._follow_recorder(hearing)),
            asyncio.create_task(self._follow_mapper()),
        ]
        await asyncio.wait_for(hearing.wait(), STARTS_WITHIN_S)

    async def steer(self, message: dict[str, Any]) -> None:
        """Tell the recorder: stop, pause, resume, mark.

        Raises:
            Conflict: If it has ended.
        """
        if self._recorder is None:
            raise Conflict("the recording has ended")
        if message["do"] in ("pause", "resume"):
            self.state = State.PAUSED if message["do"] == "pause" else State.RECORDING
        await self._recorder.send(message)

    async def leave(self) -> None:
        """Stop following; the processes go on."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def _follow_recorder(self, hearing: asyncio.Event) -> None:
        try:
            async with linked(self.session.socket("recorder")) as link:
                self._recorder = link
                hearing.set()
                async for message in link.lines():
                    if message["kind"] == "status":
                        self.state = State.PAUSED if message["paused"] else State.RECORDING
                    elif message["kind"] == "stopped" and message["why"] != "stopped":
                        self._ended_because = f"The recording ended by itself: {message['why']}"
                    self.picture.take(message)
        except OSError as error:
            log.warning("recorder of %s: %s", self.project, error)
        finally:
            hearing.set()
            self._recorder = None
        self.state = State.FINISHING
        if not self._ended_because and not self.session.outcome.exists():
            self._ended_because = "the recorder died; what it recorded until then is safe"
        self.problem = self._ended_because or self.problem

    async def _follow_mapper(self) -> None:
        """Follow the mapper; start it when there is none."""
        done = None
        while done is None and self._mapper_starts < _MAPPER_STARTS:
            try:
                async with linked(self.session.socket("mapper")) as link:
                    done = await self._receive_mapper(link)
            except OSError:  # none listens: the last one died, or there was none yet
                self._mapper_starts += 1
                try:
                    await started(self.session, "mapper", env=worker_environment())
                except ConfigError as error:
                    self.problem = str(error)
        if done is None:
            self.problem = "the map stopped growing (its process died); the recording goes on"
        else:  # its troubles are over
            self.problem = "; ".join(filter(None, (self._ended_because, done["problem"])))
        while self._recorder is not None:
            await self.picture.news(self.picture.version, timeout_s=1.0)
        self.state = State.READY

    async def _receive_mapper(self, link: LineClient) -> dict[str, Any] | None:
        """What the mapper says at the end; None if it went before, or let us go as too slow."""
        done = None
        async for message in link.lines():
            if message["kind"] == "done":
                done = message
            self.picture.take(message)
        return done


def unfinished(root: Path) -> list[Path]:
    """Projects of an earlier server whose capture was not brought to an end."""
    sessions = [
        CaptureSession(project=path.parents[1]) for path in root.glob("*/live/session.json")
    ]
    begun = [session for session in sessions if session.capture.exists()]
    return [session.project for session in begun if not session.outcome.exists()]
