"""Rotations and rigid motions (SO(3), SE(3)), one or a batch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from recon4.geometry.tuning import POSE_BLOCK

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

Array = NDArray[np.float64]

ROTATION, TRANSLATION = slice(0, 3), slice(3, 6)
"""Rows of a twist, and of a tangent or its information matrix: rotation first, (6,)."""
ARM_M = 5.0
"""Distance at which a rotation is converted to a displacement, where one number is needed [m]."""
_SMALL_ANGLE = 1e-7
_DIAGONAL = np.arange(4)


def tangent_size_m(step: Array) -> float:
    """How far a tangent moves a point at `ARM_M` [m]; rotation first, (6,)."""
    return float(ARM_M * np.linalg.norm(step[ROTATION]) + np.linalg.norm(step[TRANSLATION]))


def skew(v: Array) -> Array:
    """Cross-product matrices, (..., 3) -> (..., 3, 3)."""
    out = np.zeros((*v.shape, 3))
    out[..., 0, 1], out[..., 0, 2] = -v[..., 2], v[..., 1]
    out[..., 1, 0], out[..., 1, 2] = v[..., 2], -v[..., 0]
    out[..., 2, 0], out[..., 2, 1] = -v[..., 1], v[..., 0]
    return out


def so3_exp(omega: ArrayLike) -> Array:
    """Rotation matrices of rotation vectors [rad], (..., 3) -> (..., 3, 3). Rodrigues' formula."""
    w = np.asarray(omega, dtype=np.float64)
    angle = np.linalg.norm(w, axis=-1)[..., None, None]
    safe = np.where(angle > _SMALL_ANGLE, angle, 1.0)
    a = np.where(angle > _SMALL_ANGLE, np.sin(safe) / safe, 1.0)
    b = np.where(angle > _SMALL_ANGLE, (1.0 - np.cos(safe)) / safe**2, 0.5)
    W = skew(w)
    return np.eye(3) + a * W + b * (W @ W)


def so3_log(R: ArrayLike) -> Array:
    """Rotation vectors [rad] of rotation matrices, (..., 3, 3) -> (..., 3), |result| <= pi."""
    quat_xyzw = quat_from_matrix(np.asarray(R, dtype=np.float64))
    quat_xyzw = np.where(quat_xyzw[..., 3:] < 0.0, -quat_xyzw, quat_xyzw)
    v, w = quat_xyzw[..., :3], quat_xyzw[..., 3:]
    norm = np.linalg.norm(v, axis=-1, keepdims=True)
    scale = np.where(norm > _SMALL_ANGLE, 2.0 * np.arctan2(norm, w) / np.maximum(norm, 1e-300), 2.0)
    return scale * v


def quat_from_matrix(R: Array) -> Array:
    """Unit quaternions (x, y, z, w) of rotation matrices, (..., 3, 3) -> (..., 4).

    Shepperd 1978: the largest of the four components is computed first.
    """
    m = R
    trace = m[..., 0, 0] + m[..., 1, 1] + m[..., 2, 2]
    number = np.result_type(m, 1.0)
    four_squares = np.empty((*m.shape[:-2], 4), number)
    for k in range(3):
        four_squares[..., k] = 2 * m[..., k, k] - trace
    four_squares[..., 3] = trace
    best = np.argmax(four_squares, axis=-1)
    x, y, z = (
        m[..., 2, 1] - m[..., 1, 2],
        m[..., 0, 2] - m[..., 2, 0],
        m[..., 1, 0] - m[..., 0, 1],
    )
    xy, xz, yz = (
        m[..., 0, 1] + m[..., 1, 0],
        m[..., 0, 2] + m[..., 2, 0],
        m[..., 1, 2] + m[..., 2, 1],
    )
    rows = np.empty((*m.shape[:-2], 4, 4), number)  # to stack one matrix takes twice as long
    rows[..., _DIAGONAL, _DIAGONAL] = 1.0 + four_squares
    rows[..., 0, 1] = rows[..., 1, 0] = xy
    rows[..., 0, 2] = rows[..., 2, 0] = xz
    rows[..., 1, 2] = rows[..., 2, 1] = yz
    rows[..., 0, 3] = rows[..., 3, 0] = x
    rows[..., 1, 3] = rows[..., 3, 1] = y
    rows[..., 2, 3] = rows[..., 3, 2] = z
    quat = np.take_along_axis(rows, best[..., None, None], axis=-2)[..., 0, :]
    return quat / np.linalg.norm(quat, axis=-1, keepdims=True)


def matrix_from_quat(quat_xyzw: ArrayLike) -> Array:
    """Rotation matrices of quaternions (x, y, z, w), (..., 4) -> (..., 3, 3). Normalizes first."""
    q = np.asarray(quat_xyzw, dtype=np.float64)
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    v, w = q[..., :3], q[..., 3, None, None]
    V = skew(v)
    return np.eye(3) + 2.0 * w * V + 2.0 * (V @ V)


