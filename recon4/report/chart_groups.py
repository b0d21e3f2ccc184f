"""Figures of the report, section by section."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from recon4.findings.drift import DriftClosed
from recon4.findings.walk_record import WalkRecord
from recon4.model.finding import Finding
from recon4.report import charts
from recon4.report.beams import beam_charts
from recon4.report.edges import edge_paths
from recon4.report.facts import ReportFacts
from recon4.report.intensity import dependencies
from recon4.report.maps import ABOVE, FRONT, Raster, height_png, ink_png, intensity_png
from recon4.report.plan import PlanOverlay, PlanPath, frame_around, plan_svg
from recon4.report.rig import rig_charts
from recon4.report.stretches import marked_times


@dataclass(frozen=True, slots=True)
class ChartFigure:
    """A figure with caption, legend and color scale."""

    svg: Markup
    caption: str
    legend: tuple[tuple[str, str], ...] = ()
    """CSS class of each line, and its meaning."""
    scale: tuple[str, str, str] = ("", "", "")
    """CSS class of the color bar, and the numbers at its ends."""


def map_figures(rasters: list[Raster]) -> list[ChartFigure]:
    """The map from above and from the sides."""
    out: list[ChartFigure] = []
    for raster in rasters:
        caption = f"The map {raster.view.name}. Pixel {raster.frame.pixel_m * 100:g} cm."
        if raster.view is ABOVE:
            ink = plan_svg(ink_png(raster), raster.view, raster.frame, css="ink")
            out.append(ChartFigure(Markup(ink), f"{caption} The stronger, the more points."))
        png, (low, high) = height_png(raster)
        svg = plan_svg(png, raster.view, raster.frame)
        bar = ("viridis", f"{low:.1f} m", f"{high:.1f} m")
        out.append(ChartFigure(Markup(svg), f"{caption} Color: mean height.", scale=bar))
    return out


def trajectory_figures(
    results: WalkRecord,
    drift: DriftClosed | None,
    rasters: list[Raster],
    *,
    findings: Sequence[Finding],
) -> list[ChartFigure]:
    """The trajectory over the map, and charts along it, on which findings mark their stretches."""
    final = results.final or results.odometry
    out: list[ChartFigure] = []
    if final is None or len(final) < 2:
        return out
    marked = marked_times(findings, float(final.t_ns[-1] - final.t_ns[0]) / 1e9)
    curves = [PlanPath("line-final", (final.T_a_b.t,)), *marked.paths(final)]
    legend = [("line-final", "final trajectory"), ("mark-start", "start"), ("mark-end", "end")]
    legend += marked.legend
    if drift is not None and results.odometry is not None:
        moved = drift.T_map_odom @ results.odometry.T_a_b
        curves.insert(0, PlanPath("line-odometry", (moved.t,)))
        legend.insert(1, ("line-odometry", "odometry before loop closure"))
    marks = (("mark-start", final.T_a_b.t[0]), ("mark-end", final.T_a_b.t[-1]))
    overlay = PlanOverlay(tuple(curves), marks)
    shown = [raster for raster in rasters if raster.view in {ABOVE, FRONT}]
    for raster in shown:
        svg = plan_svg(
            ink_png(raster),
            raster.view,
            raster.frame,
            overlay=overlay,
            css="ink faint",
        )
        out.append(ChartFigure(Markup(svg), f"Trajectory {raster.view.name}.", tuple(legend)))
    if not shown:
        svg = plan_svg(None, ABOVE, frame_around(final.T_a_b.t, ABOVE), overlay=overlay)
        out.append(ChartFigure(Markup(svg), "Trajectory from above.", tuple(legend)))
    return out + framed(
        charts.walk_charts(
            final, results.steps, drift, uncertainty=results.uncertainty, findings=findings
        )
    )


def edge_figures(results: WalkRecord, rasters: list[Raster]) -> list[ChartFigure]:
    """Every registered pair, and its quality."""
    graph = results.graph
    if graph is None or not len(graph):
        return []
    above = next((raster for raster in rasters if raster.view is ABOVE), None)
    frame = above.frame if above is not None else frame_around(graph.T_map_body.t, ABOVE)
    paths = (PlanPath("line-nodes", (graph.T_map_body.t,)), *edge_paths(graph))
    png = ink_png(above) if above is not None else None
    legend = (
        ("edge-accepted", "accepted"),
        ("edge-unverified", "unverified: no alternative path"),
        ("edge-rejected", "rejected automatically: overlap, error or convergence"),
        ("edge-verification", "rejected automatically: verification or robust solve"),
    )
    svg = plan_svg(png, ABOVE, frame, overlay=PlanOverlay(paths), css="ink faint")
    caption = "Every candidate pair, from above. Of very many pairs an even sample is drawn."
    out = [ChartFigure(Markup(svg), caption, legend)]
    return out + framed(charts.edge_charts(graph))


def accuracy_figures(facts: ReportFacts) -> list[ChartFigure]:
    """Errors against the ground truth."""
    if facts.evaluation is None:
        return []
    return framed(charts.accuracy_charts(facts.evaluation))


def intensity_figures(results: WalkRecord, rasters: list[Raster]) -> list[ChartFigure]:
    """Intensity before and after normalization."""
    out: list[ChartFigure] = []
    for after in (False, True):
        above = rasters[0] if rasters else None
        if above is None or (after and not above.normalized_sum.any()):
            continue
        png, (low, high) = intensity_png(above, normalized=after)
        svg = plan_svg(png, above.view, above.frame)
        caption = "Mean intensity per pixel, " + (
            "after normalization." if after else "as measured."
        )
        out.append(ChartFigure(Markup(svg), caption, scale=("grays", f"{low:.0f}", f"{high:.0f}")))
    return out + framed(charts.intensity_charts(dependencies(results.intensity)))


def rig_figures(results: WalkRecord) -> list[ChartFigure]:
    """Differences of the recording from the rig file."""
    return framed([*rig_charts(results.calibration), *beam_charts(results.calibration)])


def georeference_figures(results: WalkRecord) -> list[ChartFigure]:
    """Residuals at the GNSS positions."""
    return framed(charts.gnss_charts(results.placement.gnss))


def framed(drawn: charts.Charts) -> list[ChartFigure]:
    """Charts with their captions for the page."""
    return [ChartFigure(Markup(svg), caption) for svg, caption in drawn]
