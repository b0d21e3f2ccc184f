"""Settings of the stage `refine`."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.settings.require import require


@dataclass(frozen=True, slots=True, kw_only=True)
class RefineSettings:
    """Semi-rigid refinement of every multiframe (requirements A12 L-4; mode ``beyond`` only)."""

    rounds: int = 3
    """At most so many rounds of building the map and moving all multiframes onto it."""
    map_stride: int = 2
    """Every so many multiframes are built into the map; all of them are moved."""
    gate_m: float = 0.1
    """Segments farther from their plane do not match [m]."""
    min_gap_s: float = 6.0
    """A multiframe is matched with points at least so much earlier or later only [s]
    (requirements A12 L-4); 0, or a recording shorter than three gaps: with all, its own as well."""
    step_sd_m: float = 0.001
    """How much the correction may change from one multiframe to the next [m] …"""
    step_sd_rad: float = 2e-4
    """… and its rotation [rad]: how well odometry knows the motion in between."""
    total_sd_m: float = 0.02
    """How much a multiframe may move in all [m]: how well the pose graph knows it."""
    total_sd_rad: float = 0.005
    """The same for its rotation [rad]."""
    converged_step_m: float = 4e-3
    """Stop once no multiframe moves farther than this [m]."""

    def __post_init__(self) -> None:
        require(self.min_gap_s >= 0.0, "min_gap_s must be 0 or more", self.min_gap_s)
