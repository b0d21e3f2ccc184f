"""Picking: the edge of the graph, or the point of the whole map nearest to the ray of a click.

Points are looked for among all of them, not among those on screen, and come back in float64.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.mapping.tiles import Tile
from recon4.slam2d.grid_files import TrinaryMap
from recon4_app.viewer.client.view import Position, ViewState
from recon4_app.viewer.cloud.parts import Cloud
from recon4_app.viewer.scene.build import GnssMarks, as_position
from recon4_app.viewer.scene.layers import EdgeTable
from recon4_app.viewer.tuning import POINT_PICKS


@dataclass(frozen=True, slots=True, eq=False)
class Ray:
    """The ray through a pixel."""

    origin_m: Array
    """(3,)"""
    direction: Array
    """Length 1, (3,)."""
    pixel_rad: float
    """Angle of one pixel."""
    point_m: float = 0.02
    """Size points are drawn with: a surface of such discs hides what is behind it [m]."""
    planes: Array = field(default_factory=lambda: np.empty((0, 4)))
    """Clip planes (n, d): points with n · p + d < 0 are not shown, (P, 4)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PickedPoint:
    """A point of the map with all its attributes."""

    p_map: Position
    """[m]"""
    t_ns: int
    sensor: int
    ring: int
    frame_id: int
    intensity: int
    intensity_normalized: float | None
    range_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PickedCell:
    """A place of a 2-D map; on a surface, the middle of its cell."""

    p_map: Position
    """[m], in the plane of the laser."""
    what: str
    """``surface``, ``free`` or ``not seen``."""
    cell_m: float
    """Edge of a cell [m]."""


def pick_edge(table: EdgeTable, view: ViewState, ray: Ray) -> int | None:
    """Row of the visible edge nearest to a ray, None if it passes none closely."""
    shown = np.array([view.shows(layer) for layer in table.layers], dtype=np.bool_)
    rows = np.flatnonzero(shown[table.layer]) if len(table.layer) else np.empty(0, np.intp)
    if len(rows) == 0:
        return None
    ends = table.graph.T_map_body.t[table.ends[rows]]
    angle = _angles(ends[:, 0], ends[:, 1], ray)
    best = int(np.argmin(angle))
    return int(rows[best]) if angle[best] <= POINT_PICKS.edge_px * ray.pixel_rad else None


def pick_gnss(marks: GnssMarks, view: ViewState, ray: Ray) -> int | None:
    """Row of the visible GNSS position, or its edge, nearest to a ray; None if none is close."""
    used, rejected = (view.shows(layer) for layer in marks.layers)
    rows = np.flatnonzero(np.where(marks.used, used, rejected))
    if len(rows) == 0:
        return None
    angle = _angles(marks.p_antenna[rows], marks.p_map[rows], ray)
    best = int(np.argmin(angle))
    return int(rows[best]) if angle[best] <= POINT_PICKS.edge_px * ray.pixel_rad else None


def _angles(start: Array, end: Array, ray: Ray) -> Array:
    """Smallest angle between a ray and each of some segments, nearly: 0 to inf, (N,)."""
    along, between = end - start, start - ray.origin_m
    a = np.einsum("ni,ni->n", along, along)
    b, d = along @ ray.direction, np.einsum("ni,ni->n", along, between)
    e = between @ ray.direction
    across = a - b**2
    s = np.where(across > 1e-12, (b * e - d) / np.maximum(across, 1e-12), 0.0).clip(0.0, 1.0)
    nearest = between + s[:, None] * along
    depth = nearest @ ray.direction
    off = np.linalg.norm(nearest - depth[:, None] * ray.direction, axis=1)
    return np.where(depth > 1e-3, off / np.maximum(depth, 1e-3), np.inf)


def pick_point(cloud: Cloud, ray: Ray) -> PickedPoint | None:
    """The point nearest to a ray on the first surface it meets, None if it meets none."""
    found = hit_point(cloud, ray)
    return None if found is None else _picked(cloud, *found)


def hit_point(cloud: Cloud, ray: Ray) -> tuple[Tile, int] | None:
    """The same point as its tile and its row in it."""
    for pixels in POINT_PICKS.point_px:
        found = _first_hit(cloud, ray, float(np.tan(pixels * ray.pixel_rad)))
        if found is not None:
            return found
    return None


def _first_hit(cloud: Cloud, ray: Ray, widening: float) -> tuple[Tile, int] | None:
    best: tuple[float, Tile, int] | None = None
    entry_m = _entries(cloud, ray, widening)
    for row in np.argsort(entry_m).tolist():
        if not np.isfinite(entry_m[row]) or (best is not None and entry_m[row] > best[0]):
            break
        tile = cloud.tiles.tiles[row]
        hit = _hit_in_tile(tile.read(["xyz"])["xyz"], tile, ray, widening=widening)
        if hit is not None and (best is None or hit[0] < best[0]):
            best = (hit[0], tile, hit[1])
    return best and best[1:]


