"""Draws nodes with viser. With `panels` the only module that imports it (pinned: 1.1.1).

Everything is drawn for one client, not for all: phones get fewer points than desktops, each
person has a view of their own, and nothing heavy stays in the buffer that viser replays.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import viser
from viser import _messages

from app.viewer.scene import (
    AxesNode,
    Bounds,
    GridNode,
    LabelNode,
    LinesNode,
    Node,
    PointsNode,
)

PHONE_WIDTH_PX = 700
PHONE_BUDGET = 300_000


class Screen:
    """Keeps what one client sees equal to the last nodes it was given."""

    def __init__(self, client: viser.ClientHandle, points: int) -> None:
        self._client = client
        self._points = points
        self._shown: dict[str, tuple[Node, Any]] = {}

    @property
    def budget(self) -> int:
        """Points this client's graphics can be trusted with."""
        phone = self._client.camera.image_width < PHONE_WIDTH_PX
        return min(PHONE_BUDGET, self._points) if phone else self._points

    def show(self, nodes: Iterable[Node]) -> None:
        """Draw the nodes and nothing else; only what differs is sent."""
        with self._client.atomic():
            fresh = {node.path: (node, self._update(node)) for node in nodes}
            for path in self._shown.keys() - fresh.keys():
                self._shown[path][1].remove()
        self._shown = fresh

    def look_at(self, box: Bounds) -> None:
        """Put the camera so that all of a box is seen, from the south and above."""
        away = max(box.size_m, 5.0)
        self._client.camera.position = box.center_m + away * np.array([0.0, -0.75, 0.75])
        self._client.camera.look_at = box.center_m

    def _update(self, node: Node) -> Any:
        if node.path not in self._shown:
            return self._draw(node)
        before, handle = self._shown[node.path]
        if isinstance(node, PointsNode) and isinstance(before, PointsNode):
            alike = before.p_node is node.p_node
            if alike:
                _recolor(handle, before, node)
        else:
            alike = _alike(before, node)
        if not alike:
            return self._draw(node)
        if before.visible != node.visible:
            handle.visible = node.visible
        return handle

    def _draw(self, node: Node) -> Any:
        scene = self._client.scene
        place: dict[str, Any] = {"position": node.position_m, "visible": node.visible}
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
                    np.array(node.rgb, dtype=np.uint8),
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
            case GridNode():
                return scene.add_grid(
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
            case LabelNode():
                return scene.add_label(node.path, node.text, **place)
            case _:
                raise AssertionError(node)


class Viewer:
    """A viser server without its ways to the outside."""

    def __init__(
        self,
        *,
        on_client: Callable[[viser.ClientHandle], None],
        on_leave: Callable[[viser.ClientHandle], None],
    ) -> None:
        self._on_leave = on_leave
        self._server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        self._server._websock_server.unregister_handler(_messages.ShareUrlRequest)
        self._server.scene.set_up_direction("+z")
        self._server.gui.configure_theme(
            dark_mode=True, show_logo=False, show_share_button=False, control_width="small"
        )
        self._server.gui.main_panel.dock_right()  # beside the map, not over it
        self._left_s = time.monotonic()
        self._server.on_client_connect(on_client)
        self._server.on_client_disconnect(self._left)

    @property
    def port(self) -> int:
        """The port it listens on."""
        return self._server.get_port()

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


def _recolor(handle: Any, before: PointsNode, node: PointsNode) -> None:
    """Same points: send what changed of the rest (viser compares the colors itself)."""
    handle.colors = node.rgb
    if before.size_m != node.size_m:
        handle.point_size = node.size_m


def _alike(before: Node, node: Node) -> bool:
    """Whether two nodes differ at most in being visible."""
    if type(before) is not type(node):
        return False
    names = [name for kind in type(node).__mro__ for name in getattr(kind, "__slots__", ())]
    return all(
        np.array_equal(getattr(before, name), getattr(node, name))
        for name in names
        if name != "visible"
    )
