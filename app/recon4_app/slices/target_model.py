"""Searches for survey targets, as the pages see them."""

from __future__ import annotations

from dataclasses import dataclass

from recon4_app.jobs.model import JobState


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetSearch:
    """A search of a whole map; it stays in the list when what it found is removed."""

    id: str
    state: JobState
    person: str
    """Who ordered it."""
    created: str
    """UTC, ISO 8601."""
    note: str
    """Why there is no result, and what to do."""
    step: str
    """What is being looked at: ``targets`` (the tiles), ``plates``, ``boards`` or ``spheres``."""
    fraction: float | None
    """Fraction of this step, None = not known."""
    kept: bool
    """Whether what it found can still be read."""
    of_this_map: bool
    """Whether it was made of the map of the latest run."""
