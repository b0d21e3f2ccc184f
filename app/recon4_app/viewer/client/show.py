"""Draws nodes with viser. With `panels` the only module that imports it (pinned: 1.1.1).

Everything is drawn per client: phones get fewer points than desktops, each person has a view of
their own, and nothing large stays in the buffer that viser replays.
"""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypedDict

import numpy as np
import viser

from recon4.geometry.se3 import Array, matrix_from_quat
from recon4_app.viewer import unix_socket
from recon4_app.viewer.cloud.lod import Camera
from recon4_app.viewer.cloud.pick import Ray
from recon4_app.viewer.scene.build import Bounds
from recon4_app.viewer.scene.nodes import (
    AxesNode,
    GridNode,
    ImageNode,
    LabelNode,
    LinesNode,
    Node,
    PointsNode,
    alike,
)
from recon4_app.viewer.tuning import SHOW
from recon4_app.viewer.wakeups import wake_every_browser

STORAGE_PREFIX = "recon4.view."
"""Name under which a browser keeps the view of a project."""
STRETCH_PREFIX = "recon4.stretch."
"""Name under which the page leaves the stretch of the walk that it was asked to show."""
LANGUAGE = "recon4.language"
"""Name under which the page leaves its language."""
DEFAULT_VIEW_DIRECTION = np.array([0.0, -0.75, 0.75])
"""Camera position relative to a box, in units of its size: south and above."""


@dataclass(frozen=True, slots=True, eq=False)
class _Drawn:
    node: PointsNode
    handle: Any
    style: object


class _Place(TypedDict):
    """What every drawn node has."""

    position: Array
    visible: bool


