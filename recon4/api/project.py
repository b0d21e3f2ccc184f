"""A finished project as a value: what a run made, read from its folder when it is needed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from recon4.api.maps import PLANAR, read_tiles
from recon4.errors import StoreError
from recon4.locales.coded import CodedText, unreadable
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.usability import MapVerdict, Usability
from recon4.untrusted.typed import as_type

if TYPE_CHECKING:
    from recon4.mapping.tiles import TileSet
    from recon4.model.pose_graph import PoseGraph
    from recon4.model.trajectory import Trajectory

_NO_VERDICT = MapVerdict(Usability.CHECK, ("It was made by a version that judged no maps.",))


class MapFinding(Finding, frozen=True, kw_only=True):
    """A finding of a project, in words too. ``recon4 explain CODE`` says what its kind means.

    >>> findings = api.open_project("walk").findings
    >>> worst = findings[0]
    >>> isinstance(worst, api.MapFinding), worst.level in ("good", "note", "check", "do not use")
    (True, True)
    >>> [one.text[:21] for one in findings if one.kind == "TRACKING-KEPT"]
    ['Tracking was not lost']
    """

    title: str = ""
    """Two to five words."""
    text: str = ""
    """Its sentences."""
    remedy: str = ""
    """What to do about it; empty = nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectSummary:
    """What ``summary.json`` says of a run: the part of it that stays as it is."""

    name: str
    """Of the project."""
    created: str
    """When the run ended, ISO 8601 UTC."""
    preset: str
    """What the settings started from."""
    duration_s: float
    """Time covered by the trajectory [s]."""
    path_length_m: float
    """Path length [m]."""
    edges: Mapping[str, int]
    """Number of edges of the pose graph by verdict."""
    seconds: float
    """Wall clock of all stages [s]."""
    verdict: MapVerdict = _NO_VERDICT
    """Whether the map may be used, and why not."""
    findings: tuple[MapFinding, ...] = ()
    """What contradicts or confirms the map, worst first."""
    lost: int = 0
    """Multiframes or 2-D scans where tracking was lost."""
    points: int = 0
    """In the map; 0 = a 2-D map."""
    crs: str = ""
    """Code of the map's coordinate reference system; empty = a local frame."""


@dataclass(frozen=True, slots=True)
class MapProject:
    """A finished project; its parts are read from the folder when they are asked for.

    The result files (``map.laz``, ``trajectory.tum``, ``report.html``, …) lie in `folder`.

    >>> project = api.open_project("walk")
    >>> poses = project.trajectory
    >>> poses.T_a_b.t.shape == (len(poses), 3)
    True
    >>> len(project.graph) > 1 and all(edge.in_graph for edge in project.graph.edges[:1])
    True
    >>> project.tiles.bounds_m[0].shape
    (3,)
    """

    folder: Path
    summary: ProjectSummary

    @property
    def findings(self) -> tuple[MapFinding, ...]:
        """What contradicts or confirms the map, worst first."""
        return self.summary.findings

    @property
    def trajectory(self) -> Trajectory:
        """The final poses ``T_map_body``, dense.

        Raises:
            Altered: If it was approved and is not what was approved.
            StoreError: If it is missing or damaged.
        """
        from recon4.export.map_files import final_trajectory
        from recon4.store.arrays import load_trajectory

        artifacts = self._artifacts()
        if PLANAR in artifacts:
            return load_trajectory(artifacts[PLANAR] / "trajectory.npz")
        return final_trajectory(self.folder, artifacts)

    @property
    def odometry(self) -> Trajectory:
        """The poses ``T_odom_body`` before loop closure.

        Raises:
            StoreError: If it is missing or damaged.
        """
        from recon4.store.arrays import load_trajectory

        return load_trajectory(self._artifact("odometry", "odometry_2d") / "trajectory.npz")

    @property
    def graph(self) -> PoseGraph:
        """The final pose graph: its nodes, and every pair that was tried with its verdict.

        Raises:
            StoreError: If it is missing or damaged.
        """
        from recon4.pose_graph.files import load_graph

        return load_graph(self._artifact("level", "review", "verification"))

    @property
    def tiles(self) -> TileSet:
        """The points of the map, see `read_tiles`.

        Raises:
            Altered: If the map was approved and is not what was approved.
            StoreError: If there is none (as of a 2-D laser), or it is damaged.
        """
        return read_tiles(self.folder)

    def _artifacts(self) -> dict[str, Path]:
        from recon4.store.project import read_artifacts

        return read_artifacts(self.folder)

    def _artifact(self, *stages: str) -> Path:
        """The artifact of the first of these stages that ran."""
        artifacts = self._artifacts()
        for stage in stages:
            if stage in artifacts:
                return artifacts[stage]
        raise StoreError(
            CodedText("project-no-stage", folder=str(self.folder), stages=" or ".join(stages))
        )


def open_project(folder: str | PathLike[str]) -> MapProject:
    """Open a project that was processed to its end; another process may work with it.

    Args:
        folder: What `process` or ``recon4 process --out`` made.

    Raises:
        StoreError: If it is no project, has no finished run, or is damaged.

    >>> project = api.open_project("walk")
    >>> project.summary.preset, project.summary.duration_s > 2
    ('indoor', True)
    >>> project.summary.verdict.usability in ("good", "check", "do not use")
    True
    >>> api.open_project("recording")
    Traceback (most recent call last):
    recon4.errors.StoreError: recording is not a recon4 project: it has no project.json
    """
    from recon4.review.state import read_summary
    from recon4.store.project import read_description

    root = Path(folder)
    read_description(root)
    record = read_summary(root)
    if record is None:
        raise StoreError(CodedText("project-no-run", root=str(root)))
    try:
        summary = as_type(record, ProjectSummary)
        if "findings" not in record:
            summary = replace(summary, findings=_earlier_findings(record.get("warnings", [])))
        return MapProject(root, summary)
    except msgspec.ValidationError as error:
        raise StoreError(unreadable(str(root / "summary.json"), error)) from error


def _earlier_findings(warnings: object) -> tuple[MapFinding, ...]:
    """Findings of ``summary.json`` before format 3: its warnings, which were sentences."""
    kind, level = FindingKind.EARLIER_REMARK, Level.CHECK
    texts = as_type(warnings, tuple[str, ...])
    return tuple(
        MapFinding(kind=kind, level=level, values={"text": text}, text=text) for text in texts
    )
