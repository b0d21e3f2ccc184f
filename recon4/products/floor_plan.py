"""The plan of a storey: walls, columns, openings and furniture, as lines and areas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.products.curves import CurvedFace, curved_faces
from recon4.products.faces import Face, fit_faces
from recon4.products.openings import FaceOpening, OpeningKind, Rays, openings_of, sample_rays
from recon4.products.storeys import BuildingStorey, Levels
from recon4.products.tuning import FACES, OPENINGS, PLANS, WALL_CELLS
from recon4.products.wall_cells import WallCells, wall_cells

if TYPE_CHECKING:
    from shapely import Geometry, Polygon


@dataclass(frozen=True, slots=True, eq=False)
class PlanOpening:
    """A door or window."""

    kind: OpeningKind
    """``hidden``: above it is a wall, but nothing of it was seen at the height of the cut."""
    line: Array
    """In the face of the wall, in the map [m], (2, 2)."""
    sill_m: float
    head_m: float
    """Heights over the floor [m]."""

    @property
    def width_m(self) -> float:
        """Clear width [m]."""
        return float(np.linalg.norm(self.line[1] - self.line[0]))


@dataclass(frozen=True, slots=True, eq=False)
class FloorPlan:
    """A storey from above; all coordinates are those of the map [m]."""

    storey: BuildingStorey
    walls: list[Array]
    """Faces of walls as they are cut, (2, 2) each, then curved ones as polylines, (N, 2)."""
    sections: list[Polygon]
    """Cut walls of which both faces were seen, and cut columns: to be filled."""
    columns: list[Polygon]
    openings: list[PlanOpening]
    furniture: list[Polygon]
    """Outlines of what stands up to `PLANS.furniture_m`."""
    rms_m: float
    """Of the distances of the cells of the walls from their lines [m]."""

    @property
    def cut_m(self) -> float:
        """Height of the cut over the floor: the middle of `OPENINGS.cut_m` [m]."""
        return sum(OPENINGS.cut_m) / 2.0

    @property
    def wall_length_m(self) -> float:
        """Of all faces that are cut [m]."""
        return float(sum(np.linalg.norm(np.diff(w, axis=0), axis=1).sum() for w in self.walls))

    @property
    def text(self) -> str:
        """Figures of the storey in words."""
        storey, kinds = self.storey, [hole.kind for hole in self.openings]
        return CodedText(
            "plan-made",
            storey=storey.name,
            floor_m=storey.floor_m,
            area_m2=storey.area_m2,
            walls_m=self.wall_length_m,
            rms_mm=1e3 * self.rms_m,
            doors=kinds.count("door"),
            windows=kinds.count("window"),
            columns=len(self.columns),
        )


def draw_plan(tiles: TileSet, storey: BuildingStorey, levels: Levels) -> FloorPlan:
    """Fit the plan of a storey to the points of a map.

    Args:
        tiles: The map.
        storey: The storey.
        levels: Level surfaces of the map.
    """
    cells = wall_cells(tiles, storey, levels)
    return plan_of(cells, sample_rays(tiles), storey)


def plan_of(cells: WallCells, rays: Rays, storey: BuildingStorey) -> FloorPlan:
    """Fit the plan of a storey to its upright surfaces."""
    curves, faces = curved_faces(fit_faces(cells), cells)
    columns, faces = _columns(faces)
    opened = [openings_of(face, cells, rays, storey=storey) for face in faces]
    seen = [k for k in range(len(faces)) if not _is_in_wall(faces, opened, k)]
    faces, opened = [faces[k] for k in seen], [opened[k] for k in seen]
    sections = _sections(faces, opened)
    walls = [line for face, holes in zip(faces, opened, strict=True) for line in _cut(face, holes)]
    walls += [line for k in range(len(faces)) for line in _jambs(faces, opened, k)]
    walls += [curve.line for curve in curves]
    openings = [
        PlanOpening(hole.kind, np.array([face.at(hole.start_m), face.at(hole.end_m)]),
                    hole.sill_m, hole.head_m)
        for face, holes in zip(faces, opened, strict=True) for hole in holes
    ]  # fmt: skip
    fitted: list[Face | CurvedFace] = [*faces, *curves]
    lengths = [face.length_m for face in fitted]
    rms = np.average([face.rms_m**2 for face in fitted], weights=lengths) if fitted else 0.0
    furniture = _furniture(cells, fitted)
    return FloorPlan(
        storey, walls, [*sections, *columns], columns, openings, furniture, float(np.sqrt(rms))
    )


def _is_in_wall(faces: list[Face], opened: list[list[FaceOpening]], k: int) -> bool:
    """Whether a face lies between both sides of a wall, away from openings: nobody can see it."""
    ends, margin = np.array([faces[k].start, faces[k].end]), OPENINGS.jamb_m
    sides = []
    for other, holes in zip(faces, opened, strict=True):
        depth = (other.start - ends) @ other.n
        at = float(other.along(ends).mean())
        is_behind = depth.min() > -FACES.own_m and depth.max() < PLANS.thickness_m[1]
        is_closed = 0.0 < at < other.length_m and not any(
            hole.start_m - margin < at < hole.end_m + margin for hole in holes
        )
        if other is not faces[k] and is_behind and is_closed:
            sides.append(other)
    return any(_thickness(a, b) is not None for a in sides for b in sides)


def _cut(face: Face, holes: list[FaceOpening]) -> list[Array]:
    """The face without its openings."""
    at, out = 0.0, []
    for start, end in [(hole.start_m, hole.end_m) for hole in holes] + [(face.length_m, 0.0)]:
        if start > at:
            out.append(np.array([face.at(at), face.at(start)]))
        at = end
    return out


def _jambs(faces: list[Face], opened: list[list[FaceOpening]], k: int) -> list[Array]:
    """Sides of the openings of a face, up to the other face of its wall; once for both faces."""
    face, lines = faces[k], []
    for hole in (one for one in opened[k] if one.seen_through):
        middle = face.at((hole.start_m + hole.end_m) / 2.0)
        for j, other in enumerate(faces):
            thickness = _thickness(face, other)
            at = float(other.along(middle[None])[0])
            if thickness is None or not 0.0 < at < other.length_m:
                continue
            both = any(one.start_m < at < one.end_m for one in opened[j])
            if both and j < k:
                break
            ends = [face.at(hole.start_m), face.at(hole.end_m)]
            lines += [np.array([end, end - thickness * face.n]) for end in ends]
            break
    return lines


def _columns(faces: list[Face]) -> tuple[list[Polygon], list[Face]]:
    """Free-standing columns, and the faces of walls.

    A column is a group of short faces that meet in corners and look away from their middle.
    """
    from shapely import MultiPoint

    groups = _met(faces)
    columns, walls = [], []
    for group in groups:
        middle = np.mean([(face.start + face.end) / 2.0 for face in group], axis=0)
        away = all(float(((f.start + f.end) / 2.0 - middle) @ f.n) > 0.0 for f in group)
        short = max(face.length_m for face in group) < PLANS.column_m
        if len(group) > 1 and short and away:
            corners = [end for face in group for end in (face.start, face.end)]
            columns.append(MultiPoint(corners).minimum_rotated_rectangle)
        else:
            walls += group
    return columns, walls


def _met(faces: list[Face]) -> list[list[Face]]:
    """Groups of faces with common corners."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    if not faces:
        return []
    ends = np.array([[face.start, face.end] for face in faces]).reshape(-1, 2)
    pairs = cKDTree(ends).query_pairs(1e-6, output_type="ndarray") // 2
    near = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (len(faces), len(faces)))
    count, label = connected_components(near, directed=False)
    return [
        [face for face, k in zip(faces, label, strict=True) if k == one] for one in range(count)
    ]


