"""Writing the body of a request to disk: constant memory, durable before the response."""

from __future__ import annotations

import asyncio
import hashlib
import os
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path

from starlette.requests import ClientDisconnect

from recon4.errors import NoSpace
from recon4.locales.coded import CodedText
from recon4.store.atomic import raise_if_full
from recon4_app.errors import BadRequest, NoRoom
from recon4_app.uploads.tuning import RECEIVING


@dataclass(frozen=True, slots=True)
class Checksum:
    """Checksum of the bytes of a request, as the sender gave it."""

    algorithm: str
    digest: bytes


class WrongChecksum(BadRequest):
    """The received bytes differ from the sent ones."""

    status = 460


async def receive(
    path: Path,
    pieces: AsyncIterator[bytes],
    *,
    offset: int,
    length: int,
    checksum: Checksum | None = None,
) -> int:
    """Append the received bytes to a file.

    When the sender disconnects, the received bytes are kept, unless there is a checksum to verify.

    Args:
        path: The file; it is ``offset`` bytes long.
        pieces: The received bytes.
        offset: Where they belong in the file.
        length: Final length of the file.
        checksum: Checksum of the received bytes.

    Returns:
        The new length, durably on disk.

    Raises:
        BadRequest: If more bytes come than were announced; none of them are kept.
        WrongChecksum: If the checksum differs; no bytes are kept.
        NoRoom: If the disk is full; the written bytes are kept.
        ClientDisconnect: If the sender disconnected.
    """
    descriptor = os.open(path, os.O_WRONLY)
    sink = _Sink(descriptor, offset, length, checksum=checksum)
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
        _raise_no_room(error, path)
        raise
    finally:
        os.close(descriptor)
    return sink.end


class _Sink:
    """Gathers, hashes, counts and writes bytes."""

    def __init__(
        self, descriptor: int, offset: int, length: int, *, checksum: Checksum | None
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
                CodedText("upload-length", expected=self._length, got=self.end + self._bytes)
            )
        if self._bytes >= RECEIVING.gather_bytes:
            await asyncio.to_thread(self._write)

    async def flush(self, *, keep: bool) -> None:
        """Write the rest and sync; ``keep=False`` discards the bytes of this request."""
        if not keep:
            await asyncio.to_thread(_cut, self._descriptor, self._start)
            self.end = self._start
            return
        await asyncio.to_thread(self._write)
        if self._hash and self._checksum and self._hash.digest() != self._checksum.digest:
            raise WrongChecksum(CodedText("upload-checksum"))
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
            async with asyncio.timeout(RECEIVING.silent_s):
                piece = await anext(pieces)
        except StopAsyncIteration:
            return
        yield piece


def _cut(descriptor: int, length: int) -> None:
    os.ftruncate(descriptor, length)
    os.fsync(descriptor)


def _raise_no_room(error: OSError, path: Path) -> None:
    try:
        raise_if_full(error, path)
    except NoSpace as full:
        raise NoRoom(CodedText("upload-disk-full")) from full
