"""Rotation rate of a sensor, from the directions in its packets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.units import SECOND_NS


@dataclass(slots=True)
class Rotation:
    """Measures how fast a sensor spins, from packets that follow each other."""

    turned_cdeg: int = 0
    seconds: float = 0.0
    _last: tuple[int, int] = (0, -1)

    def push(self, t_ns: Times, azimuth_cdeg: NDArray[np.int64], packet_s: float) -> None:
        """Add the turns between packets without a gap."""
        if not len(t_ns):
            return
        azimuth = azimuth_cdeg
        if self._last[1] >= 0:
            t_ns, azimuth = np.append(self._last[0], t_ns), np.append(self._last[1], azimuth)
        self._last = int(t_ns[-1]), int(azimuth[-1])
        step_s = np.diff(t_ns) / SECOND_NS
        joined = step_s < 1.5 * packet_s
        self.seconds += float(step_s[joined].sum())
        self.turned_cdeg += int((np.diff(azimuth) % 36000)[joined].sum())

    @property
    def hz(self) -> float:
        """Revolutions a second; NaN before two packets have followed each other."""
        return self.turned_cdeg / 36000 / self.seconds if self.seconds > 0 else float("nan")
