"""Normal equations of a rig from one window: planes and trajectory are eliminated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.imu_rows import BIASES, WindowBiases, imu_rows
from recon4.calibration.parameters import Parameters
from recon4.calibration.surfaces import SharedSurfaces, find_surfaces
from recon4.calibration.window import PlacedPoints, Window, place
from recon4.geometry.se3 import Array
from recon4.kernels.calibration import accumulate_point_rows
from recon4.model.rig import Rig
from recon4.model.samples import STANDARD_GRAVITY_M_S2
from recon4.settings import OdometrySettings

_POINT_SD_M = 0.015
_GRAZING = 0.15
"""Cosine of the incidence below which a range hardly tells the distance from a plane."""
_COLUMNS = 19
"""What a point depends on: two knots, mount and clock of its LiDAR."""
_KNOT_SD = np.repeat([0.05, 0.3], 3)
"""Of a knot's step in one round: rotation [rad], position [m]."""
_CHAIN_SD = np.repeat([3e-4, 1e-3], 3)
"""Without an IMU: change of the correction from knot to knot, rotation [rad], position [m]."""
_BIAS_SD = np.repeat([0.1, 0.3, 2.0], 3)
"""Biases of gyroscope [rad/s] and accelerometer [m/s²], gravity [m/s²]."""
_GRAVITY_SD_M_S2 = 0.02
_FIXED = 1e8
"""Information of the first knot: a window floats freely, so one pose is fixed."""
_PLANE_PRIOR = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class RoundBounds:
    """Bounds of one round; they become tighter as the rig becomes better."""

    cube_m: float
    """Edge of the cubes in which planes are looked for."""
    max_sd_m: float
    """Largest standard deviation of the points of one LiDAR across its plane."""
    gate_m: float
    """Largest distance between the planes of two LiDARs in a cube."""
    kernel_m: float
    """Scale of the Cauchy kernel on the distance of a point."""


@dataclass(frozen=True, slots=True, eq=False)
class WindowState:
    """A window with its current estimates."""

    window: Window
    biases: WindowBiases

    @property
    def unknowns(self) -> int:
        """Number of its own parameters: six for each knot, biases and gravity."""
        return 6 * self.window.knots + BIASES


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """How well one window is explained, before the step."""

    points: int
    """Points on planes."""
    shared_points: int
    """Points on planes that several LiDARs see."""
    rms_m: float
    """Of their distances, robustly weighted [m]."""
    offset_m: float
    """Of one surface as two LiDARs see it, root mean square [m]; NaN = none is seen by two."""
    imu_rms: float
    """Of the residuals of the IMU, each divided by its standard deviation; NaN = no IMU."""


@dataclass(frozen=True, slots=True, eq=False)
class Reduced:
    """Normal equations of the rig from one window, and how to get its own unknowns back."""

    H: Array
    """Information of the rig's parameters, (P, P)."""
    g: Array
    """Gradient, (P,)."""
    own: Array
    """Step of the window's unknowns where the rig does not change, (Q,)."""
    coupling: Array
    """Their change by the rig's parameters, (Q, P)."""
    fit: Fit

    def step(self, delta: Array) -> Array:
        """Step of the window's unknowns for a step of the rig."""
        return self.own + self.coupling @ delta


@dataclass(frozen=True, slots=True, eq=False)
class _NormalEquations:
    """Of the unknowns of a window and the parameters of the rig; filled in place."""

    H: Array
    """Information, (Q + P, Q + P)."""
    g: Array
    """Gradient, (Q + P,)."""
    parameters: Parameters
    """The last P unknowns."""
    rig: Rig
    """Current mounts and clocks."""


@dataclass(frozen=True, slots=True, eq=False)
class _OnPlanes:
    """Points that lie on planes."""

    row: NDArray[np.intp]
    """Among the points of the window, (M,)."""
    normal: Array
    """Of the plane of each, (M, 3)."""
    back_m: Array
    """How much farther the plane is along the beam [m], (M,)."""