def _entries(cloud: Cloud, ray: Ray, widening: float) -> Array:
    """Distance along the ray at which its cone may enter each tile [m]; inf = never, (T,)."""
    boxes = cloud.boxes
    low, high = boxes.low_m - ray.origin_m, boxes.high_m - ray.origin_m
    farthest = np.linalg.norm(np.maximum(np.abs(low), np.abs(high)), axis=1, keepdims=True)
    margin = widening * farthest + ray.point_m
    low, high = low - margin, high + margin
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = low / ray.direction, high / ray.direction
    near, far = np.fmin(near, far), np.fmax(near, far)
    parallel = np.abs(ray.direction) < 1e-12
    inside = (low <= 0.0) & (high >= 0.0)
    near = np.where(parallel, np.where(inside, -np.inf, np.inf), near)
    far = np.where(parallel, np.where(inside, np.inf, -np.inf), far)
    first, last = np.maximum(near.max(axis=1), 0.0), far.min(axis=1)
    return np.where(first <= last, first, np.inf)


def _hit_in_tile(
    xyz: NDArray[np.float32], tile: Tile, ray: Ray, *, widening: float
) -> tuple[float, int] | None:
    """Depth [m] and row of the point hit."""
    to_tile = (tile.origin_m - ray.origin_m).astype(np.float32)
    direction = ray.direction.astype(np.float32)
    depth = xyz @ direction + to_tile @ direction
    square = np.einsum("ni,ni->n", xyz, xyz) + 2.0 * (xyz @ to_tile) + to_tile @ to_tile
    # The difference of squares loses digits far away: a coarse sieve, then exactly.
    rough = np.float32(widening) * depth + np.float32(ray.point_m + 0.02)
    rows = np.flatnonzero((depth > 0.0) & (square - depth**2 <= rough**2 + 1e-5 * square))
    p = xyz[rows].astype(np.float64) + (tile.origin_m - ray.origin_m)
    exact = p @ ray.direction
    off_m = np.linalg.norm(p - exact[:, None] * ray.direction, axis=1)
    shown = (ray.planes[:, :3] @ (p + ray.origin_m).T + ray.planes[:, 3:] >= 0.0).all(axis=0)
    hits = np.flatnonzero((off_m <= widening * exact + ray.point_m) & shown)
    if len(hits) == 0:
        return None
    front = exact[hits].min()
    surface = hits[exact[hits] <= front + POINT_PICKS.same_surface_m + 0.01 * front]
    best = surface[np.argmin(off_m[surface] / exact[surface])]
    return float(exact[best]), int(rows[best])


def _picked(cloud: Cloud, tile: Tile, row: int) -> PickedPoint:
    names = ["xyz", "t_ns", "sensor", "ring", "frame_id", "intensity", "range_m"]
    known = "intensity_normalized" in cloud.tiles.fields
    names += ["intensity_normalized"] if known else []
    found = {name: values[0] for name, values in tile.read(names, rows=slice(row, row + 1)).items()}
    return PickedPoint(
        p_map=as_position(found["xyz"].astype(np.float64) + tile.origin_m),
        t_ns=int(found["t_ns"]),
        sensor=int(found["sensor"]),
        ring=int(found["ring"]),
        frame_id=int(found["frame_id"]),
        intensity=int(found["intensity"]),
        intensity_normalized=float(found["intensity_normalized"]) if known else None,
        range_m=float(found["range_m"]),
    )


def pick_cell(plan: TrinaryMap, ray: Ray) -> PickedCell | None:
    """The place of a 2-D map under a ray, None if it misses the map.

    A surface within a few pixels on screen is meant more likely than the floor beside it.
    """
    down = float(ray.direction[2])
    depth = -float(ray.origin_m[2]) / down if down else -1.0
    if depth <= 0.0:
        return None
    hit = (ray.origin_m + depth * ray.direction)[:2]
    low = np.asarray(plan.origin_m)
    rows, columns = plan.gray.shape
    at = np.floor((hit - low) / plan.cell_m).astype(np.int64)
    if not (0 <= at[0] < columns and 0 <= at[1] < rows):
        return None
    reach = min(
        int(np.ceil(POINT_PICKS.point_px[-1] * ray.pixel_rad * depth / plan.cell_m)),
        POINT_PICKS.most_cells,
    )
    first = np.maximum(at - reach, 0)
    last = np.minimum(at + reach + 1, [columns, rows])
    # The first row of the image has the largest y.
    part = plan.occupied[rows - last[1] : rows - first[1], first[0] : last[0]][::-1]
    y, x = np.nonzero(part)
    if len(x):
        middle = low + plan.cell_m * (np.column_stack([x, y]) + first + 0.5)
        away_m = np.linalg.norm(middle - hit, axis=1)
        nearest = int(np.argmin(away_m))
        if away_m[nearest] <= max(plan.cell_m, POINT_PICKS.point_px[-1] * ray.pixel_rad * depth):
            p_map = as_position(np.append(middle[nearest], 0.0))
            return PickedCell(p_map=p_map, what="surface", cell_m=plan.cell_m)
    free = bool(plan.free[rows - 1 - at[1], at[0]])
    p_map = as_position(np.append(hit, 0.0))
    return PickedCell(p_map=p_map, what="free" if free else "not seen", cell_m=plan.cell_m)
