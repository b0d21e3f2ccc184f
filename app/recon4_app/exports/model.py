"""Requests and responses of exports."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import BaseModel, ConfigDict, Field

from recon4.delivery.kinds import ExportedFile, ExportKind
from recon4.export.options import ExportOptions
from recon4_app.jobs.model import JobState


class NewExport(BaseModel):
    """A file to be made of a map."""

    model_config = ConfigDict(extra="forbid")

    file: str = Field(max_length=64)
    """Kind of file: see `/api/projects/{project_id}/exports/choices`."""
    options: ExportOptions = ExportOptions()
    """What is written of the map; each kind of file takes some of them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ClassChoice:
    """A class of points that the map has."""

    code: int
    title: str
    points: int
    """How many points have it."""
    percent: float
    """Their part of all points, those that are left out of the map included [%]."""
    delivered: bool
    """Whether the map delivers it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StoreyChoice:
    """A storey of the map."""

    name: str
    floor_m: float
    """Height of its floor in the map [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportChoices:
    """What can be chosen of the exports of a map."""

    kinds: list[ExportKind]
    classes: list[ClassChoice]
    storeys: list[StoreyChoice]
    crs: str
    """Of the map; empty = its local frame."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportView:
    """A row of the list of exports; it stays when the file is removed."""

    id: str
    file: str
    """Kind of file."""
    title: str
    options: ExportOptions
    state: JobState
    person: str
    """Who ordered it."""
    created: str
    """UTC, ISO 8601."""
    finished: str
    note: str
    """Why there is no file, and what to do."""
    fraction: float | None
    """Fraction of the current piece of work, None = not known."""
    what: str
    """The current piece of work."""
    made: ExportedFile | None
    """The file that was made."""
    kept: bool
    """Whether the file can still be downloaded."""
    of_this_map: bool
    """Whether it was made of the map of the latest run."""
