"""What a finished run of LiDARs or a profiler leaves in the project folder for people."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4.findings.walk_record import path_length_m
from recon4.model.figures import CorrectedClass, UncertaintyFigures
from recon4.model.finding import Finding, Level, Value, worst_first
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig_origin import RigOrigin
from recon4.pose_graph.files import load_graph
from recon4.report.assessment import Assessment, assess
from recon4.report.facts import ReportFacts
from recon4.report.html import write_report
from recon4.review.approval import put_back
from recon4.review.approved import Approval, approval_of
from recon4.review.stamp import Stamp
from recon4.settings import Settings
from recon4.store.arrays import load_trajectory
from recon4.store.atomic import copy_file, link_file
from recon4.store.checked import Altered
from recon4.store.frames import open_frames
from recon4.store.package_versions import versions
from recon4.store.stage import StageRun, figures_of
from recon4.workflows import stages
from recon4.workflows.lidar import ODOMETRY
from recon4.workflows.make_map import MAP
from recon4.workflows.publish import FinishedRun, Results, run_keys
from recon4.workflows.result_files import write_graph, write_pose_covariances, write_trajectory
from recon4.workflows.summary import About, RunSummary, duration_s, timings


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary(RunSummary):
    """Contents of ``summary.json``; the fields are its keys."""

    rig: str
    """Name of the rig that was used."""
    crs: str
    """Code of the map's CRS; empty = a local frame."""
    multiframes: int
    lost: int
    """Multiframes the odometry could not place."""
    points: int
    """In the map."""
    rig_origin: RigOrigin | None
    """Serial numbers, date and accuracy of the rig's calibration; null = not known."""
    uncertainty: UncertaintyFigures | None
    """How well the poses are known; null = not stated."""
    corrections: tuple[CorrectedClass, ...]
    """Of classes by people."""
    approval: Stamp | None
    """Who approved these results, when, as which version; null = a draft."""


@dataclass(frozen=True, slots=True, eq=False)
class _FinishedMap:
    """A finished run with its verdict."""

    run: FinishedRun
    assessed: Assessment

    @property
    def level(self) -> Path:
        """Artifact with the final trajectory and graph."""
        return self.run.folder["level"]


def _gather(run: FinishedRun) -> _FinishedMap:
    return _FinishedMap(run, assess(report_facts(run.runs, run.about, created=run.created)))


def _summary(root: Path, made: _FinishedMap) -> Summary:
    runs, assessed = made.run.runs, made.assessed
    # Before the results are hashed: those that a person approved are the same again, byte by byte.
    approval, altered = _put_back(root, {name: run.artifact.key for name, run in runs.items()})
    trajectory = load_trajectory(made.level / "trajectory.npz")
    frames, level = figures_of(runs, stages.FRAMES), figures_of(runs, stages.LEVEL)
    return Summary(
        **run_keys(root, made.run, RESULTS),
        rig=frames.rig,
        rig_origin=assessed.facts.rig_origin,
        crs=level.crs,
        duration_s=duration_s(trajectory),
        path_length_m=round(float(path_length_m(trajectory)[-1]), 3),
        multiframes=frames.multiframes,
        lost=figures_of(runs, ODOMETRY).lost,
        points=figures_of(runs, MAP).points,
        edges=load_graph(made.level).verdict_counts(),
        verdict=assessed.verdict,
        uncertainty=level.uncertainty,
        findings=worst_first((*assessed.findings, *altered)),
        corrections=figures_of(runs, MAP).corrections,
        approval=approval.stamp if approval else None,
    )


def _put_back(root: Path, keys: Mapping[str, str]) -> tuple[Approval | None, tuple[Finding, ...]]:
    """The approval of these results, put back; and why not, when what was issued was changed."""
    try:
        approval = approval_of(root, keys)
        if approval:
            put_back(root, approval)
    except Altered as error:
        values: dict[str, Value] = {"reason": str(error)}
        return None, (Finding(kind=FindingKind.APPROVAL_ALTERED, level=Level.NOTE, values=values),)
    return approval, ()


def report_facts(runs: Mapping[str, StageRun[Any]], about: About, *, created: str) -> ReportFacts:
    """What the report and the verdict are made of; the stages up to ``level`` are enough."""
    return ReportFacts(
        title=about.project.name,
        created=created,
        preset=about.project.preset,
        settings=about.settings,
        artifacts={name: run.artifact.folder for name, run in runs.items()},
        stages=timings(runs),
        inputs=about.project.inputs,
        versions=versions(),
        rig=figures_of(runs, stages.FRAMES).rig,
        rig_origin=_rig_origin(runs, about.settings),
        crs=figures_of(runs, stages.LEVEL).crs,
    )


def _rig_origin(runs: Mapping[str, StageRun[Any]], settings: Settings) -> RigOrigin:
    """Where the rig that the map was made with comes from."""
    found = runs.get(stages.CALIBRATION.name)
    used = found.artifact.folder if found and found.figures.applied else None
    store = open_frames(runs[stages.FRAMES.name].artifact.folder, used)
    return RigOrigin.of(
        store.rig,
        recorded_ns=int(store.index["t_ns"][0]) if len(store) else 0,
        max_age_days=settings.rig.max_age_days,
    )


MAP_RESULTS = Results(
    _gather,
    {
        "trajectory.tum": lambda made, path: write_trajectory(made.level, path),
        "odometry.tum": lambda made, path: write_trajectory(made.run.folder["odometry"], path),
        "poses_covariance.csv": lambda made, path: write_pose_covariances(
            made.run.folder["frames"], made.level, path
        ),
        "map.laz": lambda made, path: link_file(made.run.folder["map"] / "map.laz", path),
        "edges.json": lambda made, path: copy_file(made.level / "edges.json", path),
        "graph.g2o": lambda made, path: write_graph(made.level, path),
        "report.html": lambda made, path: write_report(path, made.assessed),
    },
    _summary,
)
RESULTS = tuple(MAP_RESULTS.files)
"""Files of a finished run, beside its summary."""
