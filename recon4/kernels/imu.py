"""Strapdown integration of an IMU, with the covariance of its error state."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray


class ErrorRows(NamedTuple):
    """First row of each quantity in the error state; slices: `recon4.registration.state_vector`."""

    rotation: int = 0
    position: int = 3
    velocity: int = 6
    gyro_bias: int = 9
    accel_bias: int = 12
    gravity: int = 15
    gyro_gain: int = 18
    """Error of the gyroscope's scale and axes, a (3, 3) matrix row by row. A state of 18 rows has
    neither this nor a clock."""
    clock: int = 27
    """Error of the clock of the IMU."""
    size: int = 28
    """All rows."""
    vector: int = 3
    """First row in the vector of a state (25,), which has no rotation."""


ROWS = ErrorRows()


class NoiseRows(NamedTuple):
    """Rows of the noise densities."""

    gyro: int = 0
    accel: int = 1
    gyro_bias_walk: int = 2
    accel_bias_walk: int = 3
    gain_walk: int = 4
    clock_walk: int = 5


NOISE = NoiseRows()


@njit(cache=True, nogil=True, error_model="numpy")
def rotation(w: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation matrix of a rotation vector [rad], (3,) -> (3, 3). Rodrigues' formula."""
    angle = np.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    if angle < 1e-9:
        a, b = 1.0, 0.5
    else:
        a, b = np.sin(angle) / angle, (1.0 - np.cos(angle)) / (angle * angle)
    out = np.empty((3, 3))
    xx, yy, zz = w[0] * w[0], w[1] * w[1], w[2] * w[2]
    out[0, 0] = 1.0 - b * (yy + zz)
    out[1, 1] = 1.0 - b * (xx + zz)
    out[2, 2] = 1.0 - b * (xx + yy)
    out[0, 1] = -a * w[2] + b * w[0] * w[1]
    out[1, 0] = a * w[2] + b * w[0] * w[1]
    out[0, 2] = a * w[1] + b * w[0] * w[2]
    out[2, 0] = -a * w[1] + b * w[0] * w[2]
    out[1, 2] = -a * w[0] + b * w[1] * w[2]
    out[2, 1] = a * w[0] + b * w[1] * w[2]
    return out


@njit(cache=True, nogil=True, error_model="numpy")
def _quantity(state: NDArray[np.float64], first: int) -> NDArray[np.float64]:
    """Three rows of the vector of a state, by their first row in the error state."""
    return state[first - ROWS.vector : first]


@njit(cache=True, nogil=True, error_model="numpy")
def _step_transition(
    half: NDArray[np.float64], f: NDArray[np.float64], dt: float, size: int
) -> NDArray[np.float64]:
    """Transition of the error state over one sample, without scale and clock of the IMU.

    Args:
        half: ``R_odom_body`` in the middle of the step, (3, 3).
        f: Specific force in the odometry frame [m/s²], (3,).
        dt: Length of the step [s].
        size: Rows of the error state N.

    Returns:
        (N, N).
    """
    R, p, v = ROWS.rotation, ROWS.position, ROWS.velocity
    bg, ba, g = ROWS.gyro_bias, ROWS.accel_bias, ROWS.gravity
    F = np.eye(size)
    F[v, R + 1], F[v, R + 2] = f[2] * dt, -f[1] * dt
    F[v + 1, R], F[v + 1, R + 2] = -f[2] * dt, f[0] * dt
    F[v + 2, R], F[v + 2, R + 1] = f[1] * dt, -f[0] * dt
    for i in range(3):
        F[p + i, v + i] = dt
        F[v + i, g + i] = dt
        F[p + i, g + i] = 0.5 * dt * dt
        for j in range(3):
            F[R + i, bg + j] = -half[i, j] * dt
            F[v + i, ba + j] = -half[i, j] * dt
            F[p + i, ba + j] = -0.5 * half[i, j] * dt * dt
            F[p + i, R + j] = 0.5 * dt * F[v + i, R + j]
    return F


