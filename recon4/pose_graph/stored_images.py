"""Density images of the places of a walk, in an unnamed file: memory does not grow with it."""

from __future__ import annotations

import os
import tempfile
import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import overload

import numpy as np

from recon4.geometry.se3 import Array
from recon4.pose_graph.density_images import DensityImage, Overlay, TurnedImage, overlays


class StoredImages(Sequence[DensityImage]):
    """Images that are read whenever they are asked for; their descriptors stay in memory."""

    def __init__(self, scratch: Path) -> None:
        """There are none yet.

        Args:
            scratch: Folder for the unnamed file; a full disk raises OSError.
        """
        self._file = tempfile.TemporaryFile(dir=scratch)  # noqa: SIM115
        weakref.finalize(self, self._file.close)
        self._rows: list[tuple[int, int, tuple[int, ...], Array]] = []
        """Of each the first byte, its points, the shape of its spectrum, and its descriptor."""
        self.laid: dict[tuple[int, int, int], list[Overlay]] = {}
        """Overlays that were found, by their target, source and number of yaws."""

    def append(self, image: DensityImage) -> None:
        """Store an image."""
        first = self._file.seek(0, os.SEEK_END)
        self._file.write(np.ascontiguousarray(image.walls_m, np.float64).tobytes())
        self._file.write(np.ascontiguousarray(image.spectrum, np.complex64).tobytes())
        self._file.flush()
        self._rows.append((first, len(image.walls_m), image.spectrum.shape, image.descriptor))

    @property
    def descriptors(self) -> Array:
        """Those of all images, (K, D)."""
        return np.stack([descriptor for *_, descriptor in self._rows])

    def __len__(self) -> int:
        return len(self._rows)

    @overload
    def __getitem__(self, k: int) -> DensityImage: ...
    @overload
    def __getitem__(self, k: slice) -> Sequence[DensityImage]: ...
    def __getitem__(self, k: int | slice) -> DensityImage | Sequence[DensityImage]:
        if isinstance(k, slice):
            return [self[row] for row in range(len(self))[k]]
        first, points, shape, descriptor = self._rows[k]
        walls = os.pread(self._file.fileno(), 16 * points, first)
        spectrum = os.pread(self._file.fileno(), 8 * int(np.prod(shape)), first + len(walls))
        return DensityImage(
            np.frombuffer(walls, np.float64).reshape(points, 2),
            np.frombuffer(spectrum, np.complex64).reshape(shape),
            descriptor,
        )


@dataclass(frozen=True, slots=True, eq=False)
class ChosenImages:
    """Some of the stored images."""

    stored: StoredImages
    rows: Sequence[int]
    """Of the stored ones, (K,)."""

    @property
    def descriptors(self) -> Array:
        """Those of the chosen images, (K, D)."""
        return np.asarray(self.stored.descriptors[list(self.rows)])

    def __getitem__(self, k: int) -> DensityImage:
        return self.stored[self.rows[k]]

    def laid_from(self, k: int, *, most: int) -> LaidImage:
        """An image to be laid onto others, which gives the best ``most`` overlays."""
        return LaidImage(self, k, most)


class LaidImage:
    """An image that is laid onto others; what an earlier search found is not computed again."""

    def __init__(self, images: ChosenImages, k: int, most: int) -> None:
        """Nothing is read yet."""
        self._images, self._k, self._most = images, k, most

    @cached_property
    def _turned(self) -> TurnedImage:
        return TurnedImage(self._images[self._k])

    def onto(self, k: int, yaws: Array) -> list[Overlay]:
        """The best overlays onto an image, best first.

        Args:
            k: Of the chosen images.
            yaws: As `yaws_within` makes them: there is one array of a length.
        """
        rows, known = self._images.rows, self._images.stored.laid
        key = (rows[k], rows[self._k], len(yaws))
        if key not in known:
            known[key] = overlays(self._images[k], self._turned, yaws=yaws, most=self._most)
        return known[key]
