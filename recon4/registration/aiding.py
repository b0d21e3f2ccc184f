"""GNSS aiding: position and heading of GNSS/INS as a weak measurement of odometry, outdoors.

On an open field the LiDAR does not observe the horizontal position. Fixes every tenth of a second
keep odometry within decimeters there. Where the LiDAR observes the motion they have little weight.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from recon4.geometry.se3 import SE3, Array, skew, so3_log
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.tuning_motion import AIDING


@dataclass(frozen=True, slots=True, eq=False)
class GnssAiding:
    """Antenna positions and attitudes in a local frame: x east, y north, z up."""

    t_ns: Times
    """Times of the fixes on the rig's clock [ns], strictly increasing, (N,)."""
    p_enu: Array
    """Antenna positions [m], (N, 3)."""
    sd_m: Array
    """Standard deviation of each position, per axis [m], (N, 3)."""
    R_enu_body: Array
    """Attitudes, (N, 3, 3)."""
    attitude_sd_rad: float
    """Standard deviation of the attitudes [rad]."""
    p_body_antenna: Array
    """Lever arm [m], (3,)."""

    def pose(self, t_ns: int) -> SE3 | None:
        """``T_enu_body`` at a time; None without fixes before and after it."""
        found = self._around(t_ns)
        if found is None:
            return None
        row, s = found
        near = row + (s > 0.5)
        R = self.R_enu_body[near]
        return SE3(R, self._antenna(row, s) - R @ self.p_body_antenna)

    def runs(self) -> list[GnssAiding]:
        """The fixes between outages over which no motion is predicted from one to the other."""
        ends = np.flatnonzero(np.diff(self.t_ns) > AIDING.outage_ns) + 1
        return [self._take(slice(a, b)) for a, b in pairwise([0, *ends.tolist(), len(self.t_ns)])]

    def seen_from(self, T_odom_enu: SE3) -> GnssAiding:
        """The same fixes in the frame of an odometry."""
        return replace(
            self, p_enu=T_odom_enu @ self.p_enu, R_enu_body=T_odom_enu.R @ self.R_enu_body
        )

    def _take(self, rows: slice) -> GnssAiding:
        return replace(
            self,
            t_ns=self.t_ns[rows],
            p_enu=self.p_enu[rows],
            sd_m=self.sd_m[rows],
            R_enu_body=self.R_enu_body[rows],
        )

    def first(self, t_ns: int) -> tuple[int, SE3] | None:
        """When the fixes place an odometry that begins at a time [ns], and ``T_enu_body`` then.

        None = too late: it begins in a frame of its own.
        """
        at_ns = max(t_ns, int(self.t_ns[0]))
        T_enu_body = self.pose(at_ns)
        return (
            None if T_enu_body is None or at_ns > t_ns + AIDING.outage_ns else (at_ns, T_enu_body)
        )

    def velocity(self, t_ns: int) -> Array | None:
        """Mean velocity right after a time [m/s], (3,); None without fixes."""
        span_ns = AIDING.max_gap_ns
        ends = self.pose(t_ns), self.pose(t_ns + span_ns)
        if ends[0] is None or ends[1] is None:
            return None
        return np.asarray((ends[1].t - ends[0].t) / (1e-9 * span_ns))

    def pull(self, T_enu_body: SE3, t_ns: int) -> tuple[Array, Array]:
        """Information (6, 6) and gradient (6,) of a left correction about the body's origin.

        Cauchy weights limit the influence of an outlier. The heading has one, too: with the clock
        of the receiver 50 ms off, it is wrong by 6° in a turn.
        """
        H, g = np.zeros((6, 6)), np.zeros(6)
        found = self._around(t_ns)
        if found is None:
            return H, g
        row, s = found
        arm = T_enu_body.R @ self.p_body_antenna
        J = np.hstack([-skew(arm), np.eye(3)])
        r = T_enu_body.t + arm - self._antenna(row, s)
        z = r / self.sd_m[row]
        W = np.diag(_cauchy(float(z @ z)) / self.sd_m[row] ** 2)
        H += J.T @ W @ J
        g += J.T @ W @ r
        # The heading only: roll and pitch come from gravity.
        turn = so3_log(T_enu_body.R @ self.R_enu_body[row + (s > 0.5)].T)[2]
        weight = _cauchy((turn / self.attitude_sd_rad) ** 2) / self.attitude_sd_rad**2
        H[2, 2] += weight
        g[2] += weight * turn
        return H, g

    @property
    def trajectory(self) -> Trajectory:
        """``T_enu_body`` by the fixes alone, which is no use between fixes far apart."""
        p = self.p_enu - self.R_enu_body @ self.p_body_antenna
        return Trajectory(self.t_ns, SE3(self.R_enu_body, p))

    def covers(self, first_ns: int, last_ns: int) -> bool:
        """Whether there are fixes at both of two times that are near each other."""
        return self._around(first_ns) is not None and self._around(last_ns) is not None

    def rejected_ratio(self, trajectory: Trajectory) -> float:
        """Ratio of the fixes that an aided trajectory contradicts, 0..1.

        Only those of the run in whose frame it begins: it meets others where it is.
        """
        run = next((run for run in self.runs() if run.first(int(trajectory.t_ns[0]))), None)
        if run is None:
            return 0.0
        inside = (run.t_ns >= trajectory.t_ns[0]) & (run.t_ns <= trajectory.t_ns[-1])
        if not inside.any():
            return 0.0
        T = trajectory.at(run.t_ns[inside])
        z = (T.t + T.R @ run.p_body_antenna - run.p_enu[inside]) / run.sd_m[inside]
        return float(np.mean((z**2).sum(axis=1) > AIDING.outlier_sd**2))

    def agrees(self, T_enu_body: SE3, t_ns: int) -> bool:
        """Whether the antenna is at a time where the fixes say; False without them."""
        found = self._around(t_ns)
        if found is None:
            return False
        row, s = found
        z = (T_enu_body @ self.p_body_antenna - self._antenna(row, s)) / self.sd_m[row]
        return float(np.linalg.norm(z)) < AIDING.outlier_sd

    def _antenna(self, row: int, s: float) -> Array:
        """Position of the antenna between a fix and the next one, (3,)."""
        return (1.0 - s) * self.p_enu[row] + s * self.p_enu[row + 1]

    def _around(self, t_ns: int) -> tuple[int, float] | None:
        if not self.t_ns[0] <= t_ns <= self.t_ns[-1]:
            return None
        right = max(int(np.searchsorted(self.t_ns, t_ns)), 1)
        gap_ns = int(self.t_ns[right] - self.t_ns[right - 1])
        if gap_ns > AIDING.max_gap_ns:
            return None
        return right - 1, (t_ns - int(self.t_ns[right - 1])) / gap_ns


def _cauchy(z2: float) -> float:
    """Weight of a squared residual in standard deviations."""
    return 1.0 / (1.0 + z2 / AIDING.outlier_sd**2)
