"""Classes of points found by workers; what they cannot find, this process does itself.

Files of one folder: ``walk.json`` and ``carrier.npz``: what all parts have in common;
``classes_A_B``: the classes of the multiframes from ``A`` to before ``B``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.classes.carrier import CarrierCubes
from recon4.errors import StoreError
from recon4.locales.coded import CodedText, at, text_of
from recon4.orders.order import OrderKind, Workers
from recon4.orders.parts import Part, Parts
from recon4.progress import Progress
from recon4.store.arrays import load_arrays, save_arrays
from recon4.store.atomic import atomic_file
from recon4.store.frame_folders import FrameFolders
from recon4.store.unfinished import unfinished_file
from recon4.untrusted.bounded import read_bytes_limited
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.typed import decoded

_WALK, _CARRIER = "walk.json", "carrier.npz"

Classes = list[NDArray[np.uint8]]
"""Of some multiframes, each (N,)."""


class ClassedWalk(msgspec.Struct, frozen=True, kw_only=True):
    """The walk whose points are classified."""

    folders: FrameFolders
    level: str
    """Absolute path of the stage ``level``: trajectory and mirrors."""

    def save(self, folder: Path, carrier: CarrierCubes) -> None:
        """Write into a folder what all parts have in common.

        Raises:
            OSError: If it cannot be written.
        """
        save_arrays(folder / _CARRIER, {"inner": carrier.inner, "around": carrier.around})
        (folder / _WALK).write_bytes(msgspec.json.encode(self))

    @staticmethod
    def load(folder: Path) -> tuple[ClassedWalk, CarrierCubes]:
        """Read what `save` wrote.

        Raises:
            StoreError: If it is missing or damaged.
        """
        data = read_bytes_limited(folder / _WALK, LIMITS.tile_list_bytes, failure=StoreError)
        try:
            walk = decoded(data, ClassedWalk)
        except (msgspec.DecodeError, RecursionError) as error:
            raise StoreError(at(_WALK, text_of(error))) from error
        arrays = load_arrays(folder / _CARRIER, ["inner", "around"])
        return walk, CarrierCubes(arrays["inner"], arrays["around"])


@dataclass(frozen=True, slots=True)
class OrderedClasses:
    """Classes that workers find."""

    workers: Workers
    folder: Path
    """Receives the classes."""
    walk: ClassedWalk

    @staticmethod
    def of(workers: Workers | None, walk: ClassedWalk) -> OrderedClasses | None:
        """Orders of the running stage; None = without workers, or nothing of it is kept.

        Args:
            workers: Who classifies.
            walk: Whose points.
        """
        kept = unfinished_file(_WALK)
        return OrderedClasses(workers, kept.parent, walk) if workers and kept else None

    def found(
        self,
        parts: Sequence[range],
        carrier: CarrierCubes,
        *,
        here: Callable[[range], Classes],
        progress: Progress,
    ) -> Iterator[Classes]:
        """Classes of the multiframes of each part, in their order.

        Args:
            parts: Consecutive multiframes.
            carrier: His volume.
            here: Classifies a part in this process.
            progress: Receives a warning where parts were made here.
        """
        self.walk.save(self.folder, carrier)

        def read(part: Part) -> Classes:
            return take_classes(self.folder, range(*part))

        ordered = Parts(
            kind=OrderKind.CLASSES,
            folder=self.folder,
            items=[(part.start, part.stop) for part in parts],
            read=read,
            here=lambda part: here(range(*part)),
        )
        return ordered.made(self.workers, progress)


def save_classes(folder: Path, rows: range, classes: Classes) -> None:
    """Write the classes of multiframes, whole or not at all.

    Raises:
        StoreError: If they cannot be written (`NoSpace` when the disk is full).
    """
    data = msgspec.msgpack.encode([one.tobytes() for one in classes])
    with atomic_file(_path(folder, rows)) as temporary:
        temporary.write_bytes(data)


def take_classes(folder: Path, rows: range) -> Classes:
    """Read what `save_classes` wrote, and remove the file.

    Raises:
        StoreError: If it is missing or damaged.
    """
    path = _path(folder, rows)
    data = read_bytes_limited(path, LIMITS.array_bytes, failure=StoreError)
    try:
        found = msgspec.msgpack.decode(data, type=list[bytes])
    except msgspec.DecodeError as error:
        raise StoreError(at(path.name, str(error))) from error
    if len(found) != len(rows):
        raise StoreError(
            CodedText("classes-rows", file=path.name, expected=len(rows), got=len(found))
        )
    path.unlink()
    return [np.frombuffer(one, np.uint8) for one in found]


def _path(folder: Path, rows: range) -> Path:
    return folder / f"classes_{rows.start}_{rows.stop}"
