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
from scipy.special import ndtr, stdtrit

from recon4.calibration.equations import Fit, Reduced, RoundBounds, WindowState, reduce_window
from recon4.calibration.imu_rows import WindowBiases, measured_noise
from recon4.calibration.parameters import Parameters, Unit
from recon4.calibration.tuning_joint import JOINT
from recon4.calibration.window import Window, with_trajectory
from recon4.geometry.se3 import Array
from recon4.model.rig import Rig
from recon4.registration.tuning import OdometryTuning
from recon4.semi_rigid.knots import apply_knots
from recon4.settings.reads import CalibrationReads
from recon4.settings.tuning import tuned
from recon4.units import STANDARD_GRAVITY_M_S2

_TIGHT = RoundBounds(cube_m=0.6, max_sd_m=0.03, gate_m=0.08, kernel_m=0.04)
_PURE = replace(_TIGHT, pure=True)
ROUNDS = (
    RoundBounds(cube_m=0.8, max_sd_m=0.06, gate_m=0.40, kernel_m=0.15),
    RoundBounds(cube_m=0.6, max_sd_m=0.04, gate_m=0.20, kernel_m=0.08),
    RoundBounds(cube_m=0.6, max_sd_m=0.03, gate_m=0.10, kernel_m=0.05),
    _TIGHT,
    _PURE,
    _PURE,
)
"""Bounds of each round of an estimate that begins at a rig file."""
NEAR_ROUNDS = (*ROUNDS[2:], _PURE)
"""The same near the right rig: bounds as wide as the first ones join both sides of thin walls and
of flights of stairs, and a window that is bent so far does not come back."""
LAST_ROUNDS = (_PURE, _PURE, _PURE, _PURE)
"""The same at a rig that others confirm."""
EXPLAIN = (
    RoundBounds(cube_m=0.6, max_sd_m=0.04, gate_m=0.40, kernel_m=0.15),
    RoundBounds(cube_m=0.6, max_sd_m=0.04, gate_m=0.40, kernel_m=0.15),
)
"""Wide bounds that are the same for a good and a bad rig, to compare how well they explain."""
_VAGUE: dict[Unit, float] = {"rad": float(np.deg2rad(0.5)), "m": 0.05, "s": 5e-3}
"""With a larger formal standard deviation a direction counts as not shown by the walk."""
_QUANTILE = float(ndtr(JOINT.sigmas))


@dataclass(frozen=True, slots=True, eq=False)
class JointEstimate:
    """Result of a joint calibration."""

    rig: Rig
    parameters: Parameters
    change: Array
    """From the rig it began with, (P,)."""
    formal_sd: Array
    """Standard deviation of each parameter by the normal equations, (P,)."""
    scatter_sd: Array
    """The same by the scatter of the windows, (P,); infinite with too few windows."""
    fits: tuple[Fit, ...]
    """How well each window is explained in the end; windows without planes are left out."""
    disagreement: float = 0.0
    """Chi-square of each window alone against all together, per parameter, mean: 0.2 to 5 on walks
    whose rig stays the same."""

    @property
    def changes(self) -> bool:
        """Whether windows disagree so much that the rig cannot be the same in all of them."""
        return self.disagreement > JOINT.changed and len(self.fits) >= JOINT.min_windows

    @property
    def sd(self) -> Array:
        """Standard deviation of each parameter, the larger of both, (P,)."""
        return np.maximum(self.formal_sd, self.scatter_sd)

    @property
    def noise(self) -> Array:
        """Changes up to this may be noise, (P,): three standard deviations.

        How much a few windows scatter is itself uncertain: four of them show a standard deviation
        whose true value may well be three times as large (Student's t).
        """
        if len(self.fits) < JOINT.min_windows:
            return np.full(len(self.change), np.inf)
        of_scatter = float(stdtrit(len(self.fits) - 1, _QUANTILE))
        return np.maximum(JOINT.sigmas * self.formal_sd, of_scatter * self.scatter_sd)

    @property
    def rms_m(self) -> float:
        """Distance of the points from their planes in the end [m]."""
        return float(np.sqrt(np.mean([fit.rms_m**2 for fit in self.fits]))) if self.fits else np.nan


