"""The verdict on a 2-D map: what a person may do with it, and why not more."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.figures import Map2dFigures, Odometry2dFigures, Scan2dFigures
from recon4.model.import_notes import ImportNotes
from recon4.model.pose_graph import EdgeKind, PoseGraph, Verdict
from recon4.model.unused import unused_parts
from recon4.model.usability import (
    UNOBSERVED_SECONDS,
    WEAK_SD_M,
    WEAK_SECONDS,
    MapVerdict,
    Unobserved,
    Usability,
)
from recon4.slam2d.steps import Steps2d

_BRIDGED_S = 1.0
_LOST_S = 0.5
"""Tracking that is lost for a shorter time is bridged by the prediction [s]."""
_LOST_RATIO = 0.02
_SILENT_S = 1.0
"""Over a longer time without a scan and without odometry the motion is unknown [s]."""
_CROSSING_CHECK, _CROSSING_BAD = 0.1, 0.2
_SEARCHED_RATIO = 0.005
_UNCERTAIN_M = 0.5
_COARSE_M = 0.25
"""With larger cells walls and doors cannot be distinguished [m]."""
_STEEP_DEG = 30.0
"""A laser tilted by more does not see the walls of a plan [°]."""
_LONG_WALK_M = 60.0
"""A longer path without any loop closure is not confirmed by anything [m]."""

Finding2d = tuple[Usability, str]


@dataclass(frozen=True, slots=True, eq=False)
class Facts2d:
    """What the verdict is made of."""

    scans: Scan2dFigures
    imported: ImportNotes
    """Of the stage ``scans_2d``."""
    odometry: Odometry2dFigures
    map: Map2dFigures
    steps: Steps2d
    poses: Array
    """Final poses of all scans, (N, 3)."""
    graph: PoseGraph
    path_length_m: float


def judge(facts: Facts2d) -> MapVerdict:
    """The worst finding decides."""
    unobserved = unobserved_stretches(facts.steps, facts.poses)
    findings = [*_imported(facts.imported), *_mounting(facts.scans), *_tracking(facts)]
    findings += [*_observability(facts, unobserved), *_consistency(facts), *_resolution(facts.map)]
    order = {Usability.DO_NOT_USE: 0, Usability.CHECK: 1, Usability.GOOD: 2}
    findings.sort(key=lambda finding: order[finding[0]])
    usability = findings[0][0] if findings else Usability.GOOD
    return MapVerdict(usability, tuple(text for _, text in findings), unobserved)


def _imported(notes: ImportNotes) -> Iterator[Finding2d]:
    if notes.outcome != "complete":
        yield Usability.CHECK, f"The recording was read as: {notes.outcome}."
    for part in unused_parts(notes.counts):
        yield (Usability.DO_NOT_USE if part.is_severe else Usability.CHECK), part.text


def remarks(facts: Facts2d) -> tuple[str, ...]:
    """What is said beside the verdict and does not lower it.

    In a long 2-D walk few loop closures have an alternative path, and the map is right without.
    """
    verdicts = facts.graph.loop_verdicts()
    unverified, accepted = verdicts[Verdict.UNVERIFIED], verdicts[Verdict.ACCEPTED]
    if unverified <= accepted:
        return ()
    return (
        f"{unverified} loop closures are unverified: they have no alternative path; "
        f"{accepted} are accepted",
    )


def unobserved_stretches(steps: Steps2d, poses: Array) -> tuple[Unobserved, ...]:
    """Stretches of `WEAK_SECONDS` or more along which the laser hardly observes one direction."""
    t_s = (steps.t_ns - steps.t_ns[0]) / 1e9
    weak = (steps.weak_sd_m > WEAK_SD_M) & ~steps.lost
    weak[:1] = False  # there is no map yet to observe anything against
    rows = np.flatnonzero(weak)
    if not len(rows):
        return ()
    runs = np.split(rows, np.flatnonzero(np.diff(t_s[rows]) > _BRIDGED_S) + 1)
    return tuple(
        Unobserved(
            start_s=round(float(t_s[run[0]]), 2),
            end_s=round(float(t_s[run[-1]]), 2),
            direction="horizontal",
            degeneracy=round(float(np.median(steps.degeneracy[run])), 5),
            from_m=_place(poses[run[0]]),
            to_m=_place(poses[run[-1]]),
        )
        for run in runs
        if t_s[run[-1]] - t_s[run[0]] >= WEAK_SECONDS
    )


def longest_loss_s(steps: Steps2d) -> float:
    """Longest time from the last tracked scan before a loss to the next tracked one [s]."""
    if not steps.lost.any():
        return 0.0
    tracked = np.flatnonzero(~steps.lost)
    t_s = (steps.t_ns - steps.t_ns[0]) / 1e9
    ends = np.concatenate([t_s[:1], t_s[tracked], t_s[-1:]])
    between_lost = np.diff(np.concatenate([[-1], tracked, [len(t_s)]])) > 1
    return float(np.diff(ends)[between_lost].max(initial=0.0))


def _place(pose: Array) -> tuple[float, ...]:
    return (round(float(pose[0]), 2), round(float(pose[1]), 2), 0.0)


def _mounting(scans: Scan2dFigures) -> Iterator[Finding2d]:
    steep = scans.tilt_deg > _STEEP_DEG
    for text in scans.doubts:
        yield Usability.DO_NOT_USE if steep else Usability.CHECK, text


def _tracking(facts: Facts2d) -> Iterator[Finding2d]:
    odometry, has_odometry = facts.odometry, facts.scans.odometry
    longest_s = longest_loss_s(facts.steps)
    if longest_s > _LOST_S:
        ratio = odometry.lost / odometry.scans
        bad = ratio > _LOST_RATIO and not has_odometry
        yield (
            Usability.DO_NOT_USE if bad else Usability.CHECK,
            f"Tracking was lost in {odometry.lost} of {odometry.scans} scans, for up to "
            f"{longest_s:.1f} s.",
        )
    silent_s = np.diff(facts.steps.t_ns) / 1e9
    gaps = silent_s[silent_s > _SILENT_S]
    if len(gaps) and not has_odometry:
        yield (
            Usability.CHECK,
            f"The laser is silent {len(gaps)} times, for up to {gaps.max():.1f} s, and there is no "
            "odometry: how it moved meanwhile is unknown.",
        )
    if odometry.resets:
        by = "the odometry of the recording" if has_odometry else "the motion before"
        yield (
            Usability.CHECK if has_odometry else Usability.DO_NOT_USE,
            f"The local map started again {odometry.resets} times: the parts of the map are "
            f"joined by {by} and by loop closures only.",
        )
    if odometry.searched > _SEARCHED_RATIO * odometry.scans:
        yield (
            Usability.CHECK,
            f"At {odometry.searched} scans the laser had moved so far that its pose was found "
            "by a search.",
        )


def _observability(facts: Facts2d, unobserved: tuple[Unobserved, ...]) -> Iterator[Finding2d]:
    seconds = sum(stretch.end_s - stretch.start_s for stretch in unobserved)
    if unobserved:
        bad = seconds > UNOBSERVED_SECONDS and not facts.scans.odometry
        first = unobserved[0]
        by = "the odometry" if facts.scans.odometry else "the motion before"
        yield (
            Usability.DO_NOT_USE if bad else Usability.CHECK,
            f"For {seconds:.0f} s the laser hardly observes one direction, as in a corridor "
            f"without doors (first from {first.start_s:.0f} to {first.end_s:.0f} s): there the "
            f"length of the map comes from {by}.",
        )
    if facts.map.largest_sd_m > _UNCERTAIN_M:
        yield (
            Usability.CHECK,
            f"Positions are uncertain by up to {facts.map.largest_sd_m:.1f} m (one standard "
            "deviation).",
        )


def _resolution(made: Map2dFigures) -> Iterator[Finding2d]:
    if made.enlarged > 1:
        width_m, height_m = (cells * made.cell_m for cells in made.size)
        yield (
            Usability.DO_NOT_USE if made.cell_m > _COARSE_M else Usability.CHECK,
            f"The map is {width_m:.0f} x {height_m:.0f} m large: its cells are {made.cell_m:g} m, "
            f"{made.enlarged} times as large as requested. Is a position wrong?",
        )


def _consistency(facts: Facts2d) -> Iterator[Finding2d]:
    crossing = facts.map.crossing_ratio
    if crossing > _CROSSING_CHECK:
        bad = crossing > _CROSSING_BAD
        yield (
            Usability.DO_NOT_USE if bad else Usability.CHECK,
            f"{crossing:.0%} of the beams cross walls of the map: places were mapped twice.",
        )
    loops = sum(edge.kind is EdgeKind.LOOP and edge.in_graph for edge in facts.graph.edges)
    if not loops and facts.path_length_m > _LONG_WALK_M:
        yield (
            Usability.CHECK,
            f"No loop closure on a path of {facts.path_length_m:.0f} m: nothing confirms the map.",
        )
