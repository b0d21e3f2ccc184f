"""Messages between a confined process and its parent: short, typed and checked, never pickles.

The confined process may have been taken over by the recording that it reads. So the parent accepts
names of a closed list, folders inside of the project, and integers; nothing else is decoded.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Iterator, Sequence
from enum import StrEnum
from pathlib import Path
from typing import BinaryIO, Protocol, TypeVar

import msgspec

from recon4.errors import Recon4Error
from recon4.orders.tuning import ORDERS
from recon4.untrusted.typed import decoded

_LENGTH = struct.Struct(">I")
"""Header of a message: number of bytes that follow."""
_OF_STAGES = ("artifacts", "unfinished")
"""Folders of a project in which stages write."""
_NAME = re.compile(r"[A-Za-z0-9._-]+")

Message = TypeVar("Message")


class OrderRefused(Recon4Error):
    """A process sent a message that recon4 never sends."""


class OrderKind(StrEnum):
    """What workers can make."""

    MAP_TILE = "map-tile"
    """A tile of the map; its numbers are its index along x, y and z."""
    PAIRS = "pairs"
    """Pairs of nodes to register; its numbers are the round of the search and the part of it."""

    CLASSES = "classes"
    """Classes of points; its numbers are the first multiframe and the one after the last."""


NUMBERS = {OrderKind.MAP_TILE: 3, OrderKind.PAIRS: 2, OrderKind.CLASSES: 2}
"""How many numbers a part of each kind has."""


class Order(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Parts of a stage that workers are to make."""

    kind: OrderKind
    folder: str
    """Below the project, with ``/`` between: holds what the parts need, and receives them."""
    items: tuple[tuple[int, ...], ...]
    """Numbers of each part."""

    def __post_init__(self) -> None:
        if not len(self.items) <= ORDERS.items:
            raise ValueError(f"at most {ORDERS.items} parts, got {len(self.items)}")
        if any(len(numbers) != NUMBERS[self.kind] for numbers in self.items):
            raise ValueError(f"{NUMBERS[self.kind]} numbers for each part of {self.kind}")
        if any(not -ORDERS.number < n < ORDERS.number for numbers in self.items for n in numbers):
            raise ValueError(f"numbers below {ORDERS.number}")

    def folder_in(self, project: Path) -> Path:
        """Its folder, looked at on this computer.

        Raises:
            OrderRefused: If it is no ordinary folder of a stage of the project, without links.
        """
        return ordered_folder(project, self.folder)


class Answer(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What became of a part."""

    item: int
    """Its place in the order."""
    failure: str = ""
    """Why no worker could make it; empty = it is made."""


class Workers(Protocol):
    """Who makes parts of a stage in other processes."""

    def make(
        self,
        kind: OrderKind,
        folder: Path,
        items: Sequence[tuple[int, ...]],
        *,
        waiting: Callable[[], None],
    ) -> Iterator[Answer]:
        """Have parts made; each is answered once, in whatever order.

        Args:
            kind: What they are.
            folder: Holds what they need, and receives them.
            items: Numbers of each part.
            waiting: Called again and again meanwhile; may raise `Cancelled`.
        """


def ordered_folder(project: Path, folder: str) -> Path:
    """A folder that an order names, looked at on this computer.

    Args:
        project: The project.
        folder: Below it, with ``/`` between.

    Raises:
        OrderRefused: If it is no ordinary folder of a stage of the project, without links.
    """
    names = folder.split("/")
    plain = all(_NAME.fullmatch(name) and name.strip(".") for name in names)
    short = len(names) <= ORDERS.depth and max(map(len, names)) <= ORDERS.name
    if not (plain and short) or names[0] not in _OF_STAGES or len(names) < 2:
        raise OrderRefused(f"expected a folder of a stage, got {folder[: ORDERS.name]!r}")
    path = project.resolve().joinpath(*names)
    if path.resolve() != path or not path.is_dir():
        raise OrderRefused(f"expected a folder without links, got {folder!r}")
    return path


def send(file: BinaryIO, message: Order | Answer) -> None:
    """Write a message.

    Raises:
        OrderRefused: If it is too long.
        OSError: If the other side has ended.
    """
    data = msgspec.json.encode(message)
    if len(data) > ORDERS.message_bytes:
        raise OrderRefused(f"a message of {len(data)} bytes")
    file.write(_LENGTH.pack(len(data)) + data)
    file.flush()


def receive(file: BinaryIO, kind: type[Message]) -> Message | None:
    """Read a message; None when the other side has ended.

    Args:
        file: What the other side writes to.
        kind: Of the message.

    Raises:
        OrderRefused: If it is too long, or anything else than this kind of message.
    """
    head = _exactly(file, _LENGTH.size)
    if head is None:
        return None
    (length,) = _LENGTH.unpack(head)
    if length > ORDERS.message_bytes:
        raise OrderRefused(f"expected at most {ORDERS.message_bytes} bytes, got {length}")
    data = _exactly(file, length)
    if data is None:
        return None
    try:
        return decoded(data, kind)
    except (msgspec.DecodeError, ValueError, RecursionError) as error:
        raise OrderRefused(str(error)[: ORDERS.failure]) from error


def _exactly(file: BinaryIO, count: int) -> bytes | None:
    """This many bytes, also from a file without a buffer; None when it ends before."""
    data = bytearray()
    while len(data) < count:
        more = file.read(count - len(data))
        if not more:
            return None
        data += more
    return bytes(data)
