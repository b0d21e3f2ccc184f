"""Registration of collar line segments, line against line (V §2.4, Velas 2016).

Solver ``svd`` is that of the documents: closest points of matched lines, rigid fit in closed form.
Solver ``common_normal`` minimizes the distance along the common normal of two matched lines only,
because the position of a sample along its line carries no information.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.lines import Lines, closest_points
from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, align_points
from recon4.registration.result import Registration, StopReason
from recon4.registration.tuning import RegistrationTuning, registration_tuning
from recon4.registration.tuning_matching import COLLAR_LINES
from recon4.settings import RegistrationSettings

if TYPE_CHECKING:
    from scipy.spatial import cKDTree


@dataclass(frozen=True, eq=False)
class LineTarget:
    """Lines to register to; the KD-tree of their midpoints is built once."""

    lines: Lines

    @cached_property
    def tree(self) -> cKDTree:
        """KD-tree of the midpoints. Unbalanced: three times faster to build, as fast to query."""
        from scipy.spatial import cKDTree

        return cKDTree(self.lines.mid, balanced_tree=False, compact_nodes=False)


def register_lines(
    target: LineTarget,
    source: Lines,
    *,
    initial: SE3,
    portion: float,
    settings: RegistrationSettings,
) -> Registration:
    """Estimate ``T_target_source``, starting at ``initial``.

    Args:
        target: Lines in the target frame.
        source: Lines in the source frame.
        initial: First ``T_target_source``.
        portion: Fraction of nearest matches that is kept, 0..1 (the overlap, V §2.5).
        settings: Solver and stop rules.
    """
    if len(target.lines) < COLLAR_LINES.min_matches or len(source) < COLLAR_LINES.min_matches:
        return _refused(initial)
    rules = registration_tuning(settings)
    solve = _svd_step if rules.solver == "svd" else _common_normal_step
    T_target_source = initial
    errors: list[float] = []
    for iteration in range(1, rules.max_iterations + 1):
        moved = source.moved(T_target_source)
        rows_target, rows_source = _match(target.tree, moved, portion, settings=rules)
        if len(rows_source) < COLLAR_LINES.min_matches:
            return _refused(T_target_source)
        step = solve(target.lines[rows_target], moved[rows_source], rules)
        T_target_source = step.T @ T_target_source
        errors.append(step.error_m)
        stop = _stop(errors, step, rules)
        if stop is not None or iteration == rules.max_iterations:
            match_ratio = len(rows_source) / len(source)
            return Registration(
                T_target_source, stop or StopReason.LIMIT, iteration, step.error_m, match_ratio,
                step.information, step.degeneracy,
            )  # fmt: skip
    raise AssertionError("max_iterations is at least 1")


@dataclass(frozen=True, slots=True, eq=False)
class _Step:
    T: SE3
    error_m: float
    information: Array
    degeneracy: float


def _match(
    tree: cKDTree, moved: Lines, portion: float, *, settings: RegistrationTuning
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows of matched lines in target and source: nearest midpoints, the best portion of them."""
    bound_m = settings.max_distance_m if settings.solver == "common_normal" else np.inf
    distance_m, nearest = tree.query(moved.mid, distance_upper_bound=bound_m)
    found = np.flatnonzero(np.isfinite(distance_m))
    count = int(np.ceil(portion * len(moved)))
    if count < len(found):
        found = found[np.argpartition(distance_m[found], count - 1)[:count]]
        found.sort()
    return nearest[found], found


def _svd_step(target: Lines, moved: Lines, settings: RegistrationTuning) -> _Step:
    """Closed-form fit of the closest points (V Eq. 2.3-2.5)."""
    p_target, p_source = closest_points(target, moved)
    kept = np.isfinite(p_target).all(axis=1)
    p_target, p_source = p_target[kept], p_source[kept]
    if len(p_target) < COLLAR_LINES.min_matches:
        return _Step(SE3.identity(), float("nan"), np.eye(6), 0.0)
    T = align_points(p_target, p_source)
    gap = p_target - T @ p_source
    error_m = float(np.mean(np.linalg.norm(gap, axis=1)))
    n, _ = _normals(target[kept], moved[kept])
    H, _, degeneracy = _normal_equations(p_source, n, np.zeros(len(n)), w=np.ones(len(n)))
    return _Step(T, error_m, H / max(error_m, 1e-3) ** 2, degeneracy)


def _common_normal_step(target: Lines, moved: Lines, settings: RegistrationTuning) -> _Step:
    """Gauss-Newton on the distance along the common normal, robustly weighted."""
    n, sine = _normals(target, moved)
    r = np.sum(n * (moved.mid - target.mid), axis=1)
    w = sine**2 / (1.0 + (r / settings.kernel_m) ** 2)
    H, g, degeneracy = _normal_equations(moved.mid, n, r, w=w)
    xi = -np.linalg.solve(H + 1e-9 * np.trace(H) * np.eye(6), g)
    centroid = moved.mid.mean(axis=0)
    turn = SE3.exp(np.concatenate([xi[ROTATION], np.zeros(3)]))
    T = SE3(turn.R, centroid + xi[TRANSLATION] - turn.R @ centroid)
    error_m = float(np.average(np.abs(r), weights=sine**2 + 1e-12))
    return _Step(T, error_m, H / settings.kernel_m**2, degeneracy)


def _normals(target: Lines, moved: Lines) -> tuple[Array, Array]:
    """Common normals (unit, zero for parallel pairs) and the sines of the angles between."""
    n = np.cross(moved.dir, target.dir)
    sine = np.linalg.norm(n, axis=1)
    return n / np.maximum(sine, 1e-9)[:, None], sine


def _normal_equations(p: Array, n: Array, r: Array, *, w: Array) -> tuple[Array, Array, float]:
    """``H``, ``g`` of a left correction about the centroid, and the degeneracy measure."""
    J = np.hstack([np.cross(p - p.mean(axis=0), n), n])
    H = J.T @ (w[:, None] * J)
    spread = n.T @ (w[:, None] * n) / max(float(w.sum()), 1e-12)
    return H, J.T @ (w * r), float(np.linalg.eigvalsh(spread)[0])


def _stop(errors: list[float], step: _Step, settings: RegistrationTuning) -> StopReason | None:
    """Stop reason, or None: rules of requirements A3.2 for ``svd``, else a small step."""
    if settings.solver == "common_normal":
        move_m = step.T.size_m()
        return StopReason.SMALL_STEP if move_m < settings.converged_step_m else None
    window = settings.error_window
    if len(errors) < window:
        return None
    if errors[-1] < settings.target_error_m:
        return StopReason.SMALL_ERROR
    steady = np.std(errors[-window:]) < settings.error_deviation
    return StopReason.STEADY_ERROR if steady else None


def _refused(T_target_source: SE3) -> Registration:
    nan = float("nan")
    return Registration(T_target_source, StopReason.TOO_FEW, 0, nan, 0.0, np.zeros((6, 6)), 0.0)
