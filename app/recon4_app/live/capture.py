"""The capture of this computer: its two processes and their messages."""

from __future__ import annotations

import asyncio
import logging
from enum import StrEnum
from pathlib import Path

from recon4.errors import ConfigError
from recon4.live.ipc.line_client import LineClient, linked, started
from recon4.live.project_files import discard
from recon4.live.protocol import Done, Pause, Request, Resume, Status, Stopped
from recon4.live.session import CaptureSession
from recon4.live.tuning import LINE_CLIENT
from recon4.locales.coded import CodedText, coded, stored_text, text_of
from recon4_app.errors import Conflict
from recon4_app.live.stream_state import StreamState
from recon4_app.live.tuning import CAPTURES
from recon4_app.settings import worker_environment

log = logging.getLogger(__name__)


class State(StrEnum):
    """State of a capture."""

    RECORDING = "recording"
    PAUSED = "paused"
    FINISHING = "finishing"
    """The recorder has ended; the mapper catches up."""
    READY = "ready"
    """The project can be processed."""


class Capture:
    """Starts, follows and controls one capture. Its processes outlive the server."""

    def __init__(self, session: CaptureSession) -> None:
        self.session = session
        self.stream = StreamState()
        self.state = State.RECORDING
        self.problems: tuple[str, ...] = ()
        """Why the recording ended, and why the map does not grow; none = it does."""
        self._recorder: LineClient | None = None
        self._tasks: list[asyncio.Task[None]] = []
        self._mapper_starts = 0
        self._ended_because = ""
        """Why the recording ended by itself; empty = it was stopped."""

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
            Conflict: If the recorder cannot start; the text is its error. Its project is removed.
        """
        try:
            await started(self.session, "recorder", env=worker_environment())
        except ConfigError as error:
            await asyncio.to_thread(discard, self.session)
            raise Conflict(coded(error)) from None
        await self.follow()

    async def follow(self) -> None:
        """Follow the processes, including those an earlier server started."""
        connected = asyncio.Event()
        self._tasks = [
            asyncio.create_task(self._follow_recorder(connected)),
            asyncio.create_task(self._follow_mapper()),
        ]
        async with asyncio.timeout(LINE_CLIENT.starts_within_s):
            await connected.wait()

    async def request(self, request: Request) -> None:
        """Send a request to the recorder: stop, pause, resume or mark.

        Raises:
            Conflict: If the recorder has ended.
        """
        if self._recorder is None:
            raise Conflict(CodedText("capture-ended"))
        if isinstance(request, Pause | Resume):
            self.state = State.PAUSED if isinstance(request, Pause) else State.RECORDING
        await self._recorder.send(request)

    async def leave(self) -> None:
        """Stop following; the processes continue."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def _follow_recorder(self, connected: asyncio.Event) -> None:
        try:
            async with linked(self.session.socket("recorder")) as link:
                self._recorder = link
                connected.set()
                async for message in link.messages():
                    if isinstance(message, Status):
                        self.state = State.PAUSED if message.paused else State.RECORDING
                    elif isinstance(message, Stopped) and message.why != "stopped":
                        self._ended_because = CodedText("capture-ended-itself", why=message.why)
                    self.stream.take(message)
        except OSError as error:
            log.warning("recorder of %s: %s", self.project, error)
        finally:
            connected.set()
            self._recorder = None
        self.state = State.FINISHING
        if not self._ended_because and not self.session.outcome.exists():
            self._ended_because = CodedText("capture-recorder-died")
        self.problems = self._problems(*self.problems)

    async def _follow_mapper(self) -> None:
        """Follow the mapper; start it if none runs."""
        done = None
        while done is None and self._mapper_starts < CAPTURES.mapper_starts:
            try:
                async with linked(self.session.socket("mapper")) as link:
                    self.problems = self._problems()  # a failed start before is over
                    done = await self._receive_mapper(link)
            except OSError:  # no mapper runs: it died, or none was started yet
                self._mapper_starts += 1
                try:
                    await started(self.session, "mapper", env=worker_environment())
                except ConfigError as error:
                    self.problems = self._problems(text_of(error))
        if done is not None:  # finished: earlier problems no longer count
            problem = stored_text(done.code, done.values, done.problem)
            self.problems = self._problems(problem)
        else:
            goes_on = CodedText("capture-recording-goes-on") if self._recorder else ""
            self.problems = self._problems(CodedText("capture-map-stopped"), goes_on)
        while self._recorder is not None:
            await self.stream.news(self.stream.version, timeout_s=1.0)
        self.state = State.READY

    def _problems(self, *others: str) -> tuple[str, ...]:
        return tuple(filter(None, (self._ended_because, *others)))

    async def _receive_mapper(self, link: LineClient) -> Done | None:
        """The message ``done``; None if the mapper died or closed the connection as too slow."""
        done = None
        async for message in link.messages():
            if isinstance(message, Done):
                done = message
            self.stream.take(message)
        return done


def unfinished(root: Path) -> list[Path]:
    """Projects of an earlier server whose capture has not ended."""
    sessions = [
        CaptureSession(project=path.parents[1]) for path in root.glob("*/live/session.json")
    ]
    begun = [session for session in sessions if session.capture.exists()]
    return [session.project for session in begun if not session.outcome.exists()]
