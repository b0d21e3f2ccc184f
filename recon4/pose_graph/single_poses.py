"""Errors of single poses that no other pose shares, and no edge of the graph shows.

An edge registers the sub-maps around two nodes, which most of their multiframes make up. One among
them that lies turned or aside changes neither the sub-map nor the edge, however well the edge fits:
what its own registration left unknown stays an error of its pose alone.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import ROTATION, TRANSLATION, Array
from recon4.model.trajectory import Times
from recon4.pose_graph.carried_motion import CarriedMotion
from recon4.pose_graph.tuning_solve import UNCERTAINTY


def weak_part(sd: Array, limit: float) -> Array:
    """Part of a variance that is an error as large as stated, 0..1: half of it at the limit."""
    ratio = sd / limit
    return np.asarray(ratio**4 / (1.0 + ratio**4))


def unseen_errors(
    carried: CarriedMotion, frame_ids: Times, R_map_body: Array, *, half_s: float, limits: Array
) -> Array:
    """Covariance of what the registration of the multiframes around each knot left unknown.

    A knot speaks for the multiframes that are nearer to it than to others: the least known turn
    and the least known shift among them count. Those around a lone one bound its shift.

    Args:
        carried: What the filter states of each multiframe.
        frame_ids: Multiframe of each knot, (K,).
        R_map_body: Attitude of each knot, (K, 3, 3).
        half_s: Number of multiframes in half a second.
        limits: Deviation of half a second of odometry at which a direction is weak: turn [rad],
            shift [m], (2,).

    Returns:
        Turn and shift, in axes of the map, (K, 6, 6).
    """
    knot = np.searchsorted((frame_ids[1:] + frame_ids[:-1]) / 2, np.arange(len(carried.observed)))
    into_map = (R_map_body @ np.swapaxes(carried.R_odom_body[frame_ids], 1, 2))[knot]
    out = np.zeros((len(frame_ids), 6, 6))
    for part, limit, most in zip(
        (ROTATION, TRANSLATION), limits, UNCERTAINTY.unknown_step, strict=True
    ):
        stated = into_map @ carried.motion_cov[:, part, part] @ np.swapaxes(into_map, 1, 2)
        values, V = np.linalg.eigh(stated)
        values = np.maximum(values, 0.0)
        weak = weak_part(half_s * np.sqrt(values), limit)
        if part is TRANSLATION:
            weak[carried.observed] = 0.0
            bounds = into_map @ carried.bounds @ np.swapaxes(into_map, 1, 2)
            values = np.fmin(values, np.einsum("nia,nij,nja->na", V, bounds, V))
        unknown = np.minimum(weak * values, most**2)
        order = np.argsort(unknown.sum(axis=1))  # of several for a knot the last one is kept
        out[knot[order], part, part] = (V * unknown[:, None, :] @ np.swapaxes(V, 1, 2))[order]
    return out
