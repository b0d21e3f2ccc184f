"""A browser's part of viser's protocol: enough to look, press and answer, and to count bytes."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

import msgspec.msgpack
import numpy as np
import viser
import zstandard
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from recon4.geometry.se3 import quat_from_matrix
from tests.deadlines import HANG_S
from tests.service.secure import Socket

PROTOCOL = Subprotocol(f"viser-v{viser.__version__}")


def camera(
    position=(1.0, 1.0, 1.0), *, ahead=(1.0, 0.0, 0.0), width=1440, height=900
) -> dict[str, Any]:
    """The message of a browser about its camera; ``ahead`` must not be vertical."""
    z = np.array(ahead) / np.linalg.norm(ahead)
    x = np.cross(z, [0.0, 0.0, 1.0])
    x /= np.linalg.norm(x)
    quat = quat_from_matrix(np.stack([x, np.cross(z, x), z], axis=1)[None])[0]
    return {
        "type": "ViewerCameraMessage",
        "wxyz": tuple(np.roll(quat, 1).tolist()),
        "position": tuple(float(v) for v in position),
        "fov": 1.309,
        "near": 0.01,
        "far": 1000.0,
        "image_height": height,
        "image_width": width,
        "look_at": tuple((np.array(position) + z).tolist()),
        "up_direction": (0.0, 0.0, 1.0),
    }


class ViserClient:
    """Keeps what a browser would show: nodes, widgets, storage."""

    def __init__(
        self, socket: ClientConnection | Socket, storage: dict[str, str] | None = None
    ) -> None:
        self.socket = socket
        self.storage = {} if storage is None else storage
        self.answers = True
        """Whether it answers when it is asked for its storage."""
        self.nodes: dict[str, dict[str, Any]] = {}
        self.points: dict[str, int] = {}
        self.visible: dict[str, bool] = {}
        self.widgets: dict[str, dict[str, Any]] = {}
        self.commands: dict[str, str] = {}
        self.files: dict[str, bytes] = {}
        self.cameras: list[dict[str, Any]] = []
        self.notes: list[str] = []
        self.bytes = 0
        """Bytes of all that was shown, without the questions that pace it."""
        self.colored = 0
        """Points whose colors were sent again."""

    def send(self, message: dict[str, Any]) -> None:
        self.socket.send(msgspec.msgpack.encode(message))

    def until(self, met: Callable[[ViserClient], object], *, limit_s: float = HANG_S) -> float:
        """Take messages until a condition is met; how long that took [s]."""
        began_s = time.monotonic()
        while not met(self):
            left_s = began_s + limit_s - time.monotonic()
            self.take(self.socket.recv(timeout=max(left_s, 0.001)))
        return time.monotonic() - began_s

    def rest(self, *, quiet_s: float = 0.4) -> float:
        """Take messages until none comes for a while; seconds to the last one."""
        began_s = last_s = time.monotonic()
        while True:
            try:
                self.take(self.socket.recv(timeout=quiet_s))
            except TimeoutError:
                return last_s - began_s
            last_s = time.monotonic()

    def take(self, data: bytes | str) -> None:
        assert isinstance(data, bytes)
        packed = int.from_bytes(data[8:16], "little")
        inner = zstandard.ZstdDecompressor().decompress(data[16 : 16 + packed])
        window = msgspec.msgpack.decode(inner)
        sizes = window["binaryBufferLengths"]
        if any(m["type"] != "LocalStorageGetItemRequestMessage" for m in window["messages"]):
            self.bytes += len(data)
        for message in window["messages"]:
            self._apply(message, sizes)

    def _apply(self, message: dict[str, Any], sizes: list[int]) -> None:
        kind = message["type"]
        if kind == "PointCloudMessage":
            self.points[message["name"]] = sizes[_buffer(message["props"]["points"])] // 12
        if kind.startswith("LocalStorage"):
            self._storage(message)
        elif kind.startswith("Notification"):
            self.notes.append(str(message))
        elif kind.startswith("SetCamera"):
            self.cameras.append(message)
        elif kind == "RegisterCommandMessage":
            self.commands[message["props"]["label"]] = message["uuid"]
        elif kind.startswith("Gui"):
            self._panel(message)
        elif "name" in message:
            self._scene(message, sizes)

    def _scene(self, message: dict[str, Any], sizes: list[int]) -> None:
        name = message["name"]
        match message["type"]:
            case "RemoveSceneNodeMessage":
                for known in (self.nodes, self.points, self.visible):
                    known.pop(name, None)
            case "SetSceneNodeVisibilityMessage":
                self.visible[name] = message["visible"]
            case "SceneNodeUpdateMessage":
                if "colors" in message["updates"]:
                    self.colored += sizes[_buffer(message["updates"]["colors"])] // 3
                self.nodes[name]["props"].update(message["updates"])
            case _ if "props" in message:
                self.nodes[name] = message
                self.visible.setdefault(name, True)

    def _panel(self, message: dict[str, Any]) -> None:
        uuid = message.get("uuid", "")
        if message["type"] == "GuiUpdateMessage" and uuid in self.widgets:
            for name, value in message["updates"].items():
                widget = self.widgets[uuid]
                (widget if name == "value" else widget["props"])[name] = value
        elif message["type"] == "GuiRemoveMessage":
            self.widgets.pop(uuid, None)
        elif "props" in message:
            self.widgets[uuid] = message

    def _storage(self, message: dict[str, Any]) -> None:
        if message["type"] == "LocalStorageSetItemMessage":
            self.storage[message["key"]] = message["value"]
        elif message["type"] == "LocalStorageGetItemRequestMessage" and self.answers:
            kept = self.storage.get(message["key"])
            kind = "LocalStorageGetItemResponseMessage"
            answer = {"type": kind, "value": kept, "error": None}
            self.send({**answer, "request_uuid": message["request_uuid"]})

    @property
    def shown(self) -> int:
        """Points of the map on screen."""
        return sum(n for name, n in self.points.items() if self.visible[name] and "/map/" in name)

    def html(self) -> str:
        """All HTML of the panel."""
        blocks = [w for w in self.widgets.values() if w["type"] == "GuiHtmlMessage"]
        return "".join(widget["props"]["content"] for widget in blocks)

    def widget(self, label: str) -> dict[str, Any]:
        known = [w for w in self.widgets.values() if w["type"] != "GuiFolderMessage"]
        exact = [w for w in known if w["props"].get("label") == label]
        return (exact or [w for w in known if w["props"].get("label", "").startswith(label)])[0]

    def set(self, label: str, value: Any) -> None:
        """Operate a widget; pressing a button is setting it to True."""
        uuid = self.widget(label)["uuid"]
        self.send({"type": "GuiUpdateMessage", "uuid": uuid, "updates": {"value": value}})

    def press(self, command: str) -> None:
        """Use a hot key."""
        uuid = next(uuid for label, uuid in self.commands.items() if label.startswith(command))
        self.send({"type": "CommandTriggerMessage", "uuid": uuid})

    def click(self, origin: Any, direction: Any) -> None:
        self.send(
            {
                "type": "ScenePointerMessage",
                "event_type": "click",
                "ray_origin": tuple(map(float, origin)),
                "ray_direction": tuple(map(float, direction)),
                "screen_pos": ((0.5, 0.5),),
                "modifier": None,
            }
        )


def _buffer(placeholder: Any) -> int:
    """Number of the binary buffer an array was put into."""
    numbers = [v for v in placeholder.values() if isinstance(v, int)]
    assert len(numbers) == 1, placeholder
    return numbers[0]


@contextmanager
def viewing(
    url: str,
    project: str = "office",
    *,
    storage: dict[str, str] | None = None,
    buffer_bytes: int | None = None,
) -> Iterator[ViserClient]:
    """A client of a project's viewer; with a small buffer one that stops reading stalls soon."""
    host, port = urlsplit(url).netloc.split(":")
    plain = socket.socket()
    if buffer_bytes is not None:
        plain.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
    plain.connect((host, int(port)))
    with connect(
        f"ws://{urlsplit(url).netloc}/projects/{project}/viewer",
        origin=url,
        subprotocols=[PROTOCOL],
        compression=None,
        max_size=None,
        max_queue=16 if buffer_bytes is None else 1,
        proxy=None,
        sock=plain,
        open_timeout=HANG_S,
    ) as connection:
        yield ViserClient(connection, storage)
