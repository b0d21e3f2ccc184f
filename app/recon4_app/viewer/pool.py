"""The viewer processes: one for each open project, ended when idle or with the server.

Each listens on a Unix socket in a private folder: only the relay (`viewer.proxy`) reaches it,
no web page and no other user of this computer.
"""

from __future__ import annotations

import asyncio
import hashlib
import os
import secrets
import sys
from pathlib import Path

from recon4.locales.coded import CodedText
from recon4.system.processes import ChildRegister, first_line
from recon4.system.runtime_folder import private_folder, runtime_folder
from recon4_app.errors import ViewerFailed
from recon4_app.network.streams import Streams
from recon4_app.settings import worker_environment
from recon4_app.viewer.scratch import scratch_of, viewer_environment
from recon4_app.viewer.tuning import VIEWER_POOL

READY = b"ready\n"
"""Output of a viewer as soon as it listens."""

Running = tuple[asyncio.subprocess.Process, Path]
"""A viewer and its socket."""


class ViewerPool:
    """Starts viewers at the first request and keeps their sockets."""

    def __init__(
        self, *, idle_s: float, points: int, state: Path, sockets: Streams, children: ChildRegister
    ) -> None:
        """Create the pool; no viewer is started yet.

        Args:
            idle_s: A viewer without a client for this long ends [s].
            points: Most points sent to one client.
            state: Folder of the server's own files.
            sockets: Counts the clients.
            children: Where the processes are registered.
        """
        self.sockets = sockets
        self._children = children
        self._state = state
        self._points = points
        self._idle_s = idle_s
        self._logs, self._jobs = state / "viewers", state / "jobs"
        self._running: dict[Path, Running] = {}
        self._starting: dict[Path, asyncio.Lock] = {}
        self._problems: dict[Path, str] = {}
        """Why the last start of a viewer failed; none once it runs."""
        self._closed = False

    async def socket(self, project: Path) -> Path:
        """Unix socket of the project's viewer, started if there is none or it died.

        Raises:
            ViewerFailed: If it does not start.
        """
        async with self._starting.setdefault(project, asyncio.Lock()):
            if self._closed:
                raise ViewerFailed(CodedText("server-stopping"))
            running = self._running.get(project)
            if running is not None and running[0].returncode is not None:
                await self._end(*running)  # it died or was idle: remove its socket and record
            if running is None or running[0].returncode is not None:
                self._running[project] = await self._start(project)
            return self._running[project][1]

    def problem(self, project: Path) -> str:
        """Why the project's viewer does not run; empty = it does, or starts."""
        return self._problems.get(project, "")

    async def give_up(self, project: Path, socket: Path) -> None:
        """End the viewer that does not respond on this socket; `socket` starts another."""
        async with self._starting.setdefault(project, asyncio.Lock()):
            running = self._running.get(project)
            if running is not None and running[1] == socket:
                await self._end(*self._running.pop(project))

    async def close(self) -> None:
        """End all viewers, those too that are only starting; none starts after it."""
        self._closed = True
        for project, starting in list(self._starting.items()):
            async with starting:
                if project in self._running:
                    await self._end(*self._running.pop(project))

    async def _start(self, project: Path) -> Running:
        self._logs.mkdir(parents=True, exist_ok=True)
        socket = private_folder(socket_folder(self._state)) / secrets.token_hex(4)
        caches = await asyncio.to_thread(viewer_environment, scratch_of(self._state, project.name))
        with (self._logs / f"{project.name}.txt").open("ab") as log:
            process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-P", "-m", "recon4_app.viewer.process", str(project)),
                *(str(self._idle_s), str(self._points), str(self._jobs), str(socket)),
                stdin=asyncio.subprocess.PIPE,  # its lifeline
                stdout=asyncio.subprocess.PIPE,
                stderr=log,
                env=worker_environment() | caches,
            )
        self._children.add(process.pid)
        ready = False
        try:
            ready = await first_line(process, within_s=VIEWER_POOL.starts_within_s) == READY
        finally:  # who asked for it may be gone, and the request canceled
            if not ready:
                await self._end(process, socket)
        if ready:
            self._problems.pop(project, None)
            return process, socket
        log_file = f"{self._logs / project.name}.txt"
        problem = CodedText("viewer-does-not-start", project=project.name, log=log_file)
        self._problems[project] = problem
        raise ViewerFailed(problem)

    async def _end(self, process: asyncio.subprocess.Process, socket: Path) -> None:
        """Request a viewer to end; kill it if it does not."""
        if process.returncode is None:
            process.terminate()
            try:
                async with asyncio.timeout(VIEWER_POOL.ends_within_s):
                    await process.wait()
            except TimeoutError:
                process.kill()
        await process.wait()
        socket.unlink(missing_ok=True)
        self._children.remove(process.pid)


def socket_folder(state: Path) -> Path:
    """Folder of the sockets of a server's viewers; one for each folder of projects.

    Raises:
        StoreError: If there is no private folder of this user.
    """
    name = hashlib.sha256(os.fsencode(state.resolve())).hexdigest()[:16]
    return runtime_folder() / name
