"""Notes pinned to places of a map, and saved views of it."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import BaseModel, Field, model_validator

from recon4_app.annotations.tuning import ANNOTATIONS
from recon4_app.names import Name, Note
from recon4_app.slices.model import Strict, Xyz

Text = Annotated[Note, Field(min_length=1, max_length=ANNOTATIONS.max_note_characters)]
Status = Literal["open", "done"]
Revision = Annotated[int, Field(ge=1, le=1 << 53)]
"""Counts the changes of a note: a change made without having seen the last one is refused."""
MapKey = Annotated[str, Field(pattern=r"^[0-9a-f]{16,64}$")]
ViewQuery = Annotated[
    str,
    Field(
        max_length=ANNOTATIONS.max_query_characters,
        pattern=r"^[A-Za-z0-9\-._~%!$&'()*+,;=:@/]*$",
    ),
]
"""Query of the page's address."""


class NoteView(Strict):
    """Where the author of a note looked from."""

    eye_m: Xyz
    """In the map frame [m]."""
    ahead: Xyz
    """Direction of view, a unit vector."""
    up: Xyz
    """Direction of the upper rim, a unit vector."""
    parallel: bool = False
    height_m: float = Field(default=0.0, ge=0.0, le=1e6, allow_inf_nan=False)
    """Height of the image in the world, of a parallel projection [m]."""
    aspect: float = Field(default=1.0, ge=0.01, le=100.0, allow_inf_nan=False)
    """Width of the image by its height."""

    @model_validator(mode="after")
    def _directions(self) -> NoteView:
        for name in ("ahead", "up"):
            if abs(math.hypot(*getattr(self, name)) - 1.0) > 1e-3:
                raise ValueError(f"{name}: expected a unit vector")
        return self


class NewNote(Strict):
    """A note to pin to a place."""

    p_map: Xyz
    """Place in the map frame [m]."""
    text: Text
    key: MapKey
    """The map in which the place was picked."""
    camera: NoteView | None = None
    """None = not known."""


class NoteChange(Strict):
    """What of a note changes."""

    revision: Revision
    """The revision that the person saw."""
    text: Text | None = None
    """None = as it is."""
    status: Status | None = None
    """None = as it is."""


class MapNote(Strict):
    """A note of a person."""

    id: str = Field(pattern=r"^[0-9a-f]{12}$")
    p_map: Xyz
    key: MapKey
    text: Text
    status: Status
    who: str
    time: str
    """UTC, ISO 8601."""
    changed_by: str
    """Who changed it last; its author at first."""
    changed: str
    """UTC, ISO 8601."""
    revision: Revision
    camera: NoteView | None = None
    """None = not known."""
    photo: str = Field(default="", pattern=r"^([0-9a-f]{64})?$")
    """SHA-256 of its photo; empty = it has none."""


class NotePhoto(Strict):
    """A photo for a note."""

    revision: Revision
    """The revision of the note that the person saw."""
    base64: str = Field(min_length=1, max_length=ANNOTATIONS.max_sent_characters)
    """A JPEG or PNG file; it is kept as JPEG of at most 2048 px, without its metadata."""


class NotesView(BaseModel):
    """The notes of a project."""

    may_change: bool
    """Whether this person may add and change notes."""
    notes: list[MapNote]
    """Oldest first."""


class NewMapView(Strict):
    """A view to save."""

    name: Annotated[Name, Field(min_length=1)]
    query: ViewQuery


class SavedMapView(Strict):
    """A view that somebody saved."""

    id: str = Field(pattern=r"^[0-9a-f]{12}$")
    name: Annotated[Name, Field(min_length=1)]
    query: ViewQuery
    who: str
    time: str
    """UTC, ISO 8601."""


class MapViewsView(BaseModel):
    """The saved views of a project."""

    may_change: bool
    """Whether this person may save views."""
    views: list[SavedMapView]
    """Oldest first."""
