"""Requests and responses of the slices API."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, field_validator

from recon4.errors import ConfigError
from recon4.mapping.tiles import Surface
from recon4.model.survey_covariance import Covariance, check_covariance
from recon4.recording.tables.column_names import Meaning, Unit
from recon4.recording.tables.coordinates import ColumnChoice
from recon4.recording.tables.tuning import SHOWN_TABLE
from recon4.review.approval_state import ApprovalState
from recon4.review.evidence import Evidence
from recon4.slices.colors import ColorBy, Ground
from recon4.slices.control_limits import ControlLimits
from recon4.slices.measured_points import MeasuredPosition, orthonormal
from recon4.slices.slice_plane import PlanePosition, SlicePlane
from recon4.slices.tuning_files import CONTROL_LIMITS, SLICE_PLANES
from recon4_app.names import Name
from recon4_app.slices.listed_reference import ListedReference
from recon4_app.slices.tuning import SLICE_REQUESTS

Coordinate = Annotated[float, Field(ge=-1e8, le=1e8, allow_inf_nan=False)]
Part = Annotated[float, Field(ge=-2.0, le=2.0, allow_inf_nan=False)]
Xy = tuple[Coordinate, Coordinate]
Xyz = tuple[Coordinate, Coordinate, Coordinate]
Pose = tuple[Coordinate, Coordinate, Coordinate, Part, Part, Part, Part]
Reach = Annotated[float, Field(ge=-1e9, le=1e9, allow_inf_nan=False)]
"""A coordinate u or v of a slice [m]; its origin is arbitrary."""
Limit = Annotated[float, Field(gt=0.0, le=CONTROL_LIMITS.most_m, allow_inf_nan=False)]
USUAL_LIMITS = ControlLimits()


class Strict(BaseModel):
    """Request model without unknown keys."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class SlicePlaneSpec(Strict):
    """Position and thickness of a slice."""

    kind: Literal["horizontal", "vertical", "free"]
    z_m: Coordinate = 0.0
    """Height of a horizontal slice [m]."""
    a_m: Xy = (0.0, 0.0)
    """First point of a vertical slice, seen from above [m]."""
    b_m: Xy = (1.0, 0.0)
    """Second point of a vertical slice [m]."""
    origin_m: Xyz = (0.0, 0.0, 0.0)
    """A point of a free plane [m]."""
    normal: Xyz = (0.0, 0.0, 1.0)
    """Normal of a free plane."""
    thickness_m: float = Field(default=0.10, gt=0.0, le=SLICE_PLANES.max_thickness_m)

    def slice_plane(self) -> SlicePlane:
        """The slice it describes.

        Raises:
            ConfigError: If it is no plane.
        """
        if self.kind == "horizontal":
            return SlicePlane.horizontal(self.z_m, thickness_m=self.thickness_m)
        if self.kind == "vertical":
            return SlicePlane.vertical(self.a_m, self.b_m, thickness_m=self.thickness_m)
        return SlicePlane.free(self.origin_m, self.normal, thickness_m=self.thickness_m)


class WindowSpec(Strict):
    """Part of a slice, in its own coordinates [m]."""

    left: Reach
    bottom: Reach
    right: Reach
    top: Reach


class SliceView(Strict):
    """How a slice is shown."""

    plane: SlicePlaneSpec
    window: WindowSpec | None = None
    """None = all of it."""
    color: ColorBy = "height"
    low: float | None = Field(default=None, allow_inf_nan=False)
    """Value at the low end of the color scale; None = from the values in the window."""
    high: float | None = Field(default=None, allow_inf_nan=False)
    reference: str = ""
    """Id of a reference; empty = none."""
    method: Literal["plane", "point"] = "plane"
    source: str = ""
    """``""`` = the latest map, ``map:KEY`` = an earlier one, ``project:ID`` = that of another."""
    surface: Surface = "fitted"
    """Where points are drawn: on their fitted surfaces if the map has them, or as measured."""


class SliceImageRequest(SliceView):
    """Request for an image of a slice."""

    width: int = Field(ge=16, le=SLICE_REQUESTS.max_side_px)
    height: int = Field(ge=16, le=SLICE_REQUESTS.max_side_px)
    ground: Ground = "light"
    page: str = Field(default="", max_length=40)
    """Id of the page: of several requests of one page only the latest gets an image."""
    sequence: int = Field(default=0, ge=0, le=1 << 53)
    """The page's request counter: requests may arrive in another order than they were sent."""


