"""Times between the packets of a sensor: what is usual, and how many packets never arrived.

A sensor may be set to a field of view: it sends nothing while it looks elsewhere. Such a hole comes
once a revolution, at one azimuth, and is no loss.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.packets.tuning import HOLES


@dataclass(frozen=True, slots=True)
class _Hole:
    t_ns: int
    azimuth_cdeg: int
    """Of the last packet before it."""
    packets: int
    """How many fit into it."""

    def is_like(self, before: _Hole) -> bool:
        """Whether it begins where another one did, about a revolution before."""
        turn = abs((self.azimuth_cdeg - before.azimuth_cdeg + 18000) % 36000 - 18000)
        shortest, longest = HOLES.revolution_ns
        large = min(self.packets, before.packets) >= HOLES.least_packets
        return large and turn <= HOLES.same_cdeg and shortest < self.t_ns - before.t_ns < longest


@dataclass(slots=True)
class PacketHoles:
    """Counts missing packets of one sensor; push its packets in order of time."""

    _first_s: list[float] = field(default_factory=list)
    _last: tuple[int, int] | None = None
    """Time [ns] and azimuth [0.01°] of the last packet."""
    _reported: bool = False
    _open: list[_Hole] = field(default_factory=list)
    """Holes that are alike so far: losses, or outside the field of view."""
    _outside: _Hole | None = None
    """The last hole outside the field of view; None = the sensor looks all around."""

    def missing(self, t_ns: Times, azimuth_cdeg: NDArray[np.int64] | None, packet_s: float) -> int:
        """How many packets turned out to be missing, in pauses of less than a second.

        Args:
            t_ns: Times of packets [ns], (N,), rising, N > 0.
            azimuth_cdeg: Their first azimuths [0.01°], (N,); None = it does not spin, every hole
                is a loss.
            packet_s: Time between two packets of the model [s].
        """
        spins = azimuth_cdeg is not None
        azimuth_cdeg = np.zeros(len(t_ns), np.int64) if azimuth_cdeg is None else azimuth_cdeg
        if self._last is not None:
            t_ns = np.append(self._last[0], t_ns)
            azimuth_cdeg = np.append(self._last[1], azimuth_cdeg)
        self._last = int(t_ns[-1]), int(azimuth_cdeg[-1])
        steps_s = np.diff(t_ns) / 1e9
        if not self._reported:
            self._first_s.extend(steps_s[: HOLES.probed].tolist())
        holes = np.flatnonzero((steps_s > 1.5 * packet_s) & (steps_s < HOLES.longest_s))
        if not spins:
            return int(np.rint(steps_s[holes] / packet_s - 1.0).sum())
        return sum(
            self._lost_in(
                _Hole(int(t_ns[k]), int(azimuth_cdeg[k]), round(steps_s[k] / packet_s - 1))
            )
            for k in holes
        )

    def rest(self) -> int:
        """Missing packets not counted so far; call once, at the end."""
        lost = sum(hole.packets for hole in self._open)
        self._open = []
        return lost

    def usual_s(self) -> float:
        """Median of the first 100 or more steps [s], once; 0 before and after."""
        if self._reported or len(self._first_s) < HOLES.probed:
            return 0.0
        self._reported = True
        return float(np.median(self._first_s))

    def _lost_in(self, hole: _Hole) -> int:
        if self._outside is not None and hole.is_like(self._outside):
            more = hole.packets - self._outside.packets
            self._outside = _Hole(hole.t_ns, hole.azimuth_cdeg, self._outside.packets)
            return more if more > HOLES.same_packets else 0
        first = self._open[0] if self._open else hole
        alike = abs(hole.packets - first.packets) <= HOLES.same_packets
        goes_on = not self._open or (alike and hole.is_like(self._open[-1]))
        lost = 0 if goes_on else self.rest()
        self._open.append(hole)
        if len(self._open) >= HOLES.confirm:
            self._outside, self._open = hole, []
        return lost
