"""What of the motion over odometry edges the points observe, and what only an IMU carries.

An odometry edge has one covariance. Along directions that the LiDARs observe it is several times
too large, and `ErrorModel` reduces it; along those that only the accelerometer carries it is as
large as its error. Which part of it is which does not follow from its size: without an IMU a step
through a door states 16 cm and is right to 6 mm.

The multiframes before and after a short stretch that observes nothing are registered to the local
map, not to it: what it left unknown is an error of its own poses, and does not add up along the
walk. Those that observe the motion hold it, by the smoothest path of a carrier whose acceleration
has the standard deviation ``σ_a`` and soon changes:

    E[a(t) a(s)] = σ_a² exp(-|t - s| / τ)   ->   p̄_k and σ_k², given the others

so a reported position ``p̂_k`` is off by what it deviates from that path, and by ``σ_k``.
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
    """How wrong positions of short stretches that observe nothing may be beside those around.

    Args:
        observed: Whether the points of each observe its shift along all directions, (N,).
        followed: Whether the body was followed to it from the one before, (N,).
        t_ns: Middle of each, (N,).
        p_odom: Position at it [m], (N, 3).

    Returns:
        ``(p̂ - p̄)(p̂ - p̄)ᵀ + σ² I`` [m²], (N, 3, 3); NaN = not in a short stretch.
    """
    bounds = np.full((len(observed), 3, 3), np.nan)
    change = np.diff(np.concatenate([[True], observed, [True]]).astype(np.int8))
    for start, end in zip(np.flatnonzero(change < 0), np.flatnonzero(change > 0), strict=True):
        if start == 0 or end == len(observed) or not followed[start : end + 1].all():
            continue
        around = t_ns[start - 1] - LONE.around_ns, t_ns[end] + LONE.around_ns
        first, last = np.searchsorted(t_ns, around[0]), np.searchsorted(t_ns, around[1], "right")
        short = t_ns[end] - t_ns[start - 1] <= LONE.around_ns
        if not (short and _mostly(observed[first:start]) and _mostly(observed[end:last])):
            continue
        cut = np.flatnonzero(~followed[first + 1 : last]) + first + 1
        first = max(cut[cut < start], default=first)
        last = min(cut[cut > end], default=last)
        unseen = np.arange(start, end) - first
        line, variance = by_others(
            (t_ns[first:last] - t_ns[first]) / 1e9, p_odom[first:last], observed[first:last]
        )
        aside = p_odom[start:end] - line[unseen]
        own = variance[unseen, None, None] * np.eye(3)
        bounds[start:end] = aside[:, :, None] * aside[:, None, :] + own
    return bounds


def by_others(t_s: Array, p_m: Array, known: _Mask) -> tuple[Array, Array]:
    """Positions by those that are known, with an acceleration of the carrier that soon changes.

    Args:
        t_s: Times [s], (N,).
        p_m: Positions [m], (N, 3).
        known: Which of them to use, (N,).

    Returns:
        Positions (N, 3) and the variance of each along any axis [m²], (N,).
    """
    dt = np.diff(t_s)
    middle, later = (t_s[1:] + t_s[:-1]) / 2, t_s[:, None] - t_s[1:]
    # Of a place, a speed, and an acceleration between each two times.
    moved = np.where(later > -1e-9, dt * (later + dt / 2), 0.0)
    J = np.column_stack([np.ones_like(t_s), t_s, moved])
    apart = np.abs(middle[:, None] - middle) / LONE.changes_s
    information = J[known].T @ J[known] / LONE.known_m**2
    information[2:, 2:] += np.linalg.inv(LONE.speeds_up_m_s2**2 * np.exp(-apart))
    cov = np.linalg.inv(information)
    state = cov @ J[known].T @ p_m[known] / LONE.known_m**2
    return J @ state, np.einsum("ni,ij,nj->n", J, cov, J)


def _mostly(observed: _Mask) -> bool:
    return bool(len(observed)) and bool(observed.mean() >= LONE.ratio)
