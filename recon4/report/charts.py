"""Charts of the report, each with a caption."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.evaluation.evaluate import Evaluation
from recon4.evaluation.tuning import RELATIVE_ERROR
from recon4.findings.drift import DriftClosed
from recon4.findings.placement import GnssFacts
from recon4.geometry.se3 import Array
from recon4.model.finding import Finding
from recon4.model.pose_graph import PoseGraph, Verdict
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.uncertainty import PoseUncertainty
from recon4.report.edges import by_verdict, spanning
from recon4.report.figures import BLUE, GRAY, GREEN, ORANGE, PINK, cumulative, histogram, lines
from recon4.report.intensity import Dependency
from recon4.report.stretches import marked_times

Charts = list[tuple[str, str]]
"""SVG and caption of each chart."""
_COLORS = {Verdict.ACCEPTED: BLUE, Verdict.REJECTED: ORANGE, Verdict.UNVERIFIED: GRAY}


def walk_charts(
    final: Trajectory,
    steps: dict[str, NDArray[Any]],
    drift: DriftClosed | None,
    *,
    uncertainty: PoseUncertainty | None = None,
    findings: Sequence[Finding] = (),
) -> Charts:
    """Findings, drift, uncertainty, height and tracking over time."""
    t_s = (final.t_ns - final.t_ns[0]) / 1e9
    marked = marked_times(findings, float(t_s[-1]))
    shaded = marked.shaded
    out: Charts = marked.chart()
    time = "time from the start [s]"
    if drift is not None:
        series = [("", drift.t_s, 100.0 * drift.moved_m, BLUE)]
        labels = (time, "final − odometry [cm]")
        svg = lines("drift", series, labels=labels, least=1.0, shaded=shaded)
        out.append((svg, "Distance between the final trajectory and the odometry."))
    if drift is not None and len(drift.loop_before_m):
        groups = [
            ("odometry", 100.0 * drift.loop_before_m, ORANGE),
            ("final", 100.0 * drift.loop_after_m, BLUE),
        ]
        svg = histogram(
            "loops", groups, labels=("residual of a loop closure [cm]", "loop closures"), log=True
        )
        out.append((svg, "Residuals of accepted loop closures to odometry and final poses."))
    if uncertainty is not None:
        at_s = (uncertainty.t_ns - final.t_ns[0]) / 1e9
        series = [("", at_s, 200.0 * uncertainty.sd_m, BLUE)]
        labels = (time, "2σ [cm]")
        svg = lines("uncertainty", series, labels=labels, least=1.0, shaded=shaded)
        where = "on the earth" if uncertainty.on_earth else "relative to the first pose"
        out.append((svg, f"Uncertainty of the position along its worst axis, {where}."))
    series = [("", t_s, final.T_a_b.t[:, 2], BLUE)]
    svg = lines("height", series, labels=(time, "height [m]"), least=0.1, shaded=shaded)
    out.append((svg, "Height of the body."))
    out += _tracking_charts(steps, time, shaded)
    return out


def edge_charts(graph: PoseGraph) -> Charts:
    """Errors relative to their limits, path discrepancy, overlap, and edges spanning each time."""
    out: Charts = []
    ratio = by_verdict(graph, lambda edge: edge.error_m / edge.limit_m if edge.limit_m else np.nan)
    if _any(ratio):
        svg = histogram(
            "error",
            _groups(ratio),
            labels=("error / limit", "edges"),
            limit=(1.0, "limit"),
            log=True,
        )
        out.append((svg, "Registration error of each pair over its acceptance limit (V Eq. 2.7)."))
    median = by_verdict(graph, lambda edge: 100.0 * edge.verification_m)
    if _any(median):
        svg = histogram(
            "verification",
            _groups(median),
            labels=("path discrepancy [cm]", "edges"),
            limit=(10.0, "10 cm (V §2.8)"),
            log=True,
        )
        out.append(
            (svg, "Path discrepancy: median distance between each edge and its alternative paths.")
        )
    overlap = by_verdict(graph, lambda edge: 100.0 * edge.overlap)
    if _any(overlap):
        svg = histogram("overlap", _groups(overlap), labels=("overlap [%]", "edges"))
        out.append((svg, "Overlap of each pair."))
    if len(graph) > 1:
        t_s = (graph.t_ns[:-1] - graph.t_ns[0]) / 1e9
        series = [("", t_s, spanning(graph).astype(np.float64), GREEN)]
        svg = lines("span", series, labels=("time from the start [s]", "edges spanning"))
        out.append(
            (svg, "Number of edges that span each time of the trajectory; 1 = odometry only.")
        )
    return out


def accuracy_charts(found: Evaluation) -> Charts:
    """Errors against the ground truth."""
    out: Charts = []
    errors = found.aligned.position_errors_m
    groups = [("poses", 100.0 * errors, BLUE)]
    svg = histogram("ate", groups, labels=("position error after SVD alignment [cm]", "poses"))
    out.append((svg, "Distance of the poses from the ground truth."))
    if found.relative is not None and found.relative.histogram.any():
        counts = found.relative.histogram.astype(np.float64)
        distance_m = np.linspace(
            RELATIVE_ERROR.histogram_step_m,
            len(counts) * RELATIVE_ERROR.histogram_step_m,
            len(counts),
        )
        svg = cumulative("er", distance_m, counts, marks_m=(0.02, 0.05))
        out.append((svg, "Ratio of the slice points within a distance of the model (V Fig. 3.2)."))
    return out


def gnss_charts(gnss: GnssFacts) -> Charts:
    """Residuals at the GNSS positions."""
    if not gnss.residual_enu_m:
        return []
    residual_cm = 100.0 * np.asarray(gnss.residual_enu_m, dtype=np.float64)
    used, t_ns = np.asarray(gnss.used, dtype=bool), np.asarray(gnss.t_ns, dtype=np.int64)
    t_s = ((t_ns - t_ns[0]) / 1e9)[used]
    if not used.any():
        return []
    names = (("east", BLUE), ("north", ORANGE), ("up", GREEN))
    series = [(name, t_s, residual_cm[used, k], color) for k, (name, color) in enumerate(names)]
    svg = lines("gnss", series, labels=("time from the first fix [s]", "measured − solved [cm]"))
    count, unused = used.sum(), (~used).sum()
    return [(svg, f"Residuals of the {count} fixes used as GNSS priors; {unused} were not used.")]


def intensity_charts(curves: tuple[Dependency, ...]) -> Charts:
    """Dependency curves of the intensity; normalization makes them flat (V Fig. 2.13)."""
    out: Charts = []
    for curve in curves:
        series = [
            ("as measured", curve.mean.x, curve.mean.raw, GRAY),
            ("normalized", curve.mean.x, curve.mean.normalized, BLUE),
        ]
        svg = lines(f"intensity-{curve.name}", series, labels=(curve.label, "mean intensity"))
        caption = (
            f"Mean intensity by {curve.name}: the curve's deviation was "
            f"{curve.mean.spread_raw:.2f} and is {curve.mean.spread_normalized:.2f}."
        )
        out.append((svg, caption))
        out += _same_surface_chart(curve)
    return out


def _same_surface_chart(curve: Dependency) -> Charts:
    same = curve.same
    if same is None:
        return []
    series = [
        ("as measured", same.x, same.raw, GRAY),
        ("normalized", same.x, same.normalized, BLUE),
    ]
    label = "over that of the same surface"
    svg = lines(f"intensity-same-{curve.name}", series, labels=(curve.label, label))
    caption = (
        f"The same, each intensity divided by the mean of its surface, without the effect of the "
        f"scene: the deviation falls from {100.0 * same.spread_raw:.1f} % to "
        f"{100.0 * same.spread_normalized:.1f} %."
    )
    return [(svg, caption)]


def _tracking_charts(
    steps: dict[str, NDArray[Any]], time: str, shaded: Sequence[tuple[float, float, str]]
) -> Charts:
    t_ns = steps.get("t_mid_ns")
    if t_ns is None or len(t_ns) < 2:
        return []
    t_s = (t_ns - t_ns[0]) / 1e9
    out: Charts = []
    if "error_m" in steps:
        series = [("", t_s, 100.0 * steps["error_m"].astype(np.float64), PINK)]
        labels = (time, "registration error [cm]")
        svg = lines("tracking-error", series, labels=labels, shaded=shaded)
        out.append((svg, "Odometry: mean distance of matched segments from the local map."))
    if "match_ratio" in steps:
        matched = 100.0 * steps["match_ratio"].astype(np.float64)
        matched[0] = np.nan  # the first has nothing to match
        series = [("", t_s, matched, GREEN)]
        svg = lines("match-ratio", series, labels=(time, "match ratio [%]"), shaded=shaded)
        out.append((svg, "Odometry: match ratio, the segments with a partner in the local map."))
    return out


def _groups(values: dict[Verdict, Array]) -> list[tuple[str, Array, str]]:
    return [(str(verdict), values[verdict], _COLORS[verdict]) for verdict in Verdict]


def _any(values: dict[Verdict, Array]) -> bool:
    return any(np.isfinite(v).any() for v in values.values())
