"""Messages that no page of ours sends to the viewer, by what is wrong with them."""

from __future__ import annotations

from typing import Any

import msgspec.msgpack

from tests.service.viser_client import camera

NAN, INFINITY = float("nan"), float("inf")


def packed(message: dict[str, Any]) -> bytes:
    return msgspec.msgpack.encode(message)


def pointer(**changes: Any) -> bytes:
    return packed(
        {
            "type": "ScenePointerMessage",
            "event_type": "click",
            "ray_origin": (1.0, 1.0, 1.0),
            "ray_direction": (1.0, 0.0, 0.0),
            "screen_pos": ((0.5, 0.5),),
            "modifier": None,
        }
        | changes
    )


def moved(**changes: Any) -> bytes:
    return packed(camera((8.0, 3.0, 1.5)) | changes)


def without(message: dict[str, Any], name: str) -> bytes:
    return packed({key: value for key, value in message.items() if key != name})


def map_of(*pairs: tuple[str, Any]) -> bytes:
    """A map of msgpack in which a key may come twice."""
    return bytes([0x80 + len(pairs)]) + b"".join(
        msgspec.msgpack.encode(key) + msgspec.msgpack.encode(value) for key, value in pairs
    )


MALFORMED: dict[str, bytes | str] = {
    "nothing": b"",
    "no msgpack": b"\xc1\xc1",
    "text": "a frame of text",
    "a list": b"\x90",
    "60 000 levels": b"\x91" * 60_000,
    "60 000 levels of maps": b"\x81\xa1a" * 20_000,
    "100 000 levels": b"\x91" * 100_000,
    "values 60 000 levels deep": b"\x82\xa4type\xb0GuiUpdateMessage\xa7updates" + b"\x91" * 60_000,
    "900 kB": packed({"type": "GuiUpdateMessage", "uuid": "x" * 900_000, "updates": {}}),
    "a list that claims 4 billion": b"\xdd\xff\xff\xff\xff",
    "text that claims 4 GB": b"\x81\xdb\xff\xff\xff\xffa",
    "cut": moved()[:-7],
    "more behind it": moved() + b"\x00",
    "unknown": packed({"type": "NoSuchMessage"}),
    "type is a number": packed({"type": 5}),
    "type twice": map_of(("type", "CommandTriggerMessage"), ("type", "ShareUrlRequest")),
    "of the server": packed({"type": "RemoveSceneNodeMessage", "name": "/map"}),
    "run this": packed({"type": "RunJavascriptMessage", "source": "alert(1)"}),
    "form": packed({"type": "GuiFormDirtyMessage", "uuid": "x" * 1000}),
    "upload": packed({"type": "FileTransferStartUpload", "source_component_uuid": "x"}),
    "drag": packed({"type": "TransformControlsUpdateMessage", "name": "/map"}),
    "camera of NaN": moved(position=(NAN, 0.0, 0.0)),
    "camera at infinity": moved(look_at=(0.0, INFINITY, 0.0)),
    "camera at 1e300": moved(position=(1e300, 0.0, 0.0)),
    "camera of text": moved(position=("a", "b", "c")),
    "camera of two numbers": moved(position=(1.0, 2.0)),
    "camera without rotation": moved(wxyz=(0.0, 0.0, 0.0, 0.0)),
    "camera of maps": moved(wxyz={"w": 1.0}),
    "camera without an angle": moved(fov=0.0),
    "camera of a wide angle": moved(fov=7.0),
    "camera of negative size": moved(image_width=-5),
    "camera of absurd size": moved(image_width=2**40),
    "camera with more": moved(client_id=-1),
    "camera with less": without(camera(), "position"),
    "click along nothing": pointer(ray_direction=(0.0, 0.0, 0.0)),
    "click along NaN": pointer(ray_direction=(NAN, 0.0, 1.0)),
    "click without a ray": pointer(ray_origin=None, ray_direction=None),
    "click nowhere": pointer(screen_pos=()),
    "rectangle": pointer(event_type="rect-select"),
    "click with a strange key": pointer(modifier="hyper"),
    "command without a name": packed({"type": "CommandTriggerMessage"}),
    "command by number": packed({"type": "CommandTriggerMessage", "uuid": -1}),
    "answer of a number": packed(
        {
            "type": "LocalStorageGetItemResponseMessage",
            "value": 5,
            "error": None,
            "request_uuid": "x",
        }
    ),
}
"""What the relay passes on to no viewer."""

VALUES: dict[str, tuple[str, Any]] = {
    "a map for a length": ("Point size", {"a": 1}),
    "a list for a length": ("Point size", [1.0]),
    "text for a length": ("Point size", "large"),
    "NaN for a length": ("Point size", NAN),
    "infinity for a length": ("Point size", INFINITY),
    "NaN for a number": ("Range from", NAN),
    "a huge number": ("Range to", 1e300),
    "infinity for a whole number": ("Most points", INFINITY),
    "half a multiframe": ("Multiframe", 0.5),
    "text for a switch": ("Fewer when", "no"),
    "another color": ("Color by", "<script>"),
    "a number for a color": ("Color by", 5),
    "another palette": ("Palette", ""),
    "another verdict": ("Edges by", "x"),
    "nothing": ("Window", None),
    "text for a button": ("Range of the map", "pressed"),
}
"""Labels of widgets, and values that they cannot have."""

PROPERTIES: tuple[dict[str, Any], ...] = (
    {"removed": True},
    {"update_cb": 5},
    {"props": {}},
    {"no_such": 1},
    {"value": 0.05, "uuid": "x"},
    {},
)
"""Changes of a widget that are none of its value."""

VIEWS = (
    '{"moment": 1e400}',
    '{"detail": 1e400}',
    '{"point_size_m": 1e400}',
    '{"measurements": [[[1e308, -1e308, 1e308], [-1e308, 1e308, 0]]]}',
    '{"ranges": {"height": [-1e308, 1e308]}}',
    '{"window_s": ' + "9" * 400 + "}",
    '{"moment": ' + "9" * 5000 + "}",
    '{"moment": -5, "detail": -5}',
)
"""Changes of a view that a browser kept."""
