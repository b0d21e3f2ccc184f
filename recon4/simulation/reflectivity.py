"""The true reflectivity of every shot, in the order of the packets."""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import NDArray


class ReflectivityWriter:
    """Writes an ``.npz`` with an array ``sensor0``, ``sensor1``, … a sensor, without holding it.

    Each is (packets, sequences, lasers) uint8: hundred times the reflectivity of what the shot
    hit, at most 255, and 0 where nothing came back.
    """

    def __init__(self, path: Path, shapes: Sequence[tuple[int, int]]) -> None:
        """Begin.

        Args:
            path: File to write.
            shapes: Sequences and lasers of a packet of each sensor.
        """
        self._path, self._shapes, sensors = path, shapes, len(shapes)
        self._parts = [path.with_name(f"{path.stem}{row}.tmp") for row in range(sensors)]
        self._files = [part.open("wb") for part in self._parts]
        self._packets = [0] * sensors

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        for file in self._files:
            file.close()
        if kind is None:
            self._collect()
        for part in self._parts:
            part.unlink()

    def append(self, row: int, reflectivity: NDArray[np.uint8]) -> None:
        """Append packets of a sensor, (P, S, L)."""
        self._files[row].write(reflectivity.tobytes())
        self._packets[row] += len(reflectivity)

    def _collect(self) -> None:
        with zipfile.ZipFile(self._path, "w") as archive:
            for row, (part, packets) in enumerate(zip(self._parts, self._packets, strict=True)):
                name = zipfile.ZipInfo(f"sensor{row}.npy")  # of no date
                with archive.open(name, "w", force_zip64=True) as target, part.open("rb") as source:
                    header = {
                        "descr": "|u1",
                        "fortran_order": False,
                        "shape": (packets, *self._shapes[row]),
                    }
                    np.lib.format.write_array_header_1_0(target, header)
                    shutil.copyfileobj(source, target, 1 << 20)
