"""The bytes of a request onto the disk: flat memory, durable before anyone is told."""

from __future__ import annotations

import asyncio
import hashlib
import os
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path

from starlette.requests import ClientDisconnect

from app.errors import BadRequest, NoRoom
from recon4.errors import NoSpace
from recon4.store.atomic import raise_if_full

GATHER_BYTES = 1 << 20
"""The network hands over some 64 kB at a time; the disk is given more at once."""
SILENT_S = 30.0
"""A sender that says nothing for so long is cut off [s]."""


@dataclass(frozen=True, slots=True)
class Checksum:
    """What the sender says the bytes of this request hash to."""

    algorithm: str
    digest: bytes


class WrongChecksum(BadRequest):
    """The bytes that came are not those that were sent."""

    status = 460


async def receive(
    path: Path,
    pieces: AsyncIterator[bytes],
    *,
    offset: int,
    length: int,
    checksum: Checksum | None = None,
) -> int:
    """Append what comes to a file.

    When the sender breaks off, what came is kept, unless it cannot be checked.

    Args:
        path: The file; it is ``offset`` bytes long.
        pieces: What comes.
        offset: Where it belongs.
        length: The file will be this long in the end.
        checksum: Of what comes.

    Returns:
        The new length, safely on disk.

    Raises:
        BadRequest: If more comes than the file is to hold; nothing of it is kept.
        WrongChecksum: If the bytes are others; nothing of them is kept.
        NoRoom: If the disk is full; what found room is kept.
        ClientDisconnect: If the sender broke off.
    """
    descriptor = os.open(path, os.O_WRONLY)
    sink = _Sink(descriptor, offset, length, checksum)
    try:
        try:
            async for piece in _in_time(pieces):
                await sink.take(piece)
        except (ClientDisconnect, TimeoutError):
            await sink.flush(keep=checksum is None)
            raise
        await sink.flush(keep=True)
    except BadRequest:
        await asyncio.to_thread(_cut, descriptor, offset)
        raise
    except OSError as error:
        _say_full(error, path)
        raise
    finally:
        os.close(descriptor)
    return sink.end


class _Sink:
    """Gathers, hashes and writes; counts what comes."""

    def __init__(
        self, descriptor: int, offset: int, length: int, checksum: Checksum | None
    ) -> None:
        self.end = offset
        self._descriptor = descriptor
        self._start, self._length = offset, length
        self._checksum = checksum
        self._hash = hashlib.new(checksum.algorithm) if checksum else None
        self._gathered: list[bytes] = []
        self._bytes = 0

    async def take(self, piece: bytes) -> None:
        self._gathered.append(piece)
        self._bytes += len(piece)
        if self.end + self._bytes > self._length:
            raise BadRequest(
                f"{self.end + self._bytes} bytes came, the file was announced with {self._length}"
            )
        if self._bytes >= GATHER_BYTES:
            await asyncio.to_thread(self._write)

    async def flush(self, *, keep: bool) -> None:
        """The rest, and everything safely on disk; ``keep=False`` forgets this request."""
        if not keep:
            await asyncio.to_thread(_cut, self._descriptor, self._start)
            self.end = self._start
            return
        await asyncio.to_thread(self._write)
        if self._hash and self._checksum and self._hash.digest() != self._checksum.digest:
            raise WrongChecksum("the bytes were damaged on the way; send them again")
        await asyncio.to_thread(os.fsync, self._descriptor)

    def _write(self) -> None:
        data = memoryview(b"".join(self._gathered))
        self._gathered, self._bytes = [], 0
        if self._hash:
            self._hash.update(data)
        while data:
            written = os.pwrite(self._descriptor, data, self.end)
            self.end += written
            data = data[written:]


async def _in_time(pieces: AsyncIterator[bytes]) -> AsyncIterator[bytes]:
    while True:
        try:
            yield await asyncio.wait_for(anext(pieces), SILENT_S)
        except StopAsyncIteration:
            return


def _cut(descriptor: int, length: int) -> None:
    os.ftruncate(descriptor, length)
    os.fsync(descriptor)


def _say_full(error: OSError, path: Path) -> None:
    try:
        raise_if_full(error, path)
    except NoSpace as full:
        raise NoRoom("the disk is full; make room, then the upload goes on where it is") from full
