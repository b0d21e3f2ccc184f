"""Patterns that do not repeat: Livox LiDARs by equation.

The makers publish the fields of view and the rates of the shots, and figures of the patterns, but
no equations. Those here have the published outlines and repeat only after minutes:

- two wedge prisms that turn against each other (Brazeal et al. 2021, "A Rigorous Observation Model
  for the Risley Prism-Based Livox Mid-40 Lidar Sensor", section 2, in the approximation of thin
  prisms): each deflects by half of the opening, and the sum of two turning vectors is a rosette;
- a mirror that turns about z while it swings (Mid-360): azimuth grows evenly, elevation is a sine.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.simulation.patterns import Directions

FIRST_HZ, SECOND_HZ = 7294.0 / 60.0, -4664.0 / 60.0
"""Prisms of a Mid-40 (Brazeal et al. 2021, section 2): no common period within minutes."""
_MOTOR_HZ = 10.0
"""Rate of the imaginary motor whose turn measures time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Prisms:
    """Two prisms: a rosette around x, wider or higher than a circle by a scale of each axis."""

    half_azimuth_rad: float
    half_elevation_rad: float
    """Half of the field of view [rad]."""
    lines: int
    """Lasers, side by side."""
    line_rad: float = 0.0
    """From one laser to the next, in azimuth and elevation alike [rad]."""

    def directions(self, turn_rad: Array, laser: NDArray[np.int64]) -> Directions:
        """Sum of the deflections by both prisms."""
        first, second = (turn_rad * hz / _MOTOR_HZ for hz in (FIRST_HZ, SECOND_HZ))
        spread = self.line_rad * (laser - 0.5 * (self.lines - 1))
        margin = 0.5 * self.line_rad * (self.lines - 1)
        across = 0.5 * (self.half_azimuth_rad - margin)
        upward = 0.5 * (self.half_elevation_rad - margin)
        azimuth = across * (np.cos(first) + np.cos(second)) + spread
        elevation = upward * (np.sin(first) + np.sin(second)) + spread
        return Directions(azimuth, elevation, np.zeros((len(laser), 3)))


@dataclass(frozen=True, slots=True, kw_only=True)
class SwingingMirror:
    """A mirror that turns all around and swings; the lasers look up and down by a part of it."""

    lowest_rad: float
    highest_rad: float
    """Elevations [rad]."""
    turn_hz: float
    swing_hz: float
    """Their ratio is no ratio of small numbers."""
    lines: int
    """Lasers, above each other."""
    line_rad: float
    """From one laser to the next [rad]."""

    def directions(self, turn_rad: Array, laser: NDArray[np.int64]) -> Directions:
        """Azimuth grows evenly, elevation is a sine."""
        motor = turn_rad / _MOTOR_HZ
        middle = 0.5 * (self.lowest_rad + self.highest_rad)
        margin = self.line_rad * (self.lines - 1)
        reach = 0.5 * (self.highest_rad - self.lowest_rad - margin)
        swing = reach * np.sin(motor * self.swing_hz)
        elevation = middle + swing + self.line_rad * (laser - 0.5 * (self.lines - 1))
        return Directions(motor * self.turn_hz, elevation, np.zeros((len(laser), 3)))
