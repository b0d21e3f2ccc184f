"""Line scans of a profiler: when each was measured, and where its head pointed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times
from recon4.model.tuning import SWEEPS


@dataclass(frozen=True, slots=True, eq=False)
class LineScans:
    """One row per line scan; the points of a line are those measured from its time on.

    The points themselves are in the multiframes, in the frame of the profiler, which does not turn
    with the head. Points, not shots, are counted: their number and their step are found in the
    data (requirements A1, L-HW).
    """

    t_ns: Times
    """Time of the first shot [ns], strictly increasing, (L,)."""
    head_rad: Array
    """Angle of the head at that time, continuous over a full revolution [rad], (L,)."""
    points: NDArray[np.int64]
    """Number of returns, (L,)."""

    def __len__(self) -> int:
        return len(self.t_ns)

    def sweeps(self) -> NDArray[np.intp]:
        """First line of each sweep, and the number of lines at the end, (T + 1,).

        A sweep ends where the head reverses, or after a full revolution in one direction.
        """
        count = len(self)
        if count <= 2 * SWEEPS.wide_lines:
            return np.array([0, count], np.intp)
        ends = [0]
        way = np.sign(self.head_rad[SWEEPS.wide_lines :] - self.head_rad[: -SWEEPS.wide_lines])
        start_rad, heading = self.head_rad[0], way[0]
        for line in range(1, len(way)):
            turned = abs(self.head_rad[line] - start_rad) >= 2.0 * np.pi - 1e-6
            reversed_ = way[line] != 0 and way[line] != heading
            if turned or reversed_:
                # The reversal lies in the middle of the lines that were compared.
                at = line + (SWEEPS.wide_lines // 2 if reversed_ else 0)
                ends.append(at)
                start_rad, heading = self.head_rad[at], way[line] or heading
        return _without_short(np.array([*ends, count], np.intp))


def _without_short(ends: NDArray[np.intp]) -> NDArray[np.intp]:
    """Sweeps joined to the one before where they are far shorter than usual."""
    least = SWEEPS.min_part * np.median(np.diff(ends))
    kept = [int(ends[0])]
    for end in ends[1:-1]:
        if end - kept[-1] >= least:
            kept.append(int(end))
    if len(kept) > 1 and ends[-1] - kept[-1] < least:
        kept.pop()
    return np.array([*kept, int(ends[-1])], np.intp)
