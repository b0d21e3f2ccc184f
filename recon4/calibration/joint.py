"""Joint calibration: mounts and clocks together with the trajectory, from windows of a walk.

In each window all points that lie on common planes, whichever LiDAR saw them, and the samples of
the IMU are explained by one trajectory, one set of planes and one rig. Planes and trajectory are
eliminated (Schur complement); what remains are normal equations of the rig alone, which add up
over the windows (Liu 2021, BALM; Furgale 2013, continuous time).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from recon4.calibration.imu_rows import BIASES, WindowBiases, imu_rows
from recon4.calibration.parameters import Parameters
from recon4.calibration.surfaces import Surfaces, find_surfaces
from recon4.calibration.window import PlacedPoints, Window, place, with_trajectory
from recon4.geometry.se3 import Array
from recon4.kernels.calibration import accumulate_point_rows
from recon4.model.rig import Rig
from recon4.model.samples import STANDARD_GRAVITY_M_S2
from recon4.semi_rigid.knots import apply_knots
from recon4.settings import Settings


@dataclass(frozen=True, slots=True, kw_only=True)
class Round:
    """Bounds of one round; they become tighter as the rig becomes better."""

    cube_m: float
    max_sd_m: float
    gate_m: float
    kernel_m: float


ROUNDS = (
    Round(cube_m=0.8, max_sd_m=0.06, gate_m=0.40, kernel_m=0.15),
    Round(cube_m=0.6, max_sd_m=0.04, gate_m=0.20, kernel_m=0.08),
    Round(cube_m=0.6, max_sd_m=0.03, gate_m=0.10, kernel_m=0.05),
    Round(cube_m=0.6, max_sd_m=0.03, gate_m=0.08, kernel_m=0.04),
    Round(cube_m=0.6, max_sd_m=0.03, gate_m=0.08, kernel_m=0.04),
)
_POINT_SD_M = 0.015
_KNOT_SD = np.repeat([0.05, 0.3], 3)
"""Of a knot's step in one round: rotation [rad], position [m]."""
_CHAIN_SD = np.repeat([3e-4, 1e-3], 3)
"""Without an IMU: change of the correction from knot to knot, rotation [rad], position [m]."""
_BIAS_SD = np.repeat([0.1, 0.3, 2.0], 3)
"""Biases of gyroscope [rad/s] and accelerometer [m/s²], gravity [m/s²]."""
_GRAVITY_SD_M_S2 = 0.02
_RIDGE = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class WindowState:
    """A window with its current estimates."""

    window: Window
    biases: WindowBiases


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
    points: int
    mean_m: float
    """Root mean square distance of the points from their planes [m], robust."""

    def step(self, delta: Array) -> Array:
        """Step of the window's unknowns for a step of the rig."""
        return self.own + self.coupling @ delta


def first_state(window: Window) -> WindowState:
    """Biases zero, gravity downwards."""
    gravity = np.array([0.0, 0.0, -STANDARD_GRAVITY_M_S2])
    return WindowState(window, WindowBiases(np.zeros(3), np.zeros(3), gravity))


def reduce_window(
    state: WindowState, rig: Rig, parameters: Parameters, *, settings: Settings, bounds: Round
) -> Reduced | None:
    """Normal equations of the rig from one window; None if nothing lies on planes."""
    window = state.window
    placed = place(window, rig)
    surfaces = find_surfaces(
        placed.odom, window.sensor,
        cube_m=bounds.cube_m, max_sd_m=bounds.max_sd_m, gate_m=bounds.gate_m,
    )  # fmt: skip
    if len(surfaces) == 0:
        return None
    size = 6 * window.knots + BIASES + len(parameters)
    H, g, rms_m = _point_equations(window, placed, surfaces, parameters, size=size, bounds=bounds)
    _add_motion(H, g, state, rig, parameters, settings=settings)
    own = 6 * window.knots + BIASES
    solved = np.linalg.solve(H[:own, :own], np.column_stack([H[:own, own:], g[:own]]))
    coupling, step = -solved[:, :-1], -solved[:, -1]
    return Reduced(
        H[own:, own:] + H[own:, :own] @ coupling,
        g[own:] + H[own:, :own] @ step,
        step,
        coupling,
        len(surfaces.point),
        rms_m,
    )


