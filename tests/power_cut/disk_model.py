"""What may be on a disk after a power cut, from the record of all operations before it.

The model is POSIX's, harsher than most file systems: a file's data is safe when the file was
fsynced; a name in a folder (made, moved, removed) when the folder was. Of what is not safe each
cut keeps nothing (``LOST``), all names but no data (``NAMES``: files full of zeros or empty), or
a random part of both, the last write torn (``TORN``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

import msgspec.msgpack
import numpy as np

HIDDEN = ".fuse_hidden"
"""Begin of the name libfuse gives a file that is removed while it is open."""


class Keeps(StrEnum):
    """What a cut keeps of what is not safe."""

    LOST = "lost"
    NAMES = "names"
    TORN = "torn"


@dataclass(eq=False)
class File:
    """Bytes as programs see them, as they are safe, and the changes between."""

    now: bytearray = field(default_factory=bytearray)
    safe: bytes = b""
    pending: list[tuple[int, bytes | None]] = field(default_factory=list)
    """``(offset, data)`` a write, ``(length, None)`` a truncation."""

    def change(self, at: int, data: bytes | None) -> None:
        _apply(self.now, at, data)
        self.pending.append((at, data))

    def sync(self) -> None:
        self.safe = bytes(self.now)
        self.pending.clear()


@dataclass(eq=False)
class Folder:
    """Names as programs see them, as they are safe, and the changes between."""

    now: dict[str, Any] = field(default_factory=dict)
    safe: dict[str, Any] = field(default_factory=dict)
    pending: list[Change] = field(default_factory=list)

    def sync(self) -> None:
        for change in self.pending:
            change.apply(safe=True)
        self.pending.clear()


@dataclass(eq=False)
class Change:
    """Names that change together, in one folder or (a move) in two."""

    edits: list[tuple[Folder, str, Any]]
    """Folder, name, what it then means (None: nothing)."""
    done: bool = False

    def apply(self, *, safe: bool) -> None:
        if safe and self.done:
            return
        self.done = self.done or safe
        for folder, name, node in self.edits:
            names = folder.safe if safe else folder.now
            if node is None:
                names.pop(name, None)
            else:
                names[name] = node


class Disk:
    """Follows the record; `after_cut` writes what would be found."""

    def __init__(self) -> None:
        self.root = Folder()
        self.marks: list[str] = []
        self._open: dict[int, File] = {}

    def follow(self, operation: list[Any]) -> None:
        kind, *arguments = operation
        getattr(self, f"_{kind}")(*arguments)

    def after_cut(self, target: Path, keeps: Keeps, rng: np.random.Generator) -> None:
        """Write the folder that a cut now would leave."""
        kept: dict[int, bool] = {}
        _write(self.root, target, keeps, rng, kept)

    def _find(self, path: str) -> Any:
        node: Any = self.root
        for name in filter(None, path.split("/")):
            node = node.now[name]
        return node

    def _place(self, path: str) -> tuple[Folder, str]:
        folder, _, name = path.rpartition("/")
        return self._find(folder), name

    def _edit(self, *edits: tuple[Folder, str, Any]) -> None:
        change = Change(list(edits))
        change.apply(safe=False)
        for folder in {id(folder): folder for folder, _, _ in edits}.values():
            folder.pending.append(change)

    def _mark(self, text: str) -> None:
        self.marks.append(text)

    def _open_(self, fh: int, path: str) -> None:
        self._open[fh] = self._find(path)

    def _create(self, fh: int, path: str) -> None:
        self._open[fh] = File()
        self._edit((*self._place(path), self._open[fh]))

    def _write(self, fh: int, at: int, data: bytes) -> None:
        self._open[fh].change(at, data)

    def _truncate(self, path: str, length: int) -> None:
        self._find(path).change(length, None)

    def _fsync(self, fh: int) -> None:
        self._open[fh].sync()

    def _fsyncdir(self, path: str) -> None:
        self._find(path).sync()

    def _mkdir(self, path: str) -> None:
        self._edit((*self._place(path), Folder()))

    def _remove(self, path: str) -> None:
        self._edit((*self._place(path), None))

    def _rename(self, old: str, new: str) -> None:
        node, source = self._find(old), self._place(old)
        if new.rpartition("/")[2].startswith(HIDDEN):
            self._edit((*source, None))
            self._place(new)[0].now[new.rpartition("/")[2]] = node
        else:
            self._edit((*source, None), (*self._place(new), node))

    def _link(self, source: str, target: str) -> None:
        self._edit((*self._place(target), self._find(source)))


def operations(log: Path) -> Iterator[list[Any]]:
    """The record, in order."""
    with log.open("rb") as file:
        while size := file.read(4):
            operation = msgspec.msgpack.decode(file.read(int.from_bytes(size, "little")))
            yield ["open_", *operation[1:]] if operation[0] == "open" else operation


def _write(
    folder: Folder, target: Path, keeps: Keeps, rng: np.random.Generator, kept: dict[int, bool]
) -> None:
    names = dict(folder.safe)
    for change in folder.pending:
        if id(change) not in kept:
            kept[id(change)] = (
                change.done
                or {
                    Keeps.LOST: False,
                    Keeps.NAMES: True,
                    Keeps.TORN: bool(rng.random() < 0.5),
                }[keeps]
            )
        if kept[id(change)]:
            for place, name, node in change.edits:
                if place is not folder:
                    continue
                if node is None:
                    names.pop(name, None)
                else:
                    names[name] = node
    target.mkdir(exist_ok=True)
    for name, node in names.items():
        if isinstance(node, Folder):
            _write(node, target / name, keeps, rng, kept)
        else:
            (target / name).write_bytes(_bytes(node, keeps, rng))


def _bytes(file: File, keeps: Keeps, rng: np.random.Generator) -> bytes:
    found = bytearray(file.safe)
    if keeps is Keeps.NAMES and len(file.now) > len(found):
        found.extend(bytes(len(file.now) - len(found)))  # the length came, the data did not
    if keeps is Keeps.TORN:
        for at, data in file.pending:
            if rng.random() < 0.5:
                _apply(found, at, data if data is None else data[: rng.integers(len(data) + 1)])
    return bytes(found)


def _apply(found: bytearray, at: int, data: bytes | None) -> None:
    if data is None:
        del found[at:]
        found.extend(bytes(at - len(found)))
    else:
        found.extend(bytes(max(0, at - len(found))))
        found[at : at + len(data)] = data
