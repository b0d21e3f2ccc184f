"""What the page *Map* shows beside the points, and limits of what it asks for."""

from __future__ import annotations

from msgspec import Struct


class MapWalkTuning(Struct, frozen=True, kw_only=True):
    """The walk on the page."""

    most_positions: int = 4000
    """A longer walk is thinned out."""
    most_nodes: int = 20_000
    """More nodes of the graph are thinned out."""
    max_marks_bytes: int = 1 << 20
    """A larger file of marks was not written by us."""
    marks_s: float = 1.0
    """A mark this long before or after the walk is at its end [s]."""


MAP_WALK = MapWalkTuning()


class MapPickLimits(Struct, frozen=True, kw_only=True):
    """Rays of clicks."""

    max_planes: int = 16
    """Clip planes of a request."""
    max_pixel_rad: float = 0.05
    """Largest angle of a pixel [rad]."""
    max_point_m: float = 5.0
    """Largest point on screen [m]."""
    max_snap_m: float = 0.25
    """Farthest that a pick is attracted [m]."""
    max_corners: int = 500
    """Of a polygon."""
    max_points: int = 20_000
    """Points of measurements that are put into the CRS at once."""
    max_snap_rad: float = 0.1
    """Largest angle in which a pick is attracted [rad]."""


MAP_PICKS = MapPickLimits()


class MapVolumeTuning(Struct, frozen=True, kw_only=True):
    """Volumes over a plane."""

    cell_m: float = 0.02
    """Smallest edge of a cell [m]."""
    cell_times: float = 3.0
    """A cell is at least as many times as wide as points are apart: it has points then."""
    most_cells: int = 400_000
    """In the box of a polygon; a larger one has larger cells."""


MAP_VOLUMES = MapVolumeTuning()
