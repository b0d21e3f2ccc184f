"""GNSS priors: usable fixes with their standard deviations and nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.georeference.crs import GeodeticOrigin, to_enu
from recon4.georeference.tuning import FIXES, GnssTuning
from recon4.model.pose_graph import PoseGraph, Rows
from recon4.model.rig import Rig
from recon4.model.samples import GnssQuality, GnssSamples
from recon4.model.trajectory import Times, Trajectory

_RANKS: dict[int, int] = {
    GnssQuality.SINGLE: 1,
    GnssQuality.DIFFERENTIAL: 2,
    GnssQuality.RTK_FLOAT: 3,
    GnssQuality.RTK_FIXED: 4,
}
"""Rank of each fix quality; others (invalid, dead reckoning) are never used."""
_ASKED = {"single": 1, "differential": 2, "float": 3, "fixed": 4}


@dataclass(frozen=True, slots=True, eq=False)
class GnssPriors:
    """Usable fixes, each assigned to a node of the graph."""

    t_ns: Times
    """Time in the rig's clock [ns], (M,)."""
    row: Rows
    """Row in the `GnssSamples`, (M,)."""
    p_enu: Array
    """Position of the antenna [m], (M, 3)."""
    sd_m: Array
    """Standard deviation of one fix, east, north, up [m], (M, 3)."""
    node: Rows
    """Nearest node in time, (M,)."""
    p_node_antenna: Array
    """Position of the antenna at that time in the body frame of that node [m], (M, 3)."""

    def __len__(self) -> int:
        return len(self.t_ns)

    def take(self, rows: Any) -> GnssPriors:
        """The priors of some rows."""
        return GnssPriors(*(getattr(self, name)[rows] for name in GnssPriors.__slots__))


def usable_gnss_priors(
    graph: PoseGraph, trajectory: Trajectory, gnss: GnssSamples, *, rig: Rig, settings: GnssTuning
) -> tuple[GnssPriors, GeodeticOrigin | None]:
    """Select fixes with a position, of sufficient quality, during the walk and not frozen.

    Args:
        graph: A fix belongs to the node nearest in time.
        trajectory: Dense poses of the body; only motion between a fix and its node is used.
        gnss: Samples of the receiver.
        rig: Lever arm and time offset.
        settings: Required quality, smallest standard deviation.

    Returns:
        The priors and the origin of their local frame: the first fix of the best quality. Without
        a usable fix no priors, and None as origin.
    """
    t_ns = gnss.t_ns
    rank = np.array([_RANKS.get(int(quality), 0) for quality in gnss.quality], dtype=np.intp)
    good = (rank >= _ASKED[settings.min_quality]) & positioned(gnss)
    good &= (t_ns >= trajectory.t_ns[0]) & (t_ns <= trajectory.t_ns[-1])
    rows = np.flatnonzero(good)
    p_antenna = trajectory.at(t_ns[rows]) @ np.broadcast_to(rig.p_body_antenna, (len(rows), 3))
    moving = ~_frozen(gnss, rows, p_antenna)
    rows, p_antenna = rows[moving], p_antenna[moving]
    if len(rows) == 0:
        return GnssPriors(*_nothing()), None
    first = rows[np.argmax(rank[rows])]
    origin = GeodeticOrigin(
        float(gnss.lat_rad[first]), float(gnss.lon_rad[first]), float(gnss.height_m[first])
    )
    height_m = gnss.height_m[rows]
    p_enu = to_enu(origin, gnss.lat_rad[rows], gnss.lon_rad[rows], ellipsoidal_height_m=height_m)
    node = _nearest(graph.t_ns, t_ns[rows])
    T_odom_node = trajectory.at(np.clip(graph.t_ns, trajectory.t_ns[0], trajectory.t_ns[-1]))[node]
    sd_m = np.where(
        np.isfinite(gnss.sd_enu_m[rows]),
        gnss.sd_enu_m[rows],
        np.array(FIXES.default_sd_m)[rank[rows]],
    )
    return (
        GnssPriors(
            t_ns=t_ns[rows],
            row=rows,
            p_enu=p_enu,
            sd_m=np.maximum(sd_m, settings.min_sd_m),
            node=node,
            p_node_antenna=T_odom_node.inverse() @ p_antenna,
        ),
        origin,
    )


def one_prior_per_node(gnss_priors: GnssPriors) -> GnssPriors:
    """The best fix of each node; further ones are redundant."""
    order = np.lexsort((gnss_priors.t_ns, gnss_priors.sd_m.sum(1), gnss_priors.node))
    first = np.r_[True, np.diff(gnss_priors.node[order]) > 0] if len(order) else order
    return gnss_priors.take(np.sort(order[first]))


def correlated_sd(gnss_priors: GnssPriors, *, correlation_s: float) -> Array:
    """Standard deviations of fixes with correlated errors [m], (M, 3).

    ``n`` fixes within the correlation time have the information of one: the standard deviation of
    each is multiplied by ``sqrt(n)``, so that SLAM determines the motion between them.
    """
    half = correlation_s * 0.5e9
    left = np.searchsorted(gnss_priors.t_ns, gnss_priors.t_ns - half, side="left")
    right = np.searchsorted(gnss_priors.t_ns, gnss_priors.t_ns + half, side="right")
    return gnss_priors.sd_m * np.sqrt(np.maximum(right - left, 1))[:, None]


def positioned(gnss: GnssSamples) -> NDArray[np.bool_]:
    """Whether each fix has a possible position and a height, (N,)."""
    finite = np.isfinite(gnss.lat_rad) & np.isfinite(gnss.lon_rad) & np.isfinite(gnss.height_m)
    possible = (np.abs(gnss.lat_rad) <= np.pi / 2) & (np.abs(gnss.lon_rad) <= 2 * np.pi)
    # Receivers without a fix write 0, 0.
    return finite & possible & ((gnss.lat_rad != 0.0) | (gnss.lon_rad != 0.0))


def _frozen(gnss: GnssSamples, rows: Rows, p_antenna: Array) -> NDArray[np.bool_]:
    """Fixes that repeat an earlier one to the last digit although the body moved."""
    frozen = np.zeros(len(rows), dtype=np.bool_)
    since = 0
    for k in range(1, len(rows)):
        a, b = rows[since], rows[k]
        same = gnss.lat_rad[a] == gnss.lat_rad[b] and gnss.lon_rad[a] == gnss.lon_rad[b]
        if not same:
            since = k
        elif np.linalg.norm(p_antenna[k] - p_antenna[since]) > FIXES.frozen_m:
            frozen[k] = True
    return frozen


def _nearest(t_nodes_ns: Times, t_ns: Times) -> Rows:
    right = np.clip(np.searchsorted(t_nodes_ns, t_ns), 1, max(len(t_nodes_ns) - 1, 1))
    right = np.minimum(right, len(t_nodes_ns) - 1)
    left = np.maximum(right - 1, 0)
    closer_left = t_ns - t_nodes_ns[left] <= t_nodes_ns[right] - t_ns
    return np.where(closer_left, left, right)


def _nothing() -> tuple[Any, ...]:
    none, vectors = np.zeros(0, dtype=np.intp), np.zeros((0, 3))
    return none.astype(np.int64), none, vectors, vectors, none, vectors
