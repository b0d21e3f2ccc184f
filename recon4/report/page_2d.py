"""The quality report of a 2-D map: one self-contained HTML file (no scripts, no network)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from markupsafe import Markup

from recon4.evaluation.table import number
from recon4.findings.verdict import verdict_of
from recon4.findings.walk_record import path_length_m
from recon4.findings.wording import headline
from recon4.geometry.se3 import Array
from recon4.model.finding import Finding
from recon4.model.pose_graph import EdgeKind, PoseGraph
from recon4.model.trajectory import Trajectory
from recon4.report.approval import draft_block
from recon4.report.chart_groups import ChartFigure, framed
from recon4.report.edges import edge_paths, edge_rows
from recon4.report.facts import StageTiming
from recon4.report.figures import BLUE, ORANGE, Chart
from recon4.report.findings import LEVELS, shown_findings
from recon4.report.html import changed_settings, environment
from recon4.report.maps import ABOVE, ImageFrame
from recon4.report.plan import PlanOverlay, PlanPath, plan_svg
from recon4.report.stretches import MarkedTimes, marked_times
from recon4.settings import Settings
from recon4.store.atomic import write_text


@dataclass(frozen=True, slots=True, eq=False)
class GridImage:
    """The occupancy grid as it was written."""

    png: bytes
    """Image of the grid."""
    cell_m: float
    origin_m: tuple[float, float]
    """Lower left corner in the map [m]."""
    size: tuple[int, int]
    """Cells along x and y."""

    @property
    def frame(self) -> ImageFrame:
        """The part of the plane it shows."""
        return ImageFrame(*self.origin_m, self.cell_m, *self.size)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Page2d:
    """Content of the report."""

    title: str
    created: str
    preset: str
    settings: Settings
    findings: Sequence[Finding]
    """Worst first."""
    figures: Sequence[tuple[str, str, str]]
    """Name, value and unit of the figures on top."""
    grid: GridImage
    trajectory: Trajectory
    odometry: Trajectory
    """Before loop closure."""
    sd_m: Array
    """Largest standard deviation of each position [m], (N,)."""
    graph: PoseGraph
    imported: Sequence[tuple[str, str]]
    """Rows of the import report."""
    stages: Sequence[StageTiming]
    versions: Mapping[str, str]


def write_page_2d(path: Path, page: Page2d) -> None:
    """Write the report.

    Raises:
        StoreError: If the file cannot be written.
    """
    verdict = verdict_of(page.findings)
    text = (
        environment()
        .get_template("page_2d.html.jinja")
        .render(
            page=page,
            approval=draft_block(),
            level=LEVELS[verdict.usability],
            headline=headline(verdict.usability),
            unobserved=verdict.unobserved,
            findings=shown_findings(page.findings),
            maps=_maps(page),
            charts=framed(_charts(page)),
            edge_kinds=[str(kind) for kind in EdgeKind],
            edge_rows=edge_rows(page.graph, limit_m=page.settings.verification.limit_m),
            imported=page.imported,
            changed=changed_settings(page.settings, page.preset),
            number=number,
        )
    )
    write_text(path, text.encode("utf-8", errors="replace").decode("utf-8"))


def _marked(page: Page2d) -> MarkedTimes:
    t_ns = page.trajectory.t_ns
    return marked_times(page.findings, float(t_ns[-1] - t_ns[0]) / 1e9)


def _maps(page: Page2d) -> list[ChartFigure]:
    """The grid alone, under both trajectories, and under the edges."""
    grid, frame = page.grid, page.grid.frame
    places, marked = page.trajectory.T_a_b.t, _marked(page)
    walked = PlanOverlay(
        (
            PlanPath("line-odometry", (page.odometry.T_a_b.t,)),
            PlanPath("line-final", (places,)),
            *marked.paths(page.trajectory),
        ),
        (("mark-start", places[0]), ("mark-end", places[-1])),
    )
    edges = PlanOverlay(
        (PlanPath("line-nodes", (page.graph.T_map_body.t,)), *edge_paths(page.graph))
    )
    size = f"Cell {100.0 * grid.cell_m:g} cm. Black: surfaces, white: free, gray: not seen."
    return [
        ChartFigure(Markup(plan_svg(grid.png, ABOVE, frame)), f"The map. {size}"),
        ChartFigure(
            Markup(plan_svg(grid.png, ABOVE, frame, overlay=walked)),
            "Trajectory of the laser.",
            (
                ("line-final", "final trajectory"),
                ("line-odometry", "odometry before loop closure"),
                ("mark-start", "start"),
                ("mark-end", "end"),
                *marked.legend,
            ),
        ),
        ChartFigure(
            Markup(plan_svg(grid.png, ABOVE, frame, overlay=edges)),
            "Every pair of scans that was registered.",
            (
                ("edge-accepted", "accepted"),
                ("edge-unverified", "unverified: no alternative path"),
                ("edge-rejected", "rejected automatically: overlap, error or convergence"),
                ("edge-verification", "rejected automatically: verification or robust solve"),
            ),
        ),
    ]


def _charts(page: Page2d) -> list[tuple[str, str]]:
    """Findings over time; along the path uncertainty, and what loop closure corrected."""
    along_m, marked = path_length_m(page.trajectory), _marked(page)
    t_s = (page.trajectory.t_ns - page.trajectory.t_ns[0]) / 1e9
    sd = Chart("sd-2d")
    sd.axes.plot(along_m, 100.0 * page.sd_m[: len(along_m)], color=BLUE, lw=1.2)
    sd.axes.set(xlabel="path [m]", ylabel="σ of the position [cm]", ylim=(0.0, None))
    moved = page.trajectory.T_a_b.t - page.odometry.T_a_b.t
    corrected = Chart("corrected-2d")
    corrected.axes.plot(along_m, 100.0 * np.linalg.norm(moved, axis=1), color=ORANGE, lw=1.2)
    corrected.axes.set(xlabel="path [m]", ylabel="correction [cm]", ylim=(0.0, None))
    for start_m, end_m, color in marked.shaded_at(t_s, along_m):
        for chart in (sd, corrected):
            chart.axes.axvspan(start_m, end_m, color=color, alpha=0.25, lw=0)
    return [
        *marked.chart(),
        (sd.svg(), "Largest standard deviation of the position relative to the start."),
        (corrected.svg(), "How far loop closure moved each scan from the odometry."),
    ]
