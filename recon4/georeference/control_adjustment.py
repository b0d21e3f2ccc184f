"""Adjustment of a trajectory to control points (V §2.7, with targets in place of an antenna).

A target at ``s``, seen at ``q`` by the node with the pose ``T``, is a factor ``T q - s`` on that
node. ``n`` nodes that saw it share the errors of survey and pick, so each has ``1/n`` of the
information. The other factors are the motions of the refined trajectory with the information of
the edges of the graph, GNSS positions, and the tilt by leveling. The correction of the nodes is
carried to all poses between them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.georeference.control_fit import ControlFit, MeasuredTarget, fit_control
from recon4.georeference.gnss import tilt_priors
from recon4.georeference.tuning_control import ADJUSTMENT, CONTROL_FIT
from recon4.model.corrections import apply_corrections
from recon4.model.edge_columns import EdgeColumns
from recon4.model.pose_graph import PoseGraph, Rows
from recon4.model.site_control import SeenTarget
from recon4.model.survey_covariance import covariance_matrix
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.priors import PositionPriors, Priors, TargetPriors
from recon4.pose_graph.solve import optimize
from recon4.pose_graph.uncertainty import PoseUncertainty


@dataclass(frozen=True, slots=True, eq=False)
class Adjusted:
    """A graph in the coordinates of the site."""

    graph: PoseGraph
    """``T_site_body`` of the nodes; its edges as they were given."""
    T_site_map: SE3
    """The rigid fit before."""
    measured: tuple[MeasuredTarget, ...]
    """The control points before."""
    fit: ControlFit
    positions: PositionPriors | None
    """GNSS positions in the site, and the control points as if they were such."""
    datum_shift_m: Array | None
    """By how much the GNSS positions were moved, because all control points contradict them alike
    [m], (3,); None = not at all."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ToAdjust:
    """A map before its adjustment."""

    trajectory: Trajectory
    """Dense poses ``T_map_body`` whose motions are kept; leveled."""
    graph: PoseGraph
    """Its edges; the poses are not used."""
    leveled: bool
    tilt_sd_rad: float
    positions: PositionPriors | None = None
    """GNSS positions that place the map."""
    on_earth: bool = False
    """Whether these are in the system of the control points; else they say its shape only."""
    start: SE3 | None = None
    """Poses of the nodes in the frame of ``positions``; None = those of the trajectory."""
    keep_edges: bool = False
    """Whether the edges themselves are the motions: some of those the trajectory followed are
    rejected since."""
    uncertainty: PoseUncertainty | None = None
    """Of the poses of the map, for the test of points."""


def survey_covariance(target: SeenTarget) -> Array:
    """Covariance of survey and pick [m²], (3, 3), along the axes of the survey.

    Without one of its own it is the same about the vertical. The frame of the map is turned from a
    grid by the convergence of meridians at most, below 3°: an ellipse is not turned with it.
    """
    if target.covariance_m2 is not None:
        return covariance_matrix(target.covariance_m2)
    horizontal, vertical = target.sd_m
    return np.diag([horizontal**2, horizontal**2, vertical**2])


def measured_targets(
    targets: Sequence[SeenTarget],
    p_site: Array,
    trajectory: Trajectory,
    *,
    uncertainty: PoseUncertainty | None = None,
) -> list[MeasuredTarget]:
    """Where a map has targets, with the covariance of survey, pick and map.

    Args:
        targets: What was seen.
        p_site: Surveyed places in a frame without distortion of scale [m], (N, 3).
        trajectory: Of the map.
        uncertainty: Of its poses; None = not stated.
    """
    found = []
    for target, p in zip(targets, p_site, strict=True):
        cov = survey_covariance(target)
        if uncertainty is not None:
            cov = cov + _of_map(uncertainty, target)
        place, along = target.place_in(trajectory), target.directions_in(trajectory)
        found.append(MeasuredTarget(target.id, p, place, along, cov))
    return found


def adjust(given: ToAdjust, targets: Sequence[SeenTarget], p_site: Array) -> Adjusted:
    """Put a map on control points, then bend its trajectory to them.

    Args:
        given: The map.
        targets: Control points.
        p_site: Where they were surveyed, near the origin [m], (N, 3).

    Raises:
        GeoreferenceError: As `fit_control`.
        GraphError: If the graph cannot be solved.
    """
    dense, graph = given.trajectory, given.graph
    moved = graph.with_poses(given.start or dense.at(graph.t_ns))
    start = Trajectory(graph.t_ns, moved.T_map_body)
    measured = measured_targets(
        targets, p_site, _carried(dense, start), uncertainty=given.uncertainty
    )
    fit = fit_control(measured, leveled=given.leveled)
    T_site_map = fit.T_map_site.inverse()
    if not given.keep_edges:
        moved = at_rest(moved, dense)
    moved = moved.with_poses(T_site_map @ moved.T_map_body)
    priors: list[Priors] = [
        _target_priors(targets, measured, moved, dense=dense, R_site_map=T_site_map.R)
    ]
    if given.leveled:
        priors.append(tilt_priors(moved, sd_rad=given.tilt_sd_rad))
    shift = datum_shift(measured) if given.on_earth else None
    positions = None
    if given.positions is not None:
        moves = T_site_map if not given.on_earth else SE3(np.eye(3), _vector(shift))
        positions = _moved(given.positions, moves)
    if positions is not None:
        priors.append(positions)
    solution = optimize(moved, kernel="cauchy", fixed=(), priors=priors)
    as_positions = _as_positions(priors[0])
    return Adjusted(
        graph=graph.with_poses(solution.T_map_body),
        T_site_map=T_site_map,
        measured=tuple(measured),
        fit=fit,
        positions=_joined(positions, as_positions),
        datum_shift_m=shift,
    )