def _sections(faces: list[Face], opened: list[list[FaceOpening]]) -> list[Polygon]:
    """Areas between the two faces of walls, without openings, joined where walls meet."""
    from shapely import difference, union_all

    bodies = [
        _band(face, (max(0.0, low), min(face.length_m, high)), depth=thickness)
        for k, face in enumerate(faces)
        for other in faces[k + 1 :]
        if (thickness := _thickness(face, other)) is not None
        for low, high in [np.sort(face.along(np.array([other.start, other.end]))).tolist()]
    ]
    holes = [
        _band(face, (hole.start_m, hole.end_m), depth=PLANS.thickness_m[1])
        for face, found in zip(faces, opened, strict=True)
        for hole in found
        if hole.seen_through
    ]
    return _polygons(difference(union_all(bodies), union_all(holes))) if bodies else []


def _thickness(face: Face, other: Face) -> float | None:
    """Between two faces of one wall [m]; None if they are not."""
    if float(face.n @ other.n) > -0.999:
        return None
    off = -float(((other.start + other.end) / 2.0 - face.start) @ face.n)
    s = np.clip(face.along(np.array([other.start, other.end])), 0.0, face.length_m)
    low, high = PLANS.thickness_m
    return off if low <= off <= high and np.ptp(s) >= PLANS.overlap_m else None


def _band(face: Face, span_m: tuple[float, float], *, depth: float) -> Polygon:
    """Area behind a part of a face, and 1 mm before it."""
    from shapely import Polygon

    a, b, n = face.at(span_m[0]), face.at(span_m[1]), face.n
    return Polygon([a + 0.001 * n, b + 0.001 * n, b - depth * n, a - depth * n])


def _furniture(cells: WallCells, faces: Sequence[Face | CurvedFace]) -> list[Polygon]:
    """Outlines of the upright surfaces that belong to no wall."""
    from shapely import Polygon, box, union_all

    free = np.ones(len(cells), bool)
    for face in faces:
        free[face.rows] = False
    low, high = (int(z_m / WALL_CELLS.bit_m) for z_m in PLANS.furniture_m)
    free &= (cells.heights & np.uint64((1 << high) - (1 << low))) > 0
    corner = np.unique(np.floor(cells.p[free] / WALL_CELLS.cell_m), axis=0) * WALL_CELLS.cell_m
    edge = WALL_CELLS.cell_m
    reach = edge / 2.0
    area = union_all(box(*(corner - reach).T, *(corner + edge + reach).T)) if len(corner) else None
    if area is None:
        return []
    outlines = [Polygon(one.exterior).buffer(-reach) for one in _polygons(area)]
    simple = [one.simplify(PLANS.outline_m) for shape in outlines for one in _polygons(shape)]
    return [one for one in simple if one.area >= PLANS.least_m2]


def _polygons(area: Geometry) -> list[Polygon]:
    """The polygons of an area."""
    from shapely import Polygon, get_parts

    return [one for one in get_parts(area) if isinstance(one, Polygon) and not one.is_empty]
