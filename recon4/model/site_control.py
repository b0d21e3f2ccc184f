"""Control and check points as a run is given them: surveyed targets, and who saw them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import msgspec

from recon4.model.survey_covariance import Covariance

SITE_GRID = "site grid"
"""Name of the coordinate system that control points alone define."""


class SeenTarget(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A surveyed target, and its place in the body frame of the nodes that saw it.

    These places do not depend on where a map puts the nodes: another map uses them again.
    """

    id: str
    xyz_m: tuple[float, float, float]
    """Easting, northing, height of the survey [m]."""
    role: Literal["control", "check"]
    """Control points place the map, check points only judge it."""
    sd_m: tuple[float, float]
    """Standard deviation of survey and pick together, horizontal (each axis) and height [m]."""
    t_ns: tuple[int, ...]
    """Times of the multiframes that saw it [ns], (M,), M >= 1."""
    p_body_m: tuple[tuple[float, float, float], ...]
    """The target in the body at these times [m], (M, 3)."""
    directions_body: tuple[tuple[tuple[float, float, float], ...], ...]
    """Measured directions in the body at these times, orthonormal rows, (M, 1..3, 3)."""
    covariance_m2: Covariance | None = None
    """Of survey and pick together, in place of ``sd_m``; None = not stated. Left out of the journal
    then, so that earlier decisions keep their hash."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SiteControl:
    """What places a map in the coordinates of a site."""

    targets: tuple[SeenTarget, ...]
    crs: str
    """EPSG code or codes of the survey; empty = a grid of the site alone."""