def _point_equations(
    window: Window,
    placed: PlacedPoints,
    surfaces: Surfaces,
    parameters: Parameters,
    *,
    size: int,
    bounds: Round,
) -> tuple[Array, Array, float]:
    """Normal equations of knots, biases (empty) and rig, the planes eliminated."""
    rows, plane = surfaces.point, surfaces.plane
    normal = surfaces.normal[plane]
    away = placed.odom[rows] - surfaces.center[plane]
    r = np.sum(normal * away, axis=1)
    columns, values = _derivatives(window, placed, rows, normal, parameters)
    weight = 1.0 / (_POINT_SD_M**2 * (1.0 + (r / bounds.kernel_m) ** 2))
    tangents = _tangents(surfaces.normal)[plane]
    plane_values = np.column_stack(
        [np.einsum("nij,ni->nj", tangents, away), -np.ones(len(rows))]
    )
    H, g = np.zeros((size, size)), np.zeros(size)
    B = np.zeros((len(surfaces), 3, size))
    C, c = np.zeros((len(surfaces), 3, 3)), np.zeros((len(surfaces), 3))
    accumulate_point_rows(
        columns, np.ascontiguousarray(values), weight, r, plane, plane_values, H, g, B, C, c
    )
    H += np.triu(H, 1).T
    C += 1e-3 * np.eye(3)
    solved = np.linalg.solve(C, np.concatenate([B, c[:, :, None]], axis=2))
    flat = B.reshape(-1, size)
    H -= flat.T @ solved[:, :, :-1].reshape(-1, size)
    g -= flat.T @ solved[:, :, -1].ravel()
    rms_m = float(np.sqrt(np.sum(weight * r**2) / np.sum(weight)))
    return H, g, rms_m


def _derivatives(
    window: Window, placed: PlacedPoints, rows: Array, normal: Array, parameters: Parameters
) -> tuple[Array, Array]:
    """Columns and derivatives of the distances of points from fixed planes, (M, 19) each."""
    knot, s = placed.knot[rows], placed.fraction[rows, None]
    own = np.concatenate([np.cross(placed.arm_odom[rows], normal), normal], axis=1)
    six = np.arange(6)
    columns = np.full((len(rows), 19), -1, np.int64)
    values = np.zeros((len(rows), 19))
    columns[:, :6], values[:, :6] = 6 * knot[:, None] + six, (1.0 - s) * own
    columns[:, 6:12], values[:, 6:12] = 6 * (knot[:, None] + 1) + six, s * own
    first = 6 * window.knots + BIASES
    normal_body = np.einsum("nij,ni->nj", placed.R_odom_body[rows], normal)
    values[:, 12:15] = np.cross(placed.sensor_arm_body[rows], normal_body)
    values[:, 15:18] = normal_body
    values[:, 18] = np.sum(placed.velocity_odom[rows] * normal, axis=1)
    for row in parameters.lidars:
        of_sensor = window.sensor[rows] == row
        part = parameters.of_lidar(row)
        columns[of_sensor, 12:] = first + np.arange(part.start, part.stop)
    return columns, values


def _tangents(normal: Array) -> Array:
    """Two unit vectors along each plane, (V, 3, 2)."""
    smallest = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = np.cross(normal, smallest)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(normal, first)], axis=2)


def _add_motion(
    H: Array, g: Array, state: WindowState, rig: Rig, parameters: Parameters, *, settings: Settings
) -> None:
    """Add IMU and priors of the motion to normal equations of knots, biases and rig."""
    window, own = state.window, 6 * state.window.knots
    knots = window.knots
    diagonal = np.einsum("ii->i", H)
    diagonal[:own] += np.tile(_KNOT_SD**-2.0, knots)
    diagonal[:6] += 1e8  # the first knot stays: a window floats freely
    diagonal[own : own + BIASES] += _BIAS_SD**-2.0
    found = imu_rows(window, rig, state.biases, settings.odometry)
    if found is None:
        _add_chain(H, knots)
        return
    used = len(H) if parameters.imu else own + BIASES
    columns = np.arange(own + BIASES)
    if parameters.imu:
        part = parameters.of_imu
        columns = np.concatenate([columns, own + BIASES + np.arange(part.start, part.stop)])
    J = found.J[:, : len(columns)]
    H[np.ix_(columns, columns)] += J.T @ J
    g[columns] += J.T @ found.r
    _add_gravity(H, g, state.biases, first=own + 6)
    del used


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


