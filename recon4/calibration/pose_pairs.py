"""The mount of a sensor from pairs of poses (requirements L-CAL-2; L §4.4.1, eqs. 5 to 9).

A tracking system measures poses of a frame on the backpack while the sensor's poses are known from
control points. All poses are ``T_world_…`` (requirements A0 no. 9), so ``X = T_m^-1 T_r``.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.calibration.number_rows import read_number_rows
from recon4.calibration.tuning_methods import POSE_PAIRS
from recon4.errors import CalibrationError, CorruptFile
from recon4.geometry.se3 import SE3, Array, so3_log
from recon4.locales.coded import CodedText

_COLUMNS = "x y z qx qy qz qw x y z qx qy qz qw"


@dataclass(frozen=True, slots=True, eq=False)
class MarkerPosePairs:
    """Poses of two frames that are fixed to each other, at the same times."""

    T_world_marker: SE3
    """Of the frame that was tracked, (N,)."""
    T_world_sensor: SE3
    """Of the sensor, (N,)."""


@dataclass(frozen=True, slots=True, eq=False)
class PairAlignment:
    """The constant transformation between the two frames."""

    T_marker_sensor: SE3
    residual_rad: Array
    """Angle of each pair from it, (N,)."""
    residual_m: Array
    """Distance of each pair from it [m], (N,)."""
    sd_rad: float
    """Standard deviation of its rotation about the least known axis [rad]."""
    sd_m: Array
    """Standard deviations of its position along x, y, z of the marker [m], (3,)."""
    unknown: Array
    """Directions in the marker's frame along which the motions do not show the position, (K, 3)."""

    @property
    def contradictory(self) -> bool:
        """Whether the pairs contradict each other."""
        return bool(
            np.median(self.residual_rad) > POSE_PAIRS.outlier_rad
            or np.median(self.residual_m) > POSE_PAIRS.outlier_m
        )


def read_pose_pairs(path: Path) -> MarkerPosePairs:
    """Read a CSV with a pair a line: ``x y z qx qy qz qw`` of the marker, then of the sensor.

    Commas or blanks separate the numbers; ``#`` begins a comment.

    Raises:
        CorruptFile: If a line has another number of values, or a quaternion has not length 1.
    """
    table = read_number_rows(path, _COLUMNS, most_bytes=POSE_PAIRS.max_bytes)
    if not len(table):
        raise CorruptFile(CodedText("pose-pairs-none", file=path.name))
    for first in (3, 10):
        length = np.linalg.norm(table[:, first : first + 4], axis=1)
        wrong = np.flatnonzero(np.abs(length - 1.0) > POSE_PAIRS.unit_tolerance)
        if len(wrong):
            raise CorruptFile(
                CodedText(
                    "pose-pairs-quaternion",
                    file=path.name,
                    wrong=str(wrong[0] + 1),
                    length=float(length[wrong[0]]),
                )
            )
    marker = SE3.from_quat(table[:, 3:7], table[:, :3])
    return MarkerPosePairs(marker, SE3.from_quat(table[:, 10:14], table[:, 7:10]))


def average_pairs(pairs: MarkerPosePairs) -> PairAlignment:
    """Average ``T_m^-1 T_r`` of all pairs; the rotation is projected to SO(3) (L Eq. 5 to 7).

    Raises:
        CalibrationError: If there is no pair, or the mean of the rotations has no rotation near it.
    """
    each = pairs.T_world_marker.inverse() @ pairs.T_world_sensor
    if not len(each.t):
        raise CalibrationError(CodedText("pose-pairs-empty"))
    U, singular, Vt = np.linalg.svd(each.R.mean(axis=0))
    if singular[1] < POSE_PAIRS.min_axes:
        raise CalibrationError(CodedText("pose-pairs-contradict"))
    R = U @ np.diag([1.0, 1.0, np.linalg.det(U @ Vt)]) @ Vt
    return _with_residuals(SE3(R, each.t.mean(axis=0)), each)


def hand_eye(pairs: MarkerPosePairs, *, before_m: Array) -> PairAlignment:
    """The transformation where the two worlds differ: ``A X = X B`` (Park & Martin 1994).

    ``A`` and ``B`` are the motions of marker and sensor from the first pose on, so the worlds in
    which they were measured do not matter.

    Args:
        pairs: The poses.
        before_m: Position by the rig file [m], (3,): kept along directions that the motions do not
            show to 1 cm, as the vertical of a walk on a level floor.

    Raises:
        CalibrationError: If the motions turn too little about a second axis to show the rotation.
    """
    of_marker = pairs.T_world_marker[0].inverse() @ pairs.T_world_marker[1:]
    of_sensor = pairs.T_world_sensor[0].inverse() @ pairs.T_world_sensor[1:]
    a, b = so3_log(of_marker.R), so3_log(of_sensor.R)
    U, _, Vt = np.linalg.svd(a.T @ b)
    R = U @ np.diag([1.0, 1.0, np.linalg.det(U @ Vt)]) @ Vt
    left = (of_marker.R - np.eye(3)).reshape(-1, 3)
    right = (np.einsum("ij,nj->ni", R, of_sensor.t) - of_marker.t).ravel()
    t_m = np.linalg.lstsq(left, right, rcond=None)[0]
    apart = (of_marker @ SE3(R, t_m)).inverse() @ (SE3(R, t_m) @ of_sensor)
    residual_rad, residual_m = np.asarray(apart.angle()), np.linalg.norm(apart.t, axis=1)
    sd_rad = _rotation_sd_rad(b, residual_rad)
    # Whole distances in place of components: errors of the rotation move many pairs alike.
    noise_m = max(POSE_PAIRS.least_noise_m, float(np.sqrt(np.mean(residual_m**2))))
    weight, axes = np.linalg.eigh(left.T @ left)
    sd_along_m = noise_m / np.sqrt(np.maximum(weight, 1e-300))
    unknown = axes.T[sd_along_m > POSE_PAIRS.vague_m]
    t_m = t_m + unknown.T @ (unknown @ (before_m - t_m))
    sd_m = np.sqrt(axes**2 @ np.minimum(sd_along_m, 1e3) ** 2)
    found = PairAlignment(SE3(R, t_m), residual_rad, residual_m, sd_rad, sd_m, unknown)
    if not found.contradictory and not sd_rad < POSE_PAIRS.vague_rad:
        raise CalibrationError(CodedText("pose-pairs-axes"))
    return found


def _rotation_sd_rad(turns: Array, residual_rad: Array) -> float:
    """Standard deviation of the rotation about its least known axis, from turns (N, 3) [rad]."""
    noise_rad = max(POSE_PAIRS.least_noise_rad, float(np.sqrt(np.mean(residual_rad**2))))
    least = np.linalg.eigvalsh(np.sum(turns**2) * np.eye(3) - turns.T @ turns)[0]
    return noise_rad / float(np.sqrt(max(least, 1e-300)))


def _with_residuals(mean: SE3, each: SE3) -> PairAlignment:
    apart = mean.inverse() @ each
    residual_rad, residual_m = np.asarray(apart.angle()), np.linalg.norm(apart.t, axis=1)
    count = np.sqrt(len(each.t))
    sd_rad = float(np.sqrt(np.mean(residual_rad**2)) / count)
    sd_m = np.sqrt(np.mean(apart.t**2, axis=0)) / count
    return PairAlignment(mean, residual_rad, residual_m, sd_rad, sd_m, np.empty((0, 3)))