def reduce_window(
    state: WindowState,
    rig: Rig,
    parameters: Parameters,
    *,
    settings: OdometrySettings,
    bounds: RoundBounds,
) -> Reduced | None:
    """Normal equations of the rig from one window; None if nothing lies on planes.

    Args:
        state: The window with its trajectory and biases.
        rig: Current mounts and clocks.
        parameters: What is estimated of it.
        settings: Noise of the IMU.
        bounds: Of this round.
    """
    window = state.window
    placed = place(window, rig)
    surfaces = find_surfaces(
        placed.odom, window.sensor,
        cube_m=bounds.cube_m, max_sd_m=bounds.max_sd_m, gate_m=bounds.gate_m,
    )  # fmt: skip
    if len(surfaces) == 0:
        return None
    own = state.unknowns
    H, g = np.zeros((own + len(parameters),) * 2), np.zeros(own + len(parameters))
    normal = _NormalEquations(H, g, parameters, rig)
    r, weight = _add_points(normal, window, placed, surfaces=surfaces, kernel_m=bounds.kernel_m)
    imu_rms = _add_motion(normal, state, rig, settings=settings)
    right = np.column_stack([H[:own, own:], g[:own]])
    solved: Array = np.asarray(np.linalg.solve(H[:own, :own], right), np.float64)
    coupling, step = -solved[:, :-1], -solved[:, -1]
    fit = Fit(
        points=len(r),
        shared_points=int(np.count_nonzero(surfaces.shared[surfaces.plane])),
        rms_m=float(np.sqrt(np.sum(weight * r**2) / np.sum(weight))),
        offset_m=_offset_m(surfaces, window.sensor[surfaces.point], r),
        imu_rms=imu_rms,
    )
    return Reduced(
        H[own:, own:] + H[own:, :own] @ coupling, g[own:] + H[own:, :own] @ step,
        step, coupling, fit,
    )  # fmt: skip


def _add_points(
    equations: _NormalEquations,
    window: Window,
    placed: PlacedPoints,
    *,
    surfaces: SharedSurfaces,
    kernel_m: float,
) -> tuple[Array, Array]:
    """Add the points, the planes eliminated; returns their distances and weights, (M,) each."""
    H, g = equations.H, equations.g
    rows, plane = surfaces.point, surfaces.plane
    normal = surfaces.normal[plane]
    away = placed.odom[rows] - surfaces.center[plane]
    r: Array = np.sum(normal * away, axis=1)
    back = _onto_planes(placed, rows, normal=normal, r=r)
    away = away + back[:, None] * placed.beam_odom[rows]
    on_planes = _OnPlanes(rows, normal, back)
    columns, values = _derivatives(window, placed, on_planes, equations=equations)
    weight = 1.0 / (_POINT_SD_M**2 * (1.0 + (r / kernel_m) ** 2))
    tangents = _tangents(surfaces.normal)[plane]
    plane_values = np.column_stack([np.einsum("nij,ni->nj", tangents, away), -np.ones(len(rows))])
    mixed = np.zeros((len(surfaces), 3, len(H)))
    of_planes, pull = np.zeros((len(surfaces), 3, 3)), np.zeros((len(surfaces), 3))
    accumulate_point_rows(
        columns, values, weight, r, plane, plane_values, H, g, mixed, of_planes, pull
    )
    H += np.triu(H, 1).T
    solved = np.linalg.solve(
        of_planes + _PLANE_PRIOR * np.eye(3), np.concatenate([mixed, pull[:, :, None]], axis=2)
    )
    flat = mixed.reshape(-1, len(H))
    H -= flat.T @ solved[:, :, :-1].reshape(-1, len(H))
    g -= flat.T @ solved[:, :, -1].ravel()
    return r, weight


def _onto_planes(placed: PlacedPoints, rows: NDArray[np.intp], *, normal: Array, r: Array) -> Array:
    """By how much each range would have to grow for the point to lie on its plane [m], (M,).

    Derivatives at the measured points would depend on their noise, which biases the estimate.
    """
    along = np.sum(placed.beam_odom[rows] * normal, axis=1)
    along = np.where(np.abs(along) < _GRAZING, np.copysign(_GRAZING, along), along)
    return np.asarray(-r / along)


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


def _derivatives(
    window: Window, placed: PlacedPoints, on: _OnPlanes, *, equations: _NormalEquations
) -> tuple[NDArray[np.int64], Array]:
    """Columns and derivatives of the distances of points from fixed planes, (M, K) each.

    K = 19, and 22 with the beams.
    """
    parameters, rows, normal, back = equations.parameters, on.row, on.normal, on.back_m
    knot, s = placed.knot[rows], placed.fraction[rows, None]
    beam_body = _unit(placed.sensor_arm_body[rows])
    arm_odom = placed.arm_odom[rows] + back[:, None] * placed.beam_odom[rows]
    of_pose = np.concatenate([np.cross(arm_odom, normal), normal], axis=1)
    six = np.arange(6)
    size = _COLUMNS + 3 * bool(parameters.beams)
    columns = np.full((len(rows), size), -1, np.int64)
    values = np.zeros((len(rows), size))
    columns[:, :6], values[:, :6] = 6 * knot[:, None] + six, (1.0 - s) * of_pose
    columns[:, 6:12], values[:, 6:12] = 6 * (knot[:, None] + 1) + six, s * of_pose
    normal_body = np.einsum("nij,ni->nj", placed.R_odom_body[rows], normal)
    values[:, 12:15] = np.cross(
        placed.sensor_arm_body[rows] + back[:, None] * beam_body, normal_body
    )
    values[:, 15:18] = normal_body
    values[:, 18] = np.sum(placed.velocity_odom[rows] * normal, axis=1)
    first = 6 * window.knots + BIASES
    for row in parameters.lidars:
        part = parameters.of_lidar(row)
        columns[window.sensor[rows] == row, 12:19] = first + np.arange(part.start, part.stop)
    for row, count in parameters.beams:
        mine = (window.sensor[rows] == row) & (window.ring[rows] < count)
        ring = window.ring[rows[mine]].astype(np.int64)
        beam = first + parameters.of_beams(row).start + ring
        columns[mine, _COLUMNS:] = beam[:, None] + count * np.arange(3)
        R_odom_sensor = placed.R_odom_body[rows[mine]] @ equations.rig.sensors[row].T_body_sensor.R
        normal_sensor = np.einsum("nij,ni->nj", R_odom_sensor, normal[mine])
        p_sensor = placed.p_sensor[rows[mine]]
        p_sensor = p_sensor + back[mine, None] * _unit(p_sensor)
        values[mine, _COLUMNS:] = _of_beams(p_sensor, normal_sensor)
    return columns, values