class SliceImageView(BaseModel):
    """An image of a slice and its description."""

    png: str
    """PNG file, base64."""
    window: WindowSpec
    """The shown window: the requested one, widened to the aspect ratio of the image."""
    pixel_m: float
    points: int
    """Points of the map in the window."""
    surface: Surface
    """Where they lie: on fitted surfaces, or where they were measured."""
    name: str
    """Name of the slice in English."""
    position: PlanePosition
    """The same as numbers."""
    low: float
    high: float
    colors: list[str]
    """Colors from low to high, as ``#rrggbb``."""
    axes: tuple[str, str]
    """Labels of the horizontal and the vertical axis."""
    origin_m: Xyz
    u: Xyz
    v: Xyz
    offset_m: float
    seconds: float


class WalkStretch(BaseModel):
    """Where the walk was during a stretch."""

    positions_m: list[Xyz]
    """In the map [m], in order; empty if the walk is shorter."""


class PickRequest(Strict):
    """Request for the map point at a position on a slice."""

    plane: SlicePlaneSpec
    uv: Xy
    radius_m: float = Field(default=0.05, gt=0.0, le=5.0)
    source: str = ""
    surface: Surface = "fitted"


class FoundTarget(BaseModel):
    """The center of a black-white target near a pick: a proposal, which a person confirms."""

    p_map: Xyz
    """[m]"""
    sd_m: float
    """Standard deviation (1 σ) in the plane of the board by the intensities, without the errors of
    the poses [m]."""
    sd_across_m: float
    """Across the board, of a single point [m]."""
    off_m: float
    """From the pick [m]."""


class PickView(BaseModel):
    """The nearest point of the map."""

    found: bool
    p_map: Xyz = (0.0, 0.0, 0.0)
    p_crs: Xyz | None = None
    uv: Xy = (0.0, 0.0)
    about: dict[str, float] = {}
    along: list[Xyz] = []
    """Directions in which it is measured, in the map: the two of the slice, and the normal of a
    surface."""
    target: FoundTarget | None = None
    """The black-white target within 10 cm; None = there is none."""


class CompareRequest(Strict):
    """Request for a comparison of slices with a reference."""

    reference: str = Field(min_length=1)
    method: Literal["plane", "point"] = "plane"
    planes: list[SlicePlaneSpec] = Field(default=[], max_length=SLICE_PLANES.max_slices)
    """Empty = eight slices spread over the map, 2 cm thick (V §3.2)."""
    source: str = ""


