"""Readers that are broken on purpose: what the fuzzer must find."""

from __future__ import annotations

import os
import signal
from pathlib import Path

from recon4.errors import CorruptFile
from tests.security.fuzz.kind import Kind, Reading

SEED = b"COUNT 8\n" + b"x" * 8


def _hang(path: Path) -> Reading:
    if path.read_bytes() != SEED:
        signal.pause()
    return Reading(8)


def _crash(path: Path) -> Reading:
    if path.read_bytes() != SEED:
        os.abort()
    return Reading(8)


def _memory(path: Path) -> Reading:
    return Reading(8 if path.read_bytes() == SEED else len(bytearray(2 << 30)))


def _traceback(path: Path) -> Reading:
    if path.read_bytes() != SEED:
        raise KeyError("x")
    return Reading(8)


def _wordless(path: Path) -> Reading:
    if path.read_bytes() != SEED:
        raise CorruptFile
    return Reading(8)


def _silent_cut(path: Path) -> Reading:
    return Reading(path.read_bytes().count(b"x"))


def _silent_count(path: Path) -> Reading:
    return Reading(8)


def _promised(data: bytes) -> int | None:
    digits = data[6:7]
    return int(digits) if digits.isdigit() else None


def _good(path: Path) -> Reading:
    if path.read_bytes() != SEED:
        raise CorruptFile("not the seed")
    return Reading(8)


def _kind(name: str, read: object) -> Kind:
    return Kind(name=name, file_name="a", seeds=lambda: [SEED], read=read)  # type: ignore[arg-type]


BROKEN = {
    kind.name: kind
    for kind in (
        _kind("broken-hang", _hang),
        _kind("broken-crash", _crash),
        _kind("broken-memory", _memory),
        _kind("broken-traceback", _traceback),
        _kind("broken-wordless", _wordless),
        _kind("broken-silent-cut", _silent_cut),
        Kind(
            name="broken-silent-count",
            file_name="a",
            seeds=lambda: [SEED],
            read=_silent_count,
            promised=_promised,
        ),
        _kind("broken-not", _good),
    )
}
"""By name; not among the kinds that are fuzzed."""
