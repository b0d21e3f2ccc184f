"""A place of the map that may be a survey target."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.geometry.se3 import Array
from recon4.model.targets import TargetKind


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TargetCandidate:
    """A target that was found; a person confirms it."""

    kind: TargetKind
    p_map: Array
    """Its point [m], (3,)."""
    cov: Array
    """Covariance by the scatter of its points [m²], (3, 3); errors of the poses are not in it."""
    size_m: float
    """Longer edge of a plate; radius of a sphere; 0 = a board, whose edge is not known [m]."""
    points: int
    """Points of the map by which it is known."""
    agreement: float
    """How well they agree with such a target, 0 to 1."""
