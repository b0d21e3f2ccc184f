"""Scans of a 2-D laser as tables: one row a beam, CSV or NPZ."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import EmptyRecording, UnknownFormat
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.laser_scans import LaserScans, joined_scans
from recon4.recording.formats.columns import TIME, Columns, column_names, read_columns
from recon4.recording.lasers.sweeps import in_order, sweeps
from recon4.recording.lasers.tuning import SCAN_BEAMS
from recon4.recording.limits import LIMITS
from recon4.recording.report import ImportReport

LASER_COLUMNS = (TIME, "beam_deg", "range_m")
_LASER_OPTIONAL = ("scan", "x_m", "y_m", "yaw_deg")


def is_laser_table(path: Path) -> bool:
    """Whether a file has the columns of a 2-D laser."""
    return set(LASER_COLUMNS) <= column_names(path)


def returns_of(range_m: Array) -> NDArray[np.bool_]:
    """Which ranges [m] are returns."""
    with np.errstate(invalid="ignore"):
        shortest_m, longest_m = SCAN_BEAMS.shortest_m, SCAN_BEAMS.longest_m
        return np.asarray((range_m >= shortest_m) & (range_m <= longest_m), dtype=np.bool_)


def read_laser_table(path: Path, report: ImportReport) -> LaserScans:
    """Read a table of a 2-D laser alone.

    Raises:
        RecordingError: If it cannot be read.
        EmptyRecording: If it has no scan.
    """
    parts = list(laser_batches(path, report))
    if not parts:
        raise EmptyRecording(CodedText("laser-table-no-scan", file=path.name))
    scans = joined_scans(parts)
    if scans.odometry is None:
        report.derive(DerivedKind.ODOMETRY_MISSING)
    return scans


def laser_batches(path: Path, report: ImportReport, *, offset_ns: int = 0) -> Iterator[LaserScans]:
    """Stream the scans of a 2-D laser in batches.

    Args:
        path: The table.
        report: Counts scans and beams that are left out.
        offset_ns: Added to all times.

    Raises:
        RecordingError: If the table cannot be read.
    """
    blocks = read_columns(path, LASER_COLUMNS, _LASER_OPTIONAL, report=report)
    scans = sweeps(blocks, "beam_deg", number="scan", where=path.name)
    head = list(islice(scans, SCAN_BEAMS.grid_scans))
    collector = _ScanRows(_BeamGrid.usual(head, path.name), report)
    every = chain(head, scans)
    for scan in in_order(every, path.name, late="scans_out_of_order", report=report):
        collector.push(scan, offset_ns)
        if len(collector) >= SCAN_BEAMS.scans_at_once:
            yield collector.take()
    if len(collector):
        yield collector.take()


@dataclass(frozen=True, slots=True)
class _BeamGrid:
    """Angles and times of the beams of a scan, found in the data."""

    first_deg: float
    step_deg: float
    beams: int
    step_ns: float
    """Time between two beams [ns]."""
    off_grid: float = SCAN_BEAMS.off_grid
    """Part of the step by which a beam may be off its place."""

    @staticmethod
    def usual(scans: Sequence[Columns], where: str) -> _BeamGrid:
        """That of most scans.

        Raises:
            UnknownFormat: If the beams have no common step.
        """
        angles = np.concatenate([scan["beam_deg"] for scan in scans])
        steps = np.concatenate([np.diff(scan["beam_deg"]) for scan in scans])
        times = np.concatenate([np.diff(scan[TIME]) for scan in scans])
        used = np.isfinite(steps) & (steps != 0.0)
        if not used.any():
            raise UnknownFormat(CodedText("laser-table-angles", where=where))
        # A laser that swings back and forth has as many steps in either direction.
        forward = 1.0 if np.count_nonzero(steps[used] > 0.0) * 2 >= used.sum() else -1.0
        step = forward * float(np.median(np.abs(steps[used])))
        finite = angles[np.isfinite(angles)]
        low, high = float(finite.min()), float(finite.max())
        beams = round((high - low) / abs(step)) + 1
        if beams > LIMITS.beams:
            limit = LIMITS.beams
            raise UnknownFormat(CodedText("laser-table-beams", where=where, limit=limit, got=beams))
        per_beam = times[used] / np.maximum(np.rint(steps[used] / step), 1.0)
        return _BeamGrid(low if step > 0 else high, step, beams, float(np.median(per_beam)))

    def of(self, scan: Columns) -> _BeamGrid:
        """The grid of a scan: this one, or its own if its angles are others."""
        place, on_grid = self.places(scan)
        known = place[np.isfinite(place)]
        off = known - np.rint(known)
        forward = len(known) > 0 and known[-1] >= known[0]
        if forward and on_grid.sum() == len(off) and abs(float(off.mean())) <= SCAN_BEAMS.shifted:
            return self
        return self._own(scan)

    def places(self, scan: Columns) -> tuple[Array, NDArray[np.bool_]]:
        """Beams of a scan in steps from the first, and which of them lie on the grid."""
        place = np.asarray((scan["beam_deg"] - self.first_deg) / self.step_deg, dtype=np.float64)
        beam = np.rint(np.nan_to_num(place, nan=-1.0))
        on_grid = (np.abs(place - beam) <= self.off_grid) & (beam >= 0) & (beam < self.beams)
        return place, np.asarray(on_grid, dtype=np.bool_)

    def _own(self, scan: Columns) -> _BeamGrid:
        """Equal steps through the angles of a scan; finer ones if they are irregular."""
        known = np.isfinite(scan["beam_deg"])
        angle, t_ns = scan["beam_deg"][known], scan[TIME][known]
        moves = np.diff(angle)
        if not moves.any():
            return self
        step = float(np.median(moves[moves != 0.0]))
        number = np.concatenate([[0.0], np.cumsum(np.rint(moves / step))])
        if not 0 < np.ptp(number) * SCAN_BEAMS.finer < LIMITS.beams:
            return self
        fitted, first = np.polyfit(number, angle, 1)
        off_grid = SCAN_BEAMS.off_grid
        if np.abs(first + fitted * number - angle).max() > abs(fitted) / SCAN_BEAMS.finer:
            fitted, first, off_grid = step / SCAN_BEAMS.finer, float(angle[0]), SCAN_BEAMS.nearest
            number = np.rint((angle - first) / fitted)
        number, lowest = number - number.min(), number.min()
        steps = np.diff(number)
        times = np.diff(t_ns)[steps > 0] / steps[steps > 0]
        return _BeamGrid(
            first_deg=float(first + fitted * lowest),
            step_deg=float(fitted),
            beams=int(number.max()) + 1,
            step_ns=float(np.median(times)) if len(times) else 0.0,
            off_grid=off_grid,
        )


class _ScanRows:
    """Scans whose beams are placed on grids of equal steps."""

    def __init__(self, usual: _BeamGrid, report: ImportReport) -> None:
        self._usual, self._report = usual, report
        self._ranges: list[NDArray[np.float32]] = []
        self._grids: list[_BeamGrid] = []
        self._t_ns: list[int] = []
        self._odometry: list[Array] = []
        self._last_ns = -1

    def __len__(self) -> int:
        return len(self._t_ns)

    def push(self, scan: Columns, offset_ns: int) -> None:
        """Add a scan; one that is not later than the one before is counted and left out."""
        grid = self._usual.of(scan)
        place, used = grid.places(scan)
        beam = np.rint(np.nan_to_num(place, nan=-1.0)).astype(np.intp)
        if not used.any():
            self._report.count("scans_without_angles")
            return
        first = int(np.flatnonzero(used)[0])
        t_ns = int(scan[TIME][first]) - round(grid.step_ns * beam[first]) + offset_ns
        if t_ns <= self._last_ns:
            self._report.count("scans_out_of_order")
            return
        ranges = np.full(grid.beams, np.nan, np.float32)
        seen = used & returns_of(scan["range_m"])
        ranges[beam[seen]] = scan["range_m"][seen]
        left_out = np.count_nonzero(~used) + np.count_nonzero(seen) - np.isfinite(ranges).sum()
        self._report.count("beams", len(used))
        self._report.count("beams_off_grid", int(left_out))
        self._last_ns = t_ns
        self._t_ns.append(t_ns)
        self._grids.append(grid)
        self._ranges.append(ranges)
        pose = np.array([scan[name][first] for name in _LASER_OPTIONAL[1:]])
        self._odometry.append(pose * [1.0, 1.0, np.pi / 180.0])
        self._report.count("scans")

    def take(self) -> LaserScans:
        """The scans so far."""
        ranges, poses, grids = np.concatenate(self._ranges), np.stack(self._odometry), self._grids
        scans = LaserScans(
            t_ns=np.array(self._t_ns, np.int64),
            range_m=ranges,
            start=np.cumsum([0] + [grid.beams for grid in grids]),
            angle_min_rad=np.deg2rad([grid.first_deg for grid in grids]),
            angle_step_rad=np.deg2rad([grid.step_deg for grid in grids]),
            time_step_s=np.array([max(grid.step_ns * 1e-9, 0.0) for grid in grids]),
            range_max_m=max(SCAN_BEAMS.usual_reach_m, float(np.nanmax(ranges, initial=0.0))),
            odometry=poses if np.isfinite(poses).all() else None,
        )
        self._t_ns, self._ranges, self._odometry, self._grids = [], [], [], []
        return scans
