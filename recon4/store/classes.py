"""Classes of all measured points, as the stage ``classes`` leaves them.

classes.zst    classes of each multiframe, compressed, one multiframe after the other
classes.npy    the byte after each of them, (F,)
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.store.arrays import load_array
from recon4.store.compressed import compress, expand
from recon4.store.frames import storing

POINTS, ENDS = "classes.zst", "classes.npy"


class ClassWriter:
    """Writes the classes of one multiframe after the other."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._ends: list[int] = []
        self._file: BinaryIO | None = None

    def __enter__(self) -> Self:
        with storing(self._folder):
            self._file = (self._folder / POINTS).open("wb")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        assert self._file is not None
        with storing(self._folder):
            self._file.close()
            if kind is None:
                np.save(self._folder / ENDS, np.array(self._ends, np.int64))

    def append(self, classes: NDArray[np.uint8]) -> None:
        """Write the classes of the next multiframe, in the order of its points, (N,).

        Raises:
            StoreError: If they cannot be written (`NoSpace` when the disk is full).
        """
        assert self._file is not None
        data = compress(np.ascontiguousarray(classes).data)
        with storing(self._folder):
            self._file.write(data)
        self._ends.append((self._ends[-1] if self._ends else 0) + len(data))


@dataclass(frozen=True, slots=True, eq=False)
class StoredClasses:
    """The classes of the points of a walk."""

    path: Path
    ends: NDArray[np.int64]
    """Byte after the classes of each multiframe, (F,)."""

    @staticmethod
    def open(folder: Path) -> StoredClasses:
        """Open the artifact of the stage ``classes``.

        Raises:
            StoreError: If it is missing or damaged.
        """
        ends = load_array(folder / ENDS, np.dtype(np.int64))
        path = folder / POINTS
        size = path.stat().st_size if path.is_file() else -1
        if np.any(np.diff(ends, prepend=0) <= 0) or (int(ends[-1]) if len(ends) else 0) != size:
            raise StoreError(f"{path.name}: expected the bytes that {ENDS} lists, got {size}")
        return StoredClasses(path, ends)

    def of(self, row: int, count: int) -> NDArray[np.uint8]:
        """The classes of the points of a multiframe, (N,).

        Args:
            row: Number of the multiframe.
            count: Points that it has.

        Raises:
            StoreError: If there is no such multiframe, it has another number of points, or its
                bytes are damaged.
        """
        where = f"{self.path.name}: multiframe {row}"
        if not 0 <= row < len(self.ends):
            raise StoreError(f"{where}: expected one of {len(self.ends)} multiframes")
        first = int(self.ends[row - 1]) if row else 0
        try:
            with self.path.open("rb", buffering=0) as file:
                file.seek(first)
                data = file.read(int(self.ends[row]) - first)
        except OSError as error:
            raise StoreError(f"{where} cannot be read: {error.strerror}") from error
        return np.frombuffer(expand(data, count, where), np.uint8)
