"""Witnesses of 2-D maps: tracking, observability, consistency and size of the grid."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from msgspec.structs import replace

from recon4.findings.witnesses.base import finding, placed
from recon4.findings.witnesses.imports import gyro_unit_assumed
from recon4.findings.witnesses.tuning import PLANAR_WITNESS
from recon4.geometry.se3 import Array
from recon4.model.figures import Map2dFigures, Odometry2dFigures, Scan2dFigures
from recon4.model.finding import Finding, Level, Value, worst_first
from recon4.model.finding_kinds import MOUNT_DOUBTS, FindingKind
from recon4.model.import_notes import ImportNotes
from recon4.model.pose_graph import EdgeKind, PoseGraph, Verdict
from recon4.model.trajectory import Trajectory
from recon4.model.tuning import OBSERVATION
from recon4.model.unused_data import unused_parts
from recon4.slam2d.steps import Steps2d


@dataclass(frozen=True, slots=True, eq=False)
class PlanarRecord:
    """What the witnesses of a 2-D map read."""

    scans: Scan2dFigures
    imported: ImportNotes
    """Of the stage ``scans_2d``."""
    odometry: Odometry2dFigures
    map: Map2dFigures
    steps: Steps2d
    trajectory: Trajectory
    """``T_map_body`` of all scans."""
    graph: PoseGraph
    path_length_m: float


def check_planar(record: PlanarRecord) -> tuple[Finding, ...]:
    """What all witnesses find in a 2-D map, worst first, each with its place."""
    found = [
        *_imported(record.imported),
        *_mounting(record),
        *_tracking(record),
        *_motion(record),
        *_corridors(record),
        *_loops(record),
        *_consistency(record),
        *_resolution(record.map),
    ]
    return worst_first(placed(one, record.trajectory) for one in found)


@dataclass(frozen=True, slots=True)
class Corridor:
    """A stretch along which the laser hardly observes one direction."""

    start_s: float
    """After the first scan [s]."""
    end_s: float
    degeneracy: float
    """Median of the smallest eigenvalue of the normalized information."""


def corridors(steps: Steps2d) -> tuple[Corridor, ...]:
    """Stretches of `weak_s` or more along which the laser hardly observes one direction."""
    t_s = (steps.t_ns - steps.t_ns[0]) / 1e9
    weak = (steps.weak_sd_m > OBSERVATION.weak_sd_m) & ~steps.lost
    weak[:1] = False  # there is no map yet to observe anything against
    rows = np.flatnonzero(weak)
    if not len(rows):
        return ()
    runs = np.split(rows, np.flatnonzero(np.diff(t_s[rows]) > PLANAR_WITNESS.bridged_s) + 1)
    return tuple(
        Corridor(float(t_s[run[0]]), float(t_s[run[-1]]), float(np.median(steps.degeneracy[run])))
        for run in runs
        if t_s[run[-1]] - t_s[run[0]] >= OBSERVATION.weak_s
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


def _imported(notes: ImportNotes) -> Iterator[Finding]:
    yield from gyro_unit_assumed(notes, Level.NOTE)
    if notes.outcome != "complete":
        yield finding(FindingKind.IMPORT_INCOMPLETE, Level.CHECK, {"outcome": notes.outcome})
    for one in notes.findings:
        if one.kind not in MOUNT_DOUBTS:
            yield replace(one, level=Level.NOTE)
    for part in unused_parts(notes.counts):
        level = Level.DO_NOT_USE if part.is_severe else Level.CHECK
        yield finding(FindingKind.IMPORT_UNUSED, level, part.values)


def _mounting(record: PlanarRecord) -> Iterator[Finding]:
    scans = record.scans
    level = Level.DO_NOT_USE if scans.tilt_deg > PLANAR_WITNESS.steep_deg else Level.CHECK
    for one in record.imported.findings:
        if one.kind in MOUNT_DOUBTS:
            yield replace(one, level=level)
    if scans.mirrored:
        earlier: dict[str, Value] = {"mount": scans.mount} if scans.mount else {}
        stated = scans.stated or earlier
        yield finding(FindingKind.BEAM_ORDER, level if stated else Level.NOTE, stated)


def _tracking(record: PlanarRecord) -> Iterator[Finding]:
    odometry = record.odometry
    longest_s = longest_loss_s(record.steps)
    if longest_s <= PLANAR_WITNESS.lost_s:
        yield finding(FindingKind.SCANS_TRACKED, Level.GOOD, {"scans": odometry.scans})
        return
    bad = odometry.lost > PLANAR_WITNESS.lost_ratio * odometry.scans and not record.scans.odometry
    yield finding(
        FindingKind.SCANS_LOST,
        Level.DO_NOT_USE if bad else Level.CHECK,
        {"lost": odometry.lost, "scans": odometry.scans, "longest_s": longest_s},
    )


def _motion(record: PlanarRecord) -> Iterator[Finding]:
    """What joins scans that no other scan joins."""
    odometry, has_odometry = record.odometry, record.scans.odometry
    silent_s = np.diff(record.steps.t_ns) / 1e9
    gaps = silent_s[silent_s > PLANAR_WITNESS.silent_s]
    if len(gaps):
        level = Level.NOTE if has_odometry else Level.CHECK
        yield finding(FindingKind.SCANS_SILENT, level, _silence(record, silent_s))
    if odometry.resets:
        yield finding(
            FindingKind.SUBMAP_RESTARTED,
            Level.CHECK if has_odometry else Level.DO_NOT_USE,
            {"resets": odometry.resets, "by": _by(record)},
        )
    if odometry.searched > PLANAR_WITNESS.searched_ratio * odometry.scans:
        yield finding(FindingKind.SCANS_SEARCHED, Level.CHECK, {"searched": odometry.searched})


def _silence(record: PlanarRecord, silent_s: Array) -> dict[str, Value]:
    """How long the laser is silent between two scans, (N - 1,), and what bridges that."""
    longest = int(silent_s.argmax())
    return {
        "count": int((silent_s > PLANAR_WITNESS.silent_s).sum()),
        "longest_s": float(silent_s[longest]),
        "since_s": float((record.steps.t_ns[longest] - record.steps.t_ns[0]) / 1e9),
        "by": _by(record),
    }


def _by(record: PlanarRecord) -> str:
    return "odometry" if record.scans.odometry else "motion"


def _corridors(record: PlanarRecord) -> Iterator[Finding]:
    found = corridors(record.steps)
    seconds = sum(one.end_s - one.start_s for one in found)
    bad = seconds > OBSERVATION.unobserved_s and not record.scans.odometry
    for one in found:
        values: dict[str, Value] = {"degeneracy": one.degeneracy, "by": _by(record)}
        level = Level.DO_NOT_USE if bad else Level.CHECK
        corridor = finding(FindingKind.CORRIDOR, level, values, span_s=(one.start_s, one.end_s))
        yield replace(corridor, direction="horizontal")
    if record.map.largest_sd_m > PLANAR_WITNESS.uncertain_m:
        values = {"sd_m": record.map.largest_sd_m}
        yield finding(FindingKind.POSITION_UNCERTAIN, Level.CHECK, values)


def _loops(record: PlanarRecord) -> Iterator[Finding]:
    """Loop closures; in a long 2-D walk few have an alternative path, and the map is right."""
    loops = sum(edge.kind is EdgeKind.LOOP and edge.in_graph for edge in record.graph.edges)
    if loops:
        yield finding(FindingKind.LOOPS_ACCEPTED, Level.GOOD, {"accepted": loops})
    elif record.path_length_m > PLANAR_WITNESS.long_walk_m:
        yield finding(FindingKind.PATH_UNCONFIRMED, Level.CHECK, {"path_m": record.path_length_m})
    verdicts = record.graph.loop_verdicts()
    unverified, accepted = verdicts[Verdict.UNVERIFIED], verdicts[Verdict.ACCEPTED]
    if unverified > accepted:
        values: dict[str, Value] = {"unverified": unverified, "accepted": accepted}
        yield finding(FindingKind.LOOPS_UNVERIFIED, Level.NOTE, values)


def _consistency(record: PlanarRecord) -> Iterator[Finding]:
    crossing = record.map.crossing_ratio
    if crossing > PLANAR_WITNESS.crossing_check:
        level = Level.DO_NOT_USE if crossing > PLANAR_WITNESS.crossing_bad else Level.CHECK
        yield finding(FindingKind.MAPPED_TWICE, level, {"ratio": crossing})


def _resolution(made: Map2dFigures) -> Iterator[Finding]:
    if made.enlarged <= 1:
        return
    width_m, height_m = (cells * made.cell_m for cells in made.size)
    yield finding(
        FindingKind.GRID_COARSE,
        Level.DO_NOT_USE if made.cell_m > PLANAR_WITNESS.coarse_m else Level.CHECK,
        {
            "width_m": width_m,
            "height_m": height_m,
            "cell_m": made.cell_m,
            "enlarged": made.enlarged,
        },
    )
