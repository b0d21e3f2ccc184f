"""6D SLAM as published: ICP of consecutive sweeps, then all sweeps at once (L Eq. 1, 2)."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, align_points, proper, so3_exp
from recon4.profiler.sweeps import Sweeps, relative
from recon4.profiler.tuning import LineTuning
from recon4.profiler.tuning_solve import GLOBAL_ICP

Links = list[tuple[int, int, float]]
"""Pairs of sweeps, the earlier first, and the part of the points with a closest pair."""


class PairedSweeps:
    """Thinned points of all sweeps with their search trees."""

    def __init__(self, sweeps: Sweeps) -> None:
        self.points: list[Array] = []
        for sweep in sweeps.sweeps:
            step = max(1, -(-len(sweep.points) // GLOBAL_ICP.points))
            self.points.append(sweep.points[::step].astype(np.float64))
        self._trees = [cKDTree(p, balanced_tree=False, compact_nodes=False) for p in self.points]

    def pairs(self, i: int, j: int, T_i_j: SE3, *, reach_m: float) -> tuple[Array, Array]:
        """Closest points of ``i`` to those of ``j``, each in its own frame [m], (N, 3) each."""
        distance, nearest = self._trees[i].query(
            T_i_j @ self.points[j], distance_upper_bound=reach_m
        )
        found = np.isfinite(distance)
        return self.points[i][nearest[found]], self.points[j][found]


def preregister(sweeps: Sweeps, T: SE3, settings: LineTuning) -> SE3:
    """ICP of every sweep to the one before; later sweeps move along (L Eq. 1, §5.2; A12 L-5).

    The correction of a sweep applies in its middle; between the middles of two sweeps it is
    interpolated, so it is distributed over the line scans.

    Args:
        sweeps: Sweeps of the head as rigid scans.
        T: Their first poses.
        settings: Largest distance of two points and number of rounds.
    """
    paired = PairedSweeps(sweeps)
    R, t = T.R.copy(), T.t.copy()
    for k in range(1, len(sweeps)):
        T_i_j = SE3(R[k - 1], t[k - 1]).inverse() @ (
            SE3(R[k - 1], t[k - 1]) @ relative(T, k - 1, k)
        )
        for _ in range(settings.slam_rounds):
            p, q = paired.pairs(k - 1, k, T_i_j, reach_m=settings.preregister_m)
            if len(p) < GLOBAL_ICP.min_pairs:
                break
            found = align_points(p, q)
            moved = float(np.linalg.norm((found.inverse() @ T_i_j).t))
            T_i_j = found
            if moved < GLOBAL_ICP.small_m:
                break
        pose = SE3(R[k - 1], t[k - 1]) @ T_i_j
        R[k], t[k] = pose.R, pose.t
    return SE3(proper(R), t)


def register_all(sweeps: Sweeps, T: SE3, links: Links, *, settings: LineTuning) -> SE3:
    """Poses of all sweeps from the closest pairs of all links, solved at once (L Eq. 2).

    The rotation is linearized and pairs are searched again in every round, as in ICP. The first
    sweep stays.

    Args:
        sweeps: Sweeps of the head as rigid scans.
        T: Their poses.
        links: Sweeps that overlap.
        settings: Largest distance of two points and number of rounds.
    """
    paired, count = PairedSweeps(sweeps), len(sweeps)
    if count < 2 or not links:
        return T
    R, t = T.R.copy(), T.t.copy()
    for _ in range(settings.slam_rounds):
        H, g = np.zeros((6 * count, 6 * count)), np.zeros(6 * count)
        H[:6, :6] += 1e9 * np.eye(6)
        H += 1e-3 * np.eye(6 * count)
        for i, j, _ in links:
            T_i, T_j = SE3(R[i], t[i]), SE3(R[j], t[j])
            p, q = paired.pairs(i, j, T_i.inverse() @ T_j, reach_m=settings.link_distance_m)
            if len(p) >= GLOBAL_ICP.min_pairs:
                _add(H, g, (i, j), r=T_i @ p - T_j @ q, arms=(p @ R[i].T, q @ R[j].T))
        step = -np.linalg.solve(H, g).reshape(count, 6)
        R, t = proper(so3_exp(step[:, ROTATION]) @ R), t + step[:, TRANSLATION]
        if (
            np.abs(step[:, TRANSLATION]).max() < GLOBAL_ICP.small_m
            and np.abs(step[:, ROTATION]).max() < GLOBAL_ICP.small_rad
        ):
            break
    return SE3(R, t)


def _add(H: Array, g: Array, link: tuple[int, int], *, r: Array, arms: tuple[Array, Array]) -> None:
    """Add the normal equations of the pairs of one link.

    Args:
        H: Of all sweeps, added to, (6 N, 6 N).
        g: Likewise, (6 N,).
        link: The two sweeps.
        r: Point of the first minus point of the second [m], (M, 3).
        arms: The points from the position of their sweep, in the map's axes, (M, 3) each.
    """
    jacobians = (_jacobian(arms[0]), -_jacobian(arms[1]))
    for a, J_a in zip(link, jacobians, strict=True):
        rows = slice(6 * a, 6 * a + 6)
        g[rows] += np.einsum("nri,nr->i", J_a, r)
        for b, J_b in zip(link, jacobians, strict=True):
            H[rows, 6 * b : 6 * b + 6] += np.einsum("nri,nrj->ij", J_a, J_b)


def _jacobian(arm: Array) -> Array:
    """Motion of points by a rotation about the pose's position and a shift, (N, 3, 6)."""
    J = np.zeros((len(arm), 3, 6))
    J[:, 0, 1], J[:, 0, 2] = arm[:, 2], -arm[:, 1]
    J[:, 1, 0], J[:, 1, 2] = -arm[:, 2], arm[:, 0]
    J[:, 2, 0], J[:, 2, 1] = arm[:, 1], -arm[:, 0]
    J[:, [0, 1, 2], [3, 4, 5]] = 1.0
    return J
