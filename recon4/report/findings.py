"""Findings of the report: what the operator must know before using the map."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from recon4.evaluation.table import number, percentage
from recon4.model.import_notes import import_notes
from recon4.model.pose_graph import EdgeKind, PoseGraph, Verdict
from recon4.model.trajectory import Times, Trajectory
from recon4.model.unused import unused_parts
from recon4.model.usability import UNOBSERVED_SECONDS
from recon4.pose_graph.uncertainty_files import uncertainty_figures
from recon4.report.artifacts import Results, path_length_m
from recon4.report.drift import DriftClosed
from recon4.report.facts import ReportFacts
from recon4.report.heights import height_remarks
from recon4.report.observability import WeakStretch, held_by_surfaces, weak_stretches
from recon4.report.places import ambiguous_places, separate_pieces
from recon4.report.plausibility import MAX_SPEED_M_S, too_fast
from recon4.report.turn_scale import turn_scale

Flags = NDArray[np.bool_]

_GOAL_M = 0.05
"""Required relative error, V §3 [m]."""
_KNOWN_M, _KNOWN_PER_METER = 0.05, 0.001
"""Positions are known well with a 2σ of 5 cm and 0.1 % of the path length [m] …"""
_UNKNOWN = 10.0
"""… and unknown above this multiple."""
_FEW_LOST, _SHORT_GAP_S = 0.1, 2.0
"""Tracking that is lost in no more than this part of the multiframes, and for no longer than this,
may leave a usable map: if its positions are known in spite of it."""
_ANYWHERE_M = 100.0
_HELPS = 0.8
"""A control point is proposed if it leaves less than this ratio of the largest deviation."""
_MAX_WARNINGS = 12
_MIN_CONVERGED, _HALF = 0.9, 0.5


class Level(IntEnum):
    """Severity of a finding."""

    GOOD = 0
    NOTE = 1
    WARNING = 2
    BAD = 3


@dataclass(frozen=True, slots=True)
class Finding:
    """A finding, one sentence."""

    level: Level
    text: str


def find(facts: ReportFacts, results: Results, drift: DriftClosed | None) -> list[Finding]:
    """All findings, worst first."""
    found = [*_tracking(results), *_converged(results), *_observability(results)]
    found += [*_calibration(results), *_old_rig(facts), *_uncertain(results)]
    found += [*_pieces(results), *_look_alike(results.graph), *_turns(results)]
    found += [*_plausibility(results), *_loops(results.graph), *_closed(drift)]
    found += [*_leveled(results), *_contradicted(results), *_rejected_fixes(results)]
    found += [*_heights(facts, results), *_imported(results), *_accuracy(facts)]
    found += [
        Finding(Level.BAD if text in facts.severe else Level.WARNING, text)
        for text in facts.warnings
    ]
    return sorted(found, key=lambda finding: -finding.level)


def _tracking(results: Results) -> list[Finding]:
    lost = np.asarray(results.steps.get("lost", np.empty(0)), dtype=bool)
    held = held_by_surfaces(results.support, lost)
    if held is not None:
        return _bridged(lost, held, results.steps["t_mid_ns"])
    if not len(lost):
        return []
    if not lost.any():
        return [Finding(Level.GOOD, f"Tracking was not lost in any of {len(lost)} multiframes.")]
    t_ns = results.steps.get("t_mid_ns")
    where = ""
    if t_ns is not None:
        where = f", first {(t_ns[lost][0] - t_ns[0]) / 1e9:.1f} s after the start"
    text = f"Tracking was lost in {lost.sum()} of {len(lost)} multiframes "
    text += f"({percentage(lost.mean())}){where}."
    if t_ns is not None and _short_gaps(lost, t_ns) and _is_known(results):
        return [Finding(Level.WARNING, f"{text} What was registered around them holds the map.")]
    return [Finding(Level.BAD, text)]


def _short_gaps(lost: Flags, t_ns: Times) -> bool:
    """Whether few multiframes are lost, and never many in a row."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], lost, [False]]).astype(np.int8)))
    begin, end = edges[::2], np.minimum(edges[1::2], len(t_ns) - 1)
    longest_s = float((t_ns[end] - t_ns[begin]).max()) / 1e9
    return float(lost.mean()) <= _FEW_LOST and longest_s <= _SHORT_GAP_S