@njit(cache=True, nogil=True, error_model="numpy")
def _add_calibration(
    F: NDArray[np.float64],
    half: NDArray[np.float64],
    gyro: NDArray[np.float64],
    more: NDArray[np.float64],
    dt: float,
) -> None:
    """Add what scale and clock of the IMU do over one sample to the transition, in place.

    Args:
        F: Transition of the error state, (28, 28).
        half: ``R_odom_body`` in the middle of the step, (3, 3).
        gyro: Mean angular rate over the step as measured [rad/s], (3,).
        more: What angular rate and specific force gain over the step, (6,).
        dt: Length of the step [s].
    """
    R, p, v, gain, clock = ROWS.rotation, ROWS.position, ROWS.velocity, ROWS.gyro_gain, ROWS.clock
    for i in range(3):
        for j in range(3):
            F[R + i, clock] += half[i, j] * more[j]
            F[v + i, clock] += half[i, j] * more[3 + j]
            for k in range(3):
                F[R + i, gain + 3 * j + k] = half[i, j] * gyro[k] * dt
        F[p + i, clock] = 0.5 * dt * F[v + i, clock]


@njit(cache=True, nogil=True, error_model="numpy")
def _add_noise(P: NDArray[np.float64], noise: NDArray[np.float64], dt: float) -> None:
    """Add the noise of one step to the covariance of the error state (N, N), in place."""
    for i in range(3):
        P[ROWS.rotation + i, ROWS.rotation + i] += noise[NOISE.gyro] ** 2 * dt
        P[ROWS.position + i, ROWS.position + i] += noise[NOISE.accel] ** 2 * dt**3 / 3.0
        P[ROWS.position + i, ROWS.velocity + i] += noise[NOISE.accel] ** 2 * dt**2 / 2.0
        P[ROWS.velocity + i, ROWS.position + i] += noise[NOISE.accel] ** 2 * dt**2 / 2.0
        P[ROWS.velocity + i, ROWS.velocity + i] += noise[NOISE.accel] ** 2 * dt
        P[ROWS.gyro_bias + i, ROWS.gyro_bias + i] += noise[NOISE.gyro_bias_walk] ** 2 * dt
        P[ROWS.accel_bias + i, ROWS.accel_bias + i] += noise[NOISE.accel_bias_walk] ** 2 * dt
    if len(P) == ROWS.size:
        for i in range(ROWS.gyro_gain, ROWS.clock):
            P[i, i] += noise[NOISE.gain_walk] ** 2 * dt
        P[ROWS.clock, ROWS.clock] += noise[NOISE.clock_walk] ** 2 * dt


