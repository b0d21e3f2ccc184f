"""The maker: a confined process of a worker, which makes the parts of one folder.

It gets a line of JSON for each part and answers with one. Its program is
``python -m recon4.orders.maker LIFELINE PROJECT FOLDER``.
"""

from __future__ import annotations

import atexit
import faulthandler
import os
import shutil
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import msgspec

from recon4.orders.on_worker import PartOrder, PartReply
from recon4.orders.order import OrderKind
from recon4.orders.tuning import ORDERS
from recon4.recording.formats.scratch import keep_scratch_folder, sweep_scratch
from recon4.sandbox import Policy, confine
from recon4.sandbox.limits import physical_memory_bytes
from recon4.sandbox.private_cache import use_private_cache
from recon4.sandbox.tuning import CONFINEMENT
from recon4.system.processes import die_with_parent
from recon4.untrusted.typed import decoded

Make = Callable[[tuple[int, ...]], None]
"""Makes a part with these numbers and leaves its file in the folder."""


def main() -> None:
    """Make parts until there are no more."""
    lifeline, project, folder = int(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3])
    die_with_parent(lifeline)
    faulthandler.enable()  # a crash in native code says where
    replies = os.dup(1)
    os.dup2(2, 1)  # what a library prints is no reply
    _confine(project, folder)
    for line in _lines():
        os.write(replies, msgspec.json.encode(_made(line, folder)) + b"\n")


def _confine(project: Path, folder: Path) -> None:
    """Read the project, write the folder, nothing else."""
    sweep_scratch()
    scratch = keep_scratch_folder()
    atexit.register(shutil.rmtree, scratch / "tmp", ignore_errors=True)
    cached = use_private_cache(scratch / "caches")
    confine(
        Policy(
            read=(project, *cached),
            write=(folder, scratch),
            temporary=scratch / "tmp",
            memory_bytes=int(CONFINEMENT.memory_fraction * physical_memory_bytes()),
            open_files=CONFINEMENT.open_files,
        )
    )


def _lines() -> Iterator[bytes]:
    """Lines of the input until its end."""
    begun = b""
    while more := os.read(0, ORDERS.reply_bytes):
        *lines, begun = (begun + more).split(b"\n")
        yield from lines


def _made(line: bytes, folder: Path) -> PartReply:
    try:
        order = decoded(line, PartOrder)
        _make(order.kind, folder)(order.numbers)
    except Exception as error:  # whatever it is, who ordered makes the part itself and meets it
        return PartReply(failure=f"{type(error).__name__}: {error}"[: ORDERS.failure])
    return PartReply()


@cache
def _make(kind: OrderKind, folder: Path) -> Make:
    """What makes a kind of part; what all parts have in common is read once."""
    match kind:
        case OrderKind.MAP_TILE:
            from recon4.mapping.tile_files import TileMaker

            return TileMaker.open(folder).make
        case OrderKind.PAIRS:
            from recon4.pose_graph.pair_maker import PairMaker

            return PairMaker.open(folder).make
        case OrderKind.CLASSES:
            from recon4.classes.stage import ClassMaker

            return ClassMaker.open(folder).make


if __name__ == "__main__":
    main()
