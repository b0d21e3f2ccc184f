"""What a finished run of a 2-D laser leaves in the project folder for people."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from recon4.findings.audit import load_findings
from recon4.findings.finding import Finding
from recon4.findings.planar_walk import final_graph, import_report, read_planar
from recon4.findings.verdict import verdict_of
from recon4.findings.witnesses.planar import PlanarRecord
from recon4.model.figures import Map2dFigures
from recon4.model.pose_graph import EdgeKind
from recon4.progress import Progress, track
from recon4.report.page_2d import GridImage, Page2d, write_page_2d
from recon4.report.rows import imported_rows
from recon4.settings import values_by_group
from recon4.slam2d.map_files import overview_name, read_overview
from recon4.slam2d.stage import read_covariance
from recon4.store.arrays import load_trajectory
from recon4.store.atomic import copy_file, write_json
from recon4.store.package_versions import versions
from recon4.store.project import SUMMARY
from recon4.store.seal import changing
from recon4.store.stage import StageRun
from recon4.workflows.result_files import write_graph, write_trajectory
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

RESULTS_2D = (
    "map.png",
    "map.yaml",
    "overview.png",
    "trajectory.tum",
    "odometry.tum",
    "edges.json",
    "graph.g2o",
    "report.html",
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
        made = _made(runs)
        for write in track(_writers(root, made, about), progress, what="results", unit="files"):
            write()
        summary = _summary(root, made, about)
        write_json(root / SUMMARY, summary.to_json())
        return summary


@dataclass(frozen=True, slots=True, eq=False)
class _Made:
    """A finished run as its results show it."""

    runs: Mapping[str, StageRun[Any]]
    facts: PlanarRecord
    findings: Sequence[Finding]
    """Worst first."""
    created: str

    @property
    def folder(self) -> dict[str, Path]:
        """Stage -> folder of its artifact."""
        return {name: run.artifact.folder for name, run in self.runs.items()}

    @property
    def loops(self) -> int:
        """Loop closures in the graph."""
        edges = self.facts.graph.edges
        return sum(edge.kind is EdgeKind.LOOP and edge.in_graph for edge in edges)


def _made(runs: Mapping[str, StageRun[Any]]) -> _Made:
    folder = {name: run.artifact.folder for name, run in runs.items()}
    created = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
    return _Made(runs, read_planar(folder), load_findings(folder["audit"]), created)


def _summary(root: Path, made: _Made, about: About) -> Summary2d:
    runs, facts = made.runs, made.facts
    return Summary2d(
        name=about.project.name,
        created=made.created,
        preset=about.project.preset,
        duration_s=duration_s(made.facts.trajectory),
        path_length_m=round(facts.path_length_m, 3),
        scans=facts.scans.scans,
        lost=facts.odometry.lost,
        loops=made.loops,
        edges=facts.graph.verdict_counts(),
        grid=facts.map,
        verdict=verdict_of(made.findings),
        findings=tuple(made.findings),
        seconds=seconds_of(runs),
        peak_bytes=peak_bytes_of(runs),
        stages=tuple(StageSummary.of(run) for run in runs.values()),
        versions=versions(),
        settings=values_by_group(about.settings),
        hashes=hashes_of(root, about.project, RESULTS_2D),
        folder=root,
    )


def _writers(root: Path, made: _Made, about: About) -> list[Callable[[], None]]:
    """One function a file of `RESULTS_2D`."""
    folder = made.folder
    graph, shown = final_graph(folder), overview_name(folder["map_2d"])
    return [
        lambda: copy_file(folder["map_2d"] / "map.png", root / "map.png"),
        lambda: copy_file(folder["map_2d"] / "map.yaml", root / "map.yaml"),
        lambda: copy_file(folder["map_2d"] / f"{shown}.png", root / "overview.png"),
        lambda: write_trajectory(folder["map_2d"], root / "trajectory.tum"),
        lambda: write_trajectory(folder["odometry_2d"], root / "odometry.tum"),
        lambda: copy_file(graph / "edges.json", root / "edges.json"),
        lambda: write_graph(graph, root / "graph.g2o"),
        lambda: write_page_2d(root / "report.html", _page(made, about)),
    ]


def _page(made: _Made, about: About) -> Page2d:
    """Content of the report."""
    folder, facts = made.folder, made.facts
    written = read_overview(folder["map_2d"])
    sd_m = np.sqrt(np.linalg.eigvalsh(read_covariance(folder["map_2d"])[:, 1:, 1:])[:, -1])
    return Page2d(
        title=about.project.name,
        created=made.created,
        preset=about.project.preset,
        settings=about.settings,
        findings=made.findings,
        figures=_key_figures(made),
        grid=GridImage(
            (folder["map_2d"] / f"{overview_name(folder['map_2d'])}.png").read_bytes(),
            written.cell_m,
            written.origin_m,
            (written.gray.shape[1], written.gray.shape[0]),
        ),
        trajectory=facts.trajectory,
        odometry=load_trajectory(folder["odometry_2d"] / "trajectory.npz"),
        sd_m=sd_m,
        graph=facts.graph,
        imported=imported_rows(import_report(folder)),
        stages=timings(made.runs),
        versions=versions(),
    )


def _key_figures(made: _Made) -> list[tuple[str, str, str]]:
    """Name, value and unit of the figures on top."""
    facts, grid = made.facts, made.facts.map
    seconds = round(duration_s(made.facts.trajectory))
    width_m, height_m = (cells * grid.cell_m for cells in grid.size)
    return [
        ("duration", f"{seconds // 60}:{seconds % 60:02d}", "min:s"),
        ("path length", f"{facts.path_length_m:.1f}", "m"),
        ("scans", f"{facts.scans.scans}", f"{facts.odometry.lost} lost"),
        ("loop closures", f"{made.loops}", ""),
        ("map", f"{width_m:.0f} x {height_m:.0f}", "m"),
        ("free area", f"{grid.free_m2:.0f}", "m²"),
        ("beams that cross walls", f"{100.0 * grid.crossing_ratio:.1f}", "%"),
        ("largest σ of a position", f"{100.0 * grid.largest_sd_m:.1f}", "cm"),
    ]
