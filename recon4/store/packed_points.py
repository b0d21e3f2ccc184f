"""The points of a multiframe as compressed bytes: a sixth of what they take in memory.

Coordinates are rounded to whole steps of half a millimeter (`PACKING.step`); all else is kept
exactly. Each number is stored as its difference to the point before it on the same
beam, and the bytes of these differences apart: times become zeros, and what is left of the
coordinates is the noise of the sensor.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.packing import BEAMS, NUMBERS, differences, points_of
from recon4.model.multiframe import COLUMNS, Multiframe
from recon4.store.compressed import compress, expand
from recon4.store.tuning import PACKING

_BYTES = ("sensor", "ring", "echo")
_POINT_BYTES = len(_BYTES) + 4 * NUMBERS


def pack(frame: Multiframe) -> tuple[bytes, int]:
    """The points of a multiframe, compressed, and the power of two of their step."""
    count = len(frame)
    largest_m = float(np.abs(frame.xyz).max(initial=0.0))
    # Larger than usual only where coordinates have more than 31 bits, above 1000 km.
    step = max(PACKING.step, math.frexp(largest_m)[1] - 31)
    sensor, ring, echo = (np.ascontiguousarray(getattr(frame, name)) for name in _BYTES)
    packed = np.empty((_POINT_BYTES, count), np.uint8)
    packed[0], packed[1], packed[2] = sensor, ring, echo
    differences(
        (sensor, ring),
        np.ascontiguousarray(frame.xyz),
        2.0**-step,
        np.ascontiguousarray(frame.dt_ns),
        np.ascontiguousarray(frame.intensity),
        _no_beams(sensor),
        packed[len(_BYTES) :].reshape(NUMBERS, 4, count),
    )
    return compress(packed.data), step


def unpack(data: bytes, count: int, *, step: int, where: str) -> dict[str, NDArray[Any]]:
    """The columns of a multiframe, in memory of their own.

    Args:
        data: What `pack` returned.
        count: Number of its points.
        step: Power of two of their step.
        where: File and part of it, for errors.

    Raises:
        StoreError: If the data are damaged or have another number of points.
    """
    expanded = expand(data, _POINT_BYTES * count, where)
    packed = np.frombuffer(expanded, np.uint8).reshape(_POINT_BYTES, count)
    columns: dict[str, NDArray[Any]] = {
        name: np.empty((count, width) if width > 1 else count, dtype)
        for name, (dtype, width) in COLUMNS.items()
    }
    for row, name in enumerate(_BYTES):
        columns[name] = packed[row].copy()
    points_of(
        (columns["sensor"], columns["ring"]),
        packed[len(_BYTES) :].reshape(NUMBERS, 4, count),
        2.0**step,
        _no_beams(columns["sensor"]),
        columns["xyz"],
        columns["dt_ns"],
        columns["intensity"],
    )
    return columns


def _no_beams(sensor: NDArray[np.uint8]) -> NDArray[np.int32]:
    """Room for the newest numbers of each beam."""
    return np.zeros(((int(sensor.max(initial=0)) + 1) * BEAMS, NUMBERS), np.int32)