class Screen:
    """The screen of one client: sends only the differences to the last nodes."""

    def __init__(self, client: viser.ClientHandle, project: str, *, begins_at: Bounds) -> None:
        self._client = client
        self._put_m: Array | None = None
        self._box_m = begins_at.size_m
        if _is_fresh(client.camera):
            self.look_at(begins_at)
        self._key = STORAGE_PREFIX + project
        self._stretch_key = STRETCH_PREFIX + project
        self._shown: dict[str, tuple[Node, Any]] = {}
        self._points: OrderedDict[str, _Drawn] = OrderedDict()
        self._map = client.scene.add_frame("/map", show_axes=False)

    @property
    def gui(self) -> viser.GuiApi:
        """The panel of controls."""
        return self._client.gui

    @property
    def phone(self) -> bool:
        """Whether it is a small screen."""
        return self._client.camera.image_width < SHOW.phone_width_px

    @property
    def camera(self) -> Camera:
        """The current camera of the client."""
        camera = self._client.camera
        return Camera(
            np.array(camera.position),
            matrix_from_quat(np.roll(camera.wxyz, -1)),
            float(camera.fov),
            max(int(camera.image_width), 1),  # 0 in a hidden frame
            max(int(camera.image_height), 1),
        )

    def on_camera(self, moved: Callable[[], None]) -> None:
        """Register a callback for camera movements; it must be quick."""

        async def notify(_: viser.CameraHandle) -> None:
            moved()

        self._client.camera.on_update(notify)

    def on_click(self, clicked: Callable[[Ray], None]) -> None:
        """Register a callback for the ray of every click or tap on the scene."""

        @self._client.scene.on_click()
        def notify(event: viser.SceneClickEvent) -> None:
            camera = self.camera
            direction = np.array(event.ray_direction)
            pixel_rad = 1.0 / camera.focal_px
            ray = Ray(np.array(event.ray_origin), direction / np.linalg.norm(direction), pixel_rad)
            clicked(ray)

    def show_nodes(self, nodes: Iterable[Node]) -> None:
        """Draw these nodes and no others beside the map; only differences are sent."""
        with self._client.atomic():
            fresh = {node.path: (node, self._update(node)) for node in nodes}
            for path in self._shown.keys() - fresh.keys():
                self._shown[path][1].remove()
        self._shown = fresh

    def show_points(self, nodes: Iterable[PointsNode], style: object) -> None:
        """Show parts of the map; parts that are loaded are only recolored."""
        with self._client.atomic():
            for node in nodes:
                before = self._points.pop(node.path, None)
                if before is None:
                    handle = self._draw(node)
                else:
                    handle = before.handle
                    _recolor(handle, before.node, node)
                self._points[node.path] = _Drawn(node, handle, style)
        self._client.flush()  # now, not at viser's next tick

    def hide_points_except(self, paths: set[str], spare: int) -> None:
        """Hide the other parts of the map; ``spare`` of their points stay loaded."""
        with self._client.atomic():
            for path in [path for path in reversed(self._points) if path not in paths]:
                drawn = self._points[path]
                spare -= len(drawn.node.p_node)
                if spare < 0:
                    drawn.handle.remove()
                    del self._points[path]
                elif drawn.handle.visible:
                    drawn.handle.visible = False

    def has(self, path: str, style: object) -> bool:
        """Whether a part of the map is on screen in this style."""
        drawn = self._points.get(path)
        return drawn is not None and drawn.style == style and bool(drawn.handle.visible)

    def points_at(self, path: str) -> PointsNode | None:
        """A part of the map as it was drawn last."""
        drawn = self._points.get(path)
        return None if drawn is None else drawn.node

    def set_map_visible(self, visible: bool) -> None:
        """Show or hide the map without sending it again."""
        if self._map.visible != visible:
            self._map.visible = visible

    def forget_map(self) -> None:
        """Remove the map from the screen, because there is a new one."""
        self.hide_points_except(set(), -1)

    @property
    def behind(self) -> int:
        """Messages that the browser has not read yet, counted in viser's buffer."""
        return len(self._client._websock_connection.get_message_buffer().message_from_id)

    def answers_within_s(self, limit_s: float) -> float | None:
        """Response time of the browser after all sent messages [s]; None = above the limit."""
        began_s = time.monotonic()
        try:
            self._client.local_storage.get_item("recon4.ping", timeout=limit_s)
        except (TimeoutError, RuntimeError):
            return None
        return time.monotonic() - began_s

    def kept_view(self, limit_s: float) -> tuple[str | None, float | None]:
        """The view this browser kept, as untrusted text, and the response time [s]."""
        began_s = time.monotonic()
        try:
            kept = self._client.local_storage.get_item(self._key, timeout=limit_s)
        except (TimeoutError, RuntimeError):
            return None, None
        return kept, time.monotonic() - began_s

    def language(self, limit_s: float) -> str | None:
        """The language of the page, as untrusted text; None if the browser does not answer."""
        try:
            return self._client.local_storage.get_item(LANGUAGE, timeout=limit_s)
        except (TimeoutError, RuntimeError):
            return None

    def take_asked_stretch(self, limit_s: float) -> str | None:
        """The stretch that the page is asked to show, as untrusted text; the page asks until then.

        None if nothing is asked, or if the browser does not answer in time.
        """
        storage = self._client.local_storage
        try:
            asked = storage.get_item(self._stretch_key, timeout=limit_s)
        except (TimeoutError, RuntimeError):
            return None
        if asked is not None:
            storage.remove_item(self._stretch_key)
        return asked

    def keep_view(self, text: str) -> None:
        """Have the browser keep a view."""
        self._client.local_storage.set_item(self._key, text)

    def look_at(self, box: Bounds, direction: Array = DEFAULT_VIEW_DIRECTION) -> None:
        """Move the camera so that all of a box is visible from a direction."""
        self._put_m = start_m(box, direction, aspect=self.camera.aspect)
        with self._client.atomic():
            self._client.camera.position = self._put_m
            self._client.camera.look_at = box.center_m

    def follow(self, box: Bounds) -> None:
        """Keep a growing map in view as long as the person does not move the camera."""
        if self._put_m is None or abs(box.size_m - self._box_m) < SHOW.redraw_growth * self._box_m:
            return
        if np.allclose(self._client.camera.position, self._put_m, atol=1e-3):
            self._box_m = box.size_m
            self.look_at(box)

    def toggle_narrow(self) -> None:
        """Toggle a narrow field of view from far away and the usual one; the map keeps its size."""
        camera = self._client.camera
        fov_rad = (
            SHOW.usual_fov_rad if camera.fov < 2.0 * SHOW.narrow_fov_rad else SHOW.narrow_fov_rad
        )
        away = np.array(camera.position) - np.array(camera.look_at)
        scale = np.tan(camera.fov / 2.0) / np.tan(fov_rad / 2.0)
        with self._client.atomic():
            camera.fov = fov_rad
            camera.position = np.array(camera.look_at) + scale * away

    def download(self, name: str, text: str) -> None:
        """Send a file as a download."""
        self._client.send_file_download(name, text.encode(), save_immediately=True)

    def notify(self, title: str, text: str) -> None:
        """Show a notification over the map that closes by itself."""
        self._client.add_notification(title, text, auto_close_seconds=8.0)

    def _update(self, node: Node) -> Any:
        if node.path not in self._shown:
            return self._draw(node)
        before, handle = self._shown[node.path]
        if not alike(before, node):
            return self._draw(node)
        if before.visible != node.visible:
            handle.visible = node.visible
        return handle

    def _draw(self, node: Node) -> Any:
        scene = self._client.scene
        place: _Place = {"position": node.position_m, "visible": node.visible}
        match node:
            case PointsNode():
                return scene.add_point_cloud(
                    node.path,
                    node.p_node,
                    node.rgb,
                    point_size=node.size_m,
                    point_shape="circle",
                    point_shading="flat",
                    precision="float32",
                    **place,
                )
            case LinesNode():
                return scene.add_line_segments(
                    node.path,
                    node.segments,
                    _ends_alike(node.rgb),
                    thickness=node.width_px,
                    thickness_units="screen",
                    **place,
                )
            case AxesNode():
                return scene.add_batched_axes(
                    node.path,
                    node.quat_wxyz,
                    node.p_node,
                    axes_length=node.length_m,
                    axes_radius=node.length_m / 20.0,
                    **place,
                )
            case ImageNode():
                return scene.add_image(
                    node.path,
                    np.flipud(node.rgba),  # viser has y downwards
                    node.width_m,
                    node.height_m,
                    format="png",
                    cast_shadow=False,
                    receive_shadow=False,
                    **place,
                )
            case GridNode():
                return self._draw_grid(node, place)
            case LabelNode():
                return scene.add_label(node.path, node.text, **place)
            case _:
                raise AssertionError(node)

    def _draw_grid(self, node: GridNode, place: _Place) -> Any:
        return self._client.scene.add_grid(
            node.path,
            node.width_m,
            node.width_m,
            cell_size=node.cell_m,
            section_size=10.0 * node.cell_m,
            cell_color=node.rgb,
            section_color=node.rgb,
            shadow_opacity=0.0,
            **place,
        )


