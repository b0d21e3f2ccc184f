"""A capture without a server: recorder and mapper as child processes, progress as text lines."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial

from recon4.errors import ConfigError
from recon4.live.ipc.line_client import linked, started
from recon4.live.newest_messages import Newest
from recon4.live.project_files import discard
from recon4.live.session import CaptureSession
from recon4.live.tuning import HEADLESS
from recon4.system.stopping import StopSignals


class Headless:
    """Starts both processes, keeps their newest messages, and stops them in order."""

    def __init__(self, session: CaptureSession, *, send: Callable[[Newest, str], None]) -> None:
        """Prepare.

        Args:
            session: Session of a project that was created with `begin`.
            send: Called every `HEADLESS.report_every_s` with the newest message of each kind and
                the problem of the capture itself (empty = none).
        """
        self._session, self._send = session, send
        self._newest = Newest()
        self._problem = ""
        self._stopping = asyncio.Event()

    async def run(self, seconds: float | None, stop: StopSignals) -> Newest:
        """Record until a signal, the end of the time limit or the end of the recorder.

        Returns:
            The newest messages, including ``done`` of the mapper.

        Raises:
            ConfigError: If a process cannot start; the text is its last log line.
        """
        loop = asyncio.get_running_loop()
        stop.request(partial(loop.call_soon_threadsafe, self._stopping.set))
        try:
            recorder = await started(self._session, "recorder")
        except ConfigError:
            discard(self._session)
            raise
        stopping = asyncio.create_task(self._stop_after(seconds, recorder))
        reporting = asyncio.create_task(self._report_periodically())
        receiving = asyncio.create_task(self._receive("recorder"))
        try:
            await self._map()
            await recorder.wait()
            await receiving
        finally:
            self._stopping.set()
            await stopping
            reporting.cancel()
            await asyncio.gather(reporting, return_exceptions=True)
        return self._newest

    async def _map(self) -> None:
        """Keep a mapper running until it reports ``done``."""
        for _ in range(HEADLESS.mapper_starts):
            mapper = await started(self._session, "mapper")
            await self._receive("mapper")
            await mapper.wait()
            done = self._newest.done
            if done is not None:
                self._problem = done.problem and f"There is no map: {done.problem}"
                return
            self._problem = "the mapper died and was started again; the recording continues"
        self._problem = "the map stopped growing; the recording continues"

    async def _stop_after(
        self, seconds: float | None, recorder: asyncio.subprocess.Process
    ) -> None:
        with suppress(TimeoutError):
            async with asyncio.timeout(seconds):
                await self._stopping.wait()
        with suppress(ProcessLookupError):
            recorder.terminate()
        await recorder.wait()

    async def _receive(self, name: str) -> None:
        with suppress(OSError):
            async with linked(self._session.socket(name)) as link:
                async for message in link.messages():
                    self._newest.take(message)

    async def _report_periodically(self) -> None:
        while True:
            await asyncio.sleep(HEADLESS.report_every_s)
            self._send(self._newest, self._problem)


def progress_line(newest: Newest, began_s: float) -> str:
    """Progress of a capture in one line: duration, size, rates, tracking."""
    status, pose, loop = newest.status, newest.pose, newest.loop
    rates = [] if status is None else [f"{s.port}: {s.per_s:.0f}/s" for s in status.senders]
    size = 0 if status is None else status.file.written_bytes
    parts = [
        f"{time.monotonic() - began_s:6.0f} s",
        f"{size / 1e6:8.1f} MB",
        ", ".join(rates) or "no datagrams",
    ]
    if pose is not None:
        walked_m = (loop.walked_m if loop is not None else None) or 0.0
        parts.append("lost" if pose.lost else f"frame {pose.frame_id}, {walked_m:.0f} m walked")
    return " | ".join(parts)
