"""Requests and responses of exports."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import BaseModel, ConfigDict, Field

from recon4.delivery.kinds import ExportedFile, ExportKind
from recon4.export.options import ExportOptions
from recon4_app.jobs.model import DeliveryOrder, JobState


class NewDelivery(BaseModel):
    """What is in a delivery, besides its report, README, hashes and signature."""

    model_config = ConfigDict(extra="forbid")

    files: list[str] = Field(default=[], max_length=32)
    """Kinds of files that are made now, of the whole map."""
    exports: list[str] = Field(default=[], max_length=32)
    """Ids of exports of the present map whose files are packed."""
    license: str = Field(default="", max_length=100_000)
    """Text of the license of the data; empty = none is given."""
    language: str = Field(default="", max_length=16)
    """Of the report and the README; empty = that of the request."""


class NewExport(BaseModel):
    """A file to be made of a map."""

    model_config = ConfigDict(extra="forbid")

    file: str = Field(max_length=64)
    """Kind of file: see `/api/projects/{project_id}/exports/choices`."""
    options: ExportOptions = ExportOptions()
    """What is written of the map; each kind of file takes some of them."""
    delivery: NewDelivery | None = None
    """What is in it, if the file is a delivery."""


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
    delivery: DeliveryOrder | None
    """What is in a delivery; None = it is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DeliveryCheck:
    """What `recon4 verify` says of a delivery that was made here."""

    intact: list[str]
    """Files with the listed hash."""
    altered: list[str]
    missing: list[str]
    added: list[str]
    """Files that the list does not name."""
    signer: str
    """Whose signature it is; empty = no signature counts."""
    doubt: str
    """Why a signature does not count, or that there is none; empty = it counts."""
