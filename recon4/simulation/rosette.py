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


@dataclass(frozen=True, slots=True, kw_only=True)
class Prisms:
    """Two prisms: a rosette around x, wider or higher than a circle by a scale of each axis."""

    half_azimuth_rad: float
    half_elevation_rad: float
    """Half of the field of view [rad]."""
    lines: int
    """Lasers, side by side."""
    line_rad: float = 0.007
    """From one laser to the next, in azimuth and elevation alike [rad]."""
    turns: tuple[float, float] = (12.1567, -7.7733)
    """Of both prisms in a turn of the motor of 0.1 s: those of a Mid-40, 7294 and -4664 rpm
    (Brazeal et al. 2021, section 2)."""

    def directions(self, turn_rad: Array, laser: NDArray[np.int64]) -> Directions:
        """Sum of the deflections by both prisms."""
        first, second = (turn_rad * turns for turns in self.turns)
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
    lines: int
    """Lasers, above each other."""
    line_rad: float = 0.065
    """From one laser to the next [rad]."""
    turns: float = 2.1703
    swings: float = 17.3117
    """In a turn of the motor of 0.1 s. Their ratio is no ratio of small numbers, and the web is as
    dense as that in the user manual of the Mid-360."""

    def directions(self, turn_rad: Array, laser: NDArray[np.int64]) -> Directions:
        """Azimuth grows evenly, elevation is a sine."""
        middle = 0.5 * (self.lowest_rad + self.highest_rad)
        margin = self.line_rad * (self.lines - 1)
        reach = 0.5 * (self.highest_rad - self.lowest_rad - margin)
        swing = reach * np.sin(turn_rad * self.swings)
        elevation = middle + swing + self.line_rad * (laser - 0.5 * (self.lines - 1))
        return Directions(turn_rad * self.turns, elevation, np.zeros((len(laser), 3)))
