"""The scene beside the points: builds nodes from a project's content and a view, without viser.

Coordinates are in the map frame. Before conversion to float32 they are made relative to the origin
of their node, which stays float64: far from zero the step of float32 is centimeters.

Long lines are cut into pieces, so that a walk that grows resends its last piece only.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.locales.texts import Texts
from recon4.model.trajectory import Times, Trajectory
from recon4.slam2d.grid_files import TrinaryMap
from recon4_app.viewer.client.view import ColorBy, Position, ViewState
from recon4_app.viewer.cloud.multiframes import Multiframes
from recon4_app.viewer.cloud.palette import Range, Rgb, paint
from recon4_app.viewer.cloud.parts import Cloud
from recon4_app.viewer.cloud.preview import JobPreview
from recon4_app.viewer.scene.layers import (
    FINAL,
    FRAMES,
    GNSS_REJECTED,
    GNSS_USED,
    GRAVITY,
    GRID,
    LIDARS,
    NORTH,
    ODOMETRY,
    PLAN,
    EdgeTable,
    Layer,
)
from recon4_app.viewer.scene.nodes import AxesNode, GridNode, ImageNode, LabelNode, LinesNode, Node
from recon4_app.viewer.tuning import SCENE

ERROR_RANGE = Range(0.0, 1.0)
CHI2_RANGE = Range(0.0, 20.0)


@dataclass(frozen=True, slots=True, eq=False)
class GnssMarks:
    """GNSS fixes and their residuals to the trajectory."""

    t_ns: Times
    """(M,)"""
    p_map: Array
    """Antenna position of the fix [m], (M, 3)."""
    p_antenna: Array
    """Antenna position of the trajectory at that time [m], (M, 3)."""
    used: NDArray[np.bool_]
    """False = rejected as an outlier, (M,)."""

    @property
    def layers(self) -> tuple[Layer, Layer]:
        """Used and rejected ones with their counts."""
        used = int(self.used.sum())
        rejected = len(self.used) - used
        return replace(GNSS_USED, count=used), replace(GNSS_REJECTED, count=rejected)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Content:
    """Content of a project for the viewer, so far."""

    cloud: Cloud | None = None
    trajectory: Trajectory | None = None
    """``T_map_body`` of the last finished stage, or of the running one so far."""
    odometry: Trajectory | None = None
    """``T_odom_body``, before the graph."""
    edges: EdgeTable | None = None
    multiframes: Multiframes | None = None
    preview: JobPreview | None = None
    """The points of the walk until there is a map."""
    sensors: tuple[str, ...] = ()
    """Names of the LiDARs."""
    plan: TrinaryMap | None = None
    """The map of a 2-D laser."""
    gnss: GnssMarks | None = None
    crs: str = ""
    """Name of the CRS of the map; empty = not georeferenced."""

    @property
    def colors(self) -> tuple[ColorBy, ...]:
        """Attributes by which the points can be colored."""
        return self.cloud.colors if self.cloud else ()

    @property
    def layers(self) -> tuple[Layer, ...]:
        """Layers that can be switched on and off."""
        own = [
            (PLAN, self.plan is not None),
            (FINAL, self.trajectory is not None),
            (ODOMETRY, self.odometry is not None),
            (FRAMES, self.edges is not None),
            (LIDARS, self.multiframes is not None),
        ]
        edges = self.edges.layers if self.edges else ()
        gnss = self.gnss.layers if self.gnss else ()
        rest = (NORTH, GRAVITY, GRID) if self.crs else (GRAVITY, GRID)
        return (*(layer for layer, there in own if there), *edges, *gnss, *rest)


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


def describe(content: Content, view: ViewState) -> list[Node]:
    """List the nodes on screen. A hidden layer is sent but invisible: showing it is instant."""
    box = bounds(content)
    nodes: list[Node] = []
    if content.plan is not None:
        nodes.append(_plan(content.plan, view))
    for layer, line in ((FINAL, content.trajectory), (ODOMETRY, content.odometry)):
        if line is not None and len(line) > 1:
            nodes += _path(layer, line, view.shows(layer))
    if content.trajectory is not None and len(content.trajectory) > 1:
        nodes += _ends(content.trajectory, view)
    if content.edges is not None:
        nodes += [*_edges(content.edges, view), _frames(content.edges, view)]
    if content.multiframes is not None and content.trajectory is not None:
        nodes += _lidars(content.multiframes, content.trajectory, view)
    if content.gnss is not None:
        nodes += _gnss(content.gnss, view)
    nodes += [*_directions(content, box, view), _grid(box, view.shows(GRID))]
    return [*nodes, *_measurements(view)]


def bounds(content: Content) -> Bounds:
    """The box around nearly all points and the trajectory; a room's when there is neither.

    1 % of the points may be outside: measured far away through openings and windows.
    """
    corners: list[Array] = []
    if content.cloud is not None and len(content.cloud.base):
        base = content.cloud.base
        step = max(1, len(base) // 50_000)
        corners += [*(base.origin_m + np.percentile(base.p_part[::step], [1.0, 99.0], axis=0))]
    for line in (content.trajectory, content.odometry):
        if line is not None and len(line):
            corners += [line.T_a_b.t.min(axis=0), line.T_a_b.t.max(axis=0)]
            break
    if content.plan is not None:
        corners += _corners_m(content.plan)
    if not corners:
        return Bounds()
    return Bounds(np.min(corners, axis=0), np.max(corners, axis=0))


def grid_cell_m(box: Bounds) -> float:
    """A round length that divides the view into 10 to 50 cells [m]."""
    for cell_m in (1.0, 5.0, 10.0, 50.0):
        if box.size_m <= 50.0 * cell_m:
            return cell_m
    return 100.0


def _plan(plan: TrinaryMap, view: ViewState) -> ImageNode:
    low_m, high_m = _corners_m(plan)
    rgba = np.zeros((*plan.gray.shape, 4), np.uint8)
    rgba[plan.free] = (*SCENE.free_color, 255)
    rgba[plan.occupied] = (*PLAN.rgb, 255)
    width_m, height_m, _ = high_m - low_m
    return ImageNode(
        path=f"/{PLAN.key}",
        position_m=(low_m + high_m) / 2.0,
        rgba=rgba,
        width_m=float(width_m),
        height_m=float(height_m),
        visible=view.shows(PLAN),
    )


def _corners_m(plan: TrinaryMap) -> tuple[Array, Array]:
    """Lower left and upper right corner, just below the trajectory."""
    rows, columns = plan.gray.shape
    low_m = np.array([*plan.origin_m, -SCENE.under_m])
    return low_m, low_m + plan.cell_m * np.array([columns, rows, 0.0])


def _path(layer: Layer, line: Trajectory, visible: bool) -> Iterator[LinesNode]:
    t = line.T_a_b.t[:: max(1, -(-len(line) // SCENE.max_poses))]
    for piece, begin in enumerate(range(0, len(t) - 1, SCENE.piece)):
        p = t[begin : begin + SCENE.piece + 1]
        yield _lines(
            f"/{layer.key}/{piece}",
            np.stack([p[:-1], p[1:]], axis=1),
            layer.rgb,
            width_px=2.5,
            visible=visible,
        )


def _lines(
    path: str,
    segments_m: Array,
    rgb: Rgb | NDArray[np.uint8],
    *,
    width_px: float,
    visible: bool,
) -> LinesNode:
    origin = segments_m[0, 0] if len(segments_m) else np.zeros(3)
    return LinesNode(
        path=path,
        position_m=origin,
        segments=(segments_m - origin).astype(np.float32),
        rgb=rgb,
        width_px=width_px,
        visible=visible,
    )


def _ends(line: Trajectory, view: ViewState) -> Iterator[LabelNode]:
    visible = view.shows(FINAL)
    first_m, last_m = line.T_a_b.t[0], line.T_a_b.t[-1]
    apart = np.linalg.norm(last_m - first_m) > SCENE.closed_m
    yield _label("start" if apart else "start-and-end", first_m, view, visible=visible)
    if apart:
        yield _label("end", last_m, view, visible=visible)


def _label(key: str, p_map: Array, view: ViewState, *, visible: bool) -> LabelNode:
    return _named(key, p_map, view.say(f"label-{key}"), visible=visible)


def _named(key: str, p_map: Array, text: str, *, visible: bool) -> LabelNode:
    return LabelNode(path=f"/labels/{key}", position_m=p_map, text=text, visible=visible)


def _edges(table: EdgeTable, view: ViewState) -> Iterator[LinesNode]:
    t = table.graph.T_map_body.t
    for row, layer in enumerate(table.layers):
        mine = np.flatnonzero(table.layer == row)
        rgb = _edge_colors(table, mine, layer, view=view)
        for piece, begin in enumerate(range(0, len(mine), SCENE.piece)):
            part = slice(begin, begin + SCENE.piece)
            yield _lines(
                f"/edges/{layer.key}/{piece}",
                t[table.ends[mine[part]]],
                layer.rgb if rgb is None else rgb[part],
                width_px=layer.width_px,
                visible=view.shows(layer),
            )


def _edge_colors(
    table: EdgeTable, rows: NDArray[np.intp], layer: Layer, *, view: ViewState
) -> NDArray[np.uint8] | None:
    """Colors by a value, gray where it is not known; None = the layer's own."""
    if view.edge_color == "verdict":
        return None
    by_error = view.edge_color == "error / limit"
    values = (table.error_ratio if by_error else table.chi2)[rows]
    rgb = paint(values, ERROR_RANGE if by_error else CHI2_RANGE, "turbo")
    rgb[~np.isfinite(values)] = 110
    return rgb


