"""Mount and clock of one sensor against another from their two trajectories of one walk.

Each sensor was tracked by itself, in a world of its own. Their motions over the same time are the
same motion seen from two places (hand-eye): ``A X = X B`` with ``A`` the motion of sensor a, ``B``
that of sensor b and ``X = T_a_b``. The clock of b runs at another offset and rate:
``t_a = t_b + offset + rate (t_b - t_0)``.

1. Offset: the lengths of rotation vectors do not depend on the mount. Those of both sensors over
   windows of equal duration are correlated over all shifts.
2. Rotation of the mount: the rotation vectors themselves, aligned by Kabsch; a shift that is wrong
   does not align.
3. All eight unknowns by robust least squares over motions of several seconds; a further round
   without the motions that contradict the rest.

What the walk does not show (the position along an axis about which alone the body turns) has a
large standard deviation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, least_squares

from recon4.calibration.tuning_methods import TRAJECTORY_PAIR, TrajectoryPairTuning
from recon4.errors import CalibrationError
from recon4.geometry.se3 import SE3, Array, align_points, so3_exp, so3_log
from recon4.locales.coded import CodedText
from recon4.model.trajectory import Times, Trajectory

Flags = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class TrajectoryPair:
    """How sensor b is mounted in sensor a, and how its clock runs."""

    T_a_b: SE3
    offset_s: float
    """Added to times of b at the middle of the walk to get times of a [s]."""
    rate: float
    """By how much the clock of b is slow: seconds to add a second."""
    to_middle_s: float
    """From the first pose of b to the middle of the walk [s]."""
    sd_rad: Array
    """Standard deviation of the rotation about the axes of a [rad], (3,)."""
    sd_m: Array
    """Of the position along the axes of a [m], (3,)."""
    sd_offset_s: float
    sd_rate: float
    residual_rad: Array
    """How far each motion of b, moved by the mount, is from that of a [rad], (N,)."""
    residual_m: Array
    """Likewise the translation [m], (N,)."""
    used: Flags
    """Motions that agree with the rest, (N,)."""

    @property
    def clock(self) -> tuple[float, float]:
        """Offset at the first pose of b [s] and rate [s/s] that a rig file has.

        A rate that is not different from 0 is none: then the offset is that at the middle.
        """
        if abs(self.rate) <= TRAJECTORY_PAIR.rate_sigmas * self.sd_rate:
            return self.offset_s, 0.0
        return self.offset_s - self.rate * self.to_middle_s, self.rate

    @property
    def report_lines(self) -> tuple[str, ...]:
        """What the trajectories show, for the terminal."""
        turn, shift = self.residual_rad[self.used], 1e3 * self.residual_m[self.used]
        x, y, z = 1e3 * self.sd_m
        return (
            CodedText(
                "motions-agree",
                share=float(self.used.mean()),
                motions=len(self.used),
                turn_rad=float(np.median(turn)),
                shift_mm=float(np.median(shift)),
            ),
            CodedText(
                "mount-of-trajectories", sd_rad=float(self.sd_rad.max()), x_mm=x, y_mm=y, z_mm=z
            ),
            CodedText(
                "clock-of-trajectories",
                offset_ms=1e3 * self.offset_s,
                sd_ms=1e3 * self.sd_offset_s,
                rate_us=1e6 * self.rate,
                sd_us=1e6 * self.sd_rate,
            ),
        )


def align_trajectories(
    a: Trajectory, b: Trajectory, *, settings: TrajectoryPairTuning = TRAJECTORY_PAIR
) -> TrajectoryPair:
    """Estimate mount and clock of sensor b from two trajectories of one walk.

    Args:
        a: Poses of sensor a in a world of its own.
        b: Poses of sensor b in another.
        settings: Windows and limits.

    Raises:
        CalibrationError: If they cover less than `shortest_s` together, turn too little, or do not
            show the same motion.
    """
    for name, one in (("first", a), ("second", b)):
        seconds = (one.t_ns[-1] - one.t_ns[0]) / 1e9 if len(one) > 1 else 0.0
        if seconds < settings.shortest_s:
            raise CalibrationError(
                CodedText(
                    "trajectory-short",
                    name=name,
                    shortest_s=settings.shortest_s,
                    seconds=float(seconds),
                )
            )
    offset_s = _coarse_offset_s(a, b, settings)
    problem = _Problem(a, b, offset_s, settings=settings)
    start = np.concatenate([so3_log(problem.rotation()), np.zeros(5)])
    found = problem.solve(start, np.ones(len(problem.t_b_ns), bool))
    used = problem.agreeing(found.x)
    if used.mean() < settings.least_agreeing:
        raise CalibrationError(
            CodedText(
                "trajectories-differ",
                used=f"{1 - used.mean():.0%}",
                most_deg=float(np.rad2deg(settings.most_rad)),
                most_m=settings.most_m,
            )
        )
    return problem.result(problem.solve(found.x, used), used)


def _coarse_offset_s(a: Trajectory, b: Trajectory, settings: TrajectoryPairTuning) -> float:
    """Shift of b's clock at which the lengths of rotation vectors correlate best [s]."""
    from scipy.signal import correlate  # slow to import

    turn_a, turn_b = (_turn_lengths(one, settings) for one in (a, b))
    both = correlate(turn_a - turn_a.mean(), turn_b - turn_b.mean())
    # Long shifts leave little in common: weigh the sum by what would be there by chance.
    common = correlate(np.ones_like(turn_a), np.ones_like(turn_b))
    seconds = common * settings.step_s
    score = np.where(seconds > settings.shortest_s / 2, both / np.sqrt(common), -np.inf)
    shift = int(np.argmax(score)) - (len(turn_b) - 1)
    return shift * settings.step_s + (int(a.t_ns[0]) - int(b.t_ns[0])) / 1e9


