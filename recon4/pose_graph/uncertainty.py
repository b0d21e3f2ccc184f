"""Covariance of every pose of a solved graph, with the correlated errors of odometry.

The error of a pose is a turn about its own origin and a shift, both in the axes of the map. It is
the sum of the errors of all odometry edges before it (turns with their lever arms), which are
correlated over seconds: scans that follow each other are matched to the same map with the same
errors. Registered edges and positions then add what they measured. The factors of `ErrorModel`
come from walks with known truth (``docs/studies/covariances.md``).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, skew
from recon4.model.pose_graph import PoseGraph, Rows
from recon4.model.trajectory import Times
from recon4.pose_graph.carried_motion import CarriedMotion
from recon4.pose_graph.error_model import CALIBRATED, ErrorModel, GraphAgreement, agreement
from recon4.pose_graph.free_network import aligned_cov
from recon4.pose_graph.known_errors import NOTHING_KNOWN, KnownErrors
from recon4.pose_graph.priors import PositionPriors
from recon4.pose_graph.relations import in_map_axes, odometry_steps
from recon4.pose_graph.single_poses import unseen_errors, weak_part
from recon4.pose_graph.tuning_solve import UNCERTAINTY


@dataclass(frozen=True, slots=True)
class HelpfulPoint:
    """Where a control point would reduce the largest standard deviation most."""

    start_ns: int
    end_ns: int
    """Anywhere from start to end it helps nearly as much."""
    largest_m: float
    """Largest standard deviation of a position that remains [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class PoseUncertainty:
    """Covariances of poses at some times."""

    t_ns: Times
    """(N,)."""
    cov: Array
    """Turn about the pose's own origin, then shift, in the axes of the map, (N, 6, 6)."""
    on_earth: bool
    """False: relative to the first pose. True: in the frame of the positions."""
    shape_cov: Array
    """Of the positions after the best rigid alignment of all of them, in axes of the map,
    (N, 3, 3)."""
    helpful: HelpfulPoint
    """Where a control point would help most."""

    @property
    def sd_m(self) -> Array:
        """Standard deviation of the position along its worst axis [m], (N,)."""
        return _worst_sd(self.cov[:, TRANSLATION, TRANSLATION])

    @property
    def shape_sd_m(self) -> Array:
        """The same after the best alignment of all positions [m], (N,)."""
        return _worst_sd(self.shape_cov)

    @property
    def shape_rms_m(self) -> float:
        """Expected RMS of all positions after the best alignment [m]."""
        return _expected_rms(self.shape_cov)

    @property
    def rms_m(self) -> float:
        """Expected RMS of all positions in the frame of the covariances [m]."""
        return _expected_rms(self.cov[:, TRANSLATION, TRANSLATION])

    def at(self, t_ns: Times) -> Array:
        """Covariances at other times, linear between two and constant outside, (M, 6, 6)."""
        start_ns = self.t_ns[0]
        t, known = ((v - start_ns).astype(np.float64) for v in (t_ns, self.t_ns))
        columns = [np.interp(t, known, column) for column in self.cov.reshape(-1, 36).T]
        return np.stack(columns, axis=1).reshape(-1, 6, 6)


def _worst_sd(cov: Array) -> Array:
    return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(cov)[:, -1], 0.0)))


def _expected_rms(cov: Array) -> float:
    return float(np.sqrt(np.trace(cov, axis1=1, axis2=2).mean()))


@dataclass(frozen=True, slots=True, eq=False)
class _Chain:
    """Knots of the walk with the odometry between them."""

    t_ns: Times
    T_map_body: SE3
    step_cov: Array
    """Covariance of the step to each knot but the first, in axes of the map, (K - 1, 6, 6)."""
    usual: Array
    """Stated deviation of half a second of odometry as usual on the walk: turn about the best axis
    [rad], shift along the worst one [m]."""
    limits: Array
    """That at which a direction is weak on this walk: turn [rad], shift [m]."""
    step_rho: Array
    """Correlation of its whitened error with that of the step before, symmetric, (K - 1, 6, 6)."""
    rows: Rows
    """Node of each knot, (K,)."""
    knot_of: Rows
    """Knot nearest to each node, (N,)."""


