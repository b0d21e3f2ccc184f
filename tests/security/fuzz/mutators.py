"""Mutations of valid files; deterministic by seed, kind and number."""

from __future__ import annotations

import random
import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass

from tests.security.fuzz.kind import Kind

MAX_BYTES = 1 << 20
MAGIC = (
    *(
        0,
        1,
        2,
        3,
        7,
        8,
        16,
        63,
        64,
        100,
        127,
        128,
        255,
        256,
        1000,
        4096,
        32767,
        32768,
        65535,
        65536,
    ),
    *(10**6, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 10**12, 2**63 - 1, 2**63, 2**64 - 1),
)
_WORDS = (
    *(
        b"nan",
        b"inf",
        b"-inf",
        b"1e999",
        b"-1",
        b"0",
        b"-0.0",
        b"1e308",
        b"9" * 400,
        b"0x10",
        b"_1",
    ),
    *(b"18446744073709551616", b"4294967297", b"\xff\xfe", b"\x00", b"\xc3", b"\xed\xa0\x80", b"#"),
    *(b";", b",", b"\t", b'"', b"'", b"\r", b"\n", b"\n\n", b"[" * 2000, b"{" * 300, b"(" * 300),
    *(b"..", b"/", b"a" * 5000, b"1,5", b"\\ud800", "١٢".encode(), "\u2028".encode(), b"null"),
)
_NUMBER = re.compile(rb"\d+")


@dataclass(frozen=True, slots=True)
class Mutant:
    """A damaged file."""

    data: bytes
    how: str
    """The mutations, in order."""
    cut_from: int | None
    """Row of the seed of which this is a mere beginning; None = something else."""


def mutant(kind: Kind, seeds: Sequence[bytes], seed: int, number: int) -> Mutant:
    """The mutant of a number: the same for the same arguments."""
    rng = random.Random(f"{kind.name}/{seed}/{number}")
    row = rng.randrange(len(seeds))
    if rng.random() < 0.12:
        return Mutant(_truncate(rng, seeds[row]), "truncate", row)
    data, names = seeds[row], []
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 5))):
        name, change = rng.choice(_MUTATIONS)
        data = change(rng, data, kind, seeds)[:MAX_BYTES]
        names.append(name)
    if kind.repair is not None and rng.random() < 0.7:
        data = kind.repair(data)
        names.append("repair")
    return Mutant(data, "+".join(names), None)


def _truncate(rng: random.Random, data: bytes) -> bytes:
    lines = data.count(b"\n")
    if lines and rng.random() < 0.3:  # at the end of a line
        return b"\n".join(data.split(b"\n")[: rng.randrange(lines)]) + b"\n"
    return data[: rng.randrange(len(data))]


def _flip_bits(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    out = bytearray(data)
    end = len(out) if rng.random() < 0.5 else min(len(out), kind.header_bytes)
    for _ in range(rng.choice((1, 1, 2, 4, 16)) if end else 0):
        out[rng.randrange(end)] ^= 1 << rng.randrange(8)
    return bytes(out)


def _set_bytes(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    out = bytearray(data)
    end = len(out) if rng.random() < 0.5 else min(len(out), kind.header_bytes)
    for _ in range(rng.choice((1, 2, 4)) if end else 0):
        out[rng.randrange(end)] = rng.choice((0, 1, 0x7F, 0x80, 0xFF, rng.randrange(256)))
    return bytes(out)


def _set_integer(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    """A magic integer over 2, 4 or 8 bytes, mostly aligned and in the header."""
    size, code = rng.choice(((2, "H"), (4, "I"), (8, "Q")))
    end = min(len(data), kind.header_bytes if rng.random() < 0.8 else len(data)) - size
    if end < 1:
        return data
    at = rng.randrange(end)
    at -= at % size if rng.random() < 0.5 else 0
    value = (rng.choice(MAGIC) + rng.choice((-1, 0, 0, 1))) % (1 << (8 * size))
    return data[:at] + struct.pack(rng.choice("<>") + code, value) + data[at + size :]


def _set_number(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    """A magic number over the digits of one that stands in the text."""
    found = list(_NUMBER.finditer(data[: rng.choice((kind.header_bytes, 4096))]))
    if not found:
        return data
    place = rng.choice(found)
    value = rng.choice(MAGIC) if rng.random() < 0.7 else int(place[0][:18]) + rng.choice((-1, 1, 7))
    return data[: place.start()] + str(value).encode() + data[place.end() :]


def _set_word(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    at = rng.randrange(len(data) + 1)
    over = rng.choice((0, 1, 4))
    return data[:at] + rng.choice(_WORDS) + data[at + over :]


def _cut_block(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    at, size = _span(rng, data)
    return data[:at] + data[at + size :]


def _duplicate_block(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    at, size = _span(rng, data)
    return data[:at] + data[at : at + size] * rng.choice((2, 2, 3, 50)) + data[at + size :]


def _move_block(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    at, size = _span(rng, data)
    rest = data[:at] + data[at + size :]
    to = rng.randrange(len(rest) + 1)
    return rest[:to] + data[at : at + size] + rest[to:]


def _insert_block(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    at = rng.randrange(len(data) + 1)
    size = rng.choice((1, 4, 100, 5000))
    block = rng.choice((bytes(size), b"\xff" * size, rng.randbytes(size), b" " * size))
    return data[:at] + block + data[at:]


def _lines(rng: random.Random, data: bytes, kind: Kind, _: Sequence[bytes]) -> bytes:
    """Drop, repeat or swap a line; or another end of line everywhere."""
    lines = data.split(b"\n")
    k, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    choice = rng.randrange(4)
    if choice == 0:
        del lines[k]
    elif choice == 1:
        lines.insert(j, lines[k])
    elif choice == 2:
        lines[k], lines[j] = lines[j], lines[k]
    return rng.choice((b"\r\n", b"\r")).join(lines) if choice == 3 else b"\n".join(lines)


def _splice(rng: random.Random, data: bytes, kind: Kind, seeds: Sequence[bytes]) -> bytes:
    other = rng.choice(seeds)
    return data[: rng.randrange(len(data) + 1)] + other[rng.randrange(len(other) + 1) :]


def _append(rng: random.Random, data: bytes, kind: Kind, seeds: Sequence[bytes]) -> bytes:
    return data + rng.choice((b"\0" * 100, b"\n", b"1 2 3\n", rng.choice(seeds)))


def _span(rng: random.Random, data: bytes) -> tuple[int, int]:
    at = rng.randrange(len(data) + 1)
    return at, min(len(data) - at, rng.choice((1, 2, 4, 8, 30, 200, len(data) // 4)))


_MUTATIONS = (
    ("bits", _flip_bits),
    ("bytes", _set_bytes),
    ("integer", _set_integer),
    ("integer", _set_integer),
    ("number", _set_number),
    ("number", _set_number),
    ("word", _set_word),
    ("cut", _cut_block),
    ("duplicate", _duplicate_block),
    ("move", _move_block),
    ("insert", _insert_block),
    ("lines", _lines),
    ("splice", _splice),
    ("append", _append),
)
