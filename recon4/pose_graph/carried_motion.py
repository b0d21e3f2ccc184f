"""What of the motion over odometry edges the points observe, and what only an IMU carries.

An odometry edge has one covariance. Along directions that the LiDARs observe it is several times
too large, and `ErrorModel` reduces it; along those that only the accelerometer carries it is as
large as its error. Which part of it is which does not follow from its size: without an IMU a step
through a door states 16 cm and is right to 6 mm.

The multiframes before and after a lone one are registered to the local map, not to it: what it
left unknown is an error of its own pose, and does not add up along the walk. With ``i`` and ``j``
the nearest multiframes around ``k`` that observe the motion, a body that is accelerated by
``a`` ~ N(0, σ_a²) between them is

    p_k = p̄_k + ½ a (t_k - t_i) (t_j - t_k),   p̄_k linear between p_i and p_j

so a reported position ``p̂_k`` is off by what it deviates from that line, and by the second term.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array, matrix_from_quat
from recon4.model.pose_graph import PoseGraph
from recon4.model.trajectory import Times
from recon4.model.tuning import OBSERVATION
from recon4.pose_graph.tuning_solve import LONE
from recon4.store.arrays import load_arrays

_COLUMNS = [
    "t_mid_ns", "weak_direction", "weak_sd_m", "weak_motion_sd_m", "quat_xyzw", "t_m",
    "converged", "lost", "bridged", "stationary", "piece", "motion_cov",
]  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class CarriedMotion:
    """Covariances of shifts over multiframes along weak directions, and where there are none."""

    cov_odom: Array
    """[m²], (N, 3, 3)."""
    R_odom_body: Array
    """Attitude at each multiframe, (N, 3, 3)."""
    observed: NDArray[np.bool_]
    """Whether the points of a multiframe observe its shift along all directions, (N,)."""
    motion_cov: Array
    """Covariance of turn and shift over each multiframe by the filter, in odom axes, (N, 6, 6);
    zero where it begins a piece, whose poses are relative to it, and where the body stands."""
    bounds: Array
    """How wrong the position of a lone multiframe may be beside those around it [m²], (N, 3, 3);
    NaN = not lone."""

    def between(self, frame_ids: Times) -> Array:
        """The same between consecutive nodes, in axes of the body at the later one, (M - 1, 3, 3).

        As in odometry edges the standard deviations of consecutive multiframes add up.

        Args:
            frame_ids: Multiframe of each node, (M,).
        """
        out = np.zeros((max(len(frame_ids) - 1, 0), 3, 3))
        for k, (first, last) in enumerate(pairwise(frame_ids.tolist())):
            R = self.R_odom_body[last]
            cov = self.cov_odom[first + 1 : last + 1]  # each along one direction
            sd_m = np.sqrt(np.trace(cov, axis1=1, axis2=2))
            root = (cov / np.maximum(sd_m, 1e-12)[:, None, None]).sum(axis=0)
            out[k] = R.T @ root @ root @ R
        return out

    def in_map(self, graph: PoseGraph) -> Array:
        """The same between the nodes of a graph, in axes of its map, (M - 1, 3, 3)."""
        R = graph.T_map_body.R[1:]
        return np.asarray(R @ self.between(graph.frame_ids) @ np.swapaxes(R, 1, 2))

    def observed_between(self, frame_ids: Times) -> NDArray[np.bool_]:
        """Whether points observe the whole shift between consecutive nodes, (M - 1,).

        Those that follow a lone multiframe are registered to the local map, not to it.

        Args:
            frame_ids: Multiframe of each node, (M,).
        """
        unobserved = np.concatenate(
            [[0], np.cumsum(~self.observed & np.isnan(self.bounds[:, 0, 0]))]
        )
        return np.asarray(unobserved[frame_ids[1:] + 1] == unobserved[frame_ids[:-1] + 1])


def load_carried_motion(odometry: Path) -> CarriedMotion | None:
    """Read it from the artifact of the stage ``odometry``; None if its version did not state it.

    Raises:
        StoreError: If a file is missing or damaged.
    """
    steps = load_arrays(odometry / "steps.npz")
    if not steps.keys() >= set(_COLUMNS):
        return None
    along = np.nan_to_num(steps["weak_direction"]) * steps["weak_motion_sd_m"][:, None]
    new_piece = np.diff(steps["piece"], prepend=steps["piece"][:1]) != 0
    tracked = steps["converged"] & ~steps["lost"] & ~steps["bridged"] & ~new_piece
    observed = tracked & (steps["stationary"] | (steps["weak_sd_m"] < OBSERVATION.observed_sd_m))
    motion_cov = steps["motion_cov"].copy()
    motion_cov[:1] = motion_cov[new_piece | steps["stationary"]] = 0.0
    return CarriedMotion(
        along[:, :, None] * along[:, None, :],
        matrix_from_quat(steps["quat_xyzw"]),
        observed,
        motion_cov,
        bounds_by_neighbors(
            observed,
            ~steps["lost"] & ~steps["bridged"] & ~new_piece,
            t_ns=steps["t_mid_ns"],
            p_odom=steps["t_m"],
        ),
    )


_Mask = NDArray[np.bool_]


def bounds_by_neighbors(observed: _Mask, followed: _Mask, *, t_ns: Times, p_odom: Array) -> Array:
    """How wrong the position of each lone multiframe may be beside those around it.

    Args:
        observed: Whether the points of each observe its shift along all directions, (N,).
        followed: Whether the body was followed to it from the one before, (N,).
        t_ns: Middle of each, (N,).
        p_odom: Position at it [m], (N, 3).

    Returns:
        ``(p̂ - p̄)(p̂ - p̄)ᵀ + (½ σ_a (t - t_i) (t_j - t))² I`` [m²], (N, 3, 3); NaN = not lone.
    """
    bounds = np.full((len(observed), 3, 3), np.nan)
    first = np.searchsorted(t_ns, t_ns - LONE.around_ns)
    last = np.searchsorted(t_ns, t_ns + LONE.around_ns, side="right")
    for k in np.flatnonzero(~observed & followed).tolist():
        before, after = observed[first[k] : k], observed[k + 1 : last[k]]
        if not _mostly(before) or not _mostly(after):
            continue
        i, j = k - 1 - int(before[::-1].argmax()), k + 1 + int(after.argmax())
        if followed[i + 1 : j + 1].all():
            since_s, left_s = float(t_ns[k] - t_ns[i]) / 1e9, float(t_ns[j] - t_ns[k]) / 1e9
            line = (left_s * p_odom[i] + since_s * p_odom[j]) / (since_s + left_s)
            bent_m = 0.5 * LONE.speeds_up_m_s2 * since_s * left_s
            bounds[k] = np.outer(p_odom[k] - line, p_odom[k] - line) + bent_m**2 * np.eye(3)
    return bounds


def _mostly(observed: _Mask) -> bool:
    return bool(len(observed)) and bool(observed.mean() >= LONE.ratio)