def pose_uncertainty(
    graph: PoseGraph,
    *,
    positions: PositionPriors | None = None,
    model: ErrorModel = CALIBRATED,
    known: KnownErrors = NOTHING_KNOWN,
) -> PoseUncertainty | None:
    """Covariances of the poses of a graph; None with fewer than two nodes.

    Args:
        graph: Solved; its odometry edges connect consecutive nodes.
        positions: Positions of the antenna that place the map on earth; None = the first pose is
            the reference.
        model: Factors on the covariances of the edges.
        known: What other stages found to be wrong.
    """
    from scipy.linalg import cho_factor, cho_solve  # slow to import, and the server solves nothing

    if len(graph) < 2:
        return None
    agrees = agreement(graph, model, carried=known.carried)
    chain = _chain(graph, model, agrees, carried=known.carried)
    knots = len(chain.t_ns)
    information = _odometry_information(chain)
    _add_edges(information, graph, chain, factor=model.registered * agrees.ratio)
    # On the earth only the tilt is known beforehand, by leveling; else the first pose is exact.
    loose = np.diag(
        [UNCERTAINTY.tilt_rad**-2.0, UNCERTAINTY.tilt_rad**-2.0, 1e-2, 1e-6, 1e-6, 1e-6]
    )
    first = np.eye(6) * 1e9 if positions is None else loose
    information[:6, :6] += first
    if positions is not None:
        _add_positions(information, positions, graph=graph, chain=chain)
    every = cho_solve(cho_factor(information), np.eye(6 * knots)).reshape(knots, 6, knots, 6)
    knot = np.arange(knots)
    on_earth = positions is not None
    single = _single(chain, model, agrees.ratio)
    unseen = _unseen(chain, graph, known.carried)
    modes = known.modes(chain.t_ns, chain.T_map_body, on_earth=on_earth)
    alone = _alone(chain, model, single, on_earth=on_earth) + unseen
    alone = alone + modes @ np.swapaxes(modes, 1, 2)
    cov = every[knot, :, knot, :] + alone
    place = every[:, TRANSLATION, :, TRANSLATION]
    own = single[1] ** 2 * np.eye(3) + unseen[:, TRANSLATION, TRANSLATION]
    shape = _shape_cov(place, modes[:, TRANSLATION], chain.T_map_body.t, own=own)
    helpful = _helpful(place.transpose(0, 2, 1, 3), alone[:, TRANSLATION, TRANSLATION], chain.t_ns)
    return PoseUncertainty(chain.t_ns, cov, on_earth, shape, helpful)


def _shape_cov(place: Array, modes: Array, p_map: Array, *, own: Array) -> Array:
    """Covariances of positions after the best alignment, (K, 3, 3).

    Args:
        place: Covariance of all positions by the graph, (K, 3, K, 3).
        modes: Shifts of the positions by known errors, (K, 3, M).
        p_map: Positions, (K, 3).
        own: Covariance of each position's error that no other shares, (K, 3, 3).
    """
    count, knot = 3 * len(p_map), np.arange(len(p_map))
    known = modes.reshape(count, -1)
    cov = (place.reshape(count, count) + known @ known.T).reshape(place.shape)
    cov[knot, :, knot, :] += own
    return aligned_cov(cov.reshape(count, count), p_map)


