"""Tuning of images, sheets and files of slices."""

from __future__ import annotations

from msgspec import Struct


class SliceColorTuning(Struct, frozen=True, kw_only=True):
    """Colors of slices, red green blue."""

    reference_color: tuple[int, int, int] = (22, 163, 74)
    """The reference is green (V Fig. 3.3)."""
    distance_range_m: tuple[float, float] = (0.0, 0.10)
    """Distances to the reference: blue 0, red 10 cm (V Fig. 3.3)."""
    sensor_colors: tuple[tuple[int, int, int], ...] = (
        (0, 114, 178),
        (213, 94, 0),
        (0, 158, 115),
        (204, 121, 167),
        (166, 134, 0),
    )
    """Distinguishable for color-blind readers (after Okabe and Ito 2008)."""
    distance_stops: tuple[tuple[int, int, int], tuple[int, int, int], tuple[int, int, int]] = (
        (32, 84, 255),
        (150, 60, 200),
        (232, 20, 20),
    )
    """Colors of the scale of distances, from near to far."""


SLICE_COLORS = SliceColorTuning()


class ControlFileLimits(Struct, frozen=True, kw_only=True):
    """Files of control points."""

    max_points: int = 5000
    """Largest number of points in a file."""
    max_bytes: int = 4 << 20
    """Largest file."""
    max_skipped: int = 100
    """Largest number of skipped lines listed individually."""


CONTROL_FILES = ControlFileLimits()


class SliceExportTuning(Struct, frozen=True, kw_only=True):
    """Export of slices."""

    max_dxf_points: int = 2_000_000
    """Most points of a DXF: programs open no more."""
    dxf_cell_m: float = 0.01
    """One point of a cell of this edge is written to a DXF [m]."""


SLICE_EXPORT = SliceExportTuning()


class ReferenceImportTuning(Struct, frozen=True, kw_only=True):
    """Import of reference files."""

    tile_m: float = 5.0
    """Edge of a tile [m]."""
    normal_cells_m: tuple[float, float, float] = (0.05, 0.10, 0.20)
    """Cell sizes for normals: the smallest one with enough points is used."""
    burst: int = 4_000_000
    """Points that are sorted into tiles at a time."""
    max_tiles: int = 100_000
    """Limit of temporary tile files: points scattered over the Earth are no survey."""


REFERENCE_IMPORT = ReferenceImportTuning()


class ControlLimitTuning(Struct, frozen=True, kw_only=True):
    """Limits that a map has to keep."""

    least_points: int = 3
    """Fewer points are no sample: there is no verdict on what they measured."""
    most_m: float = 100.0
    """Largest limit [m]."""


CONTROL_LIMITS = ControlLimitTuning()


class SlicePointTuning(Struct, frozen=True, kw_only=True):
    """The points inside a slice."""

    block: int = 2_000_000
    """Points processed at once: memory does not depend on the size of a tile."""


SLICE_POINTS = SlicePointTuning()


class ReferenceTuning(Struct, frozen=True, kw_only=True):
    """Reference models and distances to them."""

    far_m: float = 0.5
    """Search radius of distances [m]; larger ones are returned as infinite."""
    known: float = 0.25
    """Smallest squared length of a normal: where there is none, it is zero."""
    max_facts_bytes: int = 1 << 20
    """Size of ``reference.json``."""
    longest_note: int = 400
    longest_caption: int = 150
    """Longest note and longest caption of a reference."""
    margin_m: float = 2.0
    """Points of a request are measured in cubes of this size, each with its own search tree [m]."""


REFERENCES = ReferenceTuning()


class SheetTuning(Struct, frozen=True, kw_only=True):
    """Slice sheets to print."""

    scales: tuple[int, ...] = (
        1,
        2,
        5,
        10,
        20,
        25,
        50,
        100,
        200,
        250,
        500,
        1000,
        2000,
        2500,
        5000,
        10000,
    )
    """Scales that are offered, one to this."""
    dpi: int = 300
    """Resolution of the image [dots per inch]."""
    left_mm: float = 18.0
    right_mm: float = 8.0
    top_mm: float = 20.0
    bottom_mm: float = 30.0
    """Margins [mm]."""
    reason_characters: int = 90
    """Of a signer's reason that fit on one line; all of it is in the statement."""


SHEETS = SheetTuning()


class SliceImageTuning(Struct, frozen=True, kw_only=True):
    """Images of slices."""

    max_pixels: int = 40_000_000
    """Most pixels of an image."""
    dot_m: float = 0.006
    """Smallest size of a drawn point [m]."""
    max_radius_px: int = 4
    """Largest radius of the dot of a point [px]."""


SLICE_IMAGES = SliceImageTuning()


class SlicePlaneTuning(Struct, frozen=True, kw_only=True):
    """Cuts through the map."""

    error_thickness_m: float = 0.02
    """Thickness for error measurement (V §3.2: slices 2 cm wide) [m]."""
    looking_thickness_m: float = 0.10
    """Thickness for display [m]."""
    max_thickness_m: float = 100.0
    """Largest thickness [m]."""
    max_slices: int = 200
    """Repeated slices in one request."""


SLICE_PLANES = SlicePlaneTuning()
