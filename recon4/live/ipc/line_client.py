"""Starts recorder and mapper, and connects to their sockets."""

from __future__ import annotations

import asyncio
import logging
import os
import sys
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager, suppress
from pathlib import Path

from recon4.errors import ConfigError
from recon4.live.confinement import mapper_environment
from recon4.live.protocol import Message, ProtocolError, Request, decode_message, encode
from recon4.live.session import CaptureSession
from recon4.live.tuning import LINE_CLIENT
from recon4.sandbox import ONE_THREAD, allowed_environment
from recon4.system.processes import first_line

log = logging.getLogger(__name__)


class LineClient:
    """Receives and sends JSON lines over a connection to one process."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer

    async def messages(self) -> AsyncIterator[Message]:
        """Messages of the process until it closes the connection; malformed ones are skipped."""
        while line := await self._line():
            try:
                yield decode_message(line)
            except ProtocolError as error:
                log.warning("%s", error)

    async def _line(self) -> bytes:
        """The next line; empty at the end, also after a line that is too long."""
        try:
            return await self._reader.readline()
        except ConnectionError:
            return b""
        except ValueError:
            log.warning(
                "a line of a live capture is longer than %d bytes", LINE_CLIENT.longest_line
            )
            return b""

    async def send(self, request: Request) -> None:
        """Send a request to the process."""
        self._writer.write(encode(request))
        await self._writer.drain()


@asynccontextmanager
async def linked(path: Path) -> AsyncIterator[LineClient]:
    """Connect to the process that listens on a path.

    Raises:
        OSError: If no process listens there.
    """
    reader, writer = await asyncio.open_unix_connection(path, limit=LINE_CLIENT.longest_line)
    try:
        yield LineClient(reader, writer)
    finally:
        writer.close()


async def is_listening(path: Path) -> bool:
    """Whether a process listens on a path."""
    try:
        async with linked(path):
            return True
    except OSError:
        return False


async def started(
    session: CaptureSession, name: str, *, env: Mapping[str, str] | None = None
) -> asyncio.subprocess.Process:
    """Start the ``recorder`` or the ``mapper`` of a capture; it outlives its parent.

    Args:
        session: Session of a project that was created with `begin`.
        name: ``recorder`` or ``mapper``.
        env: Environment of the process; None = the allowed variables of this process.

    Raises:
        ConfigError: If it does not report ``ready``; the text is its last log line.
    """
    env = {**allowed_environment(os.environ), **ONE_THREAD} if env is None else dict(env)
    if name == "mapper":
        env |= mapper_environment(session)
    log_path = session.folder / f"{name}.txt"
    with log_path.open("ab") as log_file:
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-P", "-m", f"recon4.live.{name}.process", str(session.project)),
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=log_file,
            start_new_session=True,  # Ctrl-C must not reach it
            env=env,
        )
    if await first_line(process, within_s=LINE_CLIENT.starts_within_s) == b"ready\n":
        return process
    with suppress(ProcessLookupError):
        process.kill()
    await process.wait()
    lines = log_path.read_text("utf-8", "replace").splitlines()
    raise ConfigError(lines[-1] if lines else f"the {name} did not start")