def _is_known(results: Results) -> bool:
    """Whether all positions are stated to be known well: lost multiframes count as unknown."""
    if results.uncertainty is None or results.final is None or len(results.final) < 2:
        return False
    found = uncertainty_figures(results.uncertainty, results.final)
    return 2.0 * found.largest_sd_m <= _known_limit_m(results.final)


def _known_limit_m(walk: Trajectory) -> float:
    return _KNOWN_M + _KNOWN_PER_METER * float(path_length_m(walk)[-1])


def _bridged(lost: Flags, held: Flags, t_ns: Times) -> list[Finding]:
    """What became of multiframes without a pose by the 2-D laser."""
    since_s = (t_ns[lost][0] - t_ns[0]) / 1e9
    text = (
        f"The 2-D laser gives no pose in {lost.sum()} of {len(lost)} multiframes "
        f"({percentage(lost.mean())}), first {since_s:.1f} s after the start. "
    )
    if held.all():
        text += "There the IMU and what the profiler saw again at other times hold the map."
        return [Finding(Level.WARNING, text)]
    text += f"In {(~held).sum()} of them the profiler saw too little again to hold the map."
    return [Finding(Level.BAD, text)]


def _pieces(results: Results) -> list[Finding]:
    return [
        Finding(
            Level.BAD,
            f"From {piece.start_s:.0f} s to {piece.end_s:.0f} s after the start the walk is a "
            f"separate piece of {piece.multiframes} multiframes: how the body got there was not "
            "recorded, and no place of it was recognized. Its position in the map is not known. "
            "A loop closure by hand joins it.",
        )
        for piece in separate_pieces(results)[:_MAX_WARNINGS]
    ]


def _look_alike(graph: PoseGraph | None) -> list[Finding]:
    return [
        Finding(
            Level.WARNING,
            f"What was seen from {place.start_s:.0f} s to {place.end_s:.0f} s looks like the place "
            f"at {place.like_s:.0f} s, but the trajectory puts it elsewhere or another place looks "
            f"the same: {place.pairs} loop closures are ambiguous and wait in the review.",
        )
        for place in ambiguous_places(graph)[:_MAX_WARNINGS]
    ]


def _converged(results: Results) -> list[Finding]:
    converged = np.asarray(results.steps.get("converged", np.empty(0)), dtype=bool)
    if not len(converged) or converged.mean() >= _MIN_CONVERGED:
        return []
    level = Level.WARNING if converged.mean() >= _HALF else Level.BAD
    how_many = f"{converged.sum()} of {len(converged)} multiframes ({percentage(converged.mean())})"
    return [Finding(level, f"The registration converged in only {how_many}.")]


def _calibration(results: Results) -> list[Finding]:
    """Whether the rig file agrees with the recording."""
    found = results.calibration
    if found is None:
        return []
    if found.warnings:
        level = Level.BAD if found.is_severe else Level.WARNING
        corrected = Level.NOTE if found.applied else level
        return [
            Finding(Level.WARNING if text in found.uncorrected else corrected, text)
            for text in found.warnings
        ]
    text = f"Rig: {found.outcome}."
    status = {row.status for row in found.parameters}
    agrees = "consistent" in status and "off" not in status
    return [Finding(Level.GOOD if agrees else Level.NOTE, text)]


def _old_rig(facts: ReportFacts) -> list[Finding]:
    """Whether the rig was calibrated long before the walk."""
    remark = facts.rig_origin.remark if facts.rig_origin else ""
    return [Finding(Level.NOTE, remark)] if remark else []


def _observability(results: Results) -> list[Finding]:
    stretches = weak_stretches(results.steps, results.support)
    if not stretches:
        return _observed_by_profiler(results)
    seconds = sum(stretch.seconds for stretch in stretches)
    positions = results.placement.gnss.georeferenced
    level = Level.BAD if seconds >= UNOBSERVED_SECONDS and not positions else Level.WARNING
    return [Finding(level, _describe_stretch(stretch)) for stretch in stretches[:_MAX_WARNINGS]]