@dataclass(frozen=True, slots=True, eq=False)
class JointEstimate:
    """Result of a joint calibration."""

    rig: Rig
    parameters: Parameters
    change: Array
    """From the recorded rig, (P,)."""
    sd: Array
    """Standard deviation of each parameter, (P,)."""
    formal_sd: Array
    """The same if all residuals were independent, (P,)."""
    rms_m: float
    """Distance of the points from their planes in the end [m]."""
    windows: int


def calibrate_jointly(
    windows: Sequence[Window],
    rig: Rig,
    parameters: Parameters,
    *,
    settings: Settings,
    rounds: Sequence[Round] = ROUNDS,
    progress: Callable[[], None] = lambda: None,
) -> JointEstimate:
    """Estimate mounts and clocks from windows of a walk.

    Args:
        windows: Cut from the walk; rotations about all axes should occur in them.
        rig: Where to begin: a few degrees and centimeters from the truth.
        parameters: What is estimated.
        settings: Noise of the IMU, number of threads.
        rounds: Bounds of each round.
        progress: Called after each round.
    """
    recorded, states = rig, [first_state(window) for window in windows]
    prior = np.diag(parameters.prior_sd**-2.0)
    found: list[Reduced | None] = []
    for bounds in rounds:
        def reduce_one(state: WindowState) -> Reduced | None:
            return reduce_window(state, rig, parameters, settings=settings, bounds=bounds)

        with ThreadPoolExecutor(settings.graph.workers) as pool:
            found = list(pool.map(reduce_one, states))
        change = parameters.between(recorded, rig)
        H, g = _total(found, len(parameters))
        delta = -np.linalg.solve(H + prior, g + prior @ change)
        rig = parameters.changed(rig, delta)
        states = [
            _moved(state, part, delta) for state, part in zip(states, found, strict=True)
        ]
        progress()
    usable = [part for part in found if part is not None]
    H, _ = _total(usable, len(parameters))
    formal = np.sqrt(np.diag(np.linalg.inv(H + prior)))
    rms_m = float(np.sqrt(np.mean([part.mean_m**2 for part in usable]))) if usable else np.nan
    return JointEstimate(
        rig, parameters, parameters.between(recorded, rig),
        np.maximum(formal, _scatter(usable, prior)), formal, rms_m, len(usable),
    )  # fmt: skip


def _total(found: Iterable[Reduced | None], size: int) -> tuple[Array, Array]:
    H, g = np.zeros((size, size)), np.zeros(size)
    for part in found:
        if part is not None:
            H += part.H
            g += part.g
    return H, g


def _scatter(found: Sequence[Reduced], prior: Array) -> Array:
    """Standard deviation by leaving out one window after the other (jackknife), (P,)."""
    count = len(found)
    if count < 3:
        return np.full(len(prior), np.inf)
    H, g = _total(found, len(prior))
    without = np.stack(
        [-np.linalg.solve(H - part.H + prior, g - part.g) for part in found]
    )
    spread = np.sum((without - without.mean(axis=0)) ** 2, axis=0)
    return np.asarray(np.sqrt((count - 1) / count * spread))


def _moved(state: WindowState, part: Reduced | None, delta: Array) -> WindowState:
    if part is None:
        return state
    window = state.window
    step = part.step(delta)
    own = 6 * window.knots
    trajectory = apply_knots(window.trajectory, window.knot_ns, step[:own].reshape(-1, 6))
    return WindowState(
        with_trajectory(window, trajectory), state.biases.plus(step[own : own + BIASES])
    )
