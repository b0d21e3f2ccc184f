"""How wrong edges are: factors from walks with known truth, and what a graph shows of itself.

Registered edges of a walk measure the same motions many times. How far they disagree with the
solved graph, and how far the graph moves the odometry, shows how wrong both are: in a garage of
large planes a fifth of what is usual in an office, with a clock that is off many times as much.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import ROTATION, TRANSLATION, Array
from recon4.model.pose_graph import Flags, PoseGraph
from recon4.pose_graph.carried_motion import CarriedMotion
from recon4.pose_graph.relations import odometry_steps
from recon4.pose_graph.tuning_solve import ERROR_MODEL


@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorModel:
    """True errors of edges against the covariances that the stages state.

    Where the LiDAR observes a direction, the stated deviations of odometry are several times too
    large, because they are those of single multiframes added up. Where it does not, they are those
    of the predicted velocity, whose error stays the same for seconds.
    """

    observed: float = 0.08
    """Factor on the standard deviation of an odometry edge along directions that are observed."""
    weak: float = 1.0
    """The same along directions that are not."""
    observed_m: float = 0.002
    """Half a second of odometry along observed directions is not more wrong than this [m] …"""
    observed_rad: float = 3e-4
    """… and its turn than this [rad]."""
    weak_m: float = 0.05
    """Stated deviation of half a second of odometry at which a direction is weak [m] …"""
    weak_rad: float = 0.01
    """… and of its turn [rad]."""
    surely_weak_m: float = 0.5
    """A direction with a larger deviation is weak on every walk: in a tunnel without an IMU all
    steps are, and nothing of that is usual [m]."""
    weak_ratio: float = 10.0
    """The same as a multiple of what is usual on the walk: without an IMU odometry states
    centimeters also where it is right to millimeters."""
    turn_s: float = 5.0
    """Time over which errors of turns are correlated [s] …"""
    shift_s: float = 1.0
    """… those of shifts along observed directions [s] …"""
    weak_s: float = 10.0
    """… and along weak ones [s]."""
    registered: float = 0.5
    """Factor on the standard deviation of neighbor and loop edges."""
    anchor_rad: float = 3e-4
    """Error of a single pose that no other shares: of the first, and of each [rad] …"""
    anchor_m: float = 1.5e-3
    """… and of its position [m]."""
    first_turn: float = 2.0
    """The turn of the first pose is wrong by this multiple of it: a walk begins standing, and the
    scans of a body that stands share their error."""
    anchor_ratio: float = 0.06
    """The same as a ratio of what half a second of odometry usually states, of shifts along its
    worst axis: without an IMU the points of a multiframe, and its pose, lie wrong along the motion.
    """
    gnss_m: float = 0.02
    """Error of GNSS that all fixes of a walk share [m] …"""
    gnss_turn_rad: float = 0.0
    """… and turn of the whole map about the vertical that they make [rad]."""
    usual_rad: float = 1.15e-3
    """Median residual of registered edges where these factors hold: turn [rad] …"""
    usual_m: float = 3.2e-3
    """… and shift [m]. Where the edges agree better or worse, the errors are smaller or larger."""
    moved: float = 2.0
    """An odometry edge is wrong by this multiple of what the graph moves it by."""


CALIBRATED = ErrorModel()


@dataclass(frozen=True, slots=True, eq=False)
class GraphAgreement:
    """What the residuals of a solved graph say of the errors of its edges."""

    ratio: Array
    """Errors of turns and of shifts as a multiple of the usual ones, (2,)."""
    moved: Array
    """Covariance of what the graph moved the odometry by around each edge, in axes of the map,
    turns and shifts apart, (N - 1, 6, 6)."""


def agreement(
    graph: PoseGraph, model: ErrorModel, *, carried: CarriedMotion | None = None
) -> GraphAgreement:
    """Compare the edges of a solved graph with its poses.

    Args:
        graph: Solved; its odometry edges connect consecutive nodes.
        model: What is usual, and over which time errors are correlated.
        carried: Motion that is known to be unsure: the graph moves it as it should.
    """
    from scipy.ndimage import correlate1d  # slow to import, and the server compares nothing

    of = graph.relations
    xi = (of.T_i_j.inverse() @ graph.T_map_body[of.i].inverse() @ graph.T_map_body[of.j]).log()
    registered = of.in_graph & (of.j > of.i + 1)
    ratio: Array = np.ones(2)
    if registered.any():
        sizes = [
            np.linalg.norm(xi[registered][:, part], axis=1) for part in (ROTATION, TRANSLATION)
        ]
        usual = np.array([model.usual_rad, model.usual_m])
        measured = np.clip(np.median(sizes, axis=1) / usual, ERROR_MODEL.least, ERROR_MODEL.most)
        ratio = measured ** min(registered.sum() / ERROR_MODEL.enough_edges, 1.0)
    moved, weight = np.zeros((len(graph) - 1, 6, 6)), np.zeros(len(graph) - 1)
    steps = odometry_steps(graph)
    steps = steps[_is_strong(of.information[steps], model)]
    for part in (ROTATION, TRANSLATION):
        r = np.einsum("nij,nj->ni", graph.T_map_body.R[of.j[steps]], xi[steps, part])
        moved[of.i[steps], part, part] = r[:, :, None] * r[:, None, :]
    weight[of.i[steps]] = 1.0
    if carried is not None:
        moved[:, TRANSLATION, TRANSLATION] *= _unexplained(
            moved[:, TRANSLATION, TRANSLATION], carried.in_map(graph)
        )[:, None, None]
    step_s = float(np.median(np.diff(graph.t_ns))) / 1e9
    size = 2 * round(model.turn_s / max(step_s, 1e-3)) + 1
    near = correlate1d(weight, np.ones(size), mode="constant")
    total = correlate1d(moved, np.ones(size), axis=0, mode="constant")
    return GraphAgreement(ratio, total / np.maximum(near, 1.0)[:, None, None])


def _unexplained(moved: Array, stated: Array) -> Array:
    """Part of squared shifts ``r r^T`` that is beyond their stated covariances, 0..1, (K,).

    Args:
        moved: [m²], (K, 3, 3).
        stated: [m²], (K, 3, 3).
    """
    squared = np.trace(moved, axis1=1, axis2=2)
    expected = np.einsum("nij,nji->n", moved, stated) / np.maximum(squared, 1e-30)
    return np.clip(1.0 - expected / np.maximum(squared, 1e-30), 0.0, 1.0)


def _is_strong(information: Array, model: ErrorModel) -> Flags:
    """Whether odometry was sure of edges, (E,): what was lost the graph moves as it should be."""
    cov = np.linalg.inv(information)[:, TRANSLATION, TRANSLATION]
    return np.asarray(np.sqrt(np.linalg.eigvalsh(cov)[:, -1]) < model.weak_m)