def datum_shift(measured: Sequence[MeasuredTarget]) -> Array | None:
    """How far the survey lies from GNSS positions in the same system [m], (3,); None = it agrees.

    The shift of a map on earth that brings it onto the control points.
    """
    off = np.array([one.p_site - one.p_map for one in measured])
    full = np.array([len(one.along) == 3 for one in measured])
    if full.sum() < CONTROL_FIT.least_points:
        return None
    mean, spread = off[full].mean(axis=0), off[full].std(axis=0)
    sd = np.sqrt(np.mean([np.diag(one.cov) for one in measured], axis=0))
    of_mean = np.maximum(spread, sd) / np.sqrt(full.sum())
    shared = (np.abs(mean) > ADJUSTMENT.datum_sd * of_mean) & (np.abs(mean) > ADJUSTMENT.datum_m)
    return np.where(shared, mean, 0.0) if shared.any() else None


def _vector(shift: Array | None) -> Array:
    return np.zeros(3) if shift is None else shift


def _carried(dense: Trajectory, nodes: Trajectory) -> Trajectory:
    return apply_corrections(dense, nodes.t_ns, T_before=dense.at(nodes.t_ns), T_after=nodes.T_a_b)


def at_rest(graph: PoseGraph, trajectory: Trajectory) -> PoseGraph:
    """The graph whose edges measure the motions of a trajectory: it resists being bent.

    The refined trajectory is better than the edges it began with; these say how stiff it is.
    """
    T = trajectory.at(graph.t_ns)
    return graph.with_edges(
        EdgeColumns.of(edge.evolve(T_i_j=T[edge.i].inverse() @ T[edge.j]) for edge in graph.edges)
    )


def _target_priors(
    targets: Sequence[SeenTarget],
    measured: Sequence[MeasuredTarget],
    graph: PoseGraph,
    *,
    dense: Trajectory,
    R_site_map: Array,
) -> TargetPriors:
    node, p_map, p_body, information = list[Rows](), list[Array](), list[Array](), list[Array]()
    for target, one in zip(targets, measured, strict=True):
        t_ns = np.array(target.t_ns)
        rows = np.abs(graph.t_ns[None, :] - t_ns[:, None]).argmin(axis=1)
        # From the body at that time into that of its node; only motion between them is used.
        T_node_body = dense.at(graph.t_ns[rows]).inverse() @ dense.at(t_ns)
        node.append(rows)
        p_body.append(T_node_body @ np.array(target.p_body_m))
        p_map.append(np.tile(one.p_site, (len(rows), 1)))
        # Not those of the dense trajectory: GNSS may have turned the map since.
        along = one.along @ R_site_map.T
        weight = _information(along, target) / len(rows)
        information.append(np.tile(weight, (len(rows), 1, 1)))
    return TargetPriors(
        np.concatenate(node),
        np.concatenate(p_map),
        np.concatenate(p_body),
        np.concatenate(information),
    )


def _information(along: Array, target: SeenTarget) -> Array:
    cov = along @ survey_covariance(target) @ along.T
    measured = np.asarray(along.T @ np.linalg.inv(cov) @ along)
    return measured + ADJUSTMENT.weak * np.trace(measured) * np.eye(3)


def _as_positions(prior: Priors) -> PositionPriors:
    """The same for the covariances of the poses, which know positions along the axes."""
    assert isinstance(prior, TargetPriors)
    sd_m = np.diagonal(prior.information, axis1=1, axis2=2) ** -0.5
    return PositionPriors(prior.node, prior.p_map, prior.p_body, np.asarray(sd_m))


def _moved(positions: PositionPriors, T: SE3) -> PositionPriors:
    return PositionPriors(positions.node, T @ positions.p_map, positions.p_body, positions.sd_m)


def _joined(a: PositionPriors | None, b: PositionPriors) -> PositionPriors:
    if a is None:
        return b
    return PositionPriors(
        np.concatenate([a.node, b.node]),
        np.concatenate([a.p_map, b.p_map]),
        np.concatenate([a.p_body, b.p_body]),
        np.concatenate([a.sd_m, b.sd_m]),
    )


def _of_map(uncertainty: PoseUncertainty, target: SeenTarget) -> Array:
    """Covariance of the map at a target, the mean over those who saw it [m²], (3, 3)."""
    at = np.array(target.t_ns)
    if uncertainty.on_earth:
        return np.asarray(uncertainty.at(at)[:, 3:, 3:].mean(axis=0))
    rows = np.abs(uncertainty.t_ns[None, :] - at[:, None]).argmin(axis=1)
    return np.asarray(uncertainty.shape_cov[rows].mean(axis=0))