def calibrate_jointly(
    windows: Sequence[Window],
    rig: Rig,
    parameters: Parameters,
    *,
    rounds: Iterable[RoundBounds] = ROUNDS,
    settings: CalibrationReads,
) -> JointEstimate:
    """Estimate mounts and clocks from windows of a walk.

    Args:
        windows: Cut from the walk; rotations about all axes should occur in them.
        rig: Where to begin: some degrees and centimeters from the truth.
        parameters: What is estimated; what is known already has a small ``prior_sd``.
        rounds: Bounds of each round.
        settings: Noise of the IMU, number of threads.
    """
    first, states = rig, [_first_state(window) for window in windows]
    samples = [window.imu for window in windows if window.imu is not None]
    noise = measured_noise(samples, tuned(OdometryTuning, settings.odometry))
    prior = parameters.prior
    found: list[Reduced | None] = []
    with ThreadPoolExecutor(settings.graph.workers) as pool:
        for bounds in rounds:
            found = list(pool.map(_reducer(rig, parameters, noise, bounds=bounds), states))
            H, g = _total(found, len(parameters))
            pull = g + prior @ parameters.between(first, rig)
            delta = _step(H + prior, pull, parameters)
            rig = parameters.changed(rig, delta)
            states = [_moved(state, part, delta) for state, part in zip(states, found, strict=True)]
    usable = [part for part in found if part is not None]
    H, _ = _total(usable, len(parameters))
    formal = np.sqrt(np.diag(np.linalg.inv(H + prior)))
    return JointEstimate(
        rig,
        parameters,
        parameters.between(first, rig),
        formal,
        _scatter(usable, prior),
        tuple(part.fit for part in usable),
        _disagreement(usable, prior),
    )


def thinned_rounds(
    rounds: Sequence[RoundBounds], every: int, *, dense: int = 0
) -> tuple[RoundBounds, ...]:
    """Rounds with every so-many-th point, of which the last ``dense`` ones use all."""
    few = len(rounds) - dense
    return (*(replace(bounds, every=every) for bounds in rounds[:few]), *rounds[few:])


def explain(
    windows: Sequence[Window], rig: Rig, *, every: int, settings: CalibrationReads
) -> list[Fit | None]:
    """How well a rig explains windows, with the best trajectory for each; None = no planes.

    Args:
        windows: Of the walk.
        rig: With which mounts and clocks.
        every: Only every so-many-th point is used.
        settings: Noise of the IMU, number of threads.
    """
    nothing = Parameters.none()
    states = [_first_state(window) for window in windows]
    found: list[Reduced | None] = []
    with ThreadPoolExecutor(settings.graph.workers) as pool:
        for bounds in thinned_rounds(EXPLAIN, every):
            found = list(
                pool.map(
                    _reducer(rig, nothing, tuned(OdometryTuning, settings.odometry), bounds=bounds),
                    states,
                )
            )
            states = [
                _moved(state, part, np.empty(0)) for state, part in zip(states, found, strict=True)
            ]
    return [part.fit if part else None for part in found]


def _step(H: Array, g: Array, parameters: Parameters) -> Array:
    """The step of the rig, (P,); along what the walk does not show the rig stays as it is.

    Such directions join several parameters: at a constant turn rate a late clock is a turned mount.
    What noise says of them would add up over the rounds to degrees and tenths of a second.
    """
    delta = np.zeros(len(g))
    free = np.flatnonzero(~parameters.fixed)
    limit = np.array([_VAGUE[parameters.listed[k].unit] for k in free])
    information, directions = np.linalg.eigh(limit[:, None] * H[np.ix_(free, free)] * limit)
    shown = information > 1.0
    along = directions[:, shown]
    delta[free] = -limit * (along @ (along.T @ (limit * g[free]) / information[shown]))
    return delta


def _reducer(
    rig: Rig, parameters: Parameters, noise: OdometryTuning, *, bounds: RoundBounds
) -> Callable[[WindowState], Reduced | None]:
    return lambda state: reduce_window(state, rig, parameters, settings=noise, bounds=bounds)


def _first_state(window: Window) -> WindowState:
    """Biases zero, gravity downwards."""
    gravity = np.array([0.0, 0.0, -STANDARD_GRAVITY_M_S2])
    return WindowState(window, WindowBiases(np.zeros(3), np.zeros(3), gravity))


def _moved(state: WindowState, part: Reduced | None, delta: Array) -> WindowState:
    """The state of a window after a step of the rig."""
    if part is None:
        return state
    window = state.window
    step = part.step(delta)
    own = 6 * window.knots
    trajectory = apply_knots(window.trajectory, window.knot_ns, step[:own].reshape(-1, 6))
    return WindowState(with_trajectory(window, trajectory), state.biases.plus(step[own:]))


def _total(found: Iterable[Reduced | None], size: int) -> tuple[Array, Array]:
    H, g = np.zeros((size, size)), np.zeros(size)
    for part in found:
        if part is not None:
            H += part.H
            g += part.g
    return H, g


def _disagreement(found: Sequence[Reduced], prior: Array) -> float:
    """Mean chi-square of the windows against all together, per parameter."""
    if not found or not len(prior):
        return 0.0
    chi2 = [float(part.g @ np.linalg.solve(part.H + prior, part.g)) for part in found]
    return float(np.mean(chi2)) / len(prior)


def _scatter(found: Sequence[Reduced], prior: Array) -> Array:
    """Standard deviation by leaving out one window after the other (jackknife), (P,)."""
    count = len(found)
    if count < JOINT.min_windows:
        return np.full(len(prior), np.inf)
    H, g = _total(found, len(prior))
    without = np.stack([-np.linalg.solve(H - part.H + prior, g - part.g) for part in found])
    spread = np.sum((without - without.mean(axis=0)) ** 2, axis=0)
    return np.asarray(np.sqrt((count - 1) / count * spread))