class Viewer:
    """A viser server on a Unix socket, without its public tunnel."""

    def __init__(
        self,
        socket: Path,
        *,
        on_client: Callable[[viser.ClientHandle], None],
        on_leave: Callable[[viser.ClientHandle], None],
    ) -> None:
        self._on_leave = on_leave
        wake_every_browser()
        with unix_socket.listening_on(socket):
            self._server = viser.ViserServer(verbose=False)
        unix_socket.remove_share_tunnel(self._server)
        self._server.scene.set_up_direction("+z")
        self._server.gui.configure_theme(
            dark_mode=True, show_logo=False, show_share_button=False, control_width="small"
        )
        self._server.gui.main_panel.dock_right()  # beside the map, not over it
        self._left_s = time.monotonic()
        self._server.on_client_connect(on_client)
        self._server.on_client_disconnect(self._left)

    @property
    def idle_s(self) -> float:
        """Seconds since the last client left (or since the start); 0 while there is one."""
        return 0.0 if self._server.get_clients() else time.monotonic() - self._left_s

    def stop(self) -> None:
        """End it."""
        self._server.stop()

    def _left(self, client: viser.ClientHandle) -> None:
        self._left_s = time.monotonic()
        self._on_leave(client)


def start_m(box: Bounds, direction: Array = DEFAULT_VIEW_DIRECTION, *, aspect: float) -> Array:
    """Camera position from which all of a box is visible at an aspect ratio [m], (3,)."""
    away = max(box.size_m, 5.0) * max(1.0, 0.9 / max(aspect, 0.1))
    return np.asarray(box.center_m + away * direction)


def _is_fresh(camera: viser.CameraHandle) -> bool:
    """Whether a page was just loaded: viser's camera starts at 3 m on each axis.

    A page that reconnects sends its last camera. (viser's own ``initial_camera`` would reset it
    then.)
    """
    return np.allclose(np.abs(camera.position), 3.0, atol=1e-3) and np.allclose(
        camera.look_at, 0.0, atol=1e-3
    )


def _recolor(handle: Any, before: PointsNode, node: PointsNode) -> None:
    """Same points: send what changed of the rest."""
    if before.rgb is not node.rgb:
        handle.colors = node.rgb
    if before.size_m != node.size_m:
        handle.point_size = node.size_m
    if not handle.visible:
        handle.visible = True


def _ends_alike(rgb: Any) -> Any:
    """Colors of lines as viser wants them: one, or one for each end of each segment."""
    colors = np.asarray(rgb, dtype=np.uint8)
    return colors if colors.ndim == 1 else np.repeat(colors[:, None], 2, axis=1)
