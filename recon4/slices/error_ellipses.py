"""How well a place of the map is known: error ellipses from the covariances of the poses."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array, skew
from recon4.mapping.deviation import PoseCovariances
from recon4.mapping.tiles import TileSet
from recon4.model.trajectory import Times
from recon4.slices.tuning import ELLIPSES


@dataclass(frozen=True, slots=True)
class ErrorEllipse:
    """Standard deviations of a place (1 σ), from the poses that measured it."""

    major_m: float
    """Along the long horizontal axis [m]."""
    minor_m: float
    """Along the short one [m]."""
    azimuth_deg: float
    """Of the long axis, clockwise from north (or +y), 0..180 [°]."""
    up_m: float
    """Of the height [m]."""


def place_covariance(
    tiles: TileSet, p_map: Array, covariances_at: Callable[[Times], PoseCovariances]
) -> Array | None:
    """Covariance of the map at a place; None without points within 10 cm of it.

    The mean over the points around it: a place that several passes measured has a mean error.

    Args:
        tiles: The map.
        p_map: The place [m], (3,).
        covariances_at: Positions and covariances of the poses by time [ns].

    Returns:
        Covariance in the axes of the map [m²], (3, 3).
    """
    t_ns = _times_near(tiles, p_map)
    if not len(t_ns):
        return None
    poses = covariances_at(t_ns)
    J = np.concatenate(
        [-skew(p_map - poses.position_m), np.broadcast_to(np.eye(3), (len(t_ns), 3, 3))], axis=2
    )
    mean: Array = (J @ poses.cov @ J.transpose(0, 2, 1)).mean(axis=0)
    return mean


def error_ellipse(cov: Array) -> ErrorEllipse:
    """The ellipse of a covariance in the axes east, north, up [m²], (3, 3)."""
    values, vectors = np.linalg.eigh(cov[:2, :2])
    east, north = vectors[:, 1]
    minor, major, up = np.sqrt(np.maximum([*values, cov[2, 2]], 0.0)).tolist()
    return ErrorEllipse(major, minor, math.degrees(math.atan2(east, north)) % 180.0, up)


def _times_near(tiles: TileSet, p_map: Array) -> Times:
    low, high = p_map - ELLIPSES.near_m, p_map + ELLIPSES.near_m
    found = [np.empty(0, np.int64)]
    for tile in tiles:
        if np.any(np.array(tile.low_m) > high) or np.any(np.array(tile.high_m) < low):
            continue
        columns = tile.read(["xyz", "t_ns"], limit=ELLIPSES.sample)
        off = np.abs(columns["xyz"] - (p_map - tile.origin_m)).max(axis=1)
        found.append(columns["t_ns"][off <= ELLIPSES.near_m])
    t_ns = np.concatenate(found)
    return t_ns[:: max(1, len(t_ns) // ELLIPSES.poses)]
