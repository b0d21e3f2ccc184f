"""Messages read by their definition: no code is generated, and arrays become columns.

A definition is text of ROS, with the types it is made of behind lines of ``=``. It may come from a
bag of unknown origin: it is parsed to a list of fields, and `read_message` walks over the bytes. A
list of structures of fixed size, as of points, becomes one array for each of its fields, however
long it is.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.formats.limits import MAX_DEFINITION_CHARACTERS

Columns = dict[str, NDArray[Any]]
"""Fields of a list of structures, those of inner ones as ``position.x``, (N,) each."""
_MAX_VALUES = 10_000
"""Of a structure with all that is in it."""
_MAX_ITEMS = 4096
"""Texts, or structures without a fixed size, of one list."""
_MAX_FIELDS = 200
_NUMBERS = {
    **{"bool": "u1", "byte": "u1", "char": "u1", "int8": "i1", "uint8": "u1", "int16": "i2"},
    **{"uint16": "u2", "int32": "i4", "uint32": "u4", "int64": "i8", "uint64": "u8"},
    **{"float32": "f4", "float64": "f8"},
}
_STAMP = "builtin_interfaces/Time"
_KNOWN = {
    _STAMP: "int32 sec\nuint32 nanosec",
    "std_msgs/Header": f"{_STAMP} stamp\nstring frame_id",
    "geometry_msgs/Point32": "float32 x\nfloat32 y\nfloat32 z",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z",
}
"""Types that definitions leave out now and then, alike for ROS 1 and 2."""
_LINE = re.compile(r"^([\w/]+)(?:<=\d+)?(\[(?:<=)?(\d*)\])?\s+(\w+)(?:\s*(=).*|\s.*)?$")


@dataclass(frozen=True, slots=True)
class SchemaField:
    """One field of a type."""

    name: str
    kind: str
    """A number, ``string``, or the name of a type, as ``std_msgs/Header``."""
    is_list: bool = False
    count: int = 0
    """Of a list of fixed length; 0 = its length is in the message."""


@dataclass(frozen=True, slots=True)
class MessageSchema:
    """The fields of a message and of the types it is made of."""

    fields: tuple[SchemaField, ...]
    types: Mapping[str, tuple[SchemaField, ...]]

    def kind_of(self, name: str) -> str:
        """The type of a field; empty = there is none, or it is a list."""
        found = (field.kind for field in self.fields if field.name == name and not field.is_list)
        return next(found, "")

    def lists(self) -> dict[str, tuple[str, ...]]:
        """Lists of structures of fixed size -> the names of their columns."""
        found = {}
        for field in self.fields:
            leaves = _leaves(field.kind, self.types)
            if field.is_list and leaves and field.kind not in _NUMBERS:
                found[field.name] = tuple(name for name, _ in leaves)
        return found

    def number_lists(self) -> tuple[str, ...]:
        """Names of the lists of numbers."""
        return tuple(f.name for f in self.fields if f.is_list and f.kind in _NUMBERS)

    def numbers(self) -> tuple[str, ...]:
        """Names of the single numbers, those of inner structures as ``stamp.sec``."""
        found = []
        for field in self.fields:
            leaves = [] if field.is_list else _leaves(field.kind, self.types)
            names = [name for name, _ in leaves if not any(map(str.isdigit, name.split(".")))]
            found += [f"{field.name}.{name}" if name else field.name for name in names]
        return tuple(found)


def parse_schema(kind: str, definition: str) -> MessageSchema:
    """Parse the definition of a message.

    Args:
        kind: Its type, as ``sensor_msgs/msg/PointCloud``.
        definition: Text, with ``MSG: pkg/Name`` in front of each further type.

    Raises:
        CorruptFile: If a line is no field, a type is missing, or types contain themselves.
    """
    if len(definition) > MAX_DEFINITION_CHARACTERS:
        raise CorruptFile(CodedText("schema-long", kind=kind, count=len(definition)))
    first, *others = re.split(r"^=+\s*$", definition, flags=re.MULTILINE)
    texts = {}
    for text in others:
        head, _, body = text.strip().partition("\n")
        texts[_plain(head.removeprefix("MSG:").strip())] = body
    texts |= _KNOWN
    package = _plain(kind).partition("/")[0]
    types = {name: _fields(text, name.partition("/")[0], texts) for name, text in texts.items()}
    schema = MessageSchema(_fields(first, package, texts), types)
    sizes: dict[str, int] = {}
    for field in schema.fields:
        _expanded(field.kind, types, sizes)
    return schema


def read_message(schema: MessageSchema, data: bytes, *, ros1: bool) -> SimpleNamespace:
    """A message with its fields.

    Numbers are numbers, lists of numbers arrays, lists of structures of fixed size `Columns`, other
    structures have their fields in turn. A header of ROS 1 is like one of ROS 2.

    Raises:
        CorruptFile: If the message ends before its fields do, or has lists of absurd length.
    """
    cursor = _Cursor(data, ros1=ros1)
    return _structure(schema.fields, schema.types, cursor)


# -- definitions


def _plain(name: str) -> str:
    """``pkg/Name`` for ``pkg/msg/Name``."""
    return name.replace("/msg/", "/")


def _fields(text: str, package: str, texts: Mapping[str, str]) -> tuple[SchemaField, ...]:
    found = []
    for line in text.splitlines():
        line = line.split("#")[0].strip()
        if not line:
            continue
        match = _LINE.match(line)
        if match is None:
            raise CorruptFile(CodedText("schema-line", line=line[:80]))
        kind, is_list, count, name, constant = match.groups()
        if not constant:
            kind = _resolved(_plain(kind), package, texts)
            bounded = "<=" in (is_list or "")
            found.append(
                SchemaField(name, kind, bool(is_list), int(count) if count and not bounded else 0)
            )
    if len(found) > _MAX_FIELDS:
        raise CorruptFile(CodedText("schema-fields", count=len(found)))
    return tuple(found)


def _resolved(kind: str, package: str, texts: Mapping[str, str]) -> str:
    if kind in _NUMBERS or kind in ("string", "wstring"):
        return kind
    aliases = {"Header": "std_msgs/Header", "time": _STAMP, "duration": _STAMP}
    for name in (aliases.get(kind, kind), f"{package}/{kind}"):
        if name in texts:
            return name
    raise CorruptFile(CodedText("schema-type-missing", kind=kind))


def _expanded(
    kind: str, types: Mapping[str, tuple[SchemaField, ...]], sizes: dict[str, int]
) -> int:
    """How many values a type has with all the types in it.

    Raises:
        CorruptFile: If types contain each other, or there are absurdly many values.
    """
    if kind not in types:
        return 1
    if kind not in sizes:
        sizes[kind] = _MAX_VALUES  # of a type inside itself
        total = 1 + sum(
            max(1, field.count if field.is_list else 1) * _expanded(field.kind, types, sizes)
            for field in types[kind]
        )
        if total > _MAX_VALUES:
            raise CorruptFile(CodedText("schema-cycle", kind=kind))
        sizes[kind] = total
    return sizes[kind]


def _leaves(kind: str, types: Mapping[str, tuple[SchemaField, ...]]) -> list[tuple[str, str]]:
    """Names and numbers of a structure of fixed size; empty = it has none."""
    if kind in _NUMBERS:
        return [("", _NUMBERS[kind])]
    found: list[tuple[str, str]] = []
    for field in types.get(kind, ()):
        inner = _leaves(field.kind, types)
        if not inner or (field.is_list and not 0 < field.count <= _MAX_FIELDS):
            return []
        names = [f"{field.name}.{k}" for k in range(field.count)] if field.is_list else [field.name]
        found += [(f"{name}.{n}" if n else name, d) for name in names for n, d in inner]
        if len(found) > _MAX_FIELDS:
            return []
    return found


# -- messages


class _Cursor:
    """A place in the bytes of a message."""

    def __init__(self, data: bytes, *, ros1: bool) -> None:
        self.data, self.aligned = data, not ros1
        self.base = 0 if ros1 else 4
        self.order = "<" if ros1 or data[1:2] != b"\0" else ">"
        self.at = self.base
        self.ros1 = ros1

    def align(self, size: int) -> None:
        if self.aligned:
            self.at += -(self.at - self.base) % size

    def take(self, size: int) -> int:
        """Move over some bytes; returns where they begin."""
        start, self.at = self.at, self.at + size
        if self.at > len(self.data):
            raise CorruptFile(CodedText("message-cut", count=len(self.data)))
        return start

    def numbers(self, code: str, count: int) -> NDArray[Any]:
        size = int(code[1])
        if count:
            self.align(size)
        start = self.take(size * count)
        return np.frombuffer(self.data, self.order + code, count, start)

    def length(self) -> int:
        return int(self.numbers("u4", 1)[0])

    def text(self) -> str:
        count = self.length()
        start = self.take(count)
        return self.data[start : start + count].rstrip(b"\0").decode("utf-8", "replace")


def _value(
    field: SchemaField, types: Mapping[str, tuple[SchemaField, ...]], cursor: _Cursor
) -> Any:
    if field.kind == "wstring":
        raise CorruptFile(CodedText("schema-wide-text", field=field.name))
    if not field.is_list:
        return _one(field.kind, types, cursor)
    count = field.count or cursor.length()
    if field.kind in _NUMBERS:
        return cursor.numbers(_NUMBERS[field.kind], count)
    leaves = _leaves(field.kind, types)
    if leaves:
        return _columns(leaves, count, cursor)
    if count > _MAX_ITEMS:
        raise CorruptFile(
            CodedText("schema-items", field=field.name, count=count, max_items=_MAX_ITEMS)
        )
    return [_one(field.kind, types, cursor) for _ in range(count)]


def _one(kind: str, types: Mapping[str, tuple[SchemaField, ...]], cursor: _Cursor) -> Any:
    if kind in _NUMBERS:
        return cursor.numbers(_NUMBERS[kind], 1)[0].item()
    if kind == "string":
        return cursor.text()
    if kind == "std_msgs/Header" and cursor.ros1:
        cursor.numbers("u4", 1)  # the number of the message
    return _structure(types[kind], types, cursor)


def _structure(
    fields: Sequence[SchemaField], types: Mapping[str, tuple[SchemaField, ...]], cursor: _Cursor
) -> SimpleNamespace:
    return SimpleNamespace(**{field.name: _value(field, types, cursor) for field in fields})


def _columns(leaves: Sequence[tuple[str, str]], count: int, cursor: _Cursor) -> Columns:
    """The columns of a list of structures.

    With alignment the place of a field depends on where its structure begins, modulo 8: starts
    repeat after at most 8 structures, so each phase of this cycle has one stride.
    """
    if count > len(cursor.data):
        raise CorruptFile(CodedText("schema-structures", count=count, size=len(cursor.data)))
    out = {name: np.empty(count, np.dtype(cursor.order + code)) for name, code in leaves}
    phases, cycle = _phases(leaves, cursor)
    begin = cursor.at
    starts: list[int] = []
    at = begin
    for _, end in phases[:count]:
        starts.append(at)
        at += end
    length = sum(end for _, end in phases[cycle:])
    repeated = len(phases) - cycle
    cursor.take(_total(count, phases, cycle))
    for k, start in enumerate(starts):
        rows = slice(k, k + 1) if k < cycle else slice(k, None, repeated)
        number = len(range(*rows.indices(count)))
        for (name, code), offset in zip(leaves, phases[k][0], strict=True):
            out[name][rows] = np.ndarray(
                (number,), cursor.order + code, cursor.data, start + offset, (length,)
            )
    return out


def _phases(
    leaves: Sequence[tuple[str, str]], cursor: _Cursor
) -> tuple[list[tuple[list[int], int]], int]:
    """Offsets and bytes of the structures until their starts repeat, and where the cycle begins."""
    phases, seen, start = [], list[int](), (cursor.at - cursor.base) % 8
    while start not in seen:
        seen.append(start)
        at, offsets = start, []
        for _, code in leaves:
            size = int(code[1])
            at += -at % size if cursor.aligned else 0
            offsets.append(at - start)
            at += size
        phases.append((offsets, at - start))
        start = at % 8 if cursor.aligned else start
    return phases, seen.index(start)


def _total(count: int, phases: Sequence[tuple[list[int], int]], cycle: int) -> int:
    """Bytes of some structures."""
    ends = [end for _, end in phases]
    if count <= cycle:
        return sum(ends[:count])
    turns, rest = divmod(count - cycle, len(phases) - cycle)
    return sum(ends[:cycle]) + turns * sum(ends[cycle:]) + sum(ends[cycle : cycle + rest])