class AlignRequest(Strict):
    """Request to align a reference with the map."""

    how: Literal["none", "icp", "pairs", "undo"]
    p_map: list[Xyz] = Field(default=[], max_length=100)
    """Points picked in the map [m]."""
    p_reference: list[Xyz] = Field(default=[], max_length=100)
    """The same points in the reference, in its own frame [m]."""
    level: bool = False
    """Pairs: picked from above. Both stay level, and the floors are laid on each other."""
    refine: bool = False
    """Pairs: refine by ICP."""
    pose: Pose | None = None
    """ICP: ``T_map_reference`` to start from, x y z qx qy qz qw; None = the present alignment."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AlignPoints:
    """Points of map and reference to be laid on each other by a person."""

    p_map: str
    """Points of the map relative to ``middle_map``, little-endian float32 x y z, base64."""
    p_reference: str
    """The same of the reference, in its own frame."""
    middle_map: Xyz
    middle_reference: Xyz
    pose: Pose
    """Of the reference's middle frame in the map's, x y z qx qy qz qw: the present alignment, or
    middle on middle if they are apart."""


class SliceExportRequest(SliceView):
    """Request for an export of slices."""

    count: int = Field(default=1, ge=1, le=SLICE_PLANES.max_slices)
    spacing_m: float = Field(default=0.5, ge=-1000.0, le=1000.0)
    size: Literal["a4", "a3", "a2", "a1"] = "a4"
    scale: int = 0
    flat: bool = False
    draft: bool = False
    """Without the approval of the map, whether or not there is one."""


class ControlFile(Strict):
    """Content of a survey file."""

    name: Name = Field(default="points.csv", max_length=200)
    base64: str = Field(max_length=900_000)
    columns: tuple[Meaning, ...] = Field(default=(), max_length=SHOWN_TABLE.columns)
    """Meaning of each column, from the left; empty = as the table says."""
    unit: Unit | None = None

    @property
    def choice(self) -> ColumnChoice:
        """Columns and unit."""
        return ColumnChoice(self.columns, self.unit)


class ControlSpec(Strict):
    """A surveyed point."""

    id: Name = Field(min_length=1, max_length=64)
    xyz_m: Xyz
    role: Literal["control", "check"] = "check"
    radius_m: float = Field(default=0.0, ge=0.0, le=10.0)
    covariance_m2: Covariance | None = None
    """EE, EN, EH, NN, NH, HH [m²] of survey and pick; null = that of all points."""

    @field_validator("covariance_m2")
    @classmethod
    def _is_one(cls, values: Covariance | None) -> Covariance | None:
        try:
            return values and check_covariance(values)
        except ConfigError as error:
            raise ValueError(str(error)) from error


class LimitsSpec(Strict):
    """Limits of a job at its points [m]; None = not required. See `ControlLimits`."""

    mean_horizontal_m: Limit | None = USUAL_LIMITS.mean_horizontal_m
    mean_height_m: Limit | None = USUAL_LIMITS.mean_height_m
    max_horizontal_m: Limit | None = USUAL_LIMITS.max_horizontal_m
    max_height_m: Limit | None = USUAL_LIMITS.max_height_m
    distances_m: Limit | None = USUAL_LIMITS.distances_m
    survey_sd_m: Limit = USUAL_LIMITS.survey_sd_m


class ControlState(Strict):
    """Control and check points of a project, and their positions in the map."""

    points: list[ControlSpec] = Field(default=[], max_length=5000)
    frame: Literal["map", "crs"] = "map"
    picks: dict[Name, Xyz] = {}
    """Id -> position in the map frame [m]."""
    along: dict[Name, Annotated[list[Xyz], Field(min_length=1, max_length=3)]] = {}
    """Id -> directions in which the position was measured, in the map frame. A new position
    without them is taken as measured in all three."""
    limits: LimitsSpec = LimitsSpec()
    found_in: dict[str, str] = {}
    """Id -> key of the map it was found in; set by the server, never taken from a request."""
    version: int | None = Field(default=None, ge=0, le=1 << 53)
    """Version of the stored points when they were read: a newer version is not overwritten.
    None = overwrite any version."""

    @field_validator("along")
    @classmethod
    def _directions(cls, along: dict[str, list[Xyz]]) -> dict[str, list[Xyz]]:
        for directions in along.values():
            orthonormal(directions)  # refuses directions that are none
        return along

    def measured_in(self, key: str) -> dict[str, MeasuredPosition]:
        """Positions found in this map, of which it is known what they measured.

        Left out are positions found in an earlier map, and those of an earlier version.
        """
        return {
            name: MeasuredPosition(np.array(at), orthonormal(self.along[name]))
            for name, at in self.picks.items()
            if self.found_in.get(name) == key and name in self.along
        }


@dataclass(frozen=True, slots=True)
class OtherMap:
    """A map that the same slice can show."""

    id: str
    kind: Literal["map", "project"]
    """An earlier map of this project, or that of another one."""
    name: str
    """When it was made, or the name of the project."""
    label: str
    """Both in words."""


class SliceFacts(BaseModel):
    """Facts about the map that can be sliced."""

    points: int
    strays: int
    """Stray returns; slices leave them out."""
    surface: Surface
    """Where its points lie; those on fitted surfaces can also be shown as measured."""
    bounds_m: tuple[Xyz, Xyz]
    fields: list[str]
    sensors: list[str]
    seconds: float
    """Duration of the recording [s]."""
    key: str
    """Key of the map."""
    crs: str
    frame: str
    """Frame, axes and unit, as text."""
    approval: ApprovalState
    """Of the map."""
    references: list[ListedReference]
    sources: list[OtherMap]
    """Other maps to compare with."""


@dataclass(frozen=True, slots=True)
class ExportContext:
    """Origin of an exported map."""

    project: str
    """Name of the project."""
    key: str
    """Key of the map."""
    evidence: Evidence | None
    """Of its approval; None = not approved."""


@dataclass(frozen=True, slots=True)
class SurfacePoint:
    """A surveyed point and the surface beside it."""

    p_map: Xyz
    """Position in the map [m]."""
    surface: Xyz | None
    """Its foot on the nearest surface of the map [m]; None = no flat surface nearby."""
    normal: Xyz | None
    """Normal of the surface: the only direction in which the foot is a measurement."""
