"""The viewer processes: one an open project, on loopback, ended when idle or with the server."""

from __future__ import annotations

import asyncio
import json
import sys
from pathlib import Path

from app.errors import ViewerFailed
from app.settings import worker_environment
from app.viewer.sockets import Sockets

STARTS_WITHIN_S = 60.0
"""A viewer that has not named its port by then will not [s]."""


class ViewerPool:
    """Starts viewers when they are asked for and knows their ports."""

    def __init__(
        self, *, idle_s: float, points: int, logs: Path, jobs: Path, sockets: Sockets
    ) -> None:
        self.sockets = sockets
        self._points = points
        self._idle_s = idle_s
        self._logs, self._jobs = logs, jobs
        self._running: dict[Path, tuple[asyncio.subprocess.Process, int]] = {}
        self._starting: dict[Path, asyncio.Lock] = {}

    async def port(self, project: Path) -> int:
        """Port on 127.0.0.1 of the project's viewer, started if there is none or it died.

        Raises:
            ViewerFailed: If it does not start.
        """
        async with self._starting.setdefault(project, asyncio.Lock()):
            running = self._running.get(project)
            if running is None or running[0].returncode is not None:
                self._running[project] = await self._start(project)
            return self._running[project][1]

    async def give_up(self, project: Path, port: int) -> None:
        """End the viewer that had this port and does not answer there; `port` starts another."""
        async with self._starting.setdefault(project, asyncio.Lock()):
            running = self._running.get(project)
            if running is not None and running[1] == port:
                await _end(self._running.pop(project)[0])

    async def close(self) -> None:
        """End all viewers."""
        for process, _ in self._running.values():
            await _end(process)
        self._running.clear()

    async def _start(self, project: Path) -> tuple[asyncio.subprocess.Process, int]:
        self._logs.mkdir(parents=True, exist_ok=True)
        with (self._logs / f"{project.name}.txt").open("ab") as log:
            process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-m", "app.viewer.process", str(project)),
                *(str(self._idle_s), str(self._points), str(self._jobs)),
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                stderr=log,
                env=worker_environment(),
            )
        assert process.stdout is not None
        try:
            line = await asyncio.wait_for(process.stdout.readline(), STARTS_WITHIN_S)
            return process, int(json.loads(line)["port"])
        except (TimeoutError, ValueError, KeyError) as error:
            await _end(process)
            raise ViewerFailed(
                f"the viewer of {project.name} does not start; its log is in "
                f"{self._logs / project.name}.txt"
            ) from error


async def _end(process: asyncio.subprocess.Process) -> None:
    """Close its input, which it takes for the end; kill it when it does not."""
    assert process.stdin is not None
    if process.returncode is None:
        process.stdin.close()
        try:
            await asyncio.wait_for(process.wait(), 5.0)
        except TimeoutError:
            process.kill()
    await process.wait()
