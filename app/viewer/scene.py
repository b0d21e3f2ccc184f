"""What is to be seen: a project and a view in, nodes and a legend out. Knows no viser.

Coordinates are those of the map frame. Whatever becomes float32 is first moved to the origin of
its node, which stays float64: far from zero float32 steps by centimetres.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from app.viewer.layers import Layer, edge_layer, edge_layers
from app.viewer.palette import SENSOR_COLORS, Palette, Range, Rgb, paint, usual_range
from recon4.geometry.se3 import Array
from recon4.model.pose_graph import PoseGraph
from recon4.model.trajectory import Trajectory

ColorBy = Literal["normalized intensity", "raw intensity", "height", "time", "sensor"]
COLOR_BY: tuple[ColorBy, ...] = get_args(ColorBy)

UNITS: dict[ColorBy, str] = {
    "normalized intensity": "",
    "raw intensity": "as the sensor gave it",
    "height": "m above the origin",
    "time": "s since the start",
    "sensor": "",
}

FINAL = Layer("trajectory", "Trajectory", (255, 179, 0))
ODOMETRY = Layer("odometry", "Trajectory before the graph", (128, 110, 200), shown=False)
FRAMES = Layer("frames", "Body frames at the nodes", (144, 164, 174), shown=False)
GRID = Layer("grid", "Grid", (96, 108, 118))
CLOSED_M = 2.0
"""Start and end nearer than this share a label [m]."""
MOST_FRAMES = 1000
"""More body frames than this are thinned out."""


@dataclass(frozen=True, slots=True, eq=False)
class Tile:
    """Points of one tile of the map; any first part of them covers all of the tile."""

    name: str
    origin_m: Array
    """Where the tile's own coordinates begin in the map [m], (3,)."""
    p_tile: NDArray[np.float32]
    """Points from there [m], (N, 3)."""
    columns: dict[ColorBy, NDArray[Any]]
    """Values to color by, (N,) each; those the map does not have are missing."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Content:
    """What a project has to show so far."""

    tiles: tuple[Tile, ...] = ()
    points_in_map: int = 0
    trajectory: Trajectory | None = None
    """``T_map_body`` of the last finished stage."""
    odometry: Trajectory | None = None
    """``T_odom_body``, before the graph."""
    graph: PoseGraph | None = None
    sensors: tuple[str, ...] = ()
    """Names of the LiDARs."""

    @property
    def colors(self) -> tuple[ColorBy, ...]:
        """What the points can be colored by."""
        return tuple(c for c in COLOR_BY if self.tiles and c in self.tiles[0].columns)

    @property
    def layers(self) -> tuple[Layer, ...]:
        """What can be switched on and off."""
        own = [(FINAL, self.trajectory), (ODOMETRY, self.odometry), (FRAMES, self.graph)]
        edges = edge_layers(self.graph.edges) if self.graph else ()
        return (*(layer for layer, there in own if there is not None), *edges, GRID)


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """What a person chose to see."""

    color_by: ColorBy = "normalized intensity"
    palette: Palette = "viridis"
    point_size_m: float = 0.02
    layers: frozenset[str] = frozenset()
    """Keys of the layers that are on."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Node:
    """Something on screen."""

    path: str
    position_m: Array
    """Origin of its coordinates in the map [m], (3,)."""
    visible: bool = True


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PointsNode(Node):
    """Points."""

    p_node: NDArray[np.float32]
    """(N, 3)"""
    rgb: NDArray[np.uint8]
    """(N, 3)"""
    size_m: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LinesNode(Node):
    """Line segments."""

    segments: NDArray[np.float32]
    """Start and end of each, (N, 2, 3)."""
    rgb: Rgb
    width_px: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AxesNode(Node):
    """Coordinate axes: x red, y green, z blue."""

    p_node: NDArray[np.float32]
    """(N, 3)"""
    quat_wxyz: Array
    """(N, 4)"""
    length_m: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GridNode(Node):
    """A horizontal grid around its position."""

    width_m: float
    cell_m: float
    rgb: Rgb


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LabelNode(Node):
    """A word in space."""

    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Legend:
    """What the colors mean."""

    color_by: ColorBy | None
    """None = there are no points."""
    palette: Palette
    span: Range
    unit: str
    sensors: tuple[tuple[str, Rgb], ...] = ()
    layers: tuple[Layer, ...] = ()
    points: int = 0
    points_in_map: int = 0
    grid_cell_m: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Bounds:
    """A box around everything."""

    low_m: Array = field(default_factory=lambda: np.full(3, -5.0))
    high_m: Array = field(default_factory=lambda: np.full(3, 5.0))

    @property
    def center_m(self) -> Array:
        """Middle of the box [m], (3,)."""
        return (self.low_m + self.high_m) / 2.0

    @property
    def size_m(self) -> float:
        """Its longest horizontal side [m]."""
        return float(np.max((self.high_m - self.low_m)[:2]))


def describe(content: Content, view: View) -> list[Node]:
    """List what is on screen. A layer that is off is there and invisible: showing it is instant."""
    box = bounds(content)
    nodes: list[Node] = [*_points(content, view)]
    for layer, line in ((FINAL, content.trajectory), (ODOMETRY, content.odometry)):
        if line is not None and len(line) > 1:
            nodes.append(_path(layer, line, layer.key in view.layers))
    if content.trajectory is not None and len(content.trajectory) > 1:
        nodes += _ends(content.trajectory, FINAL.key in view.layers)
    if content.graph is not None:
        nodes += [*_edges(content.graph, view), _frames(content.graph, FRAMES.key in view.layers)]
    nodes.append(_grid(box, GRID.key in view.layers))
    return nodes


