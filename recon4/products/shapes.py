"""What is drawn of plans and contours: shapes on layers by meaning."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from recon4.geometry.se3 import Array
from recon4.products.contours import Contour
from recon4.products.drawing import DrawingLayer, DrawnShape, DrawnTitle, circle_through
from recon4.products.floor_plan import FloorPlan

if TYPE_CHECKING:
    from shapely import Polygon


def plan_shapes(plan: FloorPlan) -> Iterator[DrawnShape]:
    """The shapes of a storey; the names of its layers begin with that of the storey."""
    z_m = plan.storey.floor_m
    storey: dict[str, float | str] = {"storey": plan.storey.name}
    fill, outline = _layer(plan, "WALLS_FILL", 8), _layer(plan, "WALLS", 7, lineweight=35)
    for section in plan.sections:
        yield _area(fill, section, z_m, storey=plan.storey.name)
    for line in plan.walls:
        length = round(float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()), 4)
        facts: dict[str, float | str] = storey | {"length_m": length}
        if curved := len(line) > 2:
            facts["radius_m"] = round(circle_through(line)[1], 4)
        yield DrawnShape(outline, _lifted(line, z_m), facts=facts, arc=curved)
    for column in plan.columns:
        yield _area(_layer(plan, "COLUMNS", 1, lineweight=35), column, z_m, storey=plan.storey.name)
    kinds = {
        "door": _layer(plan, "DOORS", 3),
        "window": _layer(plan, "WINDOWS", 5),
        "hidden": _layer(plan, "WALLS_HIDDEN", 8, lineweight=18),
    }
    for hole in plan.openings:
        facts = {
            "width_m": round(hole.width_m, 4),
            "sill_m": round(hole.sill_m, 2),
            "head_m": round(hole.head_m, 2),
        }
        yield DrawnShape(kinds[hole.kind], _lifted(hole.line, z_m), facts=storey | facts)
    for piece in plan.furniture:
        yield _area(
            _layer(plan, "FURNITURE", 9, lineweight=13), piece, z_m, storey=plan.storey.name
        )


def plan_title(plan: FloorPlan) -> DrawnTitle:
    """Storey and level below its plan."""
    corner = np.min([line.min(axis=0) for line in plan.walls] or [np.zeros(2)], axis=0)
    text = f"STOREY {plan.storey.name}, CUT {plan.cut_m:.2f} m ABOVE THE FLOOR"
    place = np.array([corner[0], corner[1] - 0.8, plan.storey.floor_m])
    return DrawnTitle(_layer(plan, "TEXT", 7, lineweight=13), text, place)


def contour_shapes(contours: Sequence[Contour], up_m: float) -> Iterator[DrawnShape]:
    """Contours at their heights; those of a CRS are ``up_m`` above those of the map."""
    usual, index = DrawingLayer("CONTOURS", 8, 13), DrawingLayer("CONTOURS_INDEX", 7, 30)
    for one in contours:
        height = {"height_m": round(one.height_m, 4), "index": one.index}
        place = _lifted(one.p, one.height_m - up_m)
        yield DrawnShape(index if one.index else usual, place, facts=height)


def _layer(plan: FloorPlan, name: str, color: int, *, lineweight: int = 18) -> DrawingLayer:
    """In characters every CAD program accepts."""
    linetype = "DASHED" if name == "WALLS_HIDDEN" else "CONTINUOUS"
    full = f"S{plan.storey.name.replace('-', 'M')}_{name}"
    return DrawingLayer(full, color, lineweight, linetype, hatched=name == "WALLS_FILL")


def _area(layer: DrawingLayer, polygon: Polygon, z_m: float, *, storey: str) -> DrawnShape:
    holes = tuple(_lifted(ring.coords[:-1], z_m) for ring in polygon.interiors)
    facts = {"storey": storey, "area_m2": round(polygon.area, 4)}
    return DrawnShape(layer, _lifted(polygon.exterior.coords[:-1], z_m), True, facts, holes)


def _lifted(xy: ArrayLike, z_m: float) -> Array:
    """Places at a height, (N, 2) -> (N, 3)."""
    xy = np.asarray(xy, dtype=np.float64)[:, :2]
    return np.column_stack([xy, np.full(len(xy), z_m)])