def _turn_lengths(one: Trajectory, settings: TrajectoryPairTuning) -> Array:
    """Length of the rotation over one window from each step on [rad]."""
    step_ns, window_ns = round(settings.step_s * 1e9), round(settings.turn_s * 1e9)
    t_ns = np.arange(one.t_ns[0], one.t_ns[-1] - window_ns, step_ns)
    T = one.at(t_ns).inverse() @ one.at(t_ns + window_ns)
    return np.asarray(T.angle())


class _Problem:
    """Motions of both sensors, and the residuals of ``A X = X B``."""

    def __init__(
        self, a: Trajectory, b: Trajectory, offset_s: float, *, settings: TrajectoryPairTuning
    ) -> None:
        """Choose the motions: they begin every step and last `motion_s`."""
        self._a, self._b, self._settings = a, b, settings
        self._offset_s = offset_s
        margin_ns = round(1e9 * settings.most_refined_s)
        shift_ns = round(1e9 * offset_s)
        first = max(int(b.t_ns[0]), int(a.t_ns[0]) - shift_ns + margin_ns)
        last = min(int(b.t_ns[-1]), int(a.t_ns[-1]) - shift_ns - margin_ns)
        self._motion_ns = round(1e9 * settings.motion_s)
        step_ns = round(1e9 * settings.step_s)
        self.t_b_ns: Times = np.arange(first, last - self._motion_ns, step_ns)
        if len(self.t_b_ns) * settings.step_s < settings.shortest_s / 2:
            raise CalibrationError(CodedText("trajectories-overlap"))
        self._middle_ns = (first + last) // 2
        self._half_s = (last - first) / 2e9
        self._B = self._motions(b, self.t_b_ns)

    def _motions(self, one: Trajectory, t_ns: Times) -> SE3:
        return one.at(t_ns).inverse() @ one.at(t_ns + self._motion_ns)

    def rotation(self) -> Array:
        """Rotation of the mount, which aligns the rotation vectors of the motions."""
        A = self._motions(self._a, self.t_b_ns + round(1e9 * self._offset_s))
        turn_a, turn_b = so3_log(A.R), so3_log(self._B.R)
        second = np.linalg.svd(turn_b, compute_uv=False)[1]
        turned = np.rad2deg(second / np.sqrt(len(turn_b)))
        if turned < self._settings.least_turn_deg:
            raise CalibrationError(
                CodedText(
                    "trajectory-one-axis", turned=float(turned), motion_s=self._settings.motion_s
                )
            )
        return align_points(turn_a, turn_b).R

    def _errors(self, x: Array) -> tuple[Array, Array]:
        """Rotation [rad] and translation [m] between ``A X`` and ``X B``, (N, 3) each.

        Args:
            x: Rotation vector and position of the mount, change of the offset at the middle [s],
                and at the end of the walk by the rate [s].
        """
        T_a_b = SE3(so3_exp(x[:3]), x[3:6])
        from_middle = (self.t_b_ns - self._middle_ns) / (1e9 * self._half_s)
        shift_s = self._offset_s + x[6] + x[7] * from_middle
        t_a_ns = self.t_b_ns + np.rint(1e9 * shift_s).astype(np.int64)
        A = self._motions(self._a, np.clip(t_a_ns, self._a.t_ns[0], self._a_last_ns))
        left, right = A @ T_a_b, T_a_b @ self._B
        return so3_log(np.swapaxes(right.R, -1, -2) @ left.R), left.t - right.t

    @property
    def _a_last_ns(self) -> int:
        return int(self._a.t_ns[-1]) - self._motion_ns

    def solve(self, start: Array, used: Flags) -> OptimizeResult:
        """Robust least squares over the motions that are used."""
        settings = self._settings
        limit = np.array([np.inf] * 6 + [settings.most_refined_s / 2] * 2)

        def weighted(x: Array) -> Array:
            turn, shift = self._errors(x)
            rows = [turn[used] / settings.sd_rad, shift[used] / settings.sd_m]
            return np.concatenate(rows, axis=1).ravel()

        steps = np.array([1e-4] * 6 + [2e-3, 2e-3])
        return least_squares(
            weighted,
            start,
            bounds=(-limit, limit),
            loss="soft_l1",
            diff_step=steps,
            x_scale="jac",
            max_nfev=settings.most_rounds,
        )

    def agreeing(self, x: Array) -> Flags:
        """Motions whose difference is within the limits, (N,)."""
        turn, shift = (np.linalg.norm(part, axis=1) for part in self._errors(x))
        return (turn < self._settings.most_rad) & (shift < self._settings.most_m)

    def result(self, found: OptimizeResult, used: Flags) -> TrajectoryPair:
        """The mount with its standard deviations, from the scatter of the residuals."""
        turn, shift = self._errors(found.x)
        weighted = np.concatenate(
            [turn[used] / self._settings.sd_rad, shift[used] / self._settings.sd_m], axis=1
        )
        # Motions overlap: only those that do not are independent.
        apart = self._motion_ns / 1e9 / self._settings.step_s
        variance = np.mean(weighted**2) * apart * np.linalg.pinv(found.jac.T @ found.jac)
        sd = np.sqrt(np.diag(variance))
        return TrajectoryPair(
            T_a_b=SE3(so3_exp(found.x[:3]), found.x[3:6]),
            offset_s=self._offset_s + float(found.x[6]),
            rate=float(found.x[7]) / self._half_s,
            to_middle_s=(self._middle_ns - int(self._b.t_ns[0])) / 1e9,
            sd_rad=sd[:3],
            sd_m=sd[3:6],
            sd_offset_s=float(sd[6]),
            sd_rate=float(sd[7]) / self._half_s,
            residual_rad=np.linalg.norm(turn, axis=1),
            residual_m=np.linalg.norm(shift, axis=1),
            used=used,
        )