@njit(cache=True, nogil=True, error_model="numpy")
def propagate(
    t_s: NDArray[np.float64],
    gyro: NDArray[np.float64],
    accel: NDArray[np.float64],
    R0: NDArray[np.float64],
    state0: NDArray[np.float64],
    P0: NDArray[np.float64],
    noise: NDArray[np.float64],
) -> tuple[NDArray[np.float64], ...]:
    """Propagate a state over the samples of one frame (midpoint rule between two samples).

    Args:
        t_s: Sample times, the first at the start, the last at the end of the frame [s], (K,).
        gyro: Angular rate in the body [rad/s], (K, 3).
        accel: Specific force in the body [m/s²], (K, 3).
        R0: Rotation ``R_odom_body`` at the start, (3, 3).
        state0: Position, velocity, gyro bias, accel bias, gravity, then gain of the gyroscope and
            clock or nothing, (N - 3,). The samples are those of the clock already.
        P0: Covariance of the error (rotation about odom axes, then as ``state0``), (N, N) with N
            of 18 or 28.
        noise: Densities per sqrt(s): gyro, accel, gyro bias walk, accel bias walk, with 28
            rows also walks of gain and clock, (4,) or (6,).

    Returns:
        Rotations (K, 3, 3), positions (K, 3), velocity at the end (3,), transition Phi (N, N)
        and covariance at the end (N, N).
    """
    count = len(t_s)
    R_all, p_all = np.empty((count, 3, 3)), np.empty((count, 3))
    R = R0.copy()
    p = _quantity(state0, ROWS.position).copy()
    v = _quantity(state0, ROWS.velocity).copy()
    bg, ba = _quantity(state0, ROWS.gyro_bias), _quantity(state0, ROWS.accel_bias)
    gravity = _quantity(state0, ROWS.gravity)
    size = len(P0)
    gain = np.eye(3)
    more = np.zeros(6)
    if size == ROWS.size:
        for i in range(9):
            gain[i // 3, i % 3] += state0[ROWS.gyro_gain - ROWS.vector + i]
    Phi = np.eye(size)
    P = P0.copy()
    R_all[0], p_all[0] = R, p
    for k in range(count - 1):
        dt = t_s[k + 1] - t_s[k]
        rate = 0.5 * (gyro[k] + gyro[k + 1])
        omega = gain @ rate - bg
        force = 0.5 * (accel[k] + accel[k + 1]) - ba
        half = R @ rotation(omega * (0.5 * dt))
        a = half @ force + gravity
        F = _step_transition(half, half @ force, dt, size)
        if size == ROWS.size:
            more[:3] = gain @ (gyro[k + 1] - gyro[k])
            more[3:] = accel[k + 1] - accel[k]
            _add_calibration(F, half, rate, more, dt)
        Phi = F @ Phi
        P = F @ P @ F.T
        _add_noise(P, noise, dt)
        p = p + v * dt + 0.5 * a * dt * dt
        v = v + a * dt
        R = R @ rotation(omega * dt)
        R_all[k + 1], p_all[k + 1] = R, p
    return R_all, p_all, v, Phi, P


@njit(cache=True, nogil=True, error_model="numpy")
def turns_between(R: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation vectors from pose to pose [rad], (K - 1, 3), of rotations, (K, 3, 3)."""
    turns = np.empty((len(R) - 1, 3))
    for k in range(len(turns)):
        D = R[k].T @ R[k + 1]
        trace = min(3.0, max(-1.0, D[0, 0] + D[1, 1] + D[2, 2]))
        angle = np.arccos(0.5 * (trace - 1.0))
        scale = 0.5 if angle < 1e-6 else 0.5 * angle / np.sin(angle)
        turns[k, 0] = scale * (D[2, 1] - D[1, 2])
        turns[k, 1] = scale * (D[0, 2] - D[2, 0])
        turns[k, 2] = scale * (D[1, 0] - D[0, 1])
    return turns


@njit(cache=True, nogil=True, error_model="numpy")
def turned(w: NDArray[np.float64], R: NDArray[np.float64]) -> NDArray[np.float64]:
    """A rotation (3, 3) turned by a rotation vector [rad] in outer axes, (3,).

    Products drift from SO(3): one step of Newton's iteration leads back (Higham 1986, Eq. 3.5).
    """
    M = rotation(w) @ R
    return 1.5 * M - 0.5 * (M @ (M.T @ M))


@njit(cache=True, nogil=True, error_model="numpy")
def led_to(
    part: NDArray[np.float64],
    R: NDArray[np.float64],
    p: NDArray[np.float64],
    R_end: NDArray[np.float64],
    p_end: NDArray[np.float64],
) -> tuple[NDArray[np.float64], ...]:
    """Poses moved so that the last one is another one.

    Args:
        part: Of that motion which each takes, (K,).
        R: Rotations, (K, 3, 3).
        p: Positions [m], (K, 3).
        R_end: Rotation to which the last one is led, (3, 3).
        p_end: Its position [m], (3,).

    Returns:
        Rotations (K, 3, 3), positions (K, 3), and the whole turn [rad] and shift [m], (3,).
    """
    ends = np.empty((2, 3, 3))
    ends[0], ends[1] = R[-1], R_end
    turn, shift = R[-1] @ turns_between(ends)[0], p_end - p[-1]
    R_out, p_out = np.empty_like(R), np.empty_like(p)
    for k in range(len(part)):
        R_out[k] = turned(part[k] * turn, R[k])
        p_out[k] = p[k] + part[k] * shift
    return R_out, p_out, turn, shift


@njit(cache=True, nogil=True, error_model="numpy")
def samples_at(
    t_ns: NDArray[np.int64], sample_t_ns: NDArray[np.int64], values: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Samples (N, 3) at other times (K,), linear between two, constant beyond the ends, (K, 3)."""
    out = np.empty((len(t_ns), 3))
    for k in range(len(t_ns)):
        after = np.searchsorted(sample_t_ns, t_ns[k], side="right")
        n = min(max(after - 1, 0), len(values) - 1)
        m = min(after, len(values) - 1)
        s = (t_ns[k] - sample_t_ns[n]) / (sample_t_ns[m] - sample_t_ns[n]) if m > n else 0.0
        for axis in range(3):
            out[k, axis] = values[n, axis] + s * (values[m, axis] - values[n, axis])
    return out


@njit(cache=True, nogil=True, error_model="numpy")
def middle_pose(
    t_s: NDArray[np.float64], R: NDArray[np.float64], p: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rotation (3, 3) and position (3,) halfway in time between the first and the last pose.

    Args:
        t_s: Times of the poses, increasing [s], (K,), K of 2 or more.
        R: Rotations, (K, 3, 3).
        p: Positions [m], (K, 3).
    """
    middle = (t_s[0] + t_s[-1]) / 2.0
    k = np.searchsorted(t_s, middle) - 1
    s = (middle - t_s[k]) / (t_s[k + 1] - t_s[k])
    turn = turns_between(R[k : k + 2])[0]
    return R[k] @ rotation(s * turn), p[k] + s * (p[k + 1] - p[k])


@njit(cache=True, nogil=True, error_model="numpy")
def place_points(
    t_s: NDArray[np.float64],
    R: NDArray[np.float64],
    p: NDArray[np.float64],
    t_points: NDArray[np.float64],
    points: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Undistort points: transform each from the body at its time to the poses' frame (V Eq. 2.8).

    Args:
        t_s: Times of the poses, increasing [s], (K,).
        R: Rotations, (K, 3, 3).
        p: Positions [m], (K, 3).
        t_points: Times of the points within the first and last pose [s], (N,).
        points: In the body [m], (N, 3).

    Returns:
        (N, 3): between two poses the position is interpolated and the rotation is SLERP.
    """
    count = len(t_s)
    w = turns_between(R)
    out = np.empty((len(points), 3))
    k = 0  # mostly the interval of the point before
    for n in range(len(points)):
        if not t_s[k] <= t_points[n] < t_s[k + 1]:
            k = min(max(np.searchsorted(t_s, t_points[n], side="right") - 1, 0), count - 2)
        s = (t_points[n] - t_s[k]) / (t_s[k + 1] - t_s[k])
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        wx, wy, wz = s * w[k, 0], s * w[k, 1], s * w[k, 2]
        angle_sq = wx * wx + wy * wy + wz * wz
        # Taylor series: exact to 1e-10 rad for the less than 0.3 rad between two poses.
        a = 1.0 - angle_sq / 6.0 * (1.0 - angle_sq / 20.0 * (1.0 - angle_sq / 42.0))
        b = 0.5 - angle_sq / 24.0 * (1.0 - angle_sq / 30.0 * (1.0 - angle_sq / 56.0))
        cx, cy, cz = wy * z - wz * y, wz * x - wx * z, wx * y - wy * x
        rx = x + a * cx + b * (wy * cz - wz * cy)
        ry = y + a * cy + b * (wz * cx - wx * cz)
        rz = z + a * cz + b * (wx * cy - wy * cx)
        M = R[k]
        out[n, 0] = (
            M[0, 0] * rx + M[0, 1] * ry + M[0, 2] * rz + p[k, 0] + s * (p[k + 1, 0] - p[k, 0])
        )
        out[n, 1] = (
            M[1, 0] * rx + M[1, 1] * ry + M[1, 2] * rz + p[k, 1] + s * (p[k + 1, 1] - p[k, 1])
        )
        out[n, 2] = (
            M[2, 0] * rx + M[2, 1] * ry + M[2, 2] * rz + p[k, 2] + s * (p[k + 1, 2] - p[k, 2])
        )
    return out
