"""What a finished run of a 2-D laser leaves in the project folder for people."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.findings.audit import load_findings
from recon4.findings.planar_walk import final_graph, import_report, read_planar
from recon4.findings.verdict import verdict_of
from recon4.findings.witnesses.planar import PlanarRecord
from recon4.model.figures import Map2dFigures
from recon4.model.finding import Finding
from recon4.model.pose_graph import EdgeKind
from recon4.report.page_2d import GridImage, Page2d, write_page_2d
from recon4.report.rows import imported_rows
from recon4.slam2d.grid_files import overview_name, read_overview
from recon4.slam2d.stage import read_covariance
from recon4.store.arrays import load_trajectory
from recon4.store.atomic import copy_file
from recon4.store.package_versions import versions
from recon4.workflows.publish import FinishedRun, Results, run_keys
from recon4.workflows.result_files import write_graph, write_trajectory
from recon4.workflows.summary import RunSummary, duration_s, timings


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


@dataclass(frozen=True, slots=True, eq=False)
class _FinishedPlan:
    """A finished run as its results show it."""

    run: FinishedRun
    facts: PlanarRecord
    findings: Sequence[Finding]
    """Worst first."""

    @property
    def map(self) -> Path:
        """Artifact with the grid and the final trajectory."""
        return self.run.folder["map_2d"]

    @property
    def graph(self) -> Path:
        """Artifact with the final graph."""
        return final_graph(self.run.folder)

    @property
    def overview(self) -> Path:
        """Image of the whole grid."""
        return self.map / f"{overview_name(self.map)}.png"

    @property
    def loops(self) -> int:
        """Loop closures in the graph."""
        edges = self.facts.graph.edges
        return sum(edge.kind is EdgeKind.LOOP and edge.in_graph for edge in edges)


def _gather(run: FinishedRun) -> _FinishedPlan:
    return _FinishedPlan(run, read_planar(run.folder), load_findings(run.folder["audit"]))


def _summary(root: Path, made: _FinishedPlan) -> Summary2d:
    facts = made.facts
    return Summary2d(
        **run_keys(root, made.run, RESULTS_2D),
        duration_s=duration_s(facts.trajectory),
        path_length_m=round(facts.path_length_m, 3),
        scans=facts.scans.scans,
        lost=facts.odometry.lost,
        loops=made.loops,
        edges=facts.graph.verdict_counts(),
        grid=facts.map,
        verdict=verdict_of(made.findings),
        findings=tuple(made.findings),
    )


def _page(made: _FinishedPlan) -> Page2d:
    """Content of the report."""
    about, facts = made.run.about, made.facts
    written = read_overview(made.map)
    sd_m = np.sqrt(np.linalg.eigvalsh(read_covariance(made.map)[:, 1:, 1:])[:, -1])
    return Page2d(
        title=about.project.name,
        created=made.run.created,
        preset=about.project.preset,
        settings=about.settings,
        findings=made.findings,
        figures=_key_figures(made),
        grid=GridImage(
            made.overview.read_bytes(),
            written.cell_m,
            written.origin_m,
            (written.gray.shape[1], written.gray.shape[0]),
        ),
        trajectory=facts.trajectory,
        odometry=load_trajectory(made.run.folder["odometry_2d"] / "trajectory.npz"),
        sd_m=sd_m,
        graph=facts.graph,
        imported=imported_rows(import_report(made.run.folder)),
        stages=timings(made.run.runs),
        versions=versions(),
    )


def _key_figures(made: _FinishedPlan) -> list[tuple[str, str, str]]:
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


PLANAR_RESULTS = Results(
    _gather,
    {
        "map.png": lambda made, path: copy_file(made.map / "map.png", path),
        "map.yaml": lambda made, path: copy_file(made.map / "map.yaml", path),
        "overview.png": lambda made, path: copy_file(made.overview, path),
        "trajectory.tum": lambda made, path: write_trajectory(made.map, path),
        "odometry.tum": lambda made, path: write_trajectory(made.run.folder["odometry_2d"], path),
        "edges.json": lambda made, path: copy_file(made.graph / "edges.json", path),
        "graph.g2o": lambda made, path: write_graph(made.graph, path),
        "report.html": lambda made, path: write_page_2d(path, _page(made)),
    },
    _summary,
)
RESULTS_2D = tuple(PLANAR_RESULTS.files)
"""Files of a finished run, beside its summary."""