def proper(R: Array) -> Array:
    """Orthonormalize rotation matrices, (..., 3, 3).

    Products of rotations drift slowly from SO(3), and fast in a loop that feeds them back.
    """
    return matrix_from_quat(quat_from_matrix(R))


@dataclass(frozen=True, slots=True, eq=False)
class SE3:
    """One motion or a batch. ``T_a_b @ p_b`` is the point in frame ``a``."""

    R: Array
    """Rotations, (..., 3, 3)."""
    t: Array
    """Translations [m], (..., 3)."""

    # -- making

    @staticmethod
    def identity(*shape: int) -> SE3:
        """One identity, or a batch of them."""
        return SE3(np.broadcast_to(np.eye(3), (*shape, 3, 3)).copy(), np.zeros((*shape, 3)))

    @staticmethod
    def exp(xi: ArrayLike) -> SE3:
        """Motion of a twist, rotation first as in gtsam, (..., 6)."""
        xi = np.asarray(xi, dtype=np.float64)
        omega, v = xi[..., ROTATION], xi[..., TRANSLATION]
        return SE3(so3_exp(omega), np.einsum("...ij,...j->...i", _left_jacobian(omega), v))

    @staticmethod
    def from_quat(quat_xyzw: ArrayLike, t: ArrayLike) -> SE3:
        """From quaternions (x, y, z, w), (..., 4), and translations [m], (..., 3)."""
        return SE3(matrix_from_quat(quat_xyzw), np.asarray(t, dtype=np.float64))

    @staticmethod
    def from_rpy(roll_rad: float, pitch_rad: float, yaw_rad: float, *, t: ArrayLike) -> SE3:
        """``Rz(yaw) Ry(pitch) Rx(roll)`` and a translation [m], (3,)."""
        R = so3_exp([0, 0, yaw_rad]) @ so3_exp([0, pitch_rad, 0]) @ so3_exp([roll_rad, 0, 0])
        return SE3(R, np.asarray(t, dtype=np.float64))

    @staticmethod
    def from_matrix(matrix: ArrayLike) -> SE3:
        """From homogeneous matrices, (..., 4, 4)."""
        m = np.asarray(matrix, dtype=np.float64)
        return SE3(m[..., :3, :3].copy(), m[..., :3, 3].copy())

    @staticmethod
    def stack(motions: Iterable[SE3]) -> SE3:
        """A batch of single motions."""
        listed = list(motions)
        if not listed:
            return SE3.identity(0)
        return SE3(np.stack([m.R for m in listed]), np.stack([m.t for m in listed]))

    # -- reading

    def log(self) -> Array:
        """Twists, rotation first, (..., 6); the inverse of `exp`."""
        omega = so3_log(self.R)
        v = np.linalg.solve(_left_jacobian(omega), self.t[..., None])[..., 0]
        return np.concatenate([omega, v], axis=-1, dtype=np.float64)

    def quat_xyzw(self) -> Array:
        """Unit quaternions (x, y, z, w), w >= 0, (..., 4)."""
        if self.t.ndim > 1 and len(self) > POSE_BLOCK.poses:
            return np.concatenate([self[rows].quat_xyzw() for rows in pose_blocks(len(self))])
        quat = quat_from_matrix(self.R)
        return np.where(quat[..., 3:] < 0.0, -quat, quat)

    def rpy(self) -> Array:
        """Roll, pitch, yaw [rad] of ``Rz Ry Rx``, (..., 3)."""
        R = self.R
        return np.stack(
            [
                np.arctan2(R[..., 2, 1], R[..., 2, 2]),
                np.arcsin(np.clip(-R[..., 2, 0], -1.0, 1.0)),
                np.arctan2(R[..., 1, 0], R[..., 0, 0]),
            ],
            axis=-1,
        )

    def matrix(self) -> Array:
        """Homogeneous matrices, (..., 4, 4)."""
        out = np.zeros((*self.t.shape[:-1], 4, 4))
        out[..., :3, :3], out[..., :3, 3], out[..., 3, 3] = self.R, self.t, 1.0
        return out

    def angle(self) -> Any:
        """Rotation angles [rad], (...)."""
        return np.linalg.norm(so3_log(self.R), axis=-1)

    def size_m(self) -> float:
        """How far one pose moves a point at `ARM_M` [m]."""
        return float(np.linalg.norm(self.t)) + ARM_M * float(self.angle())

    def moves_more_than(self, limit_m: float) -> bool:
        """Whether `size_m` of one pose is above a limit.

        Most are decided by a bound without a logarithm: the norm of R - I is sqrt(8) times the sine
        of half the angle, which is at least a pi-th of the angle.
        """
        turn_rad = np.pi / np.sqrt(8.0) * np.linalg.norm(self.R - np.eye(3))
        bound_m = float(np.linalg.norm(self.t)) + ARM_M * float(turn_rad)
        return bound_m > limit_m and self.size_m() > limit_m

    def stepped(self, step: Array) -> SE3:
        """One pose, turned about its own origin and moved by a tangent in the outer axes, (6,)."""
        return SE3(so3_exp(step[ROTATION]) @ self.R, self.t + step[TRANSLATION])

    def inverse(self) -> SE3:
        """``T_b_a`` of ``T_a_b``."""
        Rt = np.swapaxes(self.R, -1, -2)
        return SE3(Rt, -np.einsum("...ij,...j->...i", Rt, self.t))

    def __len__(self) -> int:
        return len(self.t) if self.t.ndim > 1 else 1

    def __getitem__(self, rows: Any) -> SE3:
        return SE3(self.R[rows], self.t[rows])

    # -- using

    @overload
    def __matmul__(self, other: SE3) -> SE3: ...
    @overload
    def __matmul__(self, other: NDArray[Any]) -> Array: ...
    def __matmul__(self, other: SE3 | NDArray[Any]) -> SE3 | Array:
        """Compose with motions, or move points (..., 3); leading axes broadcast."""
        if isinstance(other, SE3):
            return SE3(self.R @ other.R, np.einsum("...ij,...j->...i", self.R, other.t) + self.t)
        if self.t.ndim == 1:
            return np.asarray(other, dtype=np.float64) @ self.R.T + self.t
        return np.einsum("...ij,...j->...i", self.R, other) + self.t


