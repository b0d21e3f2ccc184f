"""Control and check points as a run is given them: surveyed targets, and who saw them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import msgspec
import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.survey_covariance import Covariance
from recon4.model.trajectory import Trajectory

Xyz = tuple[float, float, float]

SITE_GRID = "site grid"
"""Name of the coordinate system that control points alone define."""


class SeenPlace(msgspec.Struct, frozen=True, kw_only=True):
    """A place in the body frame of the nodes that saw it.

    It does not depend on where a map puts the nodes: another map uses it again.
    """

    t_ns: tuple[int, ...]
    """Times of the multiframes that saw it [ns], (M,), M >= 1."""
    p_body_m: tuple[Xyz, ...]
    """The place in the body at these times [m], (M, 3)."""
    directions_body: tuple[tuple[Xyz, ...], ...]
    """Measured directions in the body at these times, orthonormal rows, (M, 1..3, 3)."""

    def place_in(self, trajectory: Trajectory) -> Array:
        """Where a map has it [m], (3,): the mean over the multiframes that saw it.

        Raises:
            OutOfRange: If the trajectory is not that of this walk.
        """
        T_map_body = trajectory.at(np.array(self.t_ns))
        return np.asarray((T_map_body @ np.array(self.p_body_m)).mean(axis=0))

    def directions_in(self, trajectory: Trajectory) -> Array:
        """Directions in which it was measured, in the map, (1..3, 3)."""
        R = trajectory.at(np.array(self.t_ns[:1])).R[0]
        return np.asarray(np.array(self.directions_body[0]) @ R.T)


class SeenTarget(SeenPlace, frozen=True, kw_only=True, omit_defaults=True):
    """A surveyed target, and who saw it."""

    id: str
    xyz_m: Xyz
    """Easting, northing, height of the survey [m]."""
    role: Literal["control", "check"]
    """Control points place the map, check points only judge it."""
    sd_m: tuple[float, float]
    """Standard deviation of survey and pick together, horizontal (each axis) and height [m]."""
    covariance_m2: Covariance | None = None
    """Of survey and pick together, in place of ``sd_m``; None = not stated. Left out of the journal
    then, so that earlier decisions keep their hash."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SiteControl:
    """What places a map in the coordinates of a site."""

    targets: tuple[SeenTarget, ...]
    crs: str
    """EPSG code or codes of the survey; empty = a grid of the site alone."""
