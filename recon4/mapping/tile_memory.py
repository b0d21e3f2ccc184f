"""Memory that is used again for the next tile, and threads for the parts of one."""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import DTypeLike, NDArray

from recon4.mapping.threads import Each, in_turn


class ScratchArray(Protocol):
    """`Scratch.array`"""

    def __call__(
        self, name: str, shape: tuple[int, ...], dtype: DTypeLike, *, fresh: int | None = None
    ) -> NDArray[Any]: ...


class Scratch(threading.local):
    """Arrays by name, valid until the same thread asks for the next one of the same name.

    The first write to fresh memory costs more than most of what is computed in it, because the
    system clears every page.
    """

    def __init__(self) -> None:
        self._held: dict[str, NDArray[np.uint8]] = {}

    def array(
        self, name: str, shape: tuple[int, ...], dtype: DTypeLike, *, fresh: int | None = None
    ) -> NDArray[Any]:
        """An array with any content.

        Args:
            name: Its name.
            shape: Its shape.
            dtype: Its type.
            fresh: Bytes of fresh memory; the caller restores them after use.
        """
        size = math.prod(shape) * np.dtype(dtype).itemsize
        held = self._held.get(name)
        if held is None or len(held) < size:
            held = self._held[name] = np.empty(size + size // 4, np.uint8)
            if fresh is not None:
                held.fill(fresh)
        return held[:size].view(dtype).reshape(shape)


@dataclass(frozen=True, slots=True)
class TileMeans:
    """What a tile is made with."""

    scratch: Scratch | None = None
    """Memory in which surfaces are fitted; None = fresh memory, free again afterwards."""
    each: Each = in_turn
    """Threads for its parts."""
