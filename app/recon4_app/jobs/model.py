"""A job: one run of the pipeline on one project, or one result that is made of its map."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

from recon4.delivery.kinds import ExportedFile
from recon4.export.options import ExportOptions
from recon4.locales.coded import CodedText
from recon4_app.errors import IllegalTransition
from recon4_app.jobs.reason import JobReason, in_language, reason_of


class JobKind(StrEnum):
    """What a job does."""

    PROCESS = "process"
    """Runs the pipeline; a project has one that waits or runs."""
    EXPORT = "export"
    """Makes a file of a finished map; any number of them may wait."""
    COMPARE = "compare"
    """Compares a finished map with another one; any number of them may wait."""
    TARGETS = "targets"
    """Looks for survey targets in a finished map; any number of them may wait."""


class JobState(StrEnum):
    """State of a job."""

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
class PackedExport:
    """An export whose file goes into a delivery, as its row was when it was chosen."""

    id: str
    """Of its job."""
    file: str
    """Kind of file."""
    options: ExportOptions
    made: ExportedFile


@dataclass(frozen=True, slots=True, kw_only=True)
class DeliveryOrder:
    """What is in a delivery, besides its report, hashes and signature."""

    files: tuple[str, ...]
    """Kinds of files that are made now."""
    exports: tuple[PackedExport, ...] = ()
    """Files that were exported before."""
    license: str = ""
    """Text of the license of the data; empty = none is given, which the README says."""
    language: str
    """Of the report and the README."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportOrder:
    """A file that is to be made."""

    file: str
    """Kind of file: a name of `recon4.delivery.kinds.KINDS`, or a delivery."""
    options: ExportOptions
    delivery: DeliveryOrder | None = None
    """What is in a delivery; None = it is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CompareOrder:
    """Two maps that are to be compared."""

    against: str
    """The other map: ``project:NAME``, or ``map:KEY`` of an earlier run of the same project."""
    align: bool = False
    """Lay it on this one by ICP before."""
    core_spacing_m: float = 0.1
    """Distance of core points [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetOrder:
    """Survey targets that are to be found in a map."""

    radii_m: tuple[float, ...] = ()
    """Radii of spheres that the survey states [m]; empty = those that are usual."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Inputs:
    """Inputs of a job, with paths of this computer."""

    recordings: tuple[str, ...]
    """Files or folders."""
    preset: str = "indoor"
    rig: str = ""
    """Name of a shipped rig or path of a rig file; empty = detected from the recording."""
    imu: str = ""
    """CSV file; empty = what the recording has."""
    gnss: str = ""
    """CSV file; empty = what the recording has."""
    settings: tuple[str, ...] = ()
    """``group.field=value`` texts over the preset."""
    title: str = ""
    """Display name of a new project; empty = the name of its folder."""
    remake: bool = False
    """Only make the map again with the current decisions; the other inputs are unchanged."""
    export: ExportOrder | None = None
    """Only make this file of the map; the other inputs are not used."""
    compare: CompareOrder | None = None
    """Only compare the map with this one; the other inputs are not used."""
    targets: TargetOrder | None = None
    """Only look for survey targets in the map; the other inputs are not used."""

    @property
    def kind(self) -> JobKind:
        """What the job does."""
        if self.compare:
            return JobKind.COMPARE
        if self.targets:
            return JobKind.TARGETS
        return JobKind.EXPORT if self.export else JobKind.PROCESS


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
    """Number of workers it has had."""
    started: str = ""
    finished: str = ""
    note: str = ""
    """What went wrong and what to do, as text for users; stored in English."""
    reason: JobReason | None = None
    """Code and values of `note`; None = it has none."""
    person: str = ""
    """Who started it; empty = not known."""
    made: ExportedFile | None = None
    """The file that it made, also when that was removed since."""

    @property
    def kind(self) -> JobKind:
        """What it does."""
        return self.inputs.kind

    @property
    def over(self) -> bool:
        """Whether the state is final."""
        return not TRANSITIONS[self.state]

    def to(self, state: JobState, **changes: Any) -> Job:
        """The job in its next state.

        Raises:
            IllegalTransition: If that state cannot follow the present one.
        """
        if state not in TRANSITIONS[self.state]:
            raise IllegalTransition(
                CodedText("job-transition", job=self.id, state=str(self.state), next=str(state))
            )
        if "note" in changes:
            changes |= {"note": str(changes["note"]), "reason": reason_of(changes["note"])}
        return replace(self, state=state, **changes)

    def said(self, language: str) -> Job:
        """The job with its note in a language."""
        return replace(self, note=in_language(self.reason, self.note, language))
