"""The capture file: datagrams as received, synced to the disk within a second.

A classic pcap file with nanosecond timestamps. It has no end mark: a recorder that is killed leaves
a valid file, which Wireshark and VeloView read too. A separate thread writes it, so that a slow
disk does not make the sockets overflow.
"""

from __future__ import annotations

import errno
import os
import struct
import threading
import time
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, field
from pathlib import Path

from recon4.live.protocol import FileState
from recon4.live.recorder.tuning import CAPTURE_FILE

_FILE_HEADER = struct.pack("<IHHiIII", 0xA1B23C4D, 2, 4, 0, 0, 65535, 1)
_RECORD = struct.Struct("<IIII")
_HEADERS = struct.Struct(">12sH BBHHHBBH4s4s HHHH")
"""Ethernet, IPv4 and UDP."""
_ETHERNET = b"\xff" * 6 + b"\x60\x76\x88\x00\x00\x01"

_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


@dataclass(frozen=True, slots=True)
class Datagram:
    """A datagram received on a socket."""

    t_ns: int
    """Time the kernel received it [ns]."""
    source: tuple[str, int]
    """Address and port of the sender."""
    port: int
    """Destination port."""
    payload: bytes


@dataclass(slots=True)
class _Waiting:
    records: list[bytes] = field(default_factory=list)
    size: int = 0


class CaptureFile:
    """Appends datagrams; `add` never waits for the disk."""

    def __init__(self, path: Path, *, on_written: Callable[[int], None]) -> None:
        """Create the file.

        Args:
            path: Must not exist.
            on_written: Called from the writing thread with the number of readable bytes.
        """
        self._path, self._on_written = path, on_written
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o644)
        self._state = FileState()
        self._waiting = _Waiting()
        self._news = threading.Condition()
        self._ending = False
        self._write(_FILE_HEADER, 0)
        os.fsync(self._file)
        _sync_folder(path.parent)
        self._thread = threading.Thread(target=self._run, name="disk", daemon=True)
        self._thread.start()

    def add(self, datagram: Datagram) -> None:
        """Queue a datagram; it is synced to the disk within `CAPTURE_FILE.sync_every_s`."""
        record = pcap_record(datagram)
        with self._news:
            if self._waiting.size + len(record) > CAPTURE_FILE.max_waiting_bytes:
                self._state.dropped += 1
                return
            self._waiting.records.append(record)
            self._waiting.size += len(record)

    def state(self) -> FileState:
        """State of the file now."""
        with self._news:
            self._state.waiting_bytes = self._waiting.size
            return copy(self._state)

    def close(self) -> None:
        """Write and sync the queue, then close."""
        with self._news:
            self._ending = True
            self._news.notify()
        self._thread.join()
        os.close(self._file)

    def _run(self) -> None:
        synced_s = time.monotonic()
        while True:
            with self._news:
                self._news.wait_for(lambda: self._ending, timeout=CAPTURE_FILE.write_every_s)
                ending, batch, self._waiting = self._ending, self._waiting, _Waiting()
            if batch.records:
                self._write(b"".join(batch.records), len(batch.records))
            if ending or time.monotonic() - synced_s >= CAPTURE_FILE.sync_every_s:
                self._sync()
                synced_s = time.monotonic()
            if ending:
                return

    def _write(self, data: bytes, datagrams: int) -> None:
        at = self._state.written_bytes
        try:
            while data:
                data = data[os.write(self._file, data) :]
        except OSError as error:
            os.ftruncate(self._file, at)  # complete records only
            os.lseek(self._file, at, os.SEEK_SET)
            full = error.errno in _FULL
            with self._news:
                self._state.dropped += datagrams
                self._state.problem = "the disk is full" if full else f"disk: {error.strerror}"
            return
        with self._news:
            self._state.written_bytes = os.lseek(self._file, 0, os.SEEK_CUR)
            self._state.datagrams += datagrams
            self._state.problem = ""
        self._on_written(self._state.written_bytes)

    def _sync(self) -> None:
        began_s = time.monotonic()
        written = self._state.written_bytes
        try:
            os.fdatasync(self._file)
        except OSError as error:
            with self._news:
                self._state.problem = f"disk: {error.strerror}"
            return
        with self._news:
            self._state.synced_bytes = written
            took_s = time.monotonic() - began_s
            self._state.longest_sync_s = max(self._state.longest_sync_s, took_s)


def pcap_record(datagram: Datagram) -> bytes:
    """A datagram as a pcap record, with Ethernet, IPv4 and UDP headers."""
    size = len(datagram.payload)
    length = _HEADERS.size + size
    seconds, nanoseconds = divmod(datagram.t_ns, 1_000_000_000)
    address, from_port = datagram.source
    source = bytes(int(part) for part in address.split("."))
    headers = _HEADERS.pack(
        *(_ETHERNET, 0x0800),
        *(0x45, 0, 28 + size, 0, 0, 64, 17, _checksum(28 + size, source), source, b"\xff" * 4),
        *(from_port, datagram.port, 8 + size, 0),
    )
    return _RECORD.pack(seconds, nanoseconds, length, length) + headers + datagram.payload


def _checksum(ip_length: int, source: bytes) -> int:
    words = 0x4500 + ip_length + 0x4011 + 2 * 0xFFFF
    words += int.from_bytes(source[:2], "big") + int.from_bytes(source[2:], "big")
    while words > 0xFFFF:
        words = (words & 0xFFFF) + (words >> 16)
    return 0xFFFF - words


def _sync_folder(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
