"""Kinds of files that are made of a project: the one table for pages, HTTP and deliveries."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import recon4
from recon4.errors import ConfigError
from recon4.export.options import ExportOptions
from recon4.locales.coded import CodedText, StoredText
from recon4.progress import Progress
from recon4.store.hashing import hash_shown
from recon4.untrusted.names import visible

if TYPE_CHECKING:
    from recon4.review.approval_state import ApprovalState

_ALWAYS = ("draft",)
_POINTS = ("crs", "raw", "classes", "box_m", "clip", "storey", "thin_m", *_ALWAYS)
_CLASSED = (*_POINTS, "all_points")


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportKind:
    """A kind of file."""

    name: str
    """Name of the file in a delivery."""
    title: str
    programs: str
    """Who reads it."""
    group: str
    """What it shows."""
    takes: tuple[str, ...]
    """Options of `ExportOptions`."""
    point_bytes: float = 0.0
    """Usual bytes of a point of a whole map; 0 = it has none. Measured: docs/how-to/deliver.md."""
    thinned_bytes: float = 0.0
    """The same where thinning leaves one point of 32: neighbors are less alike. 0 = as many."""
    with_notes: bool = False
    """Whether it holds what people add to a finished map: another one each time."""
    sorted_bytes: float = 0.0
    """Bytes of a point in the temporary files that sort the points; 0 = there are none."""

    @property
    def ending(self) -> str:
        """With its dot."""
        return "." + self.name.partition(".")[2]


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportedFile:
    """What was written; kept when the file is gone."""

    name: str
    bytes: int
    sha256: str
    text: str
    """What is in it, in words."""
    approval: str
    """State of the approval of the map, in one line."""
    approval_line: StoredText | None = None
    """The same with its code and values; None = written by an earlier version."""
    map_key: str
    """Artifact of the map that it was made of."""
    recon4: str
    """Version of the program."""
    points: int = 0
    """Points in it; 0 = it has none."""

    @classmethod
    def of(
        cls, path: Path, text: str, state: ApprovalState, *, map_key: str, progress: Progress
    ) -> ExportedFile:
        """The record of a file that was just written.

        Args:
            path: The file.
            text: What is in it, in words.
            state: Approval of the map.
            map_key: Artifact of the map.
            progress: Counts the bytes that are hashed.
        """
        return cls(
            name=path.name,
            bytes=path.stat().st_size,
            sha256=hash_shown(path, progress),
            text=text,
            approval=state.text,
            approval_line=state.line,
            map_key=map_key,
            recon4=recon4.__version__,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportEstimate:
    """What an export will be, about."""

    points: int
    """Points in the file; 0 = it has none."""
    bytes: int
    """Size of the file; 0 = not known: drawings and tables are small."""
    is_most: bool
    """Whether it will be smaller: images are compressed."""
    sorted_bytes: int = 0
    """Size of temporary files beside it."""


def _kind(name: str, title: str, programs: str, **more: Any) -> ExportKind:
    return ExportKind(name=name, title=title, programs=programs, **more)


_CLOUDS, _DRAWINGS, _LISTS = "Point cloud", "Drawings and images", "Tables and lines"
_PLAN, _RASTER = ("crs", "storey", *_ALWAYS), ("crs", "cell_m", *_ALWAYS)
KINDS: dict[str, ExportKind] = {
    kind.name: kind
    for kind in (
        _kind("map.copc.laz", "COPC", "QGIS, web viewers", group=_CLOUDS, takes=_CLASSED,
              point_bytes=10.5, thinned_bytes=15.6, sorted_bytes=20.0),
        _kind("map.laz", "LAZ", "CloudCompare, PDAL", group=_CLOUDS, takes=_CLASSED,
              point_bytes=9.9, thinned_bytes=15.0),
        _kind("map.e57", "E57, scans with poses", "Recap, Cyclone, CloudCompare", group=_CLOUDS,
              takes=_POINTS, point_bytes=16.2, sorted_bytes=16.0),
        _kind("map.ply", "PLY, all fields and normals", "MeshLab, Open3D", group=_CLOUDS,
              takes=_CLASSED, point_bytes=66.0),
        _kind("map.pcd", "PCD", "PCL, ROS", group=_CLOUDS, takes=_CLASSED, point_bytes=43.0),
        _kind("map.xyz", "XYZ, lines of text", "any program", group=_CLOUDS, takes=_CLASSED,
              point_bytes=29.5),
        _kind("map.ptx", "PTX, scans with poses as text", "Cyclone, CloudCompare", group=_CLOUDS,
              takes=_POINTS, point_bytes=36.0, sorted_bytes=16.0),
        _kind("plan.dxf", "Floor plans, DXF", "CAD", group=_DRAWINGS, takes=_PLAN),
        _kind("plan.geojson", "Floor plans, GeoJSON", "GIS", group=_DRAWINGS, takes=_PLAN),
        _kind("orthophoto.tif", "Orthophoto of a storey, GeoTIFF", "GIS, CAD", group=_DRAWINGS,
              takes=(*_PLAN, "pixel_m")),
        _kind("dtm.tif", "Terrain, the ground, GeoTIFF", "GIS", group=_DRAWINGS, takes=_RASTER),
        _kind("dsm.tif", "Terrain, what is highest, GeoTIFF", "GIS", group=_DRAWINGS,
              takes=_RASTER),
        _kind("contours.dxf", "Contours, DXF", "CAD", group=_DRAWINGS, takes=("crs", *_ALWAYS)),
        _kind("poses.txt", "Poses, KITTI", "SLAM tools", group=_LISTS, takes=_ALWAYS),
        _kind("findings.csv", "Findings, CSV", "spreadsheets", group=_LISTS, takes=()),
        _kind("layers.gpkg", "Trajectory, points, findings, notes, double walls, GeoPackage",
              "QGIS", group=_LISTS, takes=("crs",), with_notes=True),
        _kind("findings.geojson", "Findings, GeoJSON", "GIS", group=_LISTS, takes=()),
    )
}  # fmt: skip
"""Name -> kind, in the order in which pages list them."""

DELIVERY = _kind("delivery.zip", "Delivery, ZIP", "the client", group="Delivery", takes=("crs",),
                 with_notes=True)  # fmt: skip
"""Other kinds, report and license in one file: `recon4.delivery.package`."""


def title_of(name: str) -> str:
    """What a kind is called; the name itself of what is none now."""
    found = DELIVERY if name == DELIVERY.name else KINDS.get(name)
    return found.title if found else name


def kind_named(name: str, options: ExportOptions) -> ExportKind:
    """The kind of a name, which takes these options.

    Raises:
        ConfigError: If there is none of this name, or it takes no such option.
    """
    if name not in KINDS:
        raise ConfigError(CodedText("deliver-kind", kinds=", ".join(KINDS), name=visible(name)))
    return checked_kind(KINDS[name], options)


def checked_kind(kind: ExportKind, options: ExportOptions) -> ExportKind:
    """The kind, which takes these options.

    Raises:
        ConfigError: If it takes no such option.
    """
    for option in options.changed:
        if option not in kind.takes:
            raise ConfigError(CodedText("deliver-option", title=kind.title, option=option))
    options.selection()
    return kind