def _observed_by_profiler(results: Results) -> list[Finding]:
    """Where the profiler observes what the 2-D laser does not."""
    planar = weak_stretches(results.steps) if results.support is not None else []
    if not planar:
        return []
    seconds = sum(stretch.seconds for stretch in planar)
    text = (
        f"For {seconds:.0f} s, first from {planar[0].start_s:.0f} to {planar[0].end_s:.0f} s, the "
        "2-D laser hardly observes one direction; the profiler does."
    )
    return [Finding(Level.NOTE, text)]


def _describe_stretch(stretch: WeakStretch) -> str:
    direction = "a horizontal" if stretch.horizontal else "the vertical"
    if not np.isfinite(stretch.direction_odom).all():
        direction = "one"
    weak = f"degeneracy {stretch.degeneracy:.4f}, 0 = unobservable"
    if np.isfinite(stretch.sd_m):
        weak = f"standard deviation of one multiframe {_distance(stretch.sd_m)}"
    return (
        f"Between {stretch.start_s:.0f} s and {stretch.end_s:.0f} s the LiDAR hardly observes "
        f"{direction} direction ({weak}): the position along it may be wrong by meters, and no "
        "other figure shows it. A control point, a loop or GNSS there would help."
    )


def _distance(sd_m: float) -> str:
    return f"{sd_m:.2f} m" if sd_m < 10.0 else "above 10 m"


def _uncertain(results: Results) -> list[Finding]:
    """Whether the positions are known well enough, and what would help."""
    if results.uncertainty is None or results.final is None or len(results.final) < 2:
        return []
    found = uncertainty_figures(results.uncertainty, results.final)
    known_m = 2.0 * found.largest_sd_m
    limit_m = _known_limit_m(results.final)
    place = "on the earth" if found.on_earth else "relative to the start"
    known = _cm(known_m) if known_m < _ANYWHERE_M else "more than 100 m"
    text = f"The positions are known to ± {known} (2σ) {place}"
    if known_m <= limit_m:
        return [Finding(Level.GOOD, f"{text} or better.")]
    text += f" at worst, {found.at_s:.0f} s after the start."
    if found.point_sd_m < _HELPS * found.largest_sd_m:
        text += (
            f" A control point between {found.point_from_s:.0f} s and {found.point_to_s:.0f} s "
            f"would reduce this to ± {_cm(2.0 * found.point_sd_m)}."
        )
    return [Finding(Level.WARNING if known_m <= _UNKNOWN * limit_m else Level.BAD, text)]


def _turns(results: Results) -> list[Finding]:
    """Whether the odometry turns as far as registered pairs."""
    if results.graph is None or results.odometry is None:
        return []
    found = turn_scale(results.graph, results.odometry)
    return [Finding(Level.WARNING, found.text)] if found is not None and found.is_off else []


def _plausibility(results: Results) -> list[Finding]:
    walk = results.final if results.final is not None else results.odometry
    fast = too_fast(walk) if walk is not None else None
    if fast is None:
        return []
    text = (
        f"The trajectory moves at {fast.fastest_m_s:.1f} m/s, {fast.at_s:.0f} s after the start; "
        f"{fast.seconds} s of it are faster than a person walks ({MAX_SPEED_M_S:.0f} m/s)."
    )
    return [Finding(Level.BAD, text)]


def _loops(graph: PoseGraph | None) -> list[Finding]:
    if graph is None:
        return []
    verdicts = graph.loop_verdicts()
    accepted, unverified = verdicts[Verdict.ACCEPTED], verdicts[Verdict.UNVERIFIED]
    out = []
    if accepted:
        out.append(Finding(Level.GOOD, f"{accepted} loop closures accepted."))
    else:
        text = "No loop closure was accepted: the drift of the odometry is not corrected."
        out.append(Finding(Level.WARNING, text))
    if unverified > accepted:
        text = f"{unverified} loop closures are unverified: they have no alternative path."
        out.append(Finding(Level.WARNING, text))
    broken = sum(e.kind is EdgeKind.ODOMETRY and not e.in_graph for e in graph.edges)
    if broken:
        text = f"{broken} odometry edges were rejected: the trajectory may be discontinuous there."
        out.append(Finding(Level.BAD, text))
    return out


