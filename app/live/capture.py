"""The one capture of this computer: its two processes, and what they say."""

from __future__ import annotations

import asyncio
import logging
import sys
from contextlib import suppress
from enum import StrEnum
from pathlib import Path
from typing import Any

from app.errors import Conflict
from app.live.link import Link, linked
from app.live.picture import Picture
from app.settings import worker_environment
from recon4.live.session import Session

log = logging.getLogger(__name__)

STARTS_WITHIN_S = 60.0
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

    def __init__(self, session: Session) -> None:
        self.session = session
        self.picture = Picture()
        self.state = State.RECORDING
        self.problem = ""
        """Why the map does not grow, in words; empty = it does."""
        self._recorder: Link | None = None
        self._tasks: list[asyncio.Task[None]] = []
        self._over = asyncio.Event()
        self._mapper_starts = 0
        self._recorder_died = False

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
            Conflict: If the recorder cannot start, in its own words.
        """
        process, problem = await self._spawn("recorder")
        if process is None:
            raise Conflict(problem)
        await self.follow()

    async def follow(self) -> None:
        """Follow the processes, also those an earlier server started."""
        hearing = asyncio.Event()
        self._tasks = [
            asyncio.create_task(self._follow_recorder(hearing)),
            asyncio.create_task(self._follow_mapper()),
        ]
        await asyncio.wait_for(hearing.wait(), STARTS_WITHIN_S)

    async def steer(self, told: dict[str, Any]) -> None:
        """Tell the recorder: stop, pause, resume, mark.

        Raises:
            Conflict: If it has ended.
        """
        if self._recorder is None:
            raise Conflict("the recording has ended")
        if told["do"] in ("pause", "resume"):
            self.state = State.PAUSED if told["do"] == "pause" else State.RECORDING
        await self._recorder.say(told)

    async def wait_over(self, timeout_s: float) -> bool:
        """Whether it has ended within a time."""
        with suppress(TimeoutError):
            await asyncio.wait_for(self._over.wait(), timeout_s)
        return self._over.is_set()

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
                async for told in link.lines():
                    if told["kind"] == "status":
                        self.state = State.PAUSED if told["paused"] else State.RECORDING
                    self.picture.take(told)
        except OSError as error:
            log.warning("recorder of %s: %s", self.project, error)
        finally:
            hearing.set()
            self._recorder = None
        self.state = State.FINISHING
        if not self.session.outcome.exists():
            self._recorder_died = True
            self.problem = "the recorder died; what it recorded until then is safe"

    async def _follow_mapper(self) -> None:
        """Follow the mapper; start it when there is none."""
        done = False
        while not done and self._mapper_starts < _MAPPER_STARTS:
            try:
                async with linked(self.session.socket("mapper")) as link:
                    async for told in link.lines():
                        if told["kind"] == "done":
                            done, self.problem = True, told["problem"] or self._at_the_end()
                        self.picture.take(told)
            except OSError:
                pass  # none listens yet
            if not done:
                self._mapper_starts += 1
                process, problem = await self._spawn("mapper")
                if process is None:
                    self.problem = problem
        if not done:
            self.problem = "the map stopped growing (its process died); the recording goes on"
        while self._recorder is not None:
            await self.picture.news(self.picture.version, timeout_s=1.0)
        self.state = State.READY
        self._over.set()

    def _at_the_end(self) -> str:
        """What is still wrong when the frames are ready; the mapper's troubles are over."""
        return self.problem if self._recorder_died else ""

    async def _spawn(self, name: str) -> tuple[asyncio.subprocess.Process | None, str]:
        """Start a process of the capture; None and what it said if it does not get ready."""
        log_path = self.session.folder / f"{name}.txt"
        with log_path.open("ab") as log_file:
            process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-m", f"recon4.live.{name}", str(self.session.project)),
                stdin=asyncio.subprocess.DEVNULL,
                stdout=asyncio.subprocess.PIPE,
                stderr=log_file,
                start_new_session=True,
                env=worker_environment(),
            )
        assert process.stdout is not None
        with suppress(TimeoutError):
            if await asyncio.wait_for(process.stdout.readline(), STARTS_WITHIN_S) == b"ready\n":
                return process, ""
        with suppress(ProcessLookupError):
            process.kill()
        await process.wait()
        lines = log_path.read_text("utf-8", "replace").splitlines()
        return None, lines[-1] if lines else f"the {name} did not start"


def unfinished(root: Path) -> list[Path]:
    """Projects of an earlier server whose capture was not brought to an end."""
    sessions = root.glob("*/live/session.json")
    return [path.parents[1] for path in sessions if not (path.parent / "outcome.json").exists()]
