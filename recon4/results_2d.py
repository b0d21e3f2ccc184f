"""What a finished run of a 2-D laser leaves in the project folder for people."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4 import stages, stages_2d
from recon4.geometry.se2 import from_se3
from recon4.model.figures import Map2dFigures
from recon4.model.pose_graph import EdgeKind
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.progress import Progress, track
from recon4.report.artifacts import path_length_m
from recon4.result_files import write_graph, write_trajectory
from recon4.run_summary import (
    About,
    RunSummary,
    StageSummary,
    duration_s,
    hashes_of,
    peak_bytes_of,
    seconds_of,
)
from recon4.settings import values_by_group
from recon4.slam2d.steps import Steps2d
from recon4.slam2d.verdict import Facts2d, judge
from recon4.store.arrays import load_record, load_trajectory
from recon4.store.atomic import copy_file, write_json
from recon4.store.project import SUMMARY
from recon4.store.seal import changing
from recon4.store.stage import StageRun, figures_of, versions

RESULTS_2D = (
    "map.png",
    "map.yaml",
    "trajectory.tum",
    "odometry.tum",
    "edges.json",
    "graph.g2o",
)
"""Files of a finished run, beside its summary."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary2d(RunSummary):
    """Contents of ``summary.json`` of a 2-D map; the fields are its keys."""

    map: str = "2d"
    """Kind of the map."""
    scans: int
    lost: int
    """Scans where tracking was lost."""
    loops: int
    """Loop closures in the graph."""
    grid: Map2dFigures


def publish_2d(
    root: Path, runs: Mapping[str, StageRun[Any]], about: About, *, progress: Progress
) -> Summary2d:
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
        (root / SUMMARY).unlink(missing_ok=True)
        for write in track(_writers(root, runs), progress, what="results", unit="files"):
            write()
        summary = _summary(root, runs, about)
        write_json(root / SUMMARY, summary.to_json())
        return summary


def _summary(root: Path, runs: Mapping[str, StageRun[Any]], about: About) -> Summary2d:
    folder = {name: run.artifact.folder for name, run in runs.items()}
    trajectory = load_trajectory(folder["map_2d"] / "trajectory.npz")
    length_m = float(path_length_m(trajectory)[-1]) if len(trajectory) > 1 else 0.0
    facts = _facts(runs, trajectory, length_m)
    return Summary2d(
        name=about.project.name,
        created=time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
        preset=about.project.preset,
        duration_s=duration_s(trajectory),
        path_length_m=round(length_m, 3),
        scans=facts.scans.scans,
        lost=facts.odometry.lost,
        loops=sum(edge.kind is EdgeKind.LOOP and edge.in_graph for edge in facts.graph.edges),
        edges=facts.graph.verdict_counts(),
        grid=facts.map,
        verdict=judge(facts),
        warnings=facts.scans.warnings,
        seconds=seconds_of(runs),
        peak_bytes=peak_bytes_of(runs),
        stages=tuple(StageSummary.of(run) for run in runs.values()),
        versions=versions(),
        settings=values_by_group(about.settings),
        hashes=hashes_of(root, about.project, RESULTS_2D),
        folder=root,
    )


def _facts(runs: Mapping[str, StageRun[Any]], trajectory: Trajectory, length_m: float) -> Facts2d:
    folder = {name: run.artifact.folder for name, run in runs.items()}
    return Facts2d(
        scans=figures_of(runs, stages_2d.SCANS_2D),
        odometry=figures_of(runs, stages_2d.ODOMETRY_2D),
        map=figures_of(runs, stages_2d.MAP_2D),
        steps=load_record(folder["odometry_2d"] / "steps.npz", Steps2d),
        poses=from_se3(trajectory.T_a_b),
        graph=load_graph(_final_graph(folder)),
        path_length_m=length_m,
    )


def _writers(root: Path, runs: Mapping[str, StageRun[Any]]) -> list[Callable[[], None]]:
    """One function a file of `RESULTS_2D`."""
    folder = {name: run.artifact.folder for name, run in runs.items()}
    graph = _final_graph(folder)
    return [
        lambda: copy_file(folder["map_2d"] / "map.png", root / "map.png"),
        lambda: copy_file(folder["map_2d"] / "map.yaml", root / "map.yaml"),
        lambda: write_trajectory(folder["map_2d"], root / "trajectory.tum"),
        lambda: write_trajectory(folder["odometry_2d"], root / "odometry.tum"),
        lambda: copy_file(graph / "edges.json", root / "edges.json"),
        lambda: write_graph(graph, root / "graph.g2o"),
    ]


def _final_graph(folder: Mapping[str, Path]) -> Path:
    """The graph with the decisions of people, if there are any."""
    return folder.get(stages.REVIEW.name) or folder[stages.VERIFICATION.name]
