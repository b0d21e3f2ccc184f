"""Decoded measurements of one LiDAR, before they are cut into multiframes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times


@dataclass(frozen=True, slots=True, eq=False)
class Shots:
    """A batch of returns of one sensor in firing order."""

    sensor: int
    """Row in ``Rig.sensors``."""
    t_ns: Times
    """Time of each shot on the rig's clock [ns], (N,).
    It decreases only where a clock was set back."""
    xyz: NDArray[np.float32]
    """Points in the frame of the sensor [m], (N, 3)."""
    intensity: NDArray[np.uint16]
    """Intensity as measured, (N,)."""
    ring: NDArray[np.uint8]
    """Beam, 0 = lowest elevation, (N,)."""
    echo: NDArray[np.uint8]
    """0 = only or strongest return, 1 = further return of the same shot, (N,)."""
    set_back: bool = False
    """Whether its clock was set back since the shots before: what is earlier does not overlap."""
    rotation_hz: float = math.nan
    """Revolutions a second as its packets say, from the first one on; NaN = they do not."""

    def __len__(self) -> int:
        return len(self.t_ns)

    def take(self, rows: NDArray[np.bool_] | slice) -> Shots:
        """Some of the shots, in their order."""
        return Shots(
            self.sensor,
            self.t_ns[rows],
            self.xyz[rows],
            self.intensity[rows],
            self.ring[rows],
            self.echo[rows],
        )
