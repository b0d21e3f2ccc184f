"""Views of a project for the pages."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from graphlib import TopologicalSorter
from itertools import pairwise

from recon4.review.approval_state import ApprovalState
from recon4.workflows.lidar import LIDAR
from recon4.workflows.planar import PLANAR
from recon4.workflows.profiler import PROFILER

RESULTS: dict[str, str] = {
    "report.html": "Quality report",
    "map.laz": "Map, LAZ 1.4",
    "map.png": "2-D map, image",
    "map.yaml": "2-D map, description for nav2",
    "overview.png": "2-D map, image as the pages show it",
    "trajectory.tum": "Trajectory, TUM",
    "odometry.tum": "Odometry trajectory, TUM",
    "poses_covariance.csv": "Poses of the multiframes with covariances, CSV",
    "edges.json": "Edges with verdicts",
    "graph.g2o": "Pose graph, g2o",
    "summary.json": "Figures, settings and hashes",
}
"""Files of a project that may be downloaded, and their descriptions."""

MAP_IMAGES = ("overview.png", "map.png")
"""In the artifact of a 2-D map; the first one there is shown."""


@cache
def stage_order() -> tuple[str, ...]:
    """Names of the stages of all workflows, each after those that are before it in any of them."""
    order: TopologicalSorter[str] = TopologicalSorter()
    for workflow in (LIDAR, PROFILER, PLANAR):
        for before, after in pairwise(one.name for one in workflow.stages):
            order.add(after, before)
    return tuple(order.static_order())


VIEWABLE_STAGES = {"odometry", "map", "odometry_2d", "map_2d"}
"""The viewer has something to show once one of them is done."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ResultFile:
    """A finished result."""

    name: str
    label: str
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
    """Details of a project, read without opening its arrays."""

    id: str
    """Name of its folder."""
    name: str
    finished: bool
    """Whether a run has finished."""
    updated: str
    """Time of its newest file, UTC, ISO 8601."""
    bytes: int
    """Size of the whole folder."""
    preset: str
    rig: str
    files: tuple[ResultFile, ...]
    stages: tuple[StageView, ...]
    tags: tuple[str, ...]
    """Words by which people find it."""
    archived: bool
    """Whether the list leaves it out at first."""
    viewable: bool
    """Whether the viewer can show it in 3-D."""
    has_map: bool
    """Whether there is a map, also a 2-D one, for a thumbnail."""
    summary: dict[str, object]
    """``summary.json`` of the run; empty before."""
    approval: ApprovalState
    """Of the files that are offered."""
    problem: str = ""
    """Files of the project that cannot be read, and why; empty = none."""


SHARED_SUMMARY = ("map", "points", "duration_s", "verdict", "findings", "warnings", "grid")
"""Fields of a summary that the pages of a guest show."""


def for_guests(project: ProjectView) -> ProjectView:
    """What a guest learns of a project: no files, settings, tags or machine figures."""
    return replace(
        project,
        bytes=0,
        preset="",
        rig="",
        files=(),
        tags=(),
        stages=tuple(
            StageView(stage=one.stage, seconds=0.0, peak_bytes=0, finished=one.finished)
            for one in project.stages
        ),
        summary={name: project.summary[name] for name in SHARED_SUMMARY if name in project.summary},
        problem="",
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectCard:
    """A project in the list, read from two small files."""

    id: str
    name: str
    finished: bool
    updated: str
    """Time of its newest stage or result, UTC, ISO 8601."""
    preset: str
    rig: str
    has_map: bool
    """Whether there is a map, for a thumbnail."""
    tags: tuple[str, ...]
    """Words by which people find it."""
    archived: bool
    """Whether the list leaves it out at first."""
    recording: str
    """SHA-256 of its first recording; empty = not known yet."""
    path_length_m: float | None
    """Path length [m]; None before the first run has finished."""
    points: int | None
    """Points of the map; None before the first run has finished."""
    approval: ApprovalState
    """Of the files that are offered."""
    usability: str = ""
    """Verdict on the map: good, check or do not use; empty = not known."""
    problem: str = ""
    """File of the project that cannot be read, and why; empty = none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FolderEntry:
    """An entry of a folder listing of this computer."""

    name: str
    path: str
    folder: bool
    bytes: int
