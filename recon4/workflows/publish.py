"""What a finished run leaves in the project folder for people."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4.findings.finding import Finding, Level, Value, worst_first
from recon4.findings.kinds import FindingKind
from recon4.findings.walk import path_length_m
from recon4.model.figures import UncertaintyFigures
from recon4.model.rig_origin import RigOrigin
from recon4.pose_graph.files import load_graph
from recon4.progress import Progress, track
from recon4.report.assessment import Assessment, assess
from recon4.report.facts import ReportFacts
from recon4.report.html import write_report
from recon4.review.approval import put_back
from recon4.review.approved import Approval, approval_of
from recon4.review.stamp import Stamp
from recon4.settings import Settings, values_by_group
from recon4.store.arrays import load_trajectory
from recon4.store.atomic import copy_file, write_json
from recon4.store.checked import Altered
from recon4.store.frames import open_frames
from recon4.store.package_versions import versions
from recon4.store.project import SUMMARY
from recon4.store.seal import changing
from recon4.store.stage import StageRun, figures_of
from recon4.workflows import stages
from recon4.workflows.result_files import write_graph, write_pose_covariances, write_trajectory
from recon4.workflows.summary import (
    About,
    RunSummary,
    StageSummary,
    duration_s,
    hashes_of,
    peak_bytes_of,
    seconds_of,
    timings,
)

COVARIANCES = "poses_covariance.csv"
RESULTS = (
    "trajectory.tum",
    "odometry.tum",
    COVARIANCES,
    "map.laz",
    "edges.json",
    "graph.g2o",
    "report.html",
)
"""Files of a finished run, beside its summary."""


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
    approval: Stamp | None
    """Who approved these results, when, as which version; null = a draft."""


def publish(
    root: Path, runs: Mapping[str, StageRun[Any]], about: About, *, progress: Progress
) -> Summary:
    """Write the results; ``summary.json`` comes last and vouches for the others.

    Args:
        root: The project folder.
        runs: How the stages went, in order.
        about: Request of the run.
        progress: Counts the files.

    Raises:
        StoreError: If an artifact is damaged or the folder cannot be written.
    """
    with changing(root, SUMMARY, compared=False):
        return _publish(root, runs, about, progress=progress)


def _publish(
    root: Path, runs: Mapping[str, StageRun[Any]], about: About, *, progress: Progress
) -> Summary:
    (root / SUMMARY).unlink(missing_ok=True)
    created = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
    trajectory = load_trajectory(runs["level"].artifact.folder / "trajectory.npz")
    assessed = assess(report_facts(runs, about, created=created))
    for write in track(_writers(root, runs, assessed), progress, what="results", unit="files"):
        write()
    approval, altered = _put_back(root, {name: run.artifact.key for name, run in runs.items()})
    frames, level = figures_of(runs, stages.FRAMES), figures_of(runs, stages.LEVEL)
    summary = Summary(
        name=about.project.name,
        created=created,
        preset=about.project.preset,
        rig=frames.rig,
        rig_origin=assessed.facts.rig_origin,
        crs=level.crs,
        duration_s=duration_s(trajectory),
        path_length_m=round(float(path_length_m(trajectory)[-1]), 3),
        multiframes=frames.multiframes,
        lost=figures_of(runs, stages.ODOMETRY).lost,
        points=figures_of(runs, stages.MAP).points,
        edges=load_graph(runs["level"].artifact.folder).verdict_counts(),
        verdict=assessed.verdict,
        uncertainty=level.uncertainty,
        findings=worst_first((*assessed.findings, *altered)),
        seconds=seconds_of(runs),
        peak_bytes=peak_bytes_of(runs),
        stages=tuple(StageSummary.of(run) for run in runs.values()),
        versions=versions(),
        settings=values_by_group(about.settings),
        approval=approval.stamp if approval else None,
        hashes=hashes_of(root, about.project, RESULTS),
        folder=root,
    )
    write_json(root / SUMMARY, summary.to_json())
    return summary


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


def _writers(
    root: Path, runs: Mapping[str, StageRun[Any]], assessed: Assessment
) -> list[Callable[[], None]]:
    """One function a file of `RESULTS`."""
    folder = {name: run.artifact.folder for name, run in runs.items()}
    return [
        lambda: write_trajectory(folder["level"], root / "trajectory.tum"),
        lambda: write_trajectory(folder["odometry"], root / "odometry.tum"),
        lambda: write_pose_covariances(folder["frames"], folder["level"], root / COVARIANCES),
        lambda: copy_file(folder["map"] / "map.laz", root / "map.laz"),
        lambda: copy_file(folder["level"] / "edges.json", root / "edges.json"),
        lambda: write_graph(folder["level"], root / "graph.g2o"),
        lambda: write_report(root / "report.html", assessed),
    ]


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
