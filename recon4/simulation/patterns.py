"""When and where a LiDAR fires: its firing pattern, and the directions that follow from it.

Every packet holds the same sequences of shots, one shot of each laser a sequence. What moves the
beams is a rotor that turns evenly (`Spin`) or optics whose pattern does not repeat
(`recon4.simulation.families.livox`).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times


@dataclass(frozen=True, slots=True, eq=False)
class Directions:
    """Of the beams of N shots in the frame of the sensor."""

    azimuth_rad: Array
    """Clockwise seen from above, from x, (N,)."""
    elevation_rad: Array
    """(N,)."""
    origin_m: Array
    """Where each beam begins, (N, 3)."""


class BeamMotion(Protocol):
    """What moves the beams."""

    def directions(self, turn_rad: Array, laser: NDArray[np.int64]) -> Directions:
        """Directions of shots.

        Args:
            turn_rad: How far the motor has turned, not modulo 2π, (N,). A LiDAR that does not spin
                has an imaginary one that turns like the others: it is its measure of time.
            laser: Of each shot, (N,).
        """
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Spin:
    """Lasers on a rotor. L lasers."""

    elevation_rad: Array
    """(L,)."""
    azimuth_rad: Array
    """Clockwise against the rotor, (L,)."""
    zero_rad: float = 0.0
    """Where the rotor points when its encoder says 0, clockwise from x."""
    origin_m: Array = field(default_factory=lambda: np.zeros((3, 1)))
    """Where the beams begin: ahead on the rotor, to its right, above the origin, (3, L) or (3, 1).
    """

    def directions(self, turn_rad: Array, laser: NDArray[np.int64]) -> Directions:
        """The rotor's angle and the tables of the lasers."""
        rotor = turn_rad + self.zero_rad
        ahead, right, up = np.broadcast_to(self.origin_m, (3, len(self.elevation_rad)))[:, laser]
        cos, sin = np.cos(rotor), np.sin(rotor)
        origin_m = np.stack([ahead * cos - right * sin, -ahead * sin - right * cos, up], axis=1)
        return Directions(rotor + self.azimuth_rad[laser], self.elevation_rad[laser], origin_m)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FiringPattern:
    """Packets of one model. S sequences of L lasers a packet."""

    model: str
    """As in `recon4.model.lidars.LIDARS`."""
    packet_ns: int
    """From one packet to the next [ns]."""
    offset_ns: Times
    """Time of each shot after the first one of its packet [ns], (S, L)."""
    ring: NDArray[np.uint8]
    """Ring of each laser, 0 = lowest, (L,)."""
    motion: BeamMotion
    unit_m: float
    """Of a distance in a packet [m]."""
    most_units: int = 65_535
    """Longest distance that a packet can hold; most have 16 bits for it."""
    added_m: float = 0.0
    """The sensor states a range from another place than where the beam begins: larger by this."""
    turn_hz: float = 10.0
    """Rotation rate of the motor."""
    steps: int = 0
    """Packets of a revolution of a sensor that fires by its encoder: the packets of two revolutions
    begin at the same azimuths. 0 = it fires by its clock."""

    @property
    def shape(self) -> tuple[int, int]:
        """Sequences and lasers of a packet (S, L)."""
        sequences, lasers = self.offset_ns.shape
        return sequences, lasers

    @property
    def lasers(self) -> int:
        """Number of lasers L."""
        return self.offset_ns.shape[1]


def even_shots(
    *, sequences: int, sequence_ns: float, laser_ns: ArrayLike, lasers: int
) -> NDArray[np.int64]:
    """Offsets of shots whose sequences follow each other evenly, (S, L).

    Args:
        sequences: Of a packet S.
        sequence_ns: From one to the next [ns].
        laser_ns: Of each laser after the start of its sequence [ns], (L,) or a number.
        lasers: L.
    """
    starts = sequence_ns * np.arange(sequences)
    offset = starts[:, None] + np.broadcast_to(np.asarray(laser_ns, np.float64), lasers)
    return np.rint(offset).astype(np.int64)


def rings(elevation_rad: Array) -> NDArray[np.uint8]:
    """Ring of each laser by its elevation; lasers that are equally high share one, (L,)."""
    return np.unique(elevation_rad, return_inverse=True)[1].astype(np.uint8)