def _of_beams(p_sensor: Array, normal_sensor: Array) -> Array:
    """Derivatives of the distance by range, elevation and azimuth of the beam, (M, 3)."""
    x, y, z = p_sensor.T
    flat = np.hypot(x, y)
    upwards = np.stack([-z * x / flat, -z * y / flat, flat], axis=1)
    sideways = np.stack([-y, x, np.zeros_like(x)], axis=1)
    directions = np.stack([_unit(p_sensor), upwards, sideways], axis=1)
    return np.asarray(np.einsum("nij,nj->ni", directions, normal_sensor))


def _tangents(normal: Array) -> Array:
    """Two unit vectors along each plane, (V, 3, 2)."""
    smallest = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = np.cross(normal, smallest)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(normal, first)], axis=2)


def _offset_m(surfaces: SharedSurfaces, sensor: NDArray[np.uint8], r: Array) -> float:
    """Root mean square distance between one surface as seen by two LiDARs [m]."""
    sensors = int(sensor.max()) + 1
    listed, group = np.unique(surfaces.plane * sensors + sensor, return_inverse=True)
    mean = np.bincount(group, r) / np.bincount(group)
    plane = listed // sensors
    same = np.flatnonzero(plane[1:] == plane[:-1])
    return float(np.sqrt(np.mean((mean[same + 1] - mean[same]) ** 2))) if len(same) else np.nan


def _add_motion(
    equations: _NormalEquations, state: WindowState, rig: Rig, *, settings: OdometrySettings
) -> float:
    """Add IMU and priors of the motion; returns the root mean square residual of the IMU."""
    H, g, parameters = equations.H, equations.g, equations.parameters
    knots, own = state.window.knots, state.unknowns
    diagonal = np.einsum("ii->i", H)
    diagonal[: 6 * knots] += np.tile(_KNOT_SD**-2.0, knots)
    diagonal[:6] += _FIXED
    diagonal[6 * knots : own] += _BIAS_SD**-2.0
    found = imu_rows(state.window, rig, state.biases, settings=settings)
    if found is None:
        _add_chain(H, knots)
        return float("nan")
    columns = np.arange(own)
    if parameters.imu:
        part = parameters.of_imu
        columns = np.append(columns, own + np.arange(part.start, part.stop))
    J = found.J[:, : len(columns)]
    H[np.ix_(columns, columns)] += J.T @ J
    g[columns] += J.T @ found.r
    _add_gravity(H, g, state.biases, first=own - 3)
    return float(np.sqrt(np.mean(found.r**2)))


def _add_gravity(H: Array, g: Array, biases: WindowBiases, *, first: int) -> None:
    """The length of gravity is known; its direction is not."""
    length = float(np.linalg.norm(biases.gravity_m_s2))
    direction = biases.gravity_m_s2 / length / _GRAVITY_SD_M_S2
    rows = slice(first, first + 3)
    H[rows, rows] += np.outer(direction, direction)
    g[rows] += direction * (length - STANDARD_GRAVITY_M_S2) / _GRAVITY_SD_M_S2


def _add_chain(H: Array, knots: int) -> None:
    """Without an IMU neighboring knots are corrected alike."""
    weight = np.diag(_CHAIN_SD**-2.0)
    for k in range(knots - 1):
        a, b = slice(6 * k, 6 * k + 6), slice(6 * k + 6, 6 * k + 12)
        H[a, a] += weight
        H[b, b] += weight
        H[a, b] -= weight
        H[b, a] -= weight
