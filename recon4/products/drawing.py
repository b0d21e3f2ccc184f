"""Drawings as DXF and GeoJSON: lines and areas on layers, in the coordinates of a CRS."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.products.tuning import CURVES
from recon4.slices.map_crs import MapFrame
from recon4.store.atomic import atomic_file

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts.layout import Modelspace

DRAWINGS = (".dxf", ".geojson")
"""Endings of drawings."""
Facts = Mapping[str, float | str | bool]


@dataclass(frozen=True, slots=True)
class DrawingLayer:
    """How the lines of a layer look."""

    name: str
    color: int
    """AutoCAD color index."""
    lineweight: int = 18
    """In 1/100 mm."""
    linetype: str = "CONTINUOUS"
    hatched: bool = False
    """Areas of it are filled, without an outline."""


@dataclass(frozen=True, slots=True, eq=False)
class DrawnShape:
    """A line or an area."""

    layer: DrawingLayer
    p_map: Array
    """Corners in the map [m], (N, 3)."""
    closed: bool = False
    facts: Facts = field(default_factory=dict)
    """Of GeoJSON: its properties."""
    holes: tuple[Array, ...] = ()
    """Of an area, in the map [m], (M, 3) each."""
    arc: bool = False
    """Its corners lie on a circle: an ARC, or a CIRCLE if it ends where it begins, in DXF."""


@dataclass(frozen=True, slots=True, eq=False)
class DrawnTitle:
    """A text."""

    layer: DrawingLayer
    text: str
    p_map: Array
    """Its lower left corner in the map [m], (3,)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawingNotes:
    """What a drawing says besides its shapes."""

    frame: MapFrame
    """Of the map: the file has coordinates of its CRS, if it has one."""
    description: str = ""
    titles: Sequence[DrawnTitle] = ()


def write_drawing(shapes: Sequence[DrawnShape], path: Path, notes: DrawingNotes) -> None:
    """Write lines and areas.

    Args:
        shapes: What is drawn.
        path: File to write, ``.dxf`` (R2010, meters) or ``.geojson``.
        notes: Coordinates, titles and description.

    Raises:
        ConfigError: If the ending is another.
        StoreError: If the file cannot be written.
    """
    write = {".dxf": _write_dxf, ".geojson": _write_geojson}.get(path.suffix.lower())
    if write is None:
        raise ConfigError(
            CodedText("drawing-formats", drawings=" or ".join(DRAWINGS), file=path.name)
        )
    with atomic_file(path) as temporary:
        write(shapes, temporary, notes)


def _placed(p_map: Array, frame: MapFrame) -> Array:
    return frame.to_crs(p_map) if frame.to_crs else p_map


def _write_dxf(shapes: Sequence[DrawnShape], path: Path, notes: DrawingNotes) -> None:
    import ezdxf.filemanagement
    import ezdxf.units

    drawing = ezdxf.filemanagement.new("R2010", units=ezdxf.units.M, setup=True)
    space = drawing.modelspace()
    layers = [shape.layer for shape in shapes] + [title.layer for title in notes.titles]
    for layer in {layer.name: layer for layer in layers}.values():
        _add_layer(drawing, layer)
    for shape in shapes:
        _add_shape(space, shape, notes.frame)
    for title in notes.titles:
        at = _placed(title.p_map[None], notes.frame)[0]
        facts = {"layer": title.layer.name, "insert": tuple(at.tolist())}
        space.add_text(title.text, height=0.25, dxfattribs=facts)
    drawing.header.custom_vars.append("recon4", notes.description)
    drawing.header.custom_vars.append("coordinates", notes.frame.written_text)
    drawing.saveas(path)


def _add_layer(drawing: Drawing, layer: DrawingLayer) -> None:
    made = drawing.layers.add(layer.name, color=layer.color)
    made.dxf.lineweight = layer.lineweight
    made.dxf.linetype = layer.linetype


def _add_shape(space: Modelspace, shape: DrawnShape, frame: MapFrame) -> None:
    rings = [_placed(ring, frame) for ring in (shape.p_map, *shape.holes)]
    z_m = float(rings[0][:, 2].mean())
    facts: dict[str, object] = {"layer": shape.layer.name}
    if shape.arc:
        _add_arc(space, rings[0], facts)
        return
    if not shape.layer.hatched:
        facts["elevation"] = z_m
        space.add_lwpolyline(rings[0][:, :2], close=shape.closed, dxfattribs=facts)
        return
    hatch = space.add_hatch(dxfattribs=facts | {"elevation": (0.0, 0.0, z_m)})
    hatch.set_solid_fill(color=shape.layer.color)
    for k, ring in enumerate(rings):
        hatch.paths.add_polyline_path(ring[:, :2], is_closed=True, flags=16 if k else 1)


def _add_arc(space: Modelspace, p: Array, facts: dict[str, object]) -> None:
    """Corners on a circle as an ARC from the first to the last one; DXF turns to the left."""
    center, radius_m = circle_through(p[:, :2])
    at = (*center.tolist(), float(p[:, 2].mean()))
    if np.linalg.norm(p[0, :2] - p[-1, :2]) < CURVES.closed_m:
        space.add_circle(at, radius_m, dxfattribs=facts)
        return
    way = p[:, :2] - center
    turn = way[:-1, 0] * way[1:, 1] - way[:-1, 1] * way[1:, 0]
    ends = way[[0, -1]] if turn.sum() > 0.0 else way[[-1, 0]]
    start, end = np.degrees(np.arctan2(ends[:, 1], ends[:, 0])).tolist()
    space.add_arc(at, radius_m, start, end, dxfattribs=facts)


def circle_through(p: Array) -> tuple[Array, float]:
    """Center (2,) and radius [m] of corners on a circle, (N, 2), N > 2 (Kåsa 1976)."""
    middle = p.mean(axis=0)
    q = p - middle  # coordinates of a CRS are large
    A = np.column_stack([2.0 * q, np.ones(len(q))])
    x, y, c = np.linalg.lstsq(A, (q**2).sum(axis=1), rcond=None)[0]
    return middle + np.array([x, y]), float(np.sqrt(c + x * x + y * y))


def _write_geojson(shapes: Sequence[DrawnShape], path: Path, notes: DrawingNotes) -> None:
    features = [
        {
            "type": "Feature",
            "geometry": _geometry(shape, notes.frame),
            "properties": {"layer": shape.layer.name, **shape.facts},
        }
        for shape in shapes
    ]
    record = {
        "type": "FeatureCollection",
        "name": notes.description,
        "crs": notes.frame.geojson_crs,
        "coordinates": notes.frame.written_text,
        "features": features,
    }
    path.write_text(json.dumps(record), "utf-8")


def _geometry(shape: DrawnShape, frame: MapFrame) -> dict[str, object]:
    """Coordinates to 0.1 mm."""
    rings = [np.round(_placed(ring, frame), 4).tolist() for ring in (shape.p_map, *shape.holes)]
    if not shape.closed:
        return {"type": "LineString", "coordinates": rings[0]}
    return {"type": "Polygon", "coordinates": [[*ring, ring[0]] for ring in rings]}
