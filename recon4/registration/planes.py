"""Registration of collar line segments to a map of planes: rigid, coarse to fine."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_log, tangent_size_m
from recon4.registration.degeneracy import observable_pose
from recon4.registration.plane_map import Match, PlaneMap
from recon4.registration.result import Registration, StopReason
from recon4.registration.state_vector import START
from recon4.registration.tuning import registration_tuning
from recon4.registration.tuning_matching import PLANE_MATCHES
from recon4.settings import RegistrationSettings


def register_to_planes(
    target: PlaneMap,
    source: Array,
    *,
    initial: SE3,
    settings: RegistrationSettings,
    normal_noise_rad: float = 0.0,
) -> Registration:
    """Estimate ``T_target_source`` by Gauss-Newton on the distances from the target's planes.

    Args:
        target: Planes in the target frame.
        source: Points in the source frame [m], (N, 3): both ends of segments.
        initial: First ``T_target_source``; large cubes and a wide gate come first, so that it may
            be off by up to a meter.
        settings: Stop rules.
        normal_noise_rad: Error of a plane's normal [rad]. Directions with no more information than
            such errors create keep the initial pose, and the result has no information there.
    """
    T_target_source, from_initial = initial, initial.inverse()
    rules = registration_tuning(settings)
    stop, rounds = StopReason.LIMIT, 0
    match = _empty(len(source))
    for rounds in range(1, rules.max_iterations + 1):
        last_gate = rounds >= len(PLANE_MATCHES.gates_m)
        match = _match_round(target, T_target_source, source, rounds=rounds)
        if match.matches < PLANE_MATCHES.min_matches:
            stop = StopReason.TOO_FEW
            break
        step = _gauss_newton_step(match.H[START, START], match.g[START])
        T_target_source = T_target_source.stepped(step)
        moved = from_initial @ T_target_source
        if not np.isfinite(step).all() or moved.moves_more_than(rules.max_move_m):
            stop = StopReason.UNSTABLE
            break
        if last_gate and tangent_size_m(step) < rules.converged_step_m:
            stop = StopReason.SMALL_STEP
            break
    H = match.H[START, START]
    if normal_noise_rad and stop is StopReason.SMALL_STEP:
        H, T_target_source = _observable(
            H, initial, T_target_source, normal_noise_rad=normal_noise_rad
        )
    error_m = _error(target, T_target_source, source)
    return Registration(
        T_target_source, stop, rounds, error_m, match.match_ratio, H, match.degeneracy,
    )  # fmt: skip


def _observable(
    H: Array, initial: SE3, found: SE3, *, normal_noise_rad: float
) -> tuple[Array, SE3]:
    """Information and pose without what only errors of the normals seem to observe.

    It is removed at the end: during the rounds a pose far off would be held where it is wrong.
    """
    reduced, keep = observable_pose(H, normal_noise_rad)
    moved = np.concatenate([so3_log(found.R @ initial.R.T), found.t - initial.t])
    kept = keep @ moved
    return reduced, initial.stepped(kept)


def _gauss_newton_step(H: Array, g: Array) -> Array:
    """Step that reduces the distances, damped a little, (6,)."""
    return -np.linalg.solve(H + 1e-6 * np.trace(H) / 6 * np.eye(6), g)


def _match_round(target: PlaneMap, T_target_source: SE3, source: Array, *, rounds: int) -> Match:
    """Matches of a round, counted from 1: the cubes become smaller and the gate narrower."""
    return target.match(
        T_target_source @ source,
        np.zeros(len(source)),
        center=T_target_source.t,
        finest=max(target.levels - rounds, 0),
        gate_m=PLANE_MATCHES.gates_m[min(rounds, len(PLANE_MATCHES.gates_m)) - 1],
    )


def _error(target: PlaneMap, T_target_source: SE3, source: Array) -> float:
    """Mean distance within a wide gate: one narrow enough to register hides what does not fit."""
    wide = target.match(
        T_target_source @ source,
        np.zeros(len(source)),
        center=T_target_source.t,
        finest=0,
        gate_m=PLANE_MATCHES.error_gate_m,
    )
    return wide.mean_m


def _empty(count: int) -> Match:
    nan = np.full(count, np.nan)
    return Match(np.zeros((12, 12)), np.zeros(12), nan, 0, float("nan"), 0.0)
