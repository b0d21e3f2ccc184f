"""Tuning of exports."""

from __future__ import annotations

from msgspec import Struct


class FindingExportTuning(Struct, frozen=True, kw_only=True):
    """Findings as GeoJSON."""

    max_line_points: int = 500
    """A longer stretch is thinned out."""


FINDING_EXPORT = FindingExportTuning()


class PointExportTuning(Struct, frozen=True, kw_only=True):
    """Points as files."""

    block: int = 1 << 15
    """Points that are made ready at once: with more of them they leave the processor's cache
    between one column and the next, which takes twice as long."""
    summed: int = 50_000
    """Points with a checksum of their own: says where a file is wrong."""
    cube_bits: int = 21
    """Of the index of a cube along each axis: 0.1 mm in a tile of 200 m."""
    tile_margin_m: float = 1.0
    """A projection bends a tile by less than this [m]."""
    most_clip_boxes: int = 8
    """Of one export: each is a pass over the points."""


POINT_EXPORT = PointExportTuning()


class LazTuning(Struct, frozen=True, kw_only=True):
    """A LAZ file, and steps of its numbers: coarser ones compress better."""

    scale_m: float = 0.0001
    """Of the coordinates: they reach 214 km from whole meters near the middle of the map."""
    together: int = 500_000
    """Points that are compressed at once, 50 000 a thread."""
    workers: int = 2
    """Threads that make points ready for the compression, and compare what is read again."""
    normalized_step: float = 1.0 / 16.0
    """Of normalized intensities: finer than the raw step."""
    deviation_step_m: float = 0.0001
    """Of deviations of positions, which are whole numbers in the file."""


LAZ = LazTuning()


class PtxTuning(Struct, frozen=True, kw_only=True):
    """Numbers of a PTX file."""

    steps: float = 1e5
    """Of a meter: coordinates have five decimals."""
    brightest: float = 255.0
    """Intensity that is 1 in the file."""
    intensity_steps: float = 1e6


PTX = PtxTuning()


class OctreeTuning(Struct, frozen=True, kw_only=True):
    """The octree of COPC."""

    step_m: float = LAZ.scale_m
    """Resolution of the coordinates."""
    side_bits: int = 7
    """A node samples what is below it in 2^7 cells along each edge: COPC's spacing."""
    bucket_bits: int = 17
    """Points are sorted by cubes of 2^17 steps (13 m) in files first."""
    together: int = 250_000
    """Points that are sorted by these cubes at once: frames of the files compress better."""
    points_in_memory: int = 4_000_000
    """A file with more points is split by the nodes below it: 210 MB and some copies."""
    points_of_leaf: int = 50_000
    """A node with fewer points has no nodes below it: one request of a viewer."""


OCTREE = OctreeTuning()


class RereadTuning(Struct, frozen=True, kw_only=True):
    """Files that are read again."""

    text_bytes: int = 1 << 20
    """Lines that are read at a time."""
    head_bytes: int = 64 << 10
    """The head of a PLY or PCD file is shorter."""
    bounds_m: float = 1e-6
    """Bounds of coordinates that are stored as they are agree within this [m]: what adding an
    offset rounds at 10 000 km."""


REREAD = RereadTuning()


class PcdTuning(Struct, frozen=True, kw_only=True):
    """Coordinates in single precision."""

    near_m: float = 250.0
    """Middle of points of which nothing is subtracted: within 500 m float32 is exact to 0.03 mm."""


PCD = PcdTuning()


class GeoPackageTuning(Struct, frozen=True, kw_only=True):
    """Numbers of the standard, and of ours."""

    application_id: int = 0x47504B47
    """``GPKG``."""
    version: int = 10300
    own_system: int = 100_000
    """Number of a system without an EPSG code of its own."""


GEOPACKAGES = GeoPackageTuning()


class ExpectedTuning(Struct, frozen=True, kw_only=True):
    """The estimate of an export."""

    sample: int = 2_000_000
    """Points of the map that are looked at."""
    tiles: int = 6
    """Tiles that are thinned for it."""


EXPECTED = ExpectedTuning()


class BcfTuning(Struct, frozen=True, kw_only=True):
    """Notes as BCF."""

    field_of_view_deg: float = 60.0
    """Of the camera, from the lower to the upper rim [deg], as on the page *Map*."""
    eye_m: tuple[float, float, float] = (0.0, -2.5, 2.0)
    """Where the camera of a note without one is, from its place [m]."""
    max_title: int = 80
    """Letters of a title: the first line of a note."""
    snapshot: str = "snapshot.jpg"
    """Name of the photo of a note."""


BCF = BcfTuning()
