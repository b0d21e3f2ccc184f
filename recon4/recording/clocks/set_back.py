"""Clouds whose clock went back while they were recorded, by how many come within a time.

A bag is read in the order of its times of recording. Where these went back with the stamps, clouds
from before and after lie between each other, and a sensor would have measured more often:

    stamps    0   100   200   220   320   420    [ms]: the clock went back by 80 ms
"""

from __future__ import annotations

from collections import deque

import numpy as np

from recon4.recording.clocks.tuning import SET_BACK


class SetBack:
    """Starts of the last clouds of one sensor."""

    def __init__(self) -> None:
        self._starts_ns: deque[int] = deque(maxlen=2 * SET_BACK.around + SET_BACK.between + 1)

    def back_ns(self, start_ns: int) -> int:
        """How far the clock went back some clouds ago [ns]; 0 = it did not, or is not sure.

        Clouds before and after are even, so none merely came late, and none is missing.

        Args:
            start_ns: Time of the first point of the next cloud [ns].
        """
        self._starts_ns.append(start_ns)
        if len(self._starts_ns) < (self._starts_ns.maxlen or 0):
            return 0
        steps = np.diff(np.array(self._starts_ns))
        around = SET_BACK.around
        period_ns = float(np.median(steps[:around]))
        off = np.abs(steps - period_ns) > SET_BACK.even * period_ns
        if not off[around] or off[:around].any() or off[-around:].any():
            return 0
        back_ns = len(steps) * period_ns - float(steps.sum())
        return round(back_ns) if back_ns > SET_BACK.least * period_ns else 0