def _frames(table: EdgeTable, view: ViewState) -> AxesNode:
    T = table.graph.T_map_body
    T = T[slice(None, None, max(1, -(-len(T.t) // SCENE.max_frames)))]
    return _axes("/frames", T, length_m=0.4, visible=view.shows(FRAMES))


def _lidars(multiframes: Multiframes, line: Trajectory, view: ViewState) -> Iterator[Node]:
    """Axes of each LiDAR, and of the body, at the selected multiframe."""
    T_map_body = multiframes.pose(view.moment, line)
    if T_map_body is None:
        return
    visible = view.shows(LIDARS)
    T_map_sensor = SE3(T_map_body.R[None], T_map_body.t[None]) @ multiframes.T_body_sensor
    yield _axes("/lidars/sensors", T_map_sensor, length_m=0.3, visible=visible)
    yield _axes(
        "/lidars/body", SE3(T_map_body.R[None], T_map_body.t[None]), length_m=0.6, visible=visible
    )
    for name, t in zip(multiframes.sensors, T_map_sensor.t, strict=True):
        yield _named(f"lidar-{name}", t, name, visible=visible)


def _axes(path: str, T: SE3, *, length_m: float, visible: bool) -> AxesNode:
    origin = T.t[0] if len(T.t) else np.zeros(3)
    return AxesNode(
        path=path,
        position_m=origin,
        p_node=(T.t - origin).astype(np.float32),
        quat_wxyz=np.roll(T.quat_xyzw(), 1, axis=-1),
        length_m=length_m,
        visible=visible,
    )


def _gnss(marks: GnssMarks, view: ViewState) -> Iterator[LinesNode]:
    for layer, rows in ((GNSS_USED, marks.used), (GNSS_REJECTED, ~marks.used)):
        step = max(1, int(rows.sum()) // SCENE.max_poses)
        p, p_antenna = marks.p_map[rows][::step], marks.p_antenna[rows][::step]
        lines = np.concatenate([crosses(p), np.stack([p_antenna, p], axis=1)])
        yield _lines(f"/{layer.key}", lines, layer.rgb, width_px=1.5, visible=view.shows(layer))


def crosses(p: Array) -> Array:
    """Three short lines through each point, (N, 3) -> (3 N, 2, 3)."""
    arms = np.eye(3) * SCENE.mark_m
    both = np.stack([p[:, None] - arms, p[:, None] + arms], axis=2)
    return np.asarray(both.reshape(-1, 2, 3))


def _directions(content: Content, box: Bounds, view: ViewState) -> Iterator[Node]:
    """Down, the axes of the map, and north, at the lower south-west corner of the box."""
    corner, length_m = box.low_m, max(0.08 * box.size_m, 1.0)
    down = np.stack([corner, corner - [0.0, 0.0, length_m]])[None]
    on = view.shows(GRAVITY)
    yield _lines("/gravity", down, GRAVITY.rgb, width_px=3.0, visible=on)
    yield _axes("/map-axes", SE3(np.eye(3)[None], corner[None]), length_m=length_m, visible=on)
    yield _label("down", down[0, 1], view, visible=on)
    if not content.crs:
        return
    north = corner + np.array([0.0, 2.0 * length_m, 0.0])
    wings = 0.3 * length_m * np.array([[1.0, -1.0, 0.0], [-1.0, -1.0, 0.0]])
    arrow = np.array([[corner, north], *([north, north + wing] for wing in wings)])
    on = view.shows(NORTH)
    yield _lines("/north", arrow, NORTH.rgb, width_px=3.0, visible=on)
    yield _label("north", north, view, visible=on)


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


def _measurements(view: ViewState) -> Iterator[Node]:
    for number, points in enumerate(view.measurements, start=1):
        p = np.array(points)
        lines = [crosses(p), *([p[None]] if len(p) == 2 else [])]
        yield _lines(
            f"/measured/{number}",
            np.concatenate(lines),
            SCENE.measured_color,
            width_px=2.5,
            visible=True,
        )
        text = measurement_label(number, points, view.say)
        yield _named(f"m{number}", p.mean(axis=0), text, visible=True)


def measurement_label(number: int, points: tuple[Position, ...], say: Texts) -> str:
    """Label of a measurement, in the language of texts."""
    if len(points) == 1:
        x, y, z = points[0]
        return f"{number}: {x:.3f} {y:.3f} {z:.3f}"
    length_m = float(np.linalg.norm(np.subtract(points[0], points[1])))
    return say("measured-length", number=number, m=length_m)


def as_position(p: NDArray[Any]) -> Position:
    """A point as plain numbers."""
    x, y, z = (float(value) for value in p)
    return x, y, z
