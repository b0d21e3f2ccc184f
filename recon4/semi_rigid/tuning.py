"""Tuning of the semi-rigid refinement."""

from __future__ import annotations

from dataclasses import dataclass

from msgspec import Struct

from recon4.settings import RefineSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class RefineTuning(RefineSettings):
    """Semi-rigid refinement of every multiframe
    (docs/explanation/refine.md; requirements A12 L-4).
    """

    map_stride: int = 2
    """Every n-th multiframe is built into the map; all of them are corrected."""
    gate_m: float = 0.1
    """Segments farther from their plane do not match [m]."""
    min_gap_s: float = 6.0
    """A multiframe is matched only to points that are earlier or later by at least this [s]
    (requirements A12 L-4). 0, or a recording shorter than three gaps: to all points, its own
    included."""
    step_sd_m: float = 0.001
    """Standard deviation of the change of the correction between multiframes [m] …"""
    step_sd_rad: float = 2e-4
    """… and of its rotation [rad]: the accuracy of odometry."""
    total_sd_m: float = 0.02
    """Standard deviation of the whole correction [m]: the accuracy of the pose graph."""
    total_sd_rad: float = 0.005
    """The same for its rotation [rad]."""
    converged_step_m: float = 4e-3
    """Stop if no multiframe moves farther than this [m]. Decisions that move no node farther carry
    the refined trajectory along."""
    carried_turn_rad: float = 4e-4
    """Nor may they turn one by more [rad]: as far at ten meters."""


class RefineRunTuning(Struct, frozen=True, kw_only=True):
    """Work of the refinement."""

    chunk: int = 16
    """Number of multiframes that are processed in parallel."""
    short: int = 3
    """A recording shorter than this many time gaps is matched without a gap."""


REFINE_RUN = RefineRunTuning()
