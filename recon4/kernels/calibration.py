"""Kernel of calibration: normal equations of points on planes, the planes eliminated later."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.imu import turns_between

_COLUMNS = 22
"""What a point depends on: two knots (6 each), mount and clock of its LiDAR (7), its beam (3)."""


class PlacedPoints(NamedTuple):
    """Points of a window, placed with a rig."""

    odom: NDArray[np.float64]
    """In the odometry frame [m], (N, 3)."""
    arm_odom: NDArray[np.float64]
    """From the body to the point, in odometry axes [m], (N, 3)."""
    R_odom_body: NDArray[np.float64]
    """Rotation at the time of the point, (N, 3, 3)."""
    p_sensor: NDArray[np.float64]
    """In the frame of the sensor, beams corrected [m], (N, 3)."""
    beam_odom: NDArray[np.float64]
    """Unit vectors from the sensor to the point, in odometry axes, (N, 3)."""
    sensor_arm_body: NDArray[np.float64]
    """From the sensor to the point, in body axes [m], (N, 3)."""
    velocity_odom: NDArray[np.float64]
    """Of a point fixed to the body [m/s], (N, 3): how a late clock moves it."""
    knot: NDArray[np.int64]
    """The knot before, (N,)."""
    fraction: NDArray[np.float64]
    """Time since that knot as a part of the interval, 0..1, (N,)."""


class PlanesOfPoints(NamedTuple):
    """Points that lie on planes."""

    point: NDArray[np.int64]
    """Row of each point, (M,)."""
    plane: NDArray[np.int64]
    """Row of the plane of each, (M,)."""
    center: NDArray[np.float64]
    """Of each plane [m], (V, 3)."""
    normal: NDArray[np.float64]
    """Unit normals, (V, 3)."""
    tangents: NDArray[np.float64]
    """Two unit vectors along each plane, (V, 3, 2)."""


class RigColumns(NamedTuple):
    """Where the parameters of the LiDARs stand among the unknowns."""

    sensor: NDArray[np.uint8]
    """LiDAR of each point, (N,)."""
    ring: NDArray[np.uint8]
    """Beam of each point, (N,)."""
    mount: NDArray[np.int64]
    """First column of mount and clock of each LiDAR; -1 = not estimated, (S,)."""
    beams: NDArray[np.int64]
    """First column of the beams of each LiDAR, (S,)."""
    beam_count: NDArray[np.int64]
    """Number of beams that are estimated, (S,)."""
    R_body_sensor: NDArray[np.float64]
    """Rotations of the mounts, (S, 3, 3)."""


class PointSums(NamedTuple):
    """Normal equations of the unknowns and of the planes; added to."""

    H: NDArray[np.float64]
    """Upper triangle of ``J^T W J`` of the unknowns, (P, P)."""
    g: NDArray[np.float64]
    """``J^T W r``, (P,)."""
    B: NDArray[np.float64]
    """Mixed terms ``J_plane^T W J``, (V, 3, P)."""
    C: NDArray[np.float64]
    """``J_plane^T W J_plane``, (V, 3, 3)."""
    c: NDArray[np.float64]
    """``J_plane^T W r``, (V, 3)."""


@njit(cache=True, nogil=True, error_model="numpy")
def add_points(
    placed: PlacedPoints,
    planes: PlanesOfPoints,
    rig: RigColumns,
    sums: PointSums,
    sd_m: NDArray[np.float64],
    kernel_m: float,
    grazing: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Add the distances of points from planes to the normal equations.

    Derivatives are those where the beam would meet the plane: at the measured points they would
    depend on their noise, which biases the estimate.

    Args:
        placed: The points.
        planes: On which plane each lies.
        rig: Columns of the parameters.
        sums: What is added to.
        sd_m: Standard deviation of each distance [m], (M,).
        kernel_m: Scale of the Cauchy kernel [m].
        grazing: Least cosine of the incidence: a range hardly tells the distance below it.

    Returns:
        Distances [m] and weights, (M,) each.
    """
    count = len(planes.point)
    residual, weight = np.empty(count), np.empty(count)
    columns, values, of_plane = np.empty(_COLUMNS, np.int64), np.empty(_COLUMNS), np.empty(3)
    for m in range(count):
        n, v = planes.point[m], planes.plane[m]
        r = 0.0
        for i in range(3):
            r += planes.normal[v, i] * (placed.odom[n, i] - planes.center[v, i])
        used = _row_of_point(placed, planes, rig, n, v, r, grazing, columns, values, of_plane)
        w = 1.0 / (sd_m[m] * sd_m[m] * (1.0 + (r / kernel_m) ** 2))
        residual[m], weight[m] = r, w
        _add_row(sums, columns, values, of_plane, used, v, r, w)
    return residual, weight


