"""Registration of two single scans, also sparse ones: symmetric ICP with several initial poses.

A map of small planes needs several scans to fill its cubes. Here a plane is fitted to the
neighbors of every point of both scans (symmetric ICP, Rusinkiewicz 2019). If the initial pose
proves wrong, the ground plans of both scans are correlated over rotation and shift.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from msgspec import structs
from numpy.typing import NDArray
from scipy import fft, ndimage
from scipy.spatial import cKDTree

from recon4.geometry.cubes import cube_keys, cubes_of
from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, so3_log, tangent_size_m
from recon4.kernels.scans import accumulate_symmetric, count_from_above, neighbor_normals
from recon4.registration.carrier import CarrierPrior
from recon4.registration.degeneracy import observable_pose
from recon4.registration.result import Registration, StopReason
from recon4.registration.tuning import SCANS, ScanTuning
from recon4.registration.tuning_matching import SCAN_MATCHES


@dataclass(frozen=True, eq=False)
class Scan:
    """Points of one scan, thinned, with normals."""

    points: Array
    """(N, 3) [m]."""
    normals: Array
    """Unit, of either sign; zeros where the neighbors lie on a line, (N, 3)."""
    tree: cKDTree

    def __len__(self) -> int:
        return len(self.points)

    @cached_property
    def plan(self) -> Array:
        """Ground plan: x and y of the points on steep surfaces [m], (M, 2)."""
        steep = np.abs(self.normals[:, 2]) < SCAN_MATCHES.steep
        return np.ascontiguousarray(self.points[steep, :2])


def make_scan(points: Array, settings: ScanTuning = SCANS) -> Scan:
    """Thin points [m], (N, 3), to one per voxel (the mean) and fit a plane around each."""
    p = thinned(points[np.isfinite(points).all(axis=1)], settings.voxel_m)
    tree = cKDTree(p, balanced_tree=False, compact_nodes=False)
    normals = np.zeros_like(p)
    if len(p) >= settings.neighbors:
        neighbor_normals(p, tree.query(p, settings.neighbors)[1], normals)
    return Scan(p, normals, tree)


def register_scans(
    target: Scan,
    source: Scan,
    *,
    initial: SE3,
    settings: ScanTuning = SCANS,
    prior: CarrierPrior | None = None,
) -> Registration:
    """Estimate ``T_target_source`` from an initial pose within a meter and some ten degrees.

    Converged means that the steps became small and at least ``settings.min_inlier_ratio`` of the
    source lies on the target's surfaces; a smaller inlier ratio is reported as too few matches.

    Args:
        target: Scan to register to.
        source: Scan to be moved.
        initial: First ``T_target_source``.
        settings: Gate, kernel, bounds.
        prior: Where the source is expected; decides where the scans do not.
    """
    some = _some(source, settings.source_points)
    return _descend(target, some, initial=initial, settings=settings, prior=prior)


def search_scans(
    target: Scan,
    source: Scan,
    *,
    initial: SE3,
    settings: ScanTuning = SCANS,
    prior: CarrierPrior | None = None,
) -> Registration:
    """Estimate ``T_target_source`` although the initial pose may be completely wrong.

    The initial pose is used if it leads to a good match. Otherwise it is compared with the best
    overlays of the ground plans (upright scans, any heading, shifts up to 40 m). Each one is
    registered with some of the points; the one with the largest inlier ratio is refined. With a
    prior an inlier ratio counts less the farther the pose lies from it.

    Args:
        target: Scan to register to.
        source: Scan to be moved.
        initial: First ``T_target_source``.
        settings: Gate, kernel, bounds.
        prior: Where the source is expected.
    """

    def score(found: Registration) -> float:
        likely = prior.plausibility(found.T_target_source) if prior else 1.0
        return found.match_ratio * likely

    first = register_scans(target, source, initial=initial, settings=settings, prior=prior)
    if first.converged and first.match_ratio >= settings.confident_inlier_ratio:
        return first
    some = _some(source, SCAN_MATCHES.coarse_points)
    starts = overlay_plans(target, source, count=settings.starts, height_m=float(initial.t[2]))
    coarse = structs.replace(settings, rounds=SCAN_MATCHES.coarse_rounds)
    tries = [
        _descend(target, some, initial=start, settings=coarse, prior=prior)
        for start in [first.T_target_source, *starts]
    ]
    best = max(tries, key=score)
    if best is tries[0]:
        return first
    other = register_scans(
        target, source, initial=best.T_target_source, settings=settings, prior=prior
    )
    return max(first, other, key=score)


def lay_onto(
    target: Scan, source: Scan, *, initial: Sequence[SE3], settings: ScanTuning = SCANS
) -> list[Registration]:
    """Every pose that fits, best first: from the initial poses and the overlays of ground plans.

    Unlike `search_scans` it expects nothing, and returns other poses beside the best. The stop
    reasons mean nothing: the match ratio decides.

    Args:
        target: Scan to register to.
        source: Scan to be moved.
        initial: Poses to try beside the overlays.
        settings: Gate, kernel, bounds.
    """
    settings = structs.replace(settings, min_inlier_ratio=0.0)
    coarse = structs.replace(settings, rounds=SCAN_MATCHES.coarse_rounds)
    some = _some(source, SCAN_MATCHES.coarse_points)
    starts = [*initial, *overlay_plans(target, source, count=settings.starts, height_m=0.0)]
    tries = [_descend(target, some, initial=start, settings=coarse, prior=None) for start in starts]
    tries.sort(key=lambda one: -one.match_ratio)
    fits = [
        register_scans(target, source, initial=one.T_target_source, settings=settings)
        for one in tries[: SCAN_MATCHES.fits]
    ]
    return sorted(fits, key=lambda one: -one.match_ratio)


def overlay_plans(target: Scan, source: Scan, *, count: int, height_m: float) -> list[SE3]:
    """The ``count`` best overlays of two ground plans: correlation over turn and shift by FFT.

    Args:
        target: Upright scan.
        source: Upright scan.
        count: Number of overlays; those next to a better one are omitted.
        height_m: ``z`` of the results [m].
    """
    yaw: Array = np.linspace(0.0, 2.0 * np.pi, SCAN_MATCHES.yaws, endpoint=False)
    fixed = np.zeros((1, SCAN_MATCHES.plan, SCAN_MATCHES.plan), np.float32)
    turned = np.zeros((SCAN_MATCHES.yaws, SCAN_MATCHES.plan, SCAN_MATCHES.plan), np.float32)
    count_from_above(target.plan, yaw[:1], SCAN_MATCHES.plan_cell_m, SCAN_MATCHES.plan_most, fixed)
    count_from_above(source.plan, yaw, SCAN_MATCHES.plan_cell_m, SCAN_MATCHES.plan_most, turned)
    fixed = ndimage.uniform_filter(fixed, (1, 3, 3))
    spectrum = fft.rfft2(fixed) * np.conj(fft.rfft2(turned))
    score = fft.irfft2(spectrum, s=(SCAN_MATCHES.plan, SCAN_MATCHES.plan))
    return [_start(score, yaw, height_m) for _ in range(count)]


def _start(score: NDArray[Any], yaw: Array, height_m: float) -> SE3:
    """Take the best overlay and clear its surroundings, so that the next call finds another."""
    m, i, j = np.unravel_index(int(score.argmax()), score.shape)
    near_yaw = np.arange(m - 2, m + 3) % len(score)
    near_i, near_j = (
        np.arange(i - 2, i + 3) % SCAN_MATCHES.plan,
        np.arange(j - 2, j + 3) % SCAN_MATCHES.plan,
    )
    score[np.ix_(near_yaw, near_i, near_j)] = -np.inf
    shift = (np.array([i, j]) + SCAN_MATCHES.plan // 2) % SCAN_MATCHES.plan - SCAN_MATCHES.plan // 2
    return SE3.from_rpy(
        0.0, 0.0, float(yaw[m]), t=np.append(shift * SCAN_MATCHES.plan_cell_m, height_m)
    )


def _descend(
    target: Scan,
    source: tuple[Array, Array],
    *,
    initial: SE3,
    settings: ScanTuning = SCANS,
    prior: CarrierPrior | None,
) -> Registration:
    """Match and solve until the steps are small; ``source`` are points and normals, (N, 3)."""
    p, n = source
    if len(target) < SCAN_MATCHES.min_matches or len(p) < SCAN_MATCHES.min_matches:
        return _refused(initial, 0)
    T, stop, done = initial, StopReason.LIMIT, 0
    for done in range(1, settings.rounds + 1):
        reach = settings.gate_m * (SCAN_MATCHES.wide if done <= 2 else 1.0)
        q = T @ p
        nearest = target.tree.query(q, distance_upper_bound=reach)[1]
        H, g, nn = np.zeros((6, 6)), np.zeros(6), np.zeros((3, 3))
        matches, inliers, weight, total, squares = accumulate_symmetric(
            q, n @ T.R.T, nearest, target.points, target.normals, T.t,
            settings.kernel_m, settings.inlier_m, H, g, nn,
        )  # fmt: skip
        if matches < SCAN_MATCHES.min_matches:
            return _refused(T, done)
        variance = max(squares / weight, SCAN_MATCHES.min_variance_m2)
        if prior is not None:
            H, g = _with_prior(H, g, T, variance=variance, prior=prior)
        step = -np.linalg.solve(H + 1e-9 * np.trace(H) * np.eye(6), g)
        T = T.stepped(step)
        if done > 2 and tangent_size_m(step) < 1e-3:
            stop = StopReason.SMALL_STEP
            break
    match_ratio = inliers / len(p)
    if match_ratio < settings.min_inlier_ratio:
        stop = StopReason.TOO_FEW
    degeneracy = float(np.linalg.eigvalsh(nn / weight)[0])
    return Registration(T, stop, done, total / weight, match_ratio, H / variance, degeneracy)


def _with_prior(
    H: Array, g: Array, T: SE3, *, variance: float, prior: CarrierPrior
) -> tuple[Array, Array]:
    """Normal equations with those of the prior at a pose, without what normals feign."""
    H, full = observable_pose(H, SCAN_MATCHES.normal_noise_rad)
    g = full.T @ g
    weight = variance / prior.sd_m**2
    H[TRANSLATION, TRANSLATION] += weight * np.eye(3)
    g[TRANSLATION] += weight * (T.t - prior.t_m)
    weight = variance / prior.sd_rad**2
    H[ROTATION, ROTATION] += weight * np.eye(3)
    g[ROTATION] += weight * so3_log(T.R)
    return H, g


def _some(scan: Scan, limit: int) -> tuple[Array, Array]:
    """Points and normals of a scan, evenly spaced, at most ``limit``."""
    rows = np.linspace(0, len(scan) - 1, min(len(scan), limit)).astype(np.intp)
    return scan.points[rows], scan.normals[rows]


def _refused(T: SE3, rounds: int) -> Registration:
    nan = float("nan")
    return Registration(T, StopReason.TOO_FEW, rounds, nan, 0.0, np.zeros((6, 6)), 0.0)


def thinned(p: Array, voxel_m: float) -> Array:
    """Mean of the points in each voxel, (M, 3)."""
    if not len(p):
        return np.empty((0, 3))
    key = cube_keys(cubes_of(p, voxel_m))
    _, row, count = np.unique(key, return_inverse=True, return_counts=True)
    sums = [np.bincount(row, p[:, axis]) / count for axis in range(3)]
    return np.ascontiguousarray(np.stack(sums, axis=1))
