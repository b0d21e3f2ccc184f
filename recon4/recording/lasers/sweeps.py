"""Rows of a table grouped to sweeps of a beam: lines of a profiler, scans of a 2-D laser."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise, starmap
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.recording.clocks.set_back import say_set_back
from recon4.recording.clocks.stamp_order import StampOrder
from recon4.recording.formats.columns import TIME, Columns
from recon4.recording.lasers.tuning import LINES
from recon4.recording.limits import LIMITS
from recon4.recording.report import ImportReport


def sweeps(blocks: Iterator[Columns], angle: str, *, number: str, where: str) -> Iterator[Columns]:
    """Group rows to sweeps.

    A sweep ends where its number changes; without numbers, where the angle turns back, or there is
    a pause.

    Args:
        blocks: Of `recon4.recording.formats.columns.read_columns`.
        angle: Name of the column of the beam's angle.
        number: Name of the column that numbers the sweeps; empty or NaN = not numbered.
        where: File, for the message.

    Raises:
        CorruptFile: If a sweep is too long.
    """
    rest: Columns | None = None
    for block in blocks:
        rows = block if rest is None else _joined(rest, block)
        starts = _starts(rows, angle, number)
        for first, last in pairwise(starts):
            yield _part(rows, slice(int(first), int(last)))
        rest = _part(rows, slice(int(starts[-1]), None))
        _check_length(rest, number, where)
    if rest is not None:
        yield rest


def _check_length(sweep: Columns, number: str, where: str) -> None:
    count = len(sweep[TIME])
    if count > LIMITS.beams:
        how = f"the column {number} changes" if number else "the angle turns back"
        raise CorruptFile(
            CodedText("sweep-shots", where=where, beams=LIMITS.beams, how=how, count=count)
        )


def _starts(rows: Columns, angle: str, number: str) -> NDArray[np.intp]:
    """First row of each sweep, the last one perhaps not complete, (S,)."""
    if number and np.isfinite(rows[number]).any():
        new = rows[number][1:] != rows[number][:-1]
        return np.concatenate([[0], np.flatnonzero(new) + 1]).astype(np.intp)
    paused = np.diff(rows[TIME]) > LINES.apart_ns
    way = _ways(rows[angle])
    # Where one of the two changes, a sweep may end.
    turns = np.flatnonzero(way[1:] != way[:-1]) + 1
    starts, at = [0], 0
    while at < len(way):
        k = int(np.searchsorted(turns, at, side="right"))
        end = int(turns[k]) if k < len(turns) else len(way)
        pause = np.flatnonzero(paused[at:end])
        end = at + int(pause[0]) if len(pause) else end
        if end >= len(way):
            break
        at = end + 1
        starts.append(at)
    return np.array(starts, np.intp)


def _ways(angle: Array) -> NDArray[np.int8]:
    """Direction from each angle to the next, -1 or 1; where it stands, as before, (N - 1,)."""
    way = np.sign(np.nan_to_num(np.diff(angle))).astype(np.int8)
    moves = np.flatnonzero(way)
    if not len(moves):
        return np.ones(len(way), np.int8)
    last = np.searchsorted(moves, np.arange(len(way)), side="right") - 1
    return np.asarray(way[moves[np.maximum(last, 0)]], dtype=np.int8)


def _part(rows: Columns, part: slice) -> Mapping[str, NDArray[Any]]:
    return {name: values[part] for name, values in rows.items()}


def _joined(a: Columns, b: Columns) -> Mapping[str, NDArray[Any]]:
    return {name: np.concatenate([a[name], b[name]]) for name in a}


def in_order(
    scans: Iterable[Columns], where: str, *, late: str, report: ImportReport
) -> Iterator[Columns]:
    """Scans in the order of their times, which go on where their clock was set back.

    Args:
        scans: In the order of the file.
        where: Name of the file.
        late: Name of the count of those that are left out because they come too late.
        report: Receives the count and where the clock was set back.
    """
    order: StampOrder[Columns] = StampOrder()
    for scan in scans:
        yield from starmap(_at, order.push(int(scan[TIME][0]), scan))
    yield from starmap(_at, order.flush())
    say_set_back(where, order.steps, report)
    report.count(late, order.too_late)


def _at(t_ns: int, scan: Columns) -> Columns:
    """The scan with its first shot at a time [ns]."""
    return {**scan, TIME: scan[TIME] + (t_ns - int(scan[TIME][0]))}
