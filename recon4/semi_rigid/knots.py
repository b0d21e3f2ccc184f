"""Corrections of a trajectory at knots in time, solved for all at once."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import solveh_banded

from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, so3_exp
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.state_vector import END_POSE, START


@dataclass(frozen=True, slots=True, eq=False)
class IntervalEquations:
    """Normal equations by interval; interval k of N lies between knots k and k + 1."""

    H: Array
    """Information of the corrections at start and end of each interval, (N, 12, 12)."""
    g: Array
    """Its gradient, (N, 12)."""


def solve_knots(
    system: IntervalEquations, applied: Array, *, neighbor_sd: Array, total_sd: Array
) -> Array:
    """Steps of the corrections at all knots.

    A strong prior binds neighboring knots, because odometry determines the motion between them
    well. A weak prior binds each knot to its start, because nothing else constrains the whole map.

    Args:
        system: Normal equations of the matches.
        applied: Corrections applied in earlier rounds, (N + 1, 6).
        neighbor_sd: Standard deviation of the difference of neighboring corrections, (6,).
        total_sd: Standard deviation of a correction, (6,).

    Returns:
        (N + 1, 6), rotation first.
    """
    knots = len(system.H) + 1
    chain, anchor = neighbor_sd**-2.0, total_sd**-2.0
    diagonal = np.tile(np.diag(anchor), (knots, 1, 1))
    diagonal[:-1] += system.H[:, START, START] + np.diag(chain)
    diagonal[1:] += system.H[:, END_POSE, END_POSE] + np.diag(chain)
    lower = system.H[:, END_POSE, START] - np.diag(chain)
    gradient = anchor * applied
    gradient[:-1] += system.g[:, START] - chain * np.diff(applied, axis=0)
    gradient[1:] += system.g[:, END_POSE] + chain * np.diff(applied, axis=0)
    banded = _lower_band(diagonal, lower)
    return -solveh_banded(banded, gradient.ravel(), lower=True).reshape(knots, 6)


def _lower_band(diagonal: Array, lower: Array) -> Array:
    """Block-tridiagonal matrix in the form of scipy: ``out[r - c, c]``, (12, 6 M)."""
    knots = len(diagonal)
    out = np.zeros((12, 6 * knots))
    for row in range(6):
        for column in range(6):
            if row >= column:
                out[row - column, column::6] = diagonal[:, row, column]
            out[6 + row - column, column : 6 * (knots - 1) : 6] = lower[:, row, column]
    return out


def apply_knots(trajectory: Trajectory, knot_ns: Times, correction: Array) -> Trajectory:
    """Correct each pose by the correction interpolated at its time.

    Args:
        trajectory: Poses at any times; the first and last knot also apply beyond their times.
        knot_ns: Times of the knots [ns], (M,).
        correction: Rotation about the pose's own position, then shift, in the map's axes, (M, 6).
    """
    t = (trajectory.t_ns - knot_ns[0]) * 1e-9
    knots = (knot_ns - knot_ns[0]) * 1e-9
    at = np.stack([np.interp(t, knots, correction[:, k]) for k in range(6)], axis=1)
    moved = SE3(
        so3_exp(at[:, ROTATION]) @ trajectory.T_a_b.R, trajectory.T_a_b.t + at[:, TRANSLATION]
    )
    return replace(trajectory, T_a_b=moved)
