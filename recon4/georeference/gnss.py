"""Georeferencing of a pose graph by GNSS priors (V §2.7, Fig. 2.10b; requirements A10)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, align_points
from recon4.georeference.crs import GeodeticOrigin
from recon4.georeference.gnss_priors import (
    GnssPriors,
    correlated_sd,
    one_prior_per_node,
    usable_gnss_priors,
)
from recon4.georeference.tuning import ALIGN, GnssTuning
from recon4.model.local_frame import LocalReason
from recon4.model.pose_graph import AUTOMATIC, Judge, Judgment, PoseGraph
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.pose_graph.priors import PosePriors, PositionPriors, Priors
from recon4.pose_graph.robust import optimize_gnc
from recon4.pose_graph.solve import optimize
from recon4.pose_graph.tuning_solve import ROBUST
from recon4.pose_graph.verification import outlier_judgments, with_judgments


@dataclass(frozen=True, slots=True, kw_only=True)
class LocalRecord:
    """A map without a place on earth in ``georeference.json``; the fields are its keys."""

    georeferenced: bool = False
    reason: LocalReason
    fixes: int = 0
    """Number of fixes in the recording."""
    fixes_usable: int | None = None
    """None = not counted, as all that follows."""
    fixes_agreeing: int | None = None
    """Usable fixes that agree with the trajectory."""
    extent_m: float | None = None
    """Of the trajectory over these [m]."""
    beside_m: float | None = None
    """Largest distance of a usable fix from the trajectory [m]; None = one of them stood, too."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OriginRecord:
    """The origin of a map on WGS 84."""

    lat_deg: float
    lon_deg: float
    height_m: float
    """Ellipsoidal [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GeoreferenceRecord:
    """A georeferenced map in ``georeference.json``; the fields are its keys."""

    georeferenced: bool = True
    frame: str
    origin: OriginRecord
    fixes: int
    """Number of fixes in the recording."""
    fixes_usable: int
    fixes_used: int
    rmse_enu_m: list[float]
    t_ns: list[int]
    """Times of the usable fixes [ns], (M,)."""
    residual_enu_m: list[list[float]]
    """(M, 3), see `GeoreferenceResult.residual_m`."""
    used: list[bool]
    """(M,)."""
    edges_rejected: list[int]


@dataclass(frozen=True, slots=True, eq=False)
class GeoreferenceResult:
    """A graph in the local frame at `origin`, or the unchanged graph and the reason why."""

    graph: PoseGraph
    """``T_map_body`` with x east, y north, z up at the origin, if there is one."""
    origin: GeodeticOrigin | None
    """None: the map stays in its own local frame and is not georeferenced."""
    local: LocalRecord | None
    """Why there is no origin; None if there is one."""
    T_enu_map: SE3
    """Initial rigid alignment: heading and shift only."""
    t_ns: Times
    """Times of the usable fixes [ns], (M,)."""
    residual_m: Array
    """Measured minus solved position of the antenna, east, north, up [m], (M, 3)."""
    used: NDArray[np.bool_]
    """False: outlier, (M,)."""
    samples: int
    """Number of fixes in the recording."""
    rejected: tuple[int, ...] = ()
    """Rows of edges rejected because they contradict the GNSS priors."""
    positions: PositionPriors | None = None
    """The fixes used, as the graph has them."""
    frame: str = "x east, y north, z up; WGS 84, ellipsoidal height"
    """Axes of the map."""

    @property
    def rmse_m(self) -> Array:
        """Root mean square residual of the fixes used, east, north, up [m], (3,)."""
        if not self.used.any():
            return np.full(3, np.nan)
        return np.sqrt(np.mean(self.residual_m[self.used] ** 2, axis=0))

    def record(self) -> GeoreferenceRecord | LocalRecord:
        """What ``georeference.json`` has of it."""
        if self.origin is None:
            assert self.local is not None
            return self.local
        return GeoreferenceRecord(
            frame=self.frame,
            origin=OriginRecord(
                lat_deg=float(np.rad2deg(self.origin.lat_rad)),
                lon_deg=float(np.rad2deg(self.origin.lon_rad)),
                height_m=self.origin.ellipsoidal_height_m,
            ),
            fixes=self.samples,
            fixes_usable=len(self.used),
            fixes_used=int(self.used.sum()),
            rmse_enu_m=self.rmse_m.tolist(),
            t_ns=self.t_ns.tolist(),
            residual_enu_m=np.round(self.residual_m, 4).tolist(),
            used=self.used.tolist(),
            edges_rejected=list(self.rejected),
        )


def georeference(
    graph: PoseGraph,
    trajectory: Trajectory,
    gnss: GnssSamples | None,
    *,
    rig: Rig,
    settings: GnssTuning,
) -> GeoreferenceResult:
    """Georeference a leveled graph by its GNSS positions.

    A rigid alignment (heading and shift, by consensus of the fixes) excludes gross errors. Then
    every fix becomes a factor on its node, with the lever arm, a Cauchy kernel and a standard
    deviation that leaves frame-to-frame motion to SLAM. Outliers are excluded and the graph is
    solved again. The fixes determine position and heading, the leveling determines the tilt.

    Edges that contradict the positions are rejected first: if a walk has a single loop, only
    positions show that it is false. These edges get `Reason.ROBUST`; odometry and decisions of a
    person stay.

    Args:
        graph: Verified and leveled (z up).
        trajectory: Dense poses of the body in any frame, covering the walk.
        gnss: Positions, or None.
        rig: Lever arm and time offset of the antenna.
        settings: Qualities, gates and weights.

    Returns:
        Without enough consistent positions the unchanged graph, with the reason.

    Raises:
        GraphError: If the graph itself cannot be solved.
    """
    if gnss is None or not settings.enabled:
        why = LocalReason.NO_GNSS if gnss is None else LocalReason.SWITCHED_OFF
        return _local(graph, LocalRecord(reason=why))
    gnss_priors, origin = usable_gnss_priors(graph, trajectory, gnss, rig=rig, settings=settings)
    if origin is None or len(gnss_priors) < ALIGN.min_priors:
        usable, few = len(gnss_priors), LocalReason.FEW_FIXES
        return _local(graph, LocalRecord(reason=few, fixes=len(gnss), fixes_usable=usable))
    return _place_by_priors(graph, gnss_priors, origin, samples=len(gnss), settings=settings)


def _place_by_priors(
    graph: PoseGraph,
    gnss_priors: GnssPriors,
    origin: GeodeticOrigin,
    *,
    samples: int,
    settings: GnssTuning,
) -> GeoreferenceResult:
    """Align by consensus, exclude edges and fixes that contradict, solve."""
    p_map = graph.T_map_body[gnss_priors.node] @ gnss_priors.p_node_antenna
    T_enu_map, near = align_heading(p_map, gnss_priors, settings=settings)
    extent = float(np.linalg.norm(np.ptp(p_map[near, :2], axis=0))) if near.any() else 0.0
    if near.sum() < ALIGN.min_priors or extent < settings.min_extent_m:
        local = LocalRecord(
            reason=LocalReason.NO_AGREEMENT,
            fixes=samples,
            fixes_usable=len(gnss_priors),
            fixes_agreeing=int(near.sum()),
            extent_m=round(extent, 3),
            beside_m=_beside_m(p_map, gnss_priors, settings=settings),
        )
        return _local(graph, local)
    graph = graph.with_poses(T_enu_map @ graph.T_map_body)
    rejected = _contradicting(graph, gnss_priors, near, settings=settings)
    graph = with_judgments(graph, rejected)
    graph, used = _solve(graph, gnss_priors, near, settings=settings)
    return GeoreferenceResult(
        graph=graph,
        origin=origin,
        local=None,
        T_enu_map=T_enu_map,
        t_ns=gnss_priors.t_ns,
        residual_m=_residuals(graph, gnss_priors),
        used=used,
        samples=samples,
        rejected=tuple(rejected),
        positions=_positions(gnss_priors.take(used), settings),
    )


def _beside_m(p_map: Array, gnss_priors: GnssPriors, *, settings: GnssTuning) -> float | None:
    """How far fixes lie from a trajectory that they do not place [m]; None if one stood."""
    tracks = (gnss_priors.p_enu[:, :2], p_map[:, :2])
    if min(np.linalg.norm(np.ptp(track, axis=0)) for track in tracks) < settings.min_extent_m:
        return None
    T_enu_map = _heading_fit(p_map, gnss_priors.p_enu, gnss_priors.sd_m)
    beside_m = np.linalg.norm((gnss_priors.p_enu - T_enu_map @ p_map)[:, :2], axis=1)
    return round(float(beside_m.max()), 3)


def align_heading(
    p_map: Array, gnss_priors: GnssPriors, *, settings: GnssTuning
) -> tuple[SE3, NDArray[np.bool_]]:
    """Heading and shift with the largest consensus of fixes (RANSAC).

    Args:
        p_map: Antenna in the leveled map at each fix [m], (M, 3).
        gnss_priors: The same in the local frame on earth.
        settings: Gate and seed.

    Returns:
        ``T_enu_map``, and which fixes lie inside the gate, (M,).
    """
    rng = np.random.default_rng(settings.seed)
    steps = np.linalg.norm(np.diff(p_map, axis=0), axis=1)
    gate = (
        settings.gate_m
        + settings.gate_relative * steps.sum()
        + 3.0 * gnss_priors.sd_m[:, :2].max(1)
    )
    far_enough = max(settings.min_extent_m, 0.3 * float(np.linalg.norm(np.ptp(p_map, axis=0))))
    best = (SE3.identity(), np.zeros(len(gnss_priors), dtype=np.bool_))
    for _ in range(ALIGN.draws):
        a, b = rng.integers(0, len(gnss_priors), 2)
        if np.linalg.norm(p_map[a, :2] - p_map[b, :2]) < far_enough:
            continue
        pair = [a, b]
        T_enu_map = _heading_fit(p_map[pair], gnss_priors.p_enu[pair], gnss_priors.sd_m[pair])
        near = _near(T_enu_map, p_map, gnss_priors, gate=gate)
        if near.sum() > best[1].sum():
            best = (T_enu_map, near)
    for _ in range(5 if best[1].any() else 0):
        near = best[1]
        T_enu_map = _heading_fit(p_map[near], gnss_priors.p_enu[near], gnss_priors.sd_m[near])
        best = (T_enu_map, _near(T_enu_map, p_map, gnss_priors, gate=gate))
    return best


def _heading_fit(p_map: Array, p_enu: Array, sd_m: Array) -> SE3:
    weights = 1.0 / sd_m.max(1) ** 2
    flat = np.array([1.0, 1.0, 0.0])
    R = align_points(p_enu * flat, p_map * flat, weights).R
    yaw = np.arctan2(R[1, 0], R[0, 0])
    turn = SE3.from_rpy(0.0, 0.0, float(yaw), t=[0.0, 0.0, 0.0])
    shift = np.average(p_enu - turn @ p_map, axis=0, weights=weights)
    return SE3(turn.R, shift)


def _near(
    T_enu_map: SE3, p_map: Array, gnss_priors: GnssPriors, *, gate: Array
) -> NDArray[np.bool_]:
    off = gnss_priors.p_enu - T_enu_map @ p_map
    vertical = gate + 3.0 * gnss_priors.sd_m[:, 2]
    return (np.hypot(off[:, 0], off[:, 1]) < gate) & (np.abs(off[:, 2]) < vertical)


def _solve(
    graph: PoseGraph, gnss_priors: GnssPriors, near: NDArray[np.bool_], *, settings: GnssTuning
) -> tuple[PoseGraph, NDArray[np.bool_]]:
    """Solve with the fixes inside the gate, then again without the outliers."""
    used, tilt = near, tilt_priors(graph, sd_rad=settings.tilt_sd_rad)
    for _ in range(2):
        priors = (_positions(gnss_priors.take(used), settings), tilt)
        solution = optimize(graph, kernel="cauchy", fixed=(), priors=priors)
        graph = graph.with_poses(solution.T_map_body)
        off = np.abs(_residuals(graph, gnss_priors)) / gnss_priors.sd_m
        scale = np.maximum(1.4826 * np.median(off[used], axis=0), 1.0)
        used = near & np.all(off < ALIGN.outlier_sd * scale, axis=1)
    return graph, used


def _contradicting(
    graph: PoseGraph, gnss_priors: GnssPriors, near: NDArray[np.bool_], *, settings: GnssTuning
) -> dict[int, Judgment]:
    """Judgments on the edges that the robust solve with GNSS priors rejects, by row.

    Outliers of the fixes are found by the walk without its loops: otherwise several wrong loops
    would reject the fixes that contradict them.
    """
    if not settings.judge_edges:
        return {}
    short = tuple(
        e for e in graph.edges if e.decided_by != AUTOMATIC or abs(e.j - e.i) < ROBUST.loop_nodes
    )
    walk, used = _solve(graph.with_edges(short), gnss_priors, near, settings=settings)
    tilt = tilt_priors(graph, sd_rad=settings.tilt_sd_rad)
    priors: tuple[Priors, ...] = (_positions(gnss_priors.take(used), settings), tilt)
    graph = graph.with_poses(walk.T_map_body)
    robust = optimize_gnc(graph, fixed=(), priors=priors)
    outliers = np.flatnonzero(graph.relations.in_graph & (robust.weights == 0.0)).tolist()
    return outlier_judgments(robust, outliers, by=Judge.GNSS)


def _positions(gnss_priors: GnssPriors, settings: GnssTuning) -> PositionPriors:
    chosen = one_prior_per_node(gnss_priors)
    sd_m = correlated_sd(chosen, correlation_s=settings.correlation_s)
    return PositionPriors(chosen.node, chosen.p_enu, chosen.p_node_antenna, sd_m)


def tilt_priors(graph: PoseGraph, *, sd_rad: float) -> PosePriors:
    """Priors that keep the tilt of the map: all nodes together count as one measurement.

    Without them the roll of a straight track about itself would be unobservable.
    """
    R = graph.T_map_body.R
    up = R[:, 2, :]
    information = np.zeros((len(graph), 6, 6))
    weight = 1.0 / (sd_rad**2 * len(graph))
    information[:, ROTATION, ROTATION] = weight * (np.eye(3) - np.einsum("ni,nj->nij", up, up))
    # Heading and position stay free; gtsam requires a positive definite matrix.
    information += 1e-6 * weight * np.eye(6)
    information[:, TRANSLATION, TRANSLATION] = 1e-9 * np.eye(3)
    return PosePriors(np.arange(len(graph)), graph.T_map_body, information)


def _residuals(graph: PoseGraph, gnss_priors: GnssPriors) -> Array:
    return gnss_priors.p_enu - graph.T_map_body[gnss_priors.node] @ gnss_priors.p_node_antenna


def _local(graph: PoseGraph, local: LocalRecord) -> GeoreferenceResult:
    empty = np.zeros(0, dtype=np.int64)
    return GeoreferenceResult(
        graph=graph,
        origin=None,
        local=local,
        T_enu_map=SE3.identity(),
        t_ns=empty,
        residual_m=np.zeros((0, 3)),
        used=empty.astype(np.bool_),
        samples=local.fixes,
    )
