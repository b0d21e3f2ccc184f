"""Coarse mounts of LiDARs from any start: axes exchanged, upside down, mounts swapped.

The reference LiDAR alone gives a trajectory and a map of some seconds. The other LiDAR is placed
on it with every mount that a wrong rig file may mean, and registered; the one that fits best wins.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations, product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from recon4.calibration.tuning_methods import MOUNT_SEARCH
from recon4.calibration.window import Window
from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, proper, so3_exp
from recon4.kernels.scans import neighbor_normals
from recon4.model.rig import Rig


@dataclass(frozen=True, slots=True, eq=False)
class _WindowClouds:
    """Some seconds of the walk: a map of the reference, and the points of the other LiDAR."""

    tree: cKDTree
    normals: Array
    p_sensor: Array
    """Points of the other LiDAR in its own frame [m], (N, 3)."""
    T_odom_body: SE3
    """Poses at their times, (N,)."""


def search_mounts(windows: Sequence[Window], rig: Rig, *, reference: int) -> list[Rig]:
    """Rigs with other mounts that explain some windows, the best one first.

    Args:
        windows: Tracked with the reference LiDAR alone.
        rig: Where to begin.
        reference: Row of the LiDAR whose mount stays.
    """
    ranked: dict[int, list[SE3]] = {}
    for row, sensor in enumerate(rig.sensors):
        if row != reference and sensor.enabled:
            clouds = [
                cloud for window in windows if (cloud := _window_clouds(window, reference, row))
            ]
            if clouds:
                ranked[row] = _ranked(clouds, _candidates(rig, row, reference))
    return [_with_mounts(rig, {row: mounts[k] for row, mounts in ranked.items()})
            for k in range(MOUNT_SEARCH.ranked if ranked else 0)]  # fmt: skip


def without_others(rig: Rig, reference: int) -> Rig:
    """The rig with one LiDAR only enabled."""
    sensors = tuple(
        replace(sensor, enabled=sensor.enabled and row == reference)
        for row, sensor in enumerate(rig.sensors)
    )
    return replace(rig, sensors=sensors)


def _with_mounts(rig: Rig, mounts: Mapping[int, SE3]) -> Rig:
    sensors = tuple(
        replace(sensor, T_body_sensor=mounts.get(row, sensor.T_body_sensor))
        for row, sensor in enumerate(rig.sensors)
    )
    return replace(rig, sensors=sensors)


def axis_rotations() -> Iterator[Array]:
    """The 24 rotations that exchange axes, (3, 3) each; the identity comes first."""
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            R = np.eye(3)[list(order)] * np.array(signs)[:, None]
            if np.linalg.det(R) > 0.0:
                yield R


def _candidates(rig: Rig, row: int, reference: int) -> list[SE3]:
    """The rig file's mount, that after an exchange with the reference, then exchanged axes."""
    own = rig.sensors[row].T_body_sensor
    turned = [SE3(own.R @ R, own.t) for R in axis_rotations()]
    return [own, exchanged_mount(rig, row, reference), *turned[1:]]


def exchanged_mount(rig: Rig, row: int, reference: int) -> SE3:
    """Mount of a LiDAR if its mount and that of the reference are exchanged in the rig file.

    The reference keeps the mount in the file, so the other one moves instead.
    """
    own, of_reference = (rig.sensors[k].T_body_sensor for k in (row, reference))
    return of_reference @ (own.inverse() @ of_reference)


def _window_clouds(window: Window, reference: int, row: int) -> _WindowClouds | None:
    T_body = window.recorded_rig.sensors[reference].T_body_sensor
    of_map, of_other = window.sensor == reference, window.sensor == row
    if of_map.sum() < MOUNT_SEARCH.source_points or of_other.sum() < MOUNT_SEARCH.neighbors:
        return None
    p_map = _poses(window, of_map) @ (T_body @ window.p_sensor[of_map])
    _, first = np.unique(
        np.floor(p_map / MOUNT_SEARCH.voxel_m).astype(np.int64), axis=0, return_index=True
    )
    p_map = np.ascontiguousarray(p_map[np.sort(first)])
    tree = cKDTree(p_map)
    normals = np.zeros_like(p_map)
    neighbor_normals(p_map, tree.query(p_map, MOUNT_SEARCH.neighbors)[1], normals)
    rows = np.flatnonzero(of_other)
    rows = rows[:: max(1, len(rows) // MOUNT_SEARCH.source_points)]
    return _WindowClouds(tree, normals, window.p_sensor[rows], _poses(window, rows))


def _poses(window: Window, rows: NDArray[Any]) -> SE3:
    t_ns = window.start_ns + np.rint(window.t_s[rows] * 1e9).astype(np.int64)
    return window.trajectory.at(t_ns, slack_ns=10**8)


def _ranked(clouds: Sequence[_WindowClouds], candidates: Sequence[SE3]) -> list[SE3]:
    """The registered candidates with the largest inlier ratios, best first."""
    found = [_register(clouds, candidate) for candidate in candidates]
    order = np.argsort([-ratio for _, ratio in found], kind="stable")
    return [found[k][0] for k in order[: MOUNT_SEARCH.ranked]]


def _register(clouds: Sequence[_WindowClouds], T_body_sensor: SE3) -> tuple[SE3, float]:
    """Point-to-plane registration of a mount, and the ratio of points on the map afterwards."""
    T, inliers, total = T_body_sensor, 0, 0
    for gate_m in MOUNT_SEARCH.gates_m:
        H, g, inliers, total = np.zeros((6, 6)), np.zeros(6), 0, 0
        for cloud in clouds:
            arm = cloud.p_sensor @ T.R.T
            q = cloud.T_odom_body @ (arm + T.t)
            near, row = cloud.tree.query(q, distance_upper_bound=gate_m)
            kept = np.isfinite(near)
            n = cloud.normals[row[kept]]
            r = np.sum(n * (q[kept] - cloud.tree.data[row[kept]]), axis=1)
            n_body = np.einsum("nij,ni->nj", cloud.T_odom_body.R[kept], n)
            J = np.concatenate([np.cross(arm[kept], n_body), n_body], axis=1)
            w = 1.0 / (1.0 + (r / (0.3 * gate_m)) ** 2)
            H += (J * w[:, None]).T @ J
            g += J.T @ (w * r)
            inliers += int(np.count_nonzero(np.abs(r) < MOUNT_SEARCH.inlier_m))
            total += len(q)
        step = -np.linalg.solve(H + 1e-6 * (1.0 + np.trace(H)) * np.eye(6), g)
        T = SE3(proper(so3_exp(step[ROTATION]) @ T.R), T.t + step[TRANSLATION])
    return T, inliers / max(total, 1)
