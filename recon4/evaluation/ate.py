"""Absolute trajectory error: deviation of the estimated poses from ground truth (L §4.4.2)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from recon4.errors import OutOfRange
from recon4.evaluation.tuning import ATE
from recon4.geometry.se3 import SE3, Array, align_points, quat_from_matrix
from recon4.locales.coded import CodedText
from recon4.model.trajectory import Times, Trajectory

Alignment = Literal["svd", "first", "none"]


@dataclass(frozen=True, slots=True)
class Spread:
    """Statistics of one kind of error, all in its own unit."""

    rmse: float
    mean: float
    median: float
    minimum: float
    maximum: float

    @staticmethod
    def of(errors: Array) -> Spread:
        """Statistics of errors, (N,), N > 0. The RMSE is L Eq. 13."""
        return Spread(
            rmse=float(np.sqrt(np.mean(errors**2))),
            mean=float(errors.mean()),
            median=float(np.median(errors)),
            minimum=float(errors.min()),
            maximum=float(errors.max()),
        )


@dataclass(frozen=True, slots=True, eq=False)
class PosePairs:
    """Estimated and true poses of the body at the same times."""

    t_ns: Times
    """Times of the estimate that the truth covers [ns], (N,)."""
    T_map_body: SE3
    """Estimated, N of them."""
    T_true_body: SE3
    """True, N of them, in a frame of their own."""
    coverage_ratio: float
    """Ratio of the estimated poses covered by the ground truth, 0..1."""

    def __len__(self) -> int:
        return len(self.t_ns)


@dataclass(frozen=True, slots=True, eq=False)
class AbsoluteError:
    """Absolute trajectory error under one alignment."""

    alignment: Alignment
    T_true_map: SE3
    """The alignment: moves the estimate onto the truth."""
    determined: bool
    """False: the positions lie on a line or a point, so the rotation is undetermined."""
    position_m: Spread
    rotation_rad: Spread
    """Axis-angle (L Eq. 12)."""
    yaw_rad: Spread
    """About the vertical of the truth only; hides tilt (L §5.1)."""
    position_errors_m: Array
    """One a pose, (N,)."""
    rotation_errors_rad: Array
    """One a pose, (N,)."""


def pair_poses(
    estimate: Trajectory, truth: Trajectory, *, max_gap_ns: int = 500_000_000
) -> PosePairs:
    """Interpolate the truth at the times of the estimate.

    Args:
        estimate: Poses to judge.
        truth: True poses, at any rate and in any frame.
        max_gap_ns: Times inside a longer gap of the truth are not paired.

    Raises:
        OutOfRange: If fewer than two of the estimate's times are covered by the truth.
    """
    t = estimate.t_ns
    covered = np.zeros(len(t), dtype=bool)
    if len(truth) >= 2:
        left = np.clip(np.searchsorted(truth.t_ns, t, side="right") - 1, 0, len(truth) - 2)
        gap_ns = truth.t_ns[left + 1] - truth.t_ns[left]
        covered = (t >= truth.t_ns[0]) & (t <= truth.t_ns[-1]) & (gap_ns <= max_gap_ns)
    if covered.sum() < 2:
        raise OutOfRange(
            CodedText(
                "ate-few",
                covered=str(covered.sum()),
                count=len(t),
                estimate=_span(estimate),
                truth=_span(truth),
            )
        )
    return PosePairs(
        t_ns=t[covered],
        T_map_body=estimate.T_a_b[covered],
        T_true_body=truth.at(t[covered]),
        coverage_ratio=float(covered.mean()),
    )


def absolute_error(pairs: PosePairs, *, alignment: Alignment = "svd") -> AbsoluteError:
    """Position and rotation errors of every pose.

    Position errors are ``|t_true - t|`` and rotations the angle of ``R_true^T R``,
    not L Eq. 10 as printed (requirements A0 no. 10).

    Args:
        pairs: Poses at the same times.
        alignment: ``svd``: best rigid fit of the positions (recommended); ``first``: the first
            poses coincide (L Eq. 9; every error of the first pose is magnified);
            ``none``: both are in one frame already.
    """
    T_true_map, determined = _align(pairs, alignment)
    T_true_body = T_true_map @ pairs.T_map_body
    position_m = np.linalg.norm(T_true_body.t - pairs.T_true_body.t, axis=1)
    R_true = pairs.T_true_body.R
    rotation_rad = SE3(np.swapaxes(R_true, -1, -2) @ T_true_body.R, T_true_body.t).angle()
    yaw_rad = np.abs(_twist_about_z(T_true_body.R @ np.swapaxes(R_true, -1, -2)))
    return AbsoluteError(
        alignment=alignment,
        T_true_map=T_true_map,
        determined=determined,
        position_m=Spread.of(position_m),
        rotation_rad=Spread.of(rotation_rad),
        yaw_rad=Spread.of(yaw_rad),
        position_errors_m=position_m,
        rotation_errors_rad=rotation_rad,
    )


def _align(pairs: PosePairs, alignment: Alignment) -> tuple[SE3, bool]:
    if alignment == "none":
        return SE3.identity(), True
    if alignment == "first":
        return pairs.T_true_body[0] @ pairs.T_map_body[0].inverse(), True
    p = pairs.T_true_body.t - pairs.T_true_body.t.mean(axis=0)
    spread_m = np.linalg.svd(p, compute_uv=False)[1] / np.sqrt(len(p))
    return align_points(pairs.T_true_body.t, pairs.T_map_body.t), bool(spread_m > ATE.min_spread_m)


def _twist_about_z(R: Array) -> Array:
    """Rotation about z of (N, 3, 3) [rad], (N,) within ±pi."""
    quat_xyzw = quat_from_matrix(R)
    angle = 2.0 * np.arctan2(quat_xyzw[:, 2], quat_xyzw[:, 3])
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def _span(trajectory: Trajectory) -> str:
    if len(trajectory) == 0:
        return "is empty"
    return f"{trajectory.t_ns[0] / 1e9:.3f} … {trajectory.t_ns[-1] / 1e9:.3f} s"