def _closed(drift: DriftClosed | None) -> list[Finding]:
    if drift is None:
        return []
    out = []
    text = f"The pose graph moved the last pose by {_cm(drift.end_m)} and no pose by more than "
    # Without a loop closure a small correction is no evidence of small drift.
    fine = drift.largest_m <= 1.0 and len(drift.loop_after_m) > 0
    out.append(Finding(Level.GOOD if fine else Level.NOTE, text + _cm(drift.largest_m) + "."))
    if len(drift.loop_after_m) and np.percentile(drift.loop_after_m, 95) > 0.10:
        text = "5 % of the accepted loop closures have a residual to the map above "
        out.append(
            Finding(Level.WARNING, text + _cm(float(np.percentile(drift.loop_after_m, 95))) + ".")
        )
    return out


def _leveled(results: Results) -> list[Finding]:
    if results.placement.is_leveled:
        return []
    text = "The map is not leveled: its heights and slopes are relative to the first sensor pose."
    return [Finding(Level.WARNING, text)]


def _contradicted(results: Results) -> list[Finding]:
    count = len(results.placement.gnss.edges_rejected)
    if not count:
        return []
    text = f"Rejected automatically: {count} verified loop closures contradict the GNSS priors."
    return [Finding(Level.NOTE, text)]


def _rejected_fixes(results: Results) -> list[Finding]:
    return [
        Finding(
            Level.WARNING,
            f"From {run.start_s:.0f} s to {run.end_s:.0f} s after the first fix {run.fixes} GNSS "
            f"fixes agree with each other and lie up to {run.horizontal_m:.2f} m horizontally and "
            f"{run.height_m:.2f} m in height from the trajectory. They were rejected: either the "
            "trajectory or GNSS is wrong there. A control point would tell which.",
        )
        for run in results.placement.gnss.rejected_runs[:_MAX_WARNINGS]
    ]


def _heights(facts: ReportFacts, results: Results) -> list[Finding]:
    if not results.placement.gnss.georeferenced:
        return []
    remarks = height_remarks(results.imported, facts.settings.gnss)
    levels = zip((Level.BAD, Level.WARNING), remarks, strict=True)
    return [Finding(level, text) for level, text in levels if text]


def _imported(results: Results) -> list[Finding]:
    notes = import_notes(results.imported)
    out = []
    if notes.outcome != "complete":
        out.append(Finding(Level.WARNING, f"The recording was read as: {notes.outcome}."))
    warnings = notes.warnings
    out += [Finding(Level.WARNING, text) for text in warnings[:_MAX_WARNINGS]]
    if len(warnings) > _MAX_WARNINGS:
        text = f"{len(warnings) - _MAX_WARNINGS} more warnings under Import."
        out.append(Finding(Level.WARNING, text))
    for part in unused_parts(notes.counts):
        if part.is_severe or part.is_scattered:
            out.append(Finding(Level.BAD if part.is_severe else Level.WARNING, part.text))
    return out


def _accuracy(facts: ReportFacts) -> list[Finding]:
    found = facts.evaluation
    if found is None:
        return []
    out = []
    if found.relative is not None:
        e_r = found.relative.point_weighted.mean_m
        level = Level.GOOD if e_r <= _GOAL_M else Level.BAD
        goal = "within" if e_r <= _GOAL_M else "above"
        out.append(Finding(level, f"e_r is {_cm(e_r)}: {goal} the goal of {_cm(_GOAL_M)}."))
    rmse = found.aligned.position_m.rmse
    level = Level.GOOD if rmse <= _GOAL_M else Level.NOTE
    out.append(Finding(level, f"The absolute trajectory error is {_cm(rmse)} (RMSE, SVD-aligned)."))
    if found.coverage_ratio < 0.95:
        text = f"The ground truth covers only {percentage(found.coverage_ratio)} of the poses."
        out.append(Finding(Level.WARNING, text))
    return out


def _cm(value_m: float) -> str:
    return f"{number(value_m, 1, 100.0)} cm" if value_m < 1.0 else f"{number(value_m, 2)} m"
