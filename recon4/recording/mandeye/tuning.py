"""Tuning of the reader and writer of walks of MANDEYE devices."""

from __future__ import annotations

from msgspec import Struct


class MandeyeTuning(Struct, frozen=True, kw_only=True):
    """What is expected of the files, and how a walk is cut into parts."""

    head_points: int = 50_000
    """Points that tell times and LiDARs of a file: a chunk of LAZ, fewer are not decoded faster."""
    fewest_points: int = 1000
    """From which the view of a LiDAR is known."""
    around_deg: float = 300.0
    """A LiDAR that sees more looks all around [°]."""
    latest_s: float = 4e9
    """Later times of points are none [s]."""
    most_g: float = 3.0
    """Accelerations whose median is below this are in g, else in m/s²."""
    most_bytes: int = 1 << 30
    """Of a file of IMU samples or positions."""
    status_bytes: int = 1 << 20
    """Of a file of the state of the device; those that are seen have some 3 kB."""
    position_cells: int = 7
    """Cells of a line with a position: up to the geoid separation …"""
    quality_cell: int = 9
    """… and where the quality of the fix is, if it is there."""
    part_s: float = 5.0
    """Length of a part that is written [s]: that of the devices."""
    wait_s: float = 2.0
    """A part is written when points that are this much later have come [s]."""
    scale_m: float = 1e-4
    """Unit of the coordinates [m]: that of the devices."""


MANDEYE = MandeyeTuning()
