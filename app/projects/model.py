"""A project as the pages show it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

RESULTS: dict[str, str] = {
    "report.html": "Quality report",
    "map.laz": "Map, LAZ 1.4",
    "trajectory.tum": "Trajectory, TUM",
    "odometry.tum": "Trajectory before the graph, TUM",
    "edges.json": "All pairs tried, with verdicts",
    "graph.g2o": "Pose graph, g2o",
    "summary.json": "Figures, settings and hashes",
}
"""Files of a project that may be downloaded, and nothing else, with what they are."""

STAGE_ORDER = (
    "frames",
    "odometry",
    "graph",
    "verification",
    "review",
    "carried",
    "refine",
    "level",
    "intensity",
    "map",
    "export",
    "report",
)
"""As in docs/architecture.md; a stage not named here is shown last."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ResultFile:
    """A finished result."""

    name: str
    words: str
    bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class StageView:
    """A row of the project's ledger."""

    stage: str
    seconds: float
    peak_bytes: int
    finished: str
    """UTC, ISO 8601."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectView:
    """What is known of a project without opening its arrays."""

    id: str
    """Name of its folder."""
    name: str
    finished: bool
    """Whether a run came to its end."""
    updated: str
    """When its newest file changed, UTC, ISO 8601."""
    bytes: int
    """Size of the whole folder."""
    preset: str
    rig: str
    files: tuple[ResultFile, ...]
    stages: tuple[StageView, ...]
    viewable: bool
    """Whether there is something to show in 3-D."""
    has_map: bool
    """Whether there is a map to draw a picture of."""
    summary: dict[str, Any]
    """``summary.json`` as the run wrote it; empty before."""
    problem: str = ""
    """Which files of the project cannot be read and why; empty = none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectCard:
    """What the list shows of a project: what two small files say."""

    id: str
    name: str
    finished: bool
    updated: str
    """When its newest stage or result came, UTC, ISO 8601."""
    preset: str
    rig: str
    has_map: bool
    """Whether there is a map to draw a picture of."""
    path_length_m: float | None
    """Length of the way [m]; None before the first run ended."""
    points: int | None
    """Points of the map; None before the first run ended."""
    problem: str = ""
    """Which file of the project cannot be read and why; empty = none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FolderEntry:
    """A file or folder a recording may be picked from."""

    name: str
    path: str
    folder: bool
    bytes: int
