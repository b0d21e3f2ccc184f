"""The angle table of an AT128 that does not exist, and what it says of a direction."""

from __future__ import annotations

import numpy as np

from recon4.recording.packets.family import Companion

START = np.array([23.5, 143.0, 263.25])
"""Where its mirrors begin [°]."""
_CHANNEL = np.arange(128)
AZIMUTH_DEG = np.where(_CHANNEL % 2 == 0, -2.5, 0.75)
ELEVATION_DEG = 12.5 - 0.2 * _CHANNEL
_NODE = np.arange(180)
AZIMUTH_CORRECTION = (_CHANNEL[:, None] + _NODE) % 21 - 10
ELEVATION_CORRECTION = (_CHANNEL[:, None] + 2 * _NODE) % 15 - 7
"""[0.02°]."""


def mirror_table() -> Companion:
    """The file, with a resolution of 2."""
    fine = [np.rint(values * 12800).astype("<i4") for values in (START, AZIMUTH_DEG, ELEVATION_DEG)]
    ends = np.roll(fine[0], -1)
    corrections = (AZIMUTH_CORRECTION, ELEVATION_CORRECTION)
    parts = [fine[0], ends, fine[1], fine[2], *(c.astype(np.int8) for c in corrections)]
    head = bytes((0xEE, 0xFF, 1, 5, 128, 3, 3, *range(8), 2))
    content = head + b"".join(part.tobytes() for part in parts) + bytes(32)
    return Companion("AT128.dat", content)


def mirrored(drum: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Azimuth and elevation [rad] of all channels at azimuths of the drum [1/25600°]."""
    drum_deg = np.asarray(drum) % (36000 * 256) / 25600
    start_deg = START[np.searchsorted(START, drum_deg, side="right") - 1]
    nodes = np.arange(181) * 2.0
    corrections = [
        np.stack([np.interp(drum_deg, nodes, 0.02 * row[np.arange(181) % 180]) for row in rows], -1)
        for rows in (AZIMUTH_CORRECTION, ELEVATION_CORRECTION)
    ]
    along = 2 * ((drum_deg - start_deg) % 360)
    azimuth_deg = along[..., None] - AZIMUTH_DEG + corrections[0]
    return np.deg2rad(azimuth_deg), np.deg2rad(ELEVATION_DEG + corrections[1])
