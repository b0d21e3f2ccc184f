"""What the tools return: the part of the server's answers that an assistant needs.

A later server may send more fields; they are left out. The records have no slots: the SDK takes the
descriptors of slots for defaults, and would publish no schema.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from recon4.findings.summary_notes import SaidFinding
from recon4.model.usability import MapVerdict

Figure = bool | int | float | str | None


@dataclass(frozen=True, kw_only=True)
class ApprovalLine:
    """Whether a map is approved, in one line."""

    kind: str
    text: str


@dataclass(frozen=True, kw_only=True)
class ProjectRow:
    """A project in the list."""

    id: str
    name: str
    finished: bool
    updated: str
    """UTC, ISO 8601."""
    preset: str
    rig: str
    path_length_m: float | None
    points: int | None
    usability: str
    """Verdict: good, check or do not use; empty = not known."""
    tags: list[str]
    archived: bool
    recording: str
    """SHA-256 of its first recording: equal ones are runs of the same walk; empty = not known."""
    approval: ApprovalLine
    problem: str
    """What of its files cannot be read; empty = nothing."""


@dataclass(frozen=True, kw_only=True)
class ProjectList:
    """Projects, the newest first."""

    total: int
    """How many match; more than are listed if the list is cut."""
    projects: list[ProjectRow]


@dataclass(frozen=True, kw_only=True)
class ExportFile:
    """A finished result."""

    name: str
    label: str
    bytes: int


@dataclass(frozen=True, kw_only=True)
class ProjectFacts:
    """A project as the server describes it."""

    id: str
    name: str
    finished: bool
    updated: str
    bytes: int
    preset: str
    rig: str
    has_map: bool
    files: list[ExportFile]
    summary: dict[str, object]
    approval: ApprovalLine
    problem: str


@dataclass(frozen=True, kw_only=True)
class MapJudgment:
    """The verdict on a map and its findings."""

    verdict: MapVerdict | None
    findings: list[SaidFinding] | None


@dataclass(frozen=True, kw_only=True)
class ReviewFacts:
    """State of the review of a project."""

    seq: int
    """Rows of the journal of decisions."""
    undoable: int
    in_map: bool
    """Whether the map includes the decisions."""
    busy: bool
    """Whether a job is queued or running."""
    map: MapJudgment | None


@dataclass(frozen=True, kw_only=True)
class ProjectReading:
    """A project with the verdict on its map, and the evidence for it."""

    id: str
    name: str
    page: str
    """Address of its page, for people."""
    finished: bool
    busy: bool
    updated: str
    bytes: int
    preset: str
    rig: str
    verdict: MapVerdict | None
    """None = there is no map yet, or an earlier version of recon4 made it."""
    findings: list[SaidFinding] | None
    """Worst first; `explain_finding` says what a kind means."""
    figures: dict[str, Figure]
    """By their names in ``summary.json``; parts of a group have a dot, ``edges.accepted``."""
    approval: ApprovalLine
    decisions: int
    """Rows of the journal of decisions."""
    decisions_in_map: bool
    problem: str


@dataclass(frozen=True, kw_only=True)
class StageRow:
    """A stage of a run."""

    stage: str
    state: str
    seconds: float | None


@dataclass(frozen=True, kw_only=True)
class JobInputs:
    """What a job was started with."""

    recordings: list[str]
    preset: str
    rig: str
    settings: list[str]


@dataclass(frozen=True, kw_only=True)
class JobRow:
    """A job of the server."""

    id: str
    project: str
    state: str
    created: str
    finished: str
    note: str
    inputs: JobInputs


@dataclass(frozen=True, kw_only=True)
class JobProgress:
    """The current piece of work."""

    what: str
    stages: list[StageRow]


@dataclass(frozen=True, kw_only=True)
class WatchedJob:
    """A job and its progress."""

    job: JobRow
    status: JobProgress
    run_progress: float
    """Fraction of the whole run."""
    run_eta_s: float | None
    """Remaining time [s]; None = not known yet."""
    resumable: bool

    @property
    def over(self) -> bool:
        """Whether it ended."""
        return self.job.state not in ("queued", "running")

    @property
    def stage(self) -> str:
        """The stage that runs; empty = none."""
        return next((one.stage for one in self.status.stages if one.state == "running"), "")


@dataclass(frozen=True, kw_only=True)
class ExportList:
    """Files of a project."""

    files: list[ExportFile]
    """Finished results."""
    written_on_request: list[str]
    """Other names that `download_export` takes: the server writes them first."""


@dataclass(frozen=True, kw_only=True)
class OrderedExport:
    """A file of the map that the server makes, or has made."""

    id: str


@dataclass(frozen=True, kw_only=True)
class FileAddress:
    """Where a file is downloaded."""

    url: str


@dataclass(frozen=True, kw_only=True)
class Downloaded:
    """A file on this computer."""

    path: str
    bytes: int
    sha256: str


@dataclass(frozen=True, kw_only=True)
class FigureDifference:
    """A figure or setting that two runs do not have in common."""

    name: str
    first: Figure
    second: Figure


@dataclass(frozen=True, kw_only=True)
class FindingDifference:
    """Findings of one kind, about one sensor and direction, in two runs."""

    kind: str
    title: str
    first: list[str]
    """Texts in the first run; empty = it has none."""
    second: list[str]


@dataclass(frozen=True, kw_only=True)
class RunComparison:
    """Two runs: verdicts, findings, figures, settings."""

    verdicts: tuple[str, str]
    """Usability of each; empty = none was worked out."""
    same_recording: bool | None
    """Whether their inputs have the same hashes; None = a summary has no hashes."""
    findings: list[FindingDifference]
    """Kinds whose texts differ; the worst first."""
    figures: list[FigureDifference]
    settings: list[FigureDifference]


@dataclass(frozen=True, kw_only=True)
class StoreyFloor:
    """A storey that was walked through."""

    floor_m: float


@dataclass(frozen=True, kw_only=True)
class MapExtent:
    """Extent of nearly all points, and storeys."""

    low_m: tuple[float, float, float]
    high_m: tuple[float, float, float]
    storeys: list[StoreyFloor]


@dataclass(frozen=True, kw_only=True)
class ShownSlice:
    """An image of a slice."""

    png: str
    """Base64."""
    name: str
    points: int
    pixel_m: float
    low: float
    high: float


@dataclass(frozen=True, kw_only=True)
class LoopQueue:
    """Pairs of multiframes to decide about, in the order of the review."""

    key: str
    limit_m: float
    columns: list[str]
    rows: list[list[Figure]]


@dataclass(frozen=True, kw_only=True)
class LoopPairs:
    """The first pairs of the review queue."""

    total: int
    limit_m: float
    """Discrepancy of alternative paths above which a pair is rejected [m]."""
    pairs: list[dict[str, Figure]]


@dataclass(frozen=True, kw_only=True)
class ServerFile:
    """A file or folder on the server's computer."""

    name: str
    path: str
    folder: bool
    bytes: int


@dataclass(frozen=True, kw_only=True)
class RecordingFacts:
    """Content of a recording, and suitable inputs for a job."""

    path: str
    kind: str
    seconds: float
    missing: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    project: str
    """Proposed name of the project."""
    preset: str
    rig: str
    imu: str
    gnss: str


@dataclass(frozen=True, kw_only=True)
class SignedIn:
    """The person as whom the tools act."""

    name: str
    role: str
    may: list[str]
    token: str
