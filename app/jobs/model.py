"""A job: one run of the pipeline on one project."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

from app.errors import IllegalTransition


class JobState(StrEnum):
    """Where a job is in its life."""

    QUEUED = "queued"
    """Waits for its turn."""
    RUNNING = "running"
    """Has a worker."""
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"


TRANSITIONS: dict[JobState, frozenset[JobState]] = {
    JobState.QUEUED: frozenset({JobState.RUNNING, JobState.CANCELLED}),
    JobState.RUNNING: frozenset(
        {JobState.QUEUED, JobState.SUCCEEDED, JobState.FAILED, JobState.CANCELLED}
    ),
    JobState.SUCCEEDED: frozenset(),
    JobState.FAILED: frozenset(),
    JobState.CANCELLED: frozenset(),
}
"""A running job goes back to the queue when its worker died."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Inputs:
    """What a job works on, with paths of this computer."""

    recordings: tuple[str, ...]
    """Files or folders."""
    preset: str = "indoor"
    rig: str = ""
    """Name of a shipped rig or path of a rig file; empty = guessed from the recording."""
    imu: str = ""
    """CSV file; empty = what the recording has."""
    gnss: str = ""
    """CSV file; empty = what the recording has."""
    settings: tuple[str, ...] = ()
    """``group.field=value`` texts over the preset."""
    remake: bool = False
    """Only make the map anew with the decisions that stand; the rest is how it was made first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """One row of the queue."""

    id: str
    project: str
    """Name of the project's folder."""
    inputs: Inputs
    created: str
    """UTC, ISO 8601."""
    state: JobState = JobState.QUEUED
    attempt: int = 0
    """How many workers it has had."""
    started: str = ""
    finished: str = ""
    note: str = ""
    """What went wrong or what to do, for people."""

    @property
    def over(self) -> bool:
        """Whether it will not change any more."""
        return not TRANSITIONS[self.state]

    def to(self, state: JobState, **changes: Any) -> Job:
        """The job in its next state.

        Raises:
            IllegalTransition: If that state cannot follow the present one.
        """
        if state not in TRANSITIONS[self.state]:
            raise IllegalTransition(f"job {self.id} is {self.state} and cannot become {state}")
        return replace(self, state=state, **changes)