@njit(cache=True, nogil=True, error_model="numpy")
def _row_of_point(placed, planes, rig, n, v, r, grazing, columns, values, of_plane):  # type: ignore[no-untyped-def]
    """Columns and derivatives of one distance; returns how many there are."""
    normal = planes.normal[v]
    along = 0.0
    for i in range(3):
        along += placed.beam_odom[n, i] * normal[i]
    if abs(along) < grazing:
        along = grazing if along >= 0.0 else -grazing
    back = -r / along
    _cross(placed.arm_odom[n], placed.beam_odom[n], back, normal, values[0:3])
    s, knot = placed.fraction[n], placed.knot[n]
    for i in range(3):
        values[3 + i] = normal[i]
    for i in range(6):
        columns[i], columns[6 + i] = 6 * knot + i, 6 * knot + 6 + i
        values[6 + i] = s * values[i]
        values[i] *= 1.0 - s
    for j in range(2):
        of_plane[j] = 0.0
    for i in range(3):
        away = placed.odom[n, i] - planes.center[v, i] + back * placed.beam_odom[n, i]
        for j in range(2):
            of_plane[j] += planes.tangents[v, i, j] * away
    of_plane[2] = -1.0
    used = 12
    row = rig.sensor[n]
    with_beam = rig.ring[n] < rig.beam_count[row]
    if rig.mount[row] < 0 and not with_beam:
        return used
    normal_body = placed.R_odom_body[n].T @ normal
    if rig.mount[row] >= 0:
        arm = placed.sensor_arm_body[n]
        _cross(arm, arm / np.linalg.norm(arm), back, normal_body, values[12:15])
        values[18] = 0.0
        for i in range(3):
            values[15 + i] = normal_body[i]
            values[18] += placed.velocity_odom[n, i] * normal[i]
        for i in range(7):
            columns[12 + i] = rig.mount[row] + i
        used = 19
    if with_beam:
        normal_sensor = rig.R_body_sensor[row].T @ normal_body
        _of_beam(placed.p_sensor[n], back, normal_sensor, values[used : used + 3])
        for i in range(3):
            columns[used + i] = rig.beams[row] + rig.ring[n] + i * rig.beam_count[row]
        used += 3
    return used


@njit(cache=True, nogil=True, error_model="numpy")
def _cross(arm, beam, back, normal, out):  # type: ignore[no-untyped-def]
    """``(arm + back beam) x normal``."""
    x, y, z = arm[0] + back * beam[0], arm[1] + back * beam[1], arm[2] + back * beam[2]
    out[0] = y * normal[2] - z * normal[1]
    out[1] = z * normal[0] - x * normal[2]
    out[2] = x * normal[1] - y * normal[0]


@njit(cache=True, nogil=True, error_model="numpy")
def _of_beam(p, back, normal, out):  # type: ignore[no-untyped-def]
    """Derivatives of the distance by range, elevation and azimuth of the beam."""
    length = np.linalg.norm(p)
    x, y, z = p * (1.0 + back / length)
    flat = np.hypot(x, y)
    out[0] = (p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2]) / length
    out[1] = flat * normal[2] - z / flat * (x * normal[0] + y * normal[1])
    out[2] = x * normal[1] - y * normal[0]


