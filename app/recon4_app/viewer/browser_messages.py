"""What a browser may say to viser: five records, each field with its type and limits.

Everything else is refused: sharing, uploads, forms, objects to drag. What is accepted is written
again from its record, so that viser reads what was checked and nothing beside it.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

import msgspec

from recon4_app.viewer.tuning import BROWSER_MESSAGES

Coordinate = Annotated[float, msgspec.Meta(ge=-1e12, le=1e12)]
"""[m]; neither NaN nor infinity."""
Fraction = Annotated[float, msgspec.Meta(ge=-10.0, le=10.0)]
"""Place on the canvas in units of its size; a finger may leave the canvas."""
Distance = Annotated[float, msgspec.Meta(gt=0.0, le=1e12)]
Pixels = Annotated[int, msgspec.Meta(ge=0, le=1 << 16)]
"""0 = the canvas is in a hidden frame."""
Name = Annotated[str, msgspec.Meta(max_length=100)]

Point = tuple[Coordinate, Coordinate, Coordinate]
Modifier = Literal[
    "cmd/ctrl",
    "alt",
    "shift",
    "cmd/ctrl+alt",
    "cmd/ctrl+shift",
    "alt+shift",
    "cmd/ctrl+alt+shift",
]


class RefusedMessage(ValueError):
    """A message that no page of ours sends."""


class _Said(
    msgspec.Struct, frozen=True, kw_only=True, tag_field="type", forbid_unknown_fields=True
):
    """A message; its field ``type`` names the class as viser does."""


class CameraMoved(_Said, tag="ViewerCameraMessage", frozen=True, kw_only=True):
    """Where the camera of a browser is."""

    wxyz: tuple[Coordinate, Coordinate, Coordinate, Coordinate]
    position: Point
    fov: Annotated[float, msgspec.Meta(ge=1e-4, le=3.14)]
    """[rad]"""
    near: Distance
    far: Distance
    image_height: Pixels
    image_width: Pixels
    look_at: Point
    up_direction: Point

    def __post_init__(self) -> None:
        """Refuse a quaternion that is no rotation."""
        _check_length(self.wxyz, 0.99, 1.01)


class SceneClicked(_Said, tag="ScenePointerMessage", frozen=True, kw_only=True):
    """A click or tap on the scene."""

    event_type: Literal["click"]
    ray_origin: Point
    ray_direction: Point
    screen_pos: tuple[tuple[Fraction, Fraction]]
    modifier: Modifier | None

    def __post_init__(self) -> None:
        """Refuse a ray without a direction."""
        _check_length(self.ray_direction, 1e-6, 1e6)


class NewValue(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a person set a widget to; `viewer.client.widget_values` compares it with it."""

    value: bool | int | float | str


class WidgetSet(_Said, tag="GuiUpdateMessage", frozen=True, kw_only=True):
    """A control was used."""

    uuid: Name
    updates: NewValue


class KeyPressed(_Said, tag="CommandTriggerMessage", frozen=True, kw_only=True):
    """A hot key was pressed."""

    uuid: Name


class StorageRead(_Said, tag="LocalStorageGetItemResponseMessage", frozen=True, kw_only=True):
    """What the browser kept: a view as text, checked by `view_from_json`."""

    value: str | None
    error: str | None
    request_uuid: Name


KINDS = (CameraMoved, SceneClicked, WidgetSet, KeyPressed, StorageRead)
"""All that pass; each changes only the sender's own view."""
_decoder = msgspec.msgpack.Decoder(
    CameraMoved | SceneClicked | WidgetSet | KeyPressed | StorageRead
)


def checked(data: bytes) -> bytes:
    """A message of a browser, for viser.

    Raises:
        RefusedMessage: If it is none of `KINDS`, is damaged, or has a value beyond its limits.
    """
    if len(data) > BROWSER_MESSAGES.max_message_bytes:
        raise RefusedMessage(
            f"expected at most {BROWSER_MESSAGES.max_message_bytes} bytes, got {len(data)}"
        )
    try:
        return msgspec.msgpack.encode(_decoder.decode(data))
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        raise RefusedMessage(str(error)[:200]) from error


def _check_length(vector: tuple[float, ...], least: float, most: float) -> None:
    length = math.hypot(*vector)
    if not least < length < most:
        raise ValueError(f"expected a length from {least:g} to {most:g}, got {length:g}")
