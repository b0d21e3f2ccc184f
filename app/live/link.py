"""The server's end of the Unix sockets of recorder and mapper."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

_LONGEST_LINE = 32 << 20
"""A whole preview of 400 k points is 4 MB."""


class Link:
    """JSON lines to and from one process."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer

    async def lines(self) -> AsyncIterator[dict[str, Any]]:
        """What is said, until the other side ends."""
        try:
            while line := await self._reader.readline():
                yield json.loads(line)
        except ConnectionError:
            return

    async def say(self, told: dict[str, Any]) -> None:
        """Tell the other side."""
        self._writer.write(json.dumps(told).encode() + b"\n")
        await self._writer.drain()


@asynccontextmanager
async def linked(path: Path) -> AsyncIterator[Link]:
    """A connection to the process that listens on a path.

    Raises:
        OSError: If none does.
    """
    reader, writer = await asyncio.open_unix_connection(path, limit=_LONGEST_LINE)
    try:
        yield Link(reader, writer)
    finally:
        writer.close()


async def listens(path: Path) -> bool:
    """Whether a process listens on a path."""
    try:
        async with linked(path):
            return True
    except OSError:
        return False
