"""Angle table of an AT128: its beams are turned by a drum of mirrors.

The binary file ``.dat`` of the unit (magic ``ee ff``, version 1.5) has the directions of the
channels, where each mirror begins, and corrections every 2° of the drum. A table of text has no
positions of mirrors and does not suffice. Source: Hesai AT128E2X manual A01-en-230920, section
3.1.4, and the AT128 angle correction file as published by Hesai.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.family import Companion
from recon4.recording.packets.hesai.layouts import START


class _TableFile:
    """The binary file."""

    CIRCLE = 360 * 100 * 256
    """Units of azimuth in a full turn of the drum."""
    NODES = 180
    """Corrections a channel, one every 2°."""
    HEADER = 16
    """Bytes in front of the tables."""
    VERSION = (1, 5)
    SIGNATURE = 32
    """Bytes behind them."""
    CHANNELS = 128


@dataclass(frozen=True, slots=True, eq=False)
class MirrorTable:
    """Directions of the beams of one AT128, in units of 1/25600°."""

    start: NDArray[np.int64]
    """Azimuth of the drum where each mirror begins, ascending, (M,)."""
    azimuth: NDArray[np.int64]
    """Subtracted from twice the angle since the start of the mirror, (C,)."""
    elevation: NDArray[np.int64]
    """Above the horizontal plane, (C,)."""
    azimuth_correction: NDArray[np.int64]
    """Added to the azimuth at every 2° of the drum, linear in between, (C, 180)."""
    elevation_correction: NDArray[np.int64]
    """Added to the elevation, (C, 180)."""


def read_mirrors(companion: Companion) -> MirrorTable | None:
    """The angle table in a file; None = it is another file, or of another version."""
    content = companion.content
    if (
        content[:2] != START
        or tuple(content[2:4]) != _TableFile.VERSION
        or len(content) < _TableFile.HEADER
    ):
        return None
    channels, frames, resolution = content[4], content[6], content[15]
    nodes = _TableFile.NODES
    sizes = (4 * frames, 4 * frames, 4 * channels, 4 * channels, nodes * channels, nodes * channels)
    if channels != _TableFile.CHANNELS or not 0 < frames <= 8 or not resolution:
        return None
    if len(content) != _TableFile.HEADER + sum(sizes) + _TableFile.SIGNATURE:
        return None
    cuts = np.cumsum((_TableFile.HEADER, *sizes))
    parts = [content[a:b] for a, b in pairwise(cuts)]
    start = np.frombuffer(parts[0], "<u4").astype(np.int64) * resolution
    azimuth, elevation = (np.frombuffer(p, "<i4").astype(np.int64) * resolution for p in parts[2:4])
    corrections = [
        np.frombuffer(p, np.int8).reshape(channels, nodes).astype(np.int64) * resolution * 256
        for p in parts[4:6]
    ]
    circle = _TableFile.CIRCLE
    is_sound = (np.diff(start) > 0).all() and start[-1] < circle
    is_sound &= np.abs(elevation).max() < circle // 4 and np.abs(azimuth).max() < circle
    return MirrorTable(start, azimuth, elevation, *corrections) if is_sound else None


def mirrors_of(companions: Sequence[Companion]) -> tuple[str, MirrorTable] | None:
    """The first table among some files, with its name."""
    for companion in companions:
        mirrors = read_mirrors(companion)
        if mirrors is not None:
            return companion.name, mirrors
    return None
