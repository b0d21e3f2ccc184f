"""Requests and responses of comparisons of maps."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import BaseModel, ConfigDict, Field

from recon4.comparison.records import MapDifferences
from recon4.comparison.tuning import M3C2
from recon4_app.jobs.model import JobState
from recon4_app.slices.model import OtherMap


class NewComparison(BaseModel):
    """Another map that the map is to be compared with."""

    model_config = ConfigDict(extra="forbid")

    against: str = Field(max_length=80)
    """Id of the other map, of `others`: ``project:NAME`` or ``map:KEY``."""
    align: bool = False
    """Lay it on this one by ICP before: maps of different recordings without a common CRS."""
    core_spacing_m: float = Field(default=0.1, ge=M3C2.spacing_m[0], le=M3C2.spacing_m[1])
    """Distance of core points [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparisonView:
    """A comparison; it stays in the list when its points are removed."""

    id: str
    against: str
    """Id of the other map."""
    align: bool
    core_spacing_m: float
    state: JobState
    person: str
    """Who ordered it."""
    created: str
    """UTC, ISO 8601."""
    note: str
    """Why there is no result, and what to do."""
    fraction: float | None
    """Fraction of the work, None = not known."""
    kept: bool
    """Whether its points can still be read."""
    of_this_map: bool
    """Whether it was made of the map of the latest run."""
    found: MapDifferences | None
    """The figures; None = there are none, or no longer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparisons:
    """Comparisons of a map, and what it can be compared with."""

    others: list[OtherMap]
    """Earlier maps of the project, the newest first, and those of other projects."""
    comparisons: list[ComparisonView]
    """The newest first."""
    step_m: float
    """Step of distances and levels of detection of the points [m]."""
