"""Columns and states of the tables of the plane map, which `planes` fills and reads."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class CubeStates(NamedTuple):
    """What is known of the plane of a cube."""

    dirty: np.uint8 = np.uint8(0)
    """Points came or went since it was fitted."""
    plane: np.uint8 = np.uint8(1)
    no_plane: np.uint8 = np.uint8(2)


STATE = CubeStates()


class CubeColumns(NamedTuple):
    """Columns of the tables of cubes: ``sums`` begins with ten moments."""

    batches: int = 10
    """From how many places points were seen."""
    newest: int = 11
    """Number of the newest of them."""
    seen_from: int = 12
    """First of the sum of these places (NaN = unknown)."""
    sums: int = 15
    """All columns of ``sums``."""
    fits: int = 10
    """All columns of ``fits``, see `_fit`."""


CUBE = CubeColumns()
