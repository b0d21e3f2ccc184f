"""The person who carries the sensors: what of them a beam meets, and how they walk."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.se3 import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Torso:
    """The person as an upright cylinder in the body frame, which beams do not pass."""

    x_m: float = 0.24
    y_m: float = 0.0
    radius_m: float = 0.21
    bottom_m: float = -1.5
    top_m: float = 0.12

    def row(self) -> Array:
        """x, y, radius, bottom, top, as the kernels expect it, (5,)."""
        return np.array([self.x_m, self.y_m, self.radius_m, self.bottom_m, self.top_m])


TORSO = Torso()
TORSO_WITH_LOAD_CARRIER = replace(TORSO, radius_m=0.3)
"""With the frame that the Wuerzburg backpack hangs on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Gait:
    """How people walk, turn and ride."""

    body_height_m: float = 1.5
    """Of the body frame (the INS in the backpack) above the floor."""
    speed_m_s: float = 1.2
    """Usual speed …"""
    slowest_m_s: float = 1.0
    fastest_m_s: float = 1.4
    """… which is changed within these so that rounds fit into a duration."""
    longest: float = 1.12
    """Largest factor by which a round may be longer than a full one at the usual speed."""
    stand_s: float = 1.5
    """They stand at the start and the end."""
    path_sigma_s: float = 0.2
    heading_sigma_s: float = 0.12
    """Standard deviation of the Gaussians that round off corners of path and heading."""
    fastest_turn_deg_s: float = 240.0
    ride_m_s: float = 0.6
    """Mean speed of an elevator, which starts and stops smoothly …"""
    ride_step_s: float = 0.05
    """… and steps of its course."""


GAIT = Gait()
