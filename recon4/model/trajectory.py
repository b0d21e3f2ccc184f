"""Trajectory: poses as a function of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.errors import OutOfRange
from recon4.geometry.se3 import SE3, interpolate, poses_by_blocks
from recon4.locales.coded import CodedText

Times = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Poses at strictly increasing times; between two of them lerp and SLERP (V Eq. 2.8).

    >>> walk = api.open_project("walk").trajectory
    >>> T_map_body = walk.at(walk.t_ns[:1] + 5_000_000)
    >>> T_map_body.t.shape, T_map_body.quat_xyzw().shape
    ((1, 3), (1, 4))
    """

    t_ns: Times
    """Absolute times [ns], strictly increasing, (N,)."""
    T_a_b: SE3
    """Poses of ``b`` (normally the body) in ``a`` (odom, map, …), a batch of N."""

    def __post_init__(self) -> None:
        assert len(self.t_ns) == len(self.T_a_b)
        assert np.all(np.diff(self.t_ns) > 0)

    def __len__(self) -> int:
        return len(self.t_ns)

    def __getitem__(self, rows: slice | NDArray[np.bool_] | NDArray[np.integer]) -> Trajectory:
        return Trajectory(self.t_ns[rows], self.T_a_b[rows])

    def at(self, t_ns: Times, *, slack_ns: int = 0) -> SE3:
        """Interpolated poses at any covered times.

        Args:
            t_ns: Times [ns], (M,).
            slack_ns: Largest extrapolation of the first or last motion outside the covered time.

        Raises:
            OutOfRange: If a time lies farther outside, or the trajectory is empty.
        """
        t = np.asarray(t_ns, dtype=np.int64)
        if len(self.t_ns) == 0:
            raise OutOfRange(CodedText("trajectory-empty"))
        if t.size and (t.min() < self.t_ns[0] - slack_ns or t.max() > self.t_ns[-1] + slack_ns):
            raise OutOfRange(
                CodedText(
                    "trajectory-outside",
                    from_s=float(t.min() / 1e9),
                    to_s=float(t.max() / 1e9),
                    begin_s=float(self.t_ns[0] / 1e9),
                    end_s=float(self.t_ns[-1] / 1e9),
                )
            )
        if len(self.t_ns) == 1:
            return self.T_a_b[np.zeros(t.shape, dtype=np.intp)]
        if t.ndim == 0:
            return self._between(t)
        return poses_by_blocks(lambda rows: self._between(t[rows]), len(t))

    def _between(self, t: Times) -> SE3:
        left = np.clip(np.searchsorted(self.t_ns, t, side="right") - 1, 0, len(self.t_ns) - 2)
        span = self.t_ns[left + 1] - self.t_ns[left]
        fraction = (t - self.t_ns[left]) / span
        return interpolate(self.T_a_b[left], self.T_a_b[left + 1], fraction)