def _helpful(cov: Array, alone: Array, t_ns: Times) -> HelpfulPoint:
    """Try a control point at every knot.

    Args:
        cov: Of the positions of all knots, (K, K, 3, 3).
        alone: What no control point changes, (K, 3, 3).
        t_ns: Times of the knots, (K,).
    """
    knots = len(t_ns)
    own = np.arange(knots)
    noise = UNCERTAINTY.point_m**2 * np.eye(3)
    gain = np.linalg.inv(cov[own, own] + noise)
    largest_m = np.empty(knots)
    for k in range(knots):
        left = cov[own, own] - cov[:, k] @ gain[k] @ np.swapaxes(cov[:, k], 1, 2)
        worst = np.linalg.eigvalsh(left + alone)[:, -1].max()
        largest_m[k] = np.sqrt(max(float(worst), 0.0))
    best = int(np.argmin(largest_m))
    near = largest_m <= UNCERTAINTY.nearly * largest_m[best]
    first = last = best
    while first > 0 and near[first - 1]:
        first -= 1
    while last < knots - 1 and near[last + 1]:
        last += 1
    return HelpfulPoint(int(t_ns[first]), int(t_ns[last]), float(largest_m[best]))


def _chain(
    graph: PoseGraph, model: ErrorModel, agrees: GraphAgreement, *, carried: CarriedMotion | None
) -> _Chain:
    """Join nodes to at most `UNCERTAINTY.max_knots` knots."""
    stride = -(-len(graph) // UNCERTAINTY.max_knots)
    rows = np.unique(np.append(np.arange(0, len(graph), stride), len(graph) - 1))
    step_cov, rate, usual, limits = _steps(graph, model, agrees, carried=carried)
    step_s = _step_seconds(graph.t_ns)
    covs, rhos = [], []
    for first, last in pairwise(rows.tolist()):
        move = _transport(graph.T_map_body.t[last] - graph.T_map_body.t[first + 1 : last + 1])
        cov = (move @ step_cov[first:last] @ np.swapaxes(move, 1, 2)).sum(axis=0)
        # The errors of the joined steps are correlated as all others.
        values, V = np.linalg.eigh(rate[first:last].mean(axis=0))
        at = np.cumsum(step_s[first:last])
        apart_s = np.abs(at[:, None] - at)[:, :, None]
        grow = V * np.sqrt(np.exp(-apart_s * values).sum(axis=(0, 1)) / len(at)) @ V.T
        covs.append(grow @ cov @ grow)
        rhos.append(V * np.exp(-step_s[first:last].sum() * values) @ V.T)
    nearest = np.abs(graph.t_ns[:, None] - graph.t_ns[rows]).argmin(axis=1)
    poses = graph.T_map_body[rows]
    return _Chain(
        graph.t_ns[rows], poses, np.array(covs), usual, limits, np.array(rhos), rows, nearest
    )


def _step_seconds(t_ns: Times) -> Array:
    return np.maximum(np.diff(t_ns) / 1e9, 1e-3)


def _transport(arm_m: Array) -> Array:
    """Matrices that map the error of a pose to that of a body ``arm_m`` (N, 3) away, (N, 6, 6)."""
    out = np.tile(np.eye(6), (len(arm_m), 1, 1))
    out[:, TRANSLATION, ROTATION] = -skew(arm_m)
    return out


def _steps(
    graph: PoseGraph, model: ErrorModel, agrees: GraphAgreement, *, carried: CarriedMotion | None
) -> tuple[Array, Array, Array, Array]:
    """Covariance of the odometry edge to each node but the first, and rates of decorrelation.

    Args:
        graph: Solved.
        model: Factors on the covariances.
        agrees: What its residuals say.
        carried: What the points observe of each step; None = only the size of its covariance tells.

    Returns:
        Covariances and symmetric matrices with the inverse correlation times as eigenvalues
        [1/s], (N - 1, 6, 6) each, in axes of the map; what half a second usually states, and
        where it is weak, (2,) each.
    """
    stated = _stated(graph)
    half_s = 0.5 / _step_seconds(graph.t_ns)[:, None]
    cov, rate = np.zeros_like(stated), np.zeros_like(stated)
    usual, limits = np.zeros(2), np.zeros(2)
    for row, (part, weak_at, surely, most, observed_s) in enumerate(
        (
            (ROTATION, model.weak_rad, np.inf, model.observed_rad, model.turn_s),
            (TRANSLATION, model.weak_m, model.surely_weak_m, model.observed_m, model.shift_s),
        )
    ):
        values, V = np.linalg.eigh(stated[:, part, part])
        best, _, worst = np.median(half_s * np.sqrt(values), axis=0)
        usual[row] = worst if part is TRANSLATION else best
        limits[row] = min(max(weak_at, model.weak_ratio * best), surely)
        weak = weak_part(half_s * np.sqrt(values), limits[row])
        if part is TRANSLATION and carried is not None:
            weak[carried.observed_between(graph.frame_ids)] = 0.0
            weak = np.maximum(weak, _ratio_along(V, carried.in_map(graph), values))
        observed = np.minimum(model.observed**2 * values, (most / half_s) ** 2)
        observed *= agrees.ratio[row] ** 2
        # Bounded, so that a walk that was lost leaves numbers that can be worked with.
        true = np.minimum(
            observed + weak * model.weak**2 * values, UNCERTAINTY.unknown_step[row] ** 2
        )
        inverse_s = (1.0 - weak) / observed_s + weak / model.weak_s
        cov[:, part, part] = V * true[:, None, :] @ np.swapaxes(V, 1, 2)
        rate[:, part, part] = V * inverse_s[:, None, :] @ np.swapaxes(V, 1, 2)
    return cov + model.moved**2 * agrees.moved, rate, usual, limits


def _stated(graph: PoseGraph) -> Array:
    """Covariance that each odometry edge states, in axes of the map, (N - 1, 6, 6)."""
    stated = np.tile(np.eye(6), (len(graph) - 1, 1, 1))
    of, steps = graph.relations, odometry_steps(graph)
    cov = np.asarray(np.linalg.inv(of.information[steps]), np.float64)
    stated[of.i[steps]] = in_map_axes(graph.T_map_body[of.j[steps]], cov)
    return stated


def _ratio_along(directions: Array, cov: Array, values: Array) -> Array:
    """Ratio of a covariance to others along their main axes, 0..1, (N, 3)."""
    along = np.einsum("nia,nij,nja->na", directions, cov, directions)
    return np.clip(along / values, 0.0, 1.0)


def _odometry_information(chain: _Chain) -> Array:
    """Information of the errors of all knots by odometry alone, (6 K, 6 K); the gauge is free."""
    knots = len(chain.t_ns)
    steps = knots - 1
    values, V = np.linalg.eigh(chain.step_cov)
    root = np.einsum("nab,nb,ncb->nac", V, np.maximum(values, 1e-14) ** -0.5, V)
    # Whitened steps: root (d_k - F_k d_(k-1)), correlated as an AR(1) process.
    white = np.zeros((steps, 6, knots, 6))
    rows = np.arange(steps)
    move = _transport(np.diff(chain.T_map_body.t, axis=0))
    white[rows, :, rows + 1, :] = root
    white[rows, :, rows, :] = -root @ move
    rho, U = np.linalg.eigh(chain.step_rho[1:])
    rho = np.clip(rho, 0.0, 0.99)
    back = U * (rho / np.sqrt(1.0 - rho**2))[:, None, :] @ np.swapaxes(U, 1, 2)
    keep = U * (1.0 / np.sqrt(1.0 - rho**2))[:, None, :] @ np.swapaxes(U, 1, 2)
    before = white[:-1].copy()
    white[1:] = np.einsum("sab,sbkc->sakc", keep, white[1:])
    white[1:] -= np.einsum("sab,sbkc->sakc", back, before)
    flat = white.reshape(6 * steps, 6 * knots)
    return np.asarray(flat.T @ flat)


def _add_edges(information: Array, graph: PoseGraph, chain: _Chain, *, factor: Array) -> None:
    """Add what registered edges measure, in place; ``factor`` on their turns and shifts, (2,)."""
    of = graph.relations
    i, j = chain.knot_of[of.i], chain.knot_of[of.j]
    used = np.flatnonzero(of.in_graph & (of.j > of.i + 1) & (i != j))
    if not len(used):
        return
    # Edges of the same two places share the errors of their sub-maps.
    places = np.stack([i[used] // 2, j[used] // 2], axis=1)
    _, which, count = np.unique(places, axis=0, return_inverse=True, return_counts=True)
    move = _transport(chain.T_map_body.t[j[used]] - chain.T_map_body.t[i[used]])
    scale = 1.0 / np.repeat(factor, 3)
    measured = in_map_axes(graph.T_map_body[of.j[used]], of.information[used])
    W = scale * measured * scale[:, None] / count[which.ravel()][:, None, None]
    back = np.swapaxes(move, 1, 2) @ W
    ends = 6 * i[used], 6 * j[used]
    parts = zip(*(end.tolist() for end in ends), back @ move, W, back, W @ move, strict=True)
    for first, second, at_a, at_b, across, again in parts:
        a, b = slice(first, first + 6), slice(second, second + 6)
        information[a, a] += at_a
        information[b, b] += at_b
        information[a, b] -= across
        information[b, a] -= again


def _add_positions(
    information: Array,
    positions: PositionPriors,
    *,
    graph: PoseGraph,
    chain: _Chain,
) -> None:
    """Add positions of the antenna, in place."""
    arm = np.einsum("nij,nj->ni", graph.T_map_body.R[positions.node], positions.p_body)
    J = np.concatenate([-skew(arm), np.tile(np.eye(3), (len(arm), 1, 1))], axis=2)
    for node, row, sd_m in zip(chain.knot_of[positions.node], J, positions.sd_m, strict=True):
        own = slice(6 * node, 6 * node + 6)
        information[own, own] += row.T @ np.diag(sd_m**-2.0) @ row


def _single(chain: _Chain, model: ErrorModel, ratio: Array) -> Array:
    """Error of a single pose that no other shares: turn [rad], shift [m]."""
    anchor = ratio * [model.anchor_rad, model.anchor_m]
    return np.maximum(anchor, model.anchor_ratio * chain.usual)


def _unseen(chain: _Chain, graph: PoseGraph, carried: CarriedMotion | None) -> Array:
    """What the registration of each knot's multiframes left unknown, (K, 6, 6)."""
    if carried is None:
        return np.zeros((len(chain.t_ns), 6, 6))
    frame_s = np.median(_step_seconds(graph.t_ns) / np.diff(graph.frame_ids))
    return unseen_errors(
        carried,
        graph.frame_ids[chain.rows],
        chain.T_map_body.R,
        half_s=0.5 / float(frame_s),
        limits=chain.limits,
    )


def _alone(chain: _Chain, model: ErrorModel, single: Array, *, on_earth: bool) -> Array:
    """What the errors of single poses add, and on earth that of all positions, (K, 6, 6)."""
    alone = np.diag(np.repeat(single, 3) ** 2)
    if on_earth:
        common = np.diag(np.repeat([0.0, model.gnss_m], 3) ** 2)
        about_z = np.diag([0.0, 0.0, model.gnss_turn_rad**2, 0.0, 0.0, 0.0])
        move = _transport(chain.T_map_body.t - chain.T_map_body.t.mean(axis=0))
        return np.asarray(alone + common + move @ about_z @ np.swapaxes(move, 1, 2))
    move = _transport(chain.T_map_body.t - chain.T_map_body.t[0])
    first = np.diag(np.repeat(single * [model.first_turn, 1.0], 3) ** 2)
    return np.asarray(move @ first @ np.swapaxes(move, 1, 2) + alone)