def legend(content: Content, view: View) -> Legend:
    """Say what the colors of the same view mean."""
    shown = content.tiles and view.color_by in content.colors
    return Legend(
        color_by=view.color_by if shown else None,
        palette=view.palette,
        span=span_of(content, view.color_by) if shown else Range(0.0, 1.0),
        unit=UNITS[view.color_by],
        sensors=tuple(
            (name, SENSOR_COLORS[k % len(SENSOR_COLORS)]) for k, name in enumerate(content.sensors)
        ),
        layers=tuple(layer for layer in content.layers if layer.key in view.layers),
        points=sum(len(tile.p_tile) for tile in content.tiles),
        points_in_map=content.points_in_map,
        grid_cell_m=grid_cell_m(bounds(content)),
    )


def span_of(content: Content, color_by: ColorBy) -> Range:
    """Range of the values over all tiles."""
    columns = [tile.columns[color_by] for tile in content.tiles if len(tile.p_tile)]
    return usual_range(np.concatenate(columns)) if columns else Range(0.0, 1.0)


def bounds(content: Content) -> Bounds:
    """The box around nearly all points and the trajectory; a room's when there is neither.

    A hundredth of the points may lie outside: what was seen far away through doors and panes.
    """
    step = max(1, sum(len(tile.p_tile) for tile in content.tiles) // 50_000)
    seen = [tile.origin_m + tile.p_tile[::step] for tile in content.tiles if len(tile.p_tile)]
    corners = [*np.percentile(np.concatenate(seen), [1.0, 99.0], axis=0)] if seen else []
    for line in (content.trajectory, content.odometry):
        if line is not None and len(line):
            corners += [*_ends_of(line.T_a_b.t)]
            break
    if not corners:
        return Bounds()
    return Bounds(np.min(corners, axis=0), np.max(corners, axis=0))


def grid_cell_m(box: Bounds) -> float:
    """A round length that divides the picture into 10 to 50 cells [m]."""
    for cell_m in (1.0, 5.0, 10.0, 50.0):
        if box.size_m <= 50.0 * cell_m:
            return cell_m
    return 100.0


def _ends_of(points: NDArray[Any]) -> Iterator[Array]:
    if len(points):
        yield np.asarray(points.min(axis=0), dtype=np.float64)
        yield np.asarray(points.max(axis=0), dtype=np.float64)


def _points(content: Content, view: View) -> Iterator[PointsNode]:
    if view.color_by not in content.colors:
        return
    span = span_of(content, view.color_by)
    for tile in content.tiles:
        if len(tile.p_tile):
            yield PointsNode(
                path=f"/map/{tile.name}",
                position_m=tile.origin_m,
                p_node=tile.p_tile,
                rgb=_colors(tile.columns[view.color_by], span, view),
                size_m=view.point_size_m,
            )


def _colors(values: NDArray[Any], span: Range, view: View) -> NDArray[np.uint8]:
    if view.color_by == "sensor":
        known = np.array(SENSOR_COLORS, dtype=np.uint8)
        return known[values.astype(np.intp) % len(known)]
    return paint(values, span, view.palette)


def _path(layer: Layer, line: Trajectory, visible: bool) -> LinesNode:
    origin = line.T_a_b.t[0]
    p = (line.T_a_b.t - origin).astype(np.float32)
    return LinesNode(
        path=f"/{layer.key}",
        position_m=origin,
        segments=np.stack([p[:-1], p[1:]], axis=1),
        rgb=layer.rgb,
        width_px=2.5,
        visible=visible,
    )


def _ends(line: Trajectory, visible: bool) -> Iterator[LabelNode]:
    first_m, last_m = line.T_a_b.t[0], line.T_a_b.t[-1]
    apart = np.linalg.norm(last_m - first_m) > CLOSED_M
    yield _label("start" if apart else "start and end", first_m, visible)
    if apart:
        yield _label("end", last_m, visible)


def _label(text: str, p_map: Array, visible: bool) -> LabelNode:
    path = f"/labels/{text.replace(' ', '-')}"
    return LabelNode(path=path, position_m=p_map, text=text, visible=visible)


def _edges(graph: PoseGraph, view: View) -> Iterator[LinesNode]:
    t = graph.T_map_body.t
    origin = t[0] if len(t) else np.zeros(3)
    p = (t - origin).astype(np.float32)
    keys = np.array([edge_layer(edge).key for edge in graph.edges])
    ends = np.array([(edge.i, edge.j) for edge in graph.edges], dtype=np.intp).reshape(-1, 2)
    for layer in edge_layers(graph.edges):
        yield LinesNode(
            path=f"/edges/{layer.key}",
            position_m=origin,
            segments=p[ends[keys == layer.key]],
            rgb=layer.rgb,
            width_px=layer.width_px,
            visible=layer.key in view.layers,
        )


def _frames(graph: PoseGraph, visible: bool) -> AxesNode:
    T = graph.T_map_body[slice(None, None, max(1, -(-len(graph) // MOST_FRAMES)))]
    origin = T.t[0] if len(T.t) else np.zeros(3)
    return AxesNode(
        path="/frames",
        position_m=origin,
        p_node=(T.t - origin).astype(np.float32),
        quat_wxyz=np.roll(T.quat_xyzw(), 1, axis=-1),
        length_m=0.4,
        visible=visible,
    )


def _grid(box: Bounds, visible: bool) -> GridNode:
    cell_m = grid_cell_m(box)
    floor = np.array([*np.round(box.center_m[:2] / cell_m) * cell_m, box.low_m[2]])
    width_m = (np.ceil(box.size_m / cell_m) + 4.0) * cell_m
    return GridNode(
        path="/grid",
        position_m=floor,
        width_m=float(width_m),
        cell_m=cell_m,
        rgb=GRID.rgb,
        visible=visible,
    )
