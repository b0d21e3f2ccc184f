"""Normal equations of a rig from one window: planes and trajectory are eliminated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.imu_rows import BIASES, WindowBiases, imu_rows
from recon4.calibration.parameters import Parameters
from recon4.calibration.purity import distance_sd_m, only_own_points
from recon4.calibration.surfaces import SharedSurfaces, find_surfaces
from recon4.calibration.tuning_joint import EQUATIONS
from recon4.calibration.window import Window, place
from recon4.geometry.se3 import Array
from recon4.kernels.calibration import (
    PlacedPoints,
    PlanesOfPoints,
    PointSums,
    RigColumns,
    add_points,
)
from recon4.model.rig import Rig
from recon4.registration.tuning import OdometryTuning
from recon4.units import STANDARD_GRAVITY_M_S2


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
    pure: bool = False
    """Whether points of other surfaces are left out, and points count by their incidence: only
    near the right rig, where a point lies within some standard deviations of its plane."""
    every: int = 1
    """Only every so-many-th point is used: fewer are enough on the way to the solution."""


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


def reduce_window(
    state: WindowState,
    rig: Rig,
    parameters: Parameters,
    *,
    settings: OdometryTuning,
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
    window = state.window.thinned(bounds.every)
    placed = place(window, rig)
    surfaces = find_surfaces(
        placed.odom, window.sensor,
        cube_m=bounds.cube_m, max_sd_m=bounds.max_sd_m, gate_m=bounds.gate_m,
    )  # fmt: skip
    if bounds.pure:
        surfaces = only_own_points(surfaces, placed.odom, placed.beam_odom, cube_m=bounds.cube_m)
    if len(surfaces) == 0:
        return None
    own = state.unknowns
    H, g = np.zeros((own + len(parameters),) * 2), np.zeros(own + len(parameters))
    normal = _NormalEquations(H, g, parameters, rig)
    r, weight = _add_points(normal, window, placed, surfaces=surfaces, bounds=bounds)
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
    bounds: RoundBounds,
) -> tuple[Array, Array]:
    """Add the points, the planes eliminated; returns their distances and weights, (M,) each."""
    H, g = equations.H, equations.g
    sd_m = np.full(len(surfaces.point), EQUATIONS.point_sd_m)
    if bounds.pure:
        sd_m = distance_sd_m(surfaces, placed.beam_odom)
    mixed = np.zeros((len(surfaces), 3, len(H)))
    of_planes, pull = np.zeros((len(surfaces), 3, 3)), np.zeros((len(surfaces), 3))
    r, weight = add_points(
        placed,
        PlanesOfPoints(
            surfaces.point, surfaces.plane,
            surfaces.center, surfaces.normal, _tangents(surfaces.normal),
        ),
        _columns(equations, window),
        PointSums(H, g, mixed, of_planes, pull),
        sd_m, bounds.kernel_m, EQUATIONS.grazing,
    )  # fmt: skip
    H += np.triu(H, 1).T
    inverse = np.linalg.inv(of_planes + EQUATIONS.plane_prior * np.eye(3))
    flat, solved = mixed.reshape(-1, len(H)), inverse @ mixed
    H -= flat.T @ solved.reshape(-1, len(H))
    g -= flat.T @ (inverse @ pull[:, :, None]).ravel()
    return r, weight


def _columns(equations: _NormalEquations, window: Window) -> RigColumns:
    """Where the parameters of each LiDAR stand."""
    parameters, mounts = equations.parameters, equations.rig.T_body_sensor.R
    first = 6 * window.knots + BIASES
    mount = np.full(len(mounts), -1)
    beams, beam_count = np.zeros(len(mounts), np.int64), np.zeros(len(mounts), np.int64)
    for row in parameters.lidars:
        mount[row] = first + parameters.of_lidar(row).start
    for row, count in parameters.beams:
        beams[row], beam_count[row] = first + parameters.of_beams(row).start, count
    return RigColumns(window.sensor, window.ring, mount, beams, beam_count, mounts)


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
    equations: _NormalEquations, state: WindowState, rig: Rig, *, settings: OdometryTuning
) -> float:
    """Add IMU and priors of the motion; returns the root mean square residual of the IMU."""
    H, g, parameters = equations.H, equations.g, equations.parameters
    knots, own = state.window.knots, state.unknowns
    diagonal = np.einsum("ii->i", H)
    diagonal[: 6 * knots] += np.tile(np.repeat(EQUATIONS.knot_sd, 3) ** -2.0, knots)
    diagonal[:6] += EQUATIONS.fixed
    diagonal[6 * knots : own] += np.repeat(EQUATIONS.bias_sd, 3) ** -2.0
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
    direction = biases.gravity_m_s2 / length / EQUATIONS.gravity_sd_m_s2
    rows = slice(first, first + 3)
    H[rows, rows] += np.outer(direction, direction)
    g[rows] += direction * (length - STANDARD_GRAVITY_M_S2) / EQUATIONS.gravity_sd_m_s2


def _add_chain(H: Array, knots: int) -> None:
    """Without an IMU neighboring knots are corrected alike."""
    weight = np.diag(np.repeat(EQUATIONS.chain_sd, 3) ** -2.0)
    for k in range(knots - 1):
        a, b = slice(6 * k, 6 * k + 6), slice(6 * k + 6, 6 * k + 12)
        H[a, a] += weight
        H[b, b] += weight
        H[a, b] -= weight
        H[b, a] -= weight
