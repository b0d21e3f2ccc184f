"""Requests and responses of the page *Map*."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field

from recon4.first_view.records import Stored
from recon4.slices.snap import SnapKind
from recon4_app.map_view.tuning import MAP_PICKS
from recon4_app.slices.model import Coordinate, Part, Strict, Xy, Xyz

Plane = tuple[Part, Part, Part, Annotated[float, Field(ge=-1e9, le=1e9, allow_inf_nan=False)]]
"""A clip plane (n, d): points with n · p + d < 0 are not shown."""


Version = Annotated[int, Field(ge=0, le=1 << 31)]
"""Of the layout of samples and chunks, as the index of the page said."""


_PART = "[0-9]{1,9}(:[0-9]{1,12}){2}"


class OperatorMark(BaseModel):
    """What the operator of a live capture marked."""

    t_s: float
    """After the first pose [s]."""
    p_map: Xyz
    """Where the walk was then [m]."""
    text: str
    who: str


class MapWalk(BaseModel):
    """The walk, the nodes of the pose graph, and the marks of the operator."""

    t_s: list[float]
    """Times after the first pose [s]."""
    positions_m: list[Xyz]
    nodes_m: list[Xyz]
    marks: list[OperatorMark] = []
    marks_left_out: int = 0
    """Marks that cannot be read, or are of no time of the walk."""


class SampleQuery(Strict):
    """Which values a sample of the whole map has."""

    stored: Stored
    version: Version


class ChunkQuery(SampleQuery):
    """Which points of the map a response has."""

    parts: str = Field(pattern=f"^{_PART}(,{_PART})*$", max_length=4000)
    """``ROW:START:STOP`` of each part, with commas between them: the row of its tile or cube in the
    index, its first point, counted in the order in which they are shown, and the one after it."""

    @property
    def rows(self) -> tuple[tuple[int, int, int], ...]:
        """Row, first point and last + 1 of each part."""
        numbers = (map(int, part.split(":")) for part in self.parts.split(","))
        return tuple((row, start, stop) for row, start, stop in numbers)


class RayRequest(Strict):
    """A click on the map: the ray through its pixel."""

    key: str = Field(max_length=64)
    origin_m: Xyz
    direction: tuple[Part, Part, Part]
    pixel_rad: float = Field(ge=0.0, le=MAP_PICKS.max_pixel_rad, allow_inf_nan=False)
    """Angle of a pixel; 0 in a parallel projection [rad]."""
    point_m: float = Field(gt=0.0, le=MAP_PICKS.max_point_m, allow_inf_nan=False)
    """Radius in which points are hit at the ray's origin, too [m]."""
    planes: list[Plane] = Field(default=[], max_length=MAP_PICKS.max_planes)
    """Points outside of one are not shown, and not hit."""
    snap_rad: float = Field(default=0.0, ge=0.0, le=MAP_PICKS.max_snap_rad, allow_inf_nan=False)
    """Corners, edges and planes this near to the ray attract it [rad]."""
    snap_m: float = Field(default=0.0, ge=0.0, le=MAP_PICKS.max_snap_m, allow_inf_nan=False)
    """The same as a distance; both are added, and 0 = no snapping [m]."""


class HitPoint(BaseModel):
    """The point of the map that a click hit, of all its points."""

    p_map: Xyz
    p_crs: Xyz | None
    normal: Xyz | None
    """Unit normal of its surface; None = it has none."""
    t_s: float
    """After the first point of the map [s]."""
    sensor: str
    classification: str
    intensity: int
    normalized: float | None
    range_m: float | None
    position_sd_m: float | None
    """Standard deviation of its place by the poses [m]; None = not stated."""
    surface_sd_m: float | None
    """Standard deviation of the returns across its surface [m]; None = not stated."""


class SnapPoint(BaseModel):
    """Where a click snapped to, by the points around what it hit."""

    kind: SnapKind
    p_map: Xyz
    p_crs: Xyz | None
    sd_m: float
    """Standard deviation (1 σ) by the scatter of the points about their planes [m]."""


class RayHit(BaseModel):
    """What a click hit."""

    point: HitPoint | None
    snap: SnapPoint | None = None
    """None = it was not asked for, or there is no plane."""


class PointsInMap(Strict):
    """Points of measurements."""

    key: str = Field(max_length=64)
    p_map: list[Xyz] = Field(max_length=MAP_PICKS.max_points)


class PointsInCrs(BaseModel):
    """The same points in the CRS of the map, or in the grid of its site."""

    crs: str
    p_crs: list[Xyz]


class VolumeRequest(Strict):
    """What lies over a plane inside of a polygon, of the heights that are shown."""

    key: str = Field(max_length=64)
    polygon: list[Xy] = Field(min_length=3, max_length=MAP_PICKS.max_corners)
    """Corners, seen from above [m]."""
    base_m: Coordinate | None = None
    """Height of a level plane [m]; None = a plane fitted to the surface along the border."""
    low_m: Coordinate | None = None
    """Points below are left out [m]."""
    high_m: Coordinate | None = None
    """Points above are left out, as a ceiling [m]."""


class MapVolume(BaseModel):
    """A volume, as `recon4.products.volume` computes it."""

    above_m3: float
    below_m3: float
    sd_m3: float
    area_m2: float
    unseen_m2: float
    base_m: float
    fitted: float
    """Part of the border that the base was fitted to; 1 if its height was given."""
    cell_m: float
    """Edge of the cells that were added up [m]."""
