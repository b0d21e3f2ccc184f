"""What the accelerometer says of the motion while the LiDARs hardly observe a direction.

The points say nothing of the motion along such a direction, or something wrong; but before and
after it they observed the body, or it stood. Between both the accelerometer carries the speed: a
Kalman smoother over velocity ``v``, bias ``b`` and gravity ``g``, with the specific force ``f``,

    v(k+1) = v(k) + ∫ (R (f - b) + g) ds
    p(k+1) = p(k) + v(k) dt + ∬ (R (f - b) + g) ds²

measures the shift of each multiframe. Along its weak direction ``d`` the points may say something
wrong, the more the weaker they observe it (``σ = weak_sd_m``, the larger one of both ends), and
the same for about a second:

    z(k) = p(k+1) - p(k) + dt s(k) d dᵀ u(k) + noise,   s = ½ v₀ (σ / σ₀)²
    u(k+1) = ρ u(k) + noise of 1 - ρ²,   ρ = exp(-dt / τ) min(s(k), s(k+1)) / max(s(k), s(k+1))

with the speed ``v₀`` of a carrier and the ``σ₀`` of `WEAK_MOTION`. Two shifts share at most the
smaller one of their errors. Where nothing observes ``d`` that leaves its shift out: what the
odometry makes of it does not count, so both may be compared.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import SE3, TRANSLATION, Array
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.model.tuning import OBSERVATION
from recon4.registration.imu_saturation import saturated_samples
from recon4.registration.motion import imu_in_body
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_imu import FELT
from recon4.registration.tuning_motion import WEAK_MOTION
from recon4.registration.walk_steps import WalkSteps
from recon4.units import STANDARD_GRAVITY_M_S2

_V, _PULLED = slice(0, 3), slice(9, 12)


@dataclass(frozen=True, slots=True, eq=False)
class FeltMotion:
    """Shift from the multiframe before to each as the accelerometer carries it, in odom axes."""

    shift_m: Array
    """(N - 1, 3)."""
    cov: Array
    """[m²], (N - 1, 3, 3)."""
    pull_m: Array
    """How wrong the shifts of the odometry are along the weak direction, as far as the
    accelerometer shows it: ``dt s d dᵀ u`` in odom axes [m], (N - 1, 3) …"""
    pull_sd_m: Array
    """… and the standard deviation of what it does not show [m], (N - 1,)."""
    per_second: int
    """Multiframes in a second."""

    def sd_m(self, shift_m: Array, direction: Array) -> Array:
        """How wrong other shifts (N - 1, 3) may be along directions (N - 1, 3) [m], (N - 1,).

        The uncertainty of the felt shift, and how far the other one is from it, over a second: the
        noise of single poses does not add up.
        """
        apart = uniform_filter1d(shift_m - self.shift_m, self.per_second, axis=0, mode="nearest")
        apart_m = np.einsum("ni,ni->n", apart, direction)
        variance = np.einsum("ni,nij,nj->n", direction, self.cov, direction)
        return np.sqrt(np.maximum(variance, 0.0) + apart_m**2)


@dataclass(frozen=True, slots=True, eq=False)
class Felt:
    """Integrals over the time from each multiframe to the next, in odom axes."""

    dt_s: Array
    """(K,)."""
    speed: Array
    """∫ R f and ∫ R, side by side, (K, 3, 4)."""
    shift: Array
    """∬ R f and ∬ R, side by side, (K, 3, 4)."""
    missing: NDArray[np.bool_]
    """Whether samples are missing or saturated, (K,)."""


def felt_motion(
    steps: WalkSteps,
    trajectory: Trajectory,
    imu: ImuSamples,
    *,
    rig: Rig,
    accel_noise: float,
) -> FeltMotion | None:
    """Smooth the motion of all multiframes; None without an accelerometer.

    Args:
        steps: Of all multiframes, two or more.
        trajectory: ``T_odom_body``, dense.
        imu: As it was used.
        rig: Where the IMU is.
        accel_noise: Noise density of the specific force [m/s²/√Hz].
    """
    felt = integrate_felt(steps.column("t_mid_ns"), trajectory, imu, rig=rig)
    if felt is None:
        return None
    return _smoothed(felt, _measured(steps), accel_noise)


def moved_back(
    steps: WalkSteps, trajectory: Trajectory, felt: FeltMotion
) -> tuple[Trajectory, FeltMotion]:
    """Move all heights back by what the points pull them along by, ``Σ dt s eᶻ dᵀu d``.

    Between two multiframes in proportion to the time. Sideways an accelerometer knows less: a tilt
    of the body, which is taken for known, pushes there by a part of gravity.

    Args:
        steps: Of all multiframes; they are moved, too.
        trajectory: ``T_odom_body``, dense.
        felt: What the accelerometer says of both.

    Returns:
        The dense poses that are left, and what is felt of them: nothing known pulls their heights.
    """
    at_ns, start_ns = steps.column("t_mid_ns"), trajectory.t_ns[0]
    along_m = np.concatenate([[0.0], np.cumsum(felt.pull_m[:, 2])])

    def moved(T: SE3, t_ns: Times) -> SE3:
        t_m = T.t.copy()
        t_m[:, 2] -= np.interp(t_ns - start_ns, at_ns - start_ns, along_m)
        return SE3(T.R, t_m)

    T = moved(steps.T_odom_body, at_ns)
    steps.update(
        (k, replace(step, T_odom_body=T[k], T_dense=moved(step.T_dense, step.t_ns)))
        for k, step in enumerate(steps)
    )
    poses = Trajectory(trajectory.t_ns, moved(trajectory.T_a_b, trajectory.t_ns))
    return poses, replace(felt, pull_m=felt.pull_m * [1.0, 1.0, 0.0])


def carried(steps: WalkSteps, felt: FeltMotion) -> Iterator[tuple[int, OdometryStep]]:
    """What the accelerometer says of motions that the points hardly observe: steps by number.

    Their covariance is at most what it was: where the accelerometer contradicts the odometry, or
    knows no better after a long time, it stays. A step whose points observe all directions keeps
    its covariance, and states the part of it that they pull it along by: a larger step undoes what
    the weak ones before it state.
    """
    shifts, weak = np.diff(steps.T_odom_body.t, axis=0), are_carried(steps)[1:]
    directions = steps.column("weak_direction")[1:]
    sd_m = felt.sd_m(shifts, np.where(weak[:, None], directions, 0.0)).tolist()
    pulled_sd_m = np.hypot(felt.pull_sd_m, np.linalg.norm(felt.pull_m, axis=1))
    pulled = ~weak & (pulled_sd_m > 0.0) & np.isfinite(directions).all(axis=1)
    for row in np.flatnonzero(weak | pulled).tolist():
        step = steps[row + 1]
        if weak[row]:
            yield row + 1, _with_weak_motion(step, max(sd_m[row], FELT.least_sd_m))
        else:
            yield row + 1, _pulled(step, float(pulled_sd_m[row]))


def are_carried(steps: WalkSteps) -> NDArray[np.bool_]:
    """Of which multiframes the points hardly observe the motion along a direction, (N,)."""
    known = np.isfinite(steps.column("weak_direction")).all(axis=1)
    for name in ("lost", "bridged", "stationary"):
        known &= ~steps.column(name)
    return known & ~(steps.column("weak_sd_m") < OBSERVATION.observed_sd_m)


def _with_weak_motion(step: OdometryStep, sd_m: float) -> OdometryStep:
    along = step.weak_direction
    before_m = _sd_along(step, along)
    ratio = min(sd_m / max(before_m, FELT.least_sd_m), 1.0)
    scale = np.eye(6)
    scale[TRANSLATION, TRANSLATION] -= (1.0 - ratio) * np.outer(along, along)
    cov = scale @ step.motion_cov @ scale
    return replace(step, motion_cov=cov, weak_motion_sd_m=ratio * before_m)


def _pulled(step: OdometryStep, sd_m: float) -> OdometryStep:
    return replace(step, weak_motion_sd_m=min(sd_m, _sd_along(step, step.weak_direction)))


def _sd_along(step: OdometryStep, along: Array) -> float:
    return float(np.sqrt(along @ step.motion_cov[TRANSLATION, TRANSLATION] @ along))


def integrate_felt(
    t_ns: Times, trajectory: Trajectory, imu: ImuSamples, *, rig: Rig
) -> Felt | None:
    """Integrals from each multiframe to the next; None without an accelerometer.

    Args:
        t_ns: Times of multiframes [ns], (K + 1,).
        trajectory: ``T_odom_body``.
        imu: Its samples.
        rig: Where the IMU is.
    """
    _, force = imu_in_body(imu, rig)
    if not np.isfinite(force).all():
        return None
    # Hours have millions of samples: some minutes at a time.
    parts = [
        _integrated(t_ns[k : k + FELT.at_once + 1], trajectory, imu.t_ns, force=force)
        for k in range(0, len(t_ns) - 1, FELT.at_once)
    ]
    dt_s, speed, shift = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    return Felt(dt_s, speed, shift, _missing(t_ns, imu))


def _integrated(
    t_ns: Times, trajectory: Trajectory, sample_ns: Times, *, force: Array
) -> tuple[Array, Array, Array]:
    """Times, speeds and shifts of `Felt` from each of some multiframes to the next."""
    inside = (sample_ns >= t_ns[0]) & (sample_ns <= t_ns[-1])
    grid = distinct(np.concatenate([sample_ns[inside], t_ns]))
    s = 1e-9 * (grid - grid[0])
    sample_s = 1e-9 * (sample_ns - grid[0])
    f = np.stack([np.interp(s, sample_s, force[:, axis]) for axis in range(3)], axis=1)
    R = trajectory.at(grid, slack_ns=FELT.longest_gap_ns).R
    both = np.concatenate([(R @ f[:, :, None]), R], axis=2).reshape(len(grid), 12)
    h = np.diff(s)[:, None]
    once = np.cumsum(h * (both[1:] + both[:-1]) / 2, axis=0)
    once = np.concatenate([np.zeros((1, 12)), once])
    twice = np.cumsum(h * once[:-1] + h**2 * (2 * both[:-1] + both[1:]) / 6, axis=0)
    twice = np.concatenate([np.zeros((1, 12)), twice])
    rows = np.searchsorted(grid, t_ns)
    dt_s = np.diff(s[rows])
    speed = np.diff(once[rows], axis=0)
    shift = np.diff(twice[rows], axis=0) - once[rows[:-1]] * dt_s[:, None]
    return dt_s, speed.reshape(-1, 3, 4), shift.reshape(-1, 3, 4)


def _missing(t_ns: Times, imu: ImuSamples) -> NDArray[np.bool_]:
    """Whether the samples from each multiframe to the next have a gap or are saturated, (K,)."""
    gaps = np.diff(imu.t_ns) > FELT.longest_gap_ns
    bad = np.concatenate([[0], np.cumsum(np.append(gaps, False) | saturated_samples(imu)[:, 1])])
    first = np.maximum(np.searchsorted(imu.t_ns, t_ns) - 1, 0)
    last = np.searchsorted(imu.t_ns, t_ns)
    outside = (t_ns < imu.t_ns[0] - FELT.longest_gap_ns) | (
        t_ns > imu.t_ns[-1] + FELT.longest_gap_ns
    )
    return np.asarray((bad[last[1:]] > bad[first[:-1]]) | outside[1:] | outside[:-1])


@dataclass(frozen=True, slots=True, eq=False)
class _MeasuredShifts:
    """What the odometry measures of the shift to each multiframe but the first."""

    shift_m: Array
    """(K, 3)."""
    cov: Array
    """Of errors that no other shift shares [m²], (K, 3, 3)."""
    pulled_m: Array
    """Standard deviation of those that neighbors share, along one direction, (K, 3)."""
    still: NDArray[np.bool_]
    """Whether the body stands, (K,)."""

    def shared(self, k: int, dt_s: float) -> float:
        """Correlation of the errors ``pulled_m`` of a shift and of the next: 0..1.

        What both share is at most the smaller one.
        """
        if k + 1 == len(self.pulled_m):
            return 0.0
        smaller, larger = sorted(np.linalg.norm(self.pulled_m[k : k + 2], axis=1).tolist())
        return float(np.exp(-dt_s / FELT.pulled_s)) * smaller / larger if larger else 0.0


def _measured(steps: WalkSteps) -> _MeasuredShifts:
    shifts_m, along = np.diff(steps.T_odom_body.t, axis=0), steps.column("weak_direction")
    lost, still, piece = (steps.column(name) for name in ("lost", "stationary", "piece"))
    finite = np.asarray(np.isfinite(along).all(axis=1))
    unknown = lost[1:] | lost[:-1] | steps.column("bridged")[1:] | (piece[1:] != piece[:-1])
    unknown |= ~finite[1:]
    sd_m = np.where(unknown, FELT.unknown_m, FELT.shift_sd_m)
    covs = sd_m[:, None, None] ** 2 * np.eye(3)
    pulled_m = _pulled_m(steps, finite)
    pulled_m[unknown | still[1:]] = 0.0
    return _MeasuredShifts(shifts_m, covs, pulled_m, still[1:] & still[:-1])


def _pulled_m(steps: WalkSteps, finite: NDArray[np.bool_]) -> Array:
    """Errors of shifts by what the points say wrongly of a weak direction [m], (K, 3).

    A shift is observed as well as the worse one of the poses at its ends: where a direction is
    observed again, it undoes what was wrong before.
    """
    weak_sd_m, along = steps.column("weak_sd_m"), steps.column("weak_direction")
    dt_s = 1e-9 * np.diff(steps.column("t_mid_ns"))
    rows = np.arange(1, len(steps))
    rows -= (weak_sd_m[:-1] > weak_sd_m[1:]) & finite[:-1]
    speed_m_s = 0.5 * WEAK_MOTION.speed_m_s * (weak_sd_m[rows] / WEAK_MOTION.weak_sd_m) ** 2
    return np.asarray(np.minimum(speed_m_s * dt_s, FELT.unknown_m)[:, None] * along[rows])


def _smoothed(felt: Felt, measured: _MeasuredShifts, accel_noise: float) -> FeltMotion:
    """Rauch, Tung and Striebel's smoother.

    The state is velocity, bias, gravity, and what pulls the measured shifts along, (12,).
    """
    x, P = np.zeros(12), np.diag(np.repeat([*FELT.first_sd, 1.0], 3) ** 2)
    x[8] = -STANDARD_GRAVITY_M_S2
    n = len(felt.dt_s)
    states, covs_of = np.empty((n, 12)), np.empty((n, 12, 12))
    for k in range(n):
        F, Q = _transition(felt, measured, k, accel_noise=accel_noise)
        H, z = _shift_by_state(felt, k), measured.shift_m[k] - felt.shift[k, :, 0]
        H[:, _PULLED] = _along(measured.pulled_m[k])
        x, P = _updated(x, P, H, z=z, R=measured.cov[k])
        if measured.still[k]:
            x, P = _updated(x, P, np.eye(3, 12), z=np.zeros(3), R=FELT.at_rest_m_s**2 * np.eye(3))
        states[k], covs_of[k] = x, P
        x, P = _ahead(felt, k, x, F=F), F @ P @ F.T + Q
    shifts_m, covs = np.zeros((n, 3)), np.zeros((n, 3, 3))
    pull_m, pull_sd_m = np.zeros((n, 3)), np.zeros(n)
    for k in range(n - 1, -1, -1):
        F, Q = _transition(felt, measured, k, accel_noise=accel_noise)
        known = states[k], covs_of[k]
        ahead = F @ known[1] @ F.T + Q
        gain = np.linalg.solve(ahead, F @ known[1]).T
        x = known[0] + gain @ (x - _ahead(felt, k, known[0], F=F))
        P = known[1] + gain @ (P - ahead) @ gain.T
        H = _shift_by_state(felt, k)
        shifts_m[k], covs[k] = H @ x + felt.shift[k, :, 0], H @ P @ H.T
        pull = _along(measured.pulled_m[k])
        pull_m[k] = pull @ x[_PULLED]
        pull_sd_m[k] = np.sqrt(max(float(np.trace(pull @ P[_PULLED, _PULLED] @ pull.T)), 0.0))
    per_second = max(1, round(1.0 / float(np.median(felt.dt_s))))
    return FeltMotion(shifts_m, covs, pull_m, pull_sd_m, per_second)


def _along(pulled_m: Array) -> Array:
    """Matrix by which errors of 1 along each axis pull a shift along (3,), (3, 3)."""
    return np.outer(pulled_m, pulled_m) / max(float(np.linalg.norm(pulled_m)), 1e-12)


def _shift_by_state(felt: Felt, k: int) -> Array:
    dt_s = felt.dt_s[k]
    by_pull = np.zeros((3, 3))
    return np.hstack([dt_s * np.eye(3), -felt.shift[k, :, 1:], 0.5 * dt_s**2 * np.eye(3), by_pull])


def _ahead(felt: Felt, k: int, x: Array, *, F: Array) -> Array:
    """State at the next multiframe."""
    predicted = F @ x
    predicted[_V] += felt.speed[k, :, 0]
    return np.asarray(predicted)


def _transition(
    felt: Felt, measured: _MeasuredShifts, k: int, *, accel_noise: float
) -> tuple[Array, Array]:
    """Transition to the next multiframe, and the covariance that it adds."""
    dt_s = float(felt.dt_s[k])
    F, shared = np.eye(12), measured.shared(k, dt_s)
    F[_V, 3:9] = np.hstack([-felt.speed[k, :, 1:], dt_s * np.eye(3)])
    F[_PULLED, _PULLED] *= shared
    speed = accel_noise**2 * dt_s + (FELT.unfelt_m_s**2 if felt.missing[k] else 0.0)
    noise = [speed, FELT.bias_walk**2 * dt_s, 0.0, 1.0 - shared**2]
    return F, np.diag(np.repeat(noise, 3))


def _updated(x: Array, P: Array, H: Array, *, z: Array, R: Array) -> tuple[Array, Array]:
    """State and covariance with a measurement ``z = H x``, in Joseph's form."""
    gain = np.linalg.solve(H @ P @ H.T + R, H @ P).T
    left = np.eye(len(x)) - gain @ H
    return x + gain @ (z - H @ x), left @ P @ left.T + gain @ R @ gain.T