def _left_jacobian(omega: Array) -> Array:
    """V of the exponential map, (..., 3) -> (..., 3, 3). Barfoot 2017, eq. (7.37)."""
    angle = np.linalg.norm(omega, axis=-1)[..., None, None]
    small = angle < 1e-4
    safe = np.where(small, 1.0, angle)
    a = np.where(small, 0.5 - angle**2 / 24.0, (1.0 - np.cos(safe)) / safe**2)
    b = np.where(small, 1.0 / 6.0 - angle**2 / 120.0, (safe - np.sin(safe)) / safe**3)
    W = skew(omega)
    return np.eye(3) + a * W + b * (W @ W)


def interpolate(T_a_b0: SE3, T_a_b1: SE3, fraction: ArrayLike) -> SE3:
    """Poses between two: lerp of the position, SLERP of the rotation (V Eq. 2.8).

    Args:
        T_a_b0: Poses at fraction 0, one or (N,).
        T_a_b1: Poses at fraction 1, one or (N,).
        fraction: (N,); outside 0..1 it extrapolates.
    """
    s = np.asarray(fraction, dtype=np.float64)[..., None]
    omega = so3_log(np.swapaxes(T_a_b0.R, -1, -2) @ T_a_b1.R)
    return SE3(T_a_b0.R @ so3_exp(s * omega), T_a_b0.t + s * (T_a_b1.t - T_a_b0.t))


def poses_by_blocks(made: Callable[[slice], SE3], count: int) -> SE3:
    """Many poses, of which only some are in the making at a time.

    Args:
        made: Makes the poses of some rows, each from what belongs to its row alone.
        count: Number of poses.
    """
    out = SE3(np.empty((count, 3, 3)), np.empty((count, 3)))
    for rows in pose_blocks(count):
        part = made(rows)
        out.R[rows], out.t[rows] = part.R, part.t
    return out


def pose_blocks(count: int) -> Iterator[slice]:
    """Rows of many poses, as many at a time as are computed at once."""
    block = POSE_BLOCK.poses
    return (slice(start, start + block) for start in range(0, count, block))


def mean_rotation(R: Array, weights: Array | None = None) -> Array:
    """Average of N rotations, (N, 3, 3) -> (3, 3).

    Markley 2007: the eigenvector of the largest eigenvalue of the sum of q q^T.
    """
    quat = quat_from_matrix(R)
    w = np.ones(len(quat)) if weights is None else weights
    M = np.einsum("n,ni,nj->ij", w, quat, quat)
    return matrix_from_quat(np.linalg.eigh(M)[1][:, -1])


def align_points(p_a: Array, p_b: Array, weights: Array | None = None) -> SE3:
    """Find ``T_a_b`` minimizing the weighted distance of paired points.

    Args:
        p_a: Points in frame ``a`` [m], (N, 3).
        p_b: The same points in frame ``b`` [m], (N, 3).
        weights: Non-negative, (N,); None = equal.

    Returns:
        ``T_a_b``. Always a proper rotation, also for planar point sets.

    Umeyama 1991 without scale; V Eq. 2.3-2.5 with ``R = V E U^T`` (requirements A0 no. 6).
    """
    w = np.full(len(p_a), 1.0 / len(p_a)) if weights is None else weights / weights.sum()
    mean_a, mean_b = w @ p_a, w @ p_b
    cov_ab = (w[:, None] * (p_a - mean_a)).T @ (p_b - mean_b)
    U, _, Vt = np.linalg.svd(cov_ab)
    E = np.diag([1.0, 1.0, np.sign(np.linalg.det(U @ Vt))])
    R_a_b = U @ E @ Vt
    return SE3(R_a_b, mean_a - R_a_b @ mean_b)