@njit(cache=True, nogil=True, error_model="numpy")
def _add_row(sums, columns, values, of_plane, used, v, r, w):  # type: ignore[no-untyped-def]
    """Add one row; columns increase."""
    H, g, B, C, c = sums
    for i in range(3):
        c[v, i] += w * of_plane[i] * r
        for j in range(3):
            C[v, i, j] += w * of_plane[i] * of_plane[j]
    for a in range(used):
        row = columns[a]
        scaled = w * values[a]
        g[row] += scaled * r
        for i in range(3):
            B[v, i, row] += scaled * of_plane[i]
        for b in range(a, used):
            H[row, columns[b]] += scaled * values[b]


@njit(cache=True, nogil=True, error_model="numpy")
def place_with_velocity(
    t_s: NDArray[np.float64],
    R: NDArray[np.float64],
    p: NDArray[np.float64],
    t_points: NDArray[np.float64],
    points: NDArray[np.float64],
    half_s: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Place points, and say how their body turns and moves.

    Between two poses the position is interpolated and the rotation is SLERP.

    Args:
        t_s: Times of the poses, increasing [s], (K,).
        R: Rotations, (K, 3, 3).
        p: Positions [m], (K, 3).
        t_points: Times of the points [s], (N,).
        points: In the body [m], (N, 3).
        half_s: Half of the time over which a velocity is taken [s].

    Returns:
        Placed points [m], (N, 3), rotations of the body, (N, 3, 3), velocities of points that are
        fixed to the body [m/s], (N, 3).
    """
    turns = turns_between(R)
    count = len(points)
    placed, velocity = np.empty((count, 3)), np.empty((count, 3))
    rotations = np.empty((count, 3, 3))
    before, after, M = np.empty(3), np.empty(3), np.empty((3, 3))
    for n in range(count):
        t, point = t_points[n], points[n]
        _place(t_s, R, p, turns, t - half_s, point, M, before)
        _place(t_s, R, p, turns, t + half_s, point, M, after)
        _place(t_s, R, p, turns, t, point, rotations[n], placed[n])
        for i in range(3):
            velocity[n, i] = (after[i] - before[i]) / (2.0 * half_s)
    return placed, rotations, velocity


@njit(cache=True, nogil=True, error_model="numpy")
def _place(t_s, R, p, turns, t, point, rotation, placed):  # type: ignore[no-untyped-def]
    """Rotation of the body at a time, and a point of it."""
    k = min(max(np.searchsorted(t_s, t, side="right") - 1, 0), len(turns) - 1)
    s = (t - t_s[k]) / (t_s[k + 1] - t_s[k])
    x, y, z = s * turns[k, 0], s * turns[k, 1], s * turns[k, 2]
    angle_sq = x * x + y * y + z * z
    # Taylor series: exact to 1e-10 rad for the less than 0.3 rad between two poses.
    a = 1.0 - angle_sq / 6.0 * (1.0 - angle_sq / 20.0 * (1.0 - angle_sq / 42.0))
    b = 0.5 - angle_sq / 24.0 * (1.0 - angle_sq / 30.0 * (1.0 - angle_sq / 56.0))
    for i in range(3):
        r0, r1, r2 = R[k, i, 0], R[k, i, 1], R[k, i, 2]
        c0, c1, c2 = r1 * z - r2 * y, r2 * x - r0 * z, r0 * y - r1 * x
        rotation[i, 0] = r0 + a * c0 + b * (c1 * z - c2 * y)
        rotation[i, 1] = r1 + a * c1 + b * (c2 * x - c0 * z)
        rotation[i, 2] = r2 + a * c2 + b * (c0 * y - c1 * x)
        placed[i] = (
            rotation[i, 0] * point[0] + rotation[i, 1] * point[1] + rotation[i, 2] * point[2]
            + p[k, i] + s * (p[k + 1, i] - p[k, i])
        )  # fmt: skip
