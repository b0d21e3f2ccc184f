"""Clocks that were set back while a sensor measured: its times fall, and go on from there.

The order of arrival is the witness. Times less even ones, in steps:

    set back by 3.2       0  0  0  0 │-3.2 -3.2 -3.2 -3.2    all later ones are below all before
    one came late         0  0  0  2.3 0  0  0  0            those after are as those before
    some are missing      0  0  0  0 │ 2  2  2  2            later, not earlier
    joined in parts       0  0  0  0 │-8 -8 -8 -8            in a hole of those before, or just
                                                             before them all
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.clocks.names import looks_like
from recon4.recording.clocks.tuning import SET_BACK
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS


@dataclass(frozen=True, slots=True)
class ClockStep:
    """One time a clock was set back."""

    t_ns: int
    """Time of the last one before it, on the clock that goes on [ns]."""
    back_ns: int
    """By how much it went back, if the next one came after the usual step [ns]."""


@dataclass(frozen=True, slots=True, eq=False)
class GoingOn:
    """What makes times go on where their clock was set back."""

    shift_ns: Times
    """What is added to each [ns], (N,)."""
    steps: tuple[ClockStep, ...]
    """Where the clock was set back."""


def going_on(t_ns: Times) -> GoingOn | None:
    """How times go on where their clock was set back; None = it was not.

    Args:
        t_ns: In the order of arrival [ns], (N,); copies are no step of a clock, so leave them out.
    """
    rows, back_ns, usual_ns = _falls(t_ns)
    if not 0 < len(rows) <= SET_BACK.most:
        return None
    for before, after in pairwise(np.split(np.arange(len(t_ns)), rows)):
        far = t_ns[before[-1]] - t_ns[after[0]] > SET_BACK.joined_steps * usual_ns
        if far and not _lie_between(t_ns[: after[0]], t_ns[after], usual_ns):
            return None
    shift_ns = np.zeros_like(t_ns)
    for row, back in zip(rows.tolist(), back_ns.tolist(), strict=True):
        shift_ns[row:] += back
    last_ns = (t_ns + shift_ns)[rows - 1].tolist()
    return GoingOn(shift_ns, tuple(map(ClockStep, last_ns, back_ns.tolist())))


def _falls(t_ns: Times) -> tuple[NDArray[np.intp], Times, float]:
    """Rows of the first times after a clock was set back, how far, and the usual step [ns]."""
    none = np.zeros(0, np.intp), np.zeros(0, np.int64), 0.0
    if len(t_ns) < 2 * SET_BACK.around:
        return none
    steps = np.diff(t_ns)
    usual_ns = float(np.median(steps))
    if usual_ns <= 0.0:
        return none
    off_ns = (t_ns - t_ns[0]) - usual_ns * np.arange(len(t_ns))
    some = np.lib.stride_tricks.sliding_window_view(off_ns, SET_BACK.around)
    low, high = some.min(axis=1), some.max(axis=1)
    spread = high - low
    fall = low[: -SET_BACK.around] - high[SET_BACK.around :]
    least = np.maximum(spread[: -SET_BACK.around], spread[SET_BACK.around :])
    least = np.maximum(least, max(SET_BACK.least * usual_ns, SET_BACK.least_ns))
    first = np.flatnonzero(fall > least)
    row = first + SET_BACK.around
    level = np.median(some[first], axis=1) - np.median(some[row], axis=1)
    others = np.delete(steps, row - 1)
    exact_ns = np.mean(others[np.abs(others - usual_ns) <= usual_ns / 2])
    level += (exact_ns - usual_ns) * SET_BACK.around
    return row, np.rint(level).astype(np.int64), usual_ns


def _lie_between(before: Times, after: Times, usual_ns: float) -> bool:
    """Whether times lie between earlier ones, or too far before them to be their begin."""
    if after[-1] < before.min():
        return bool(before.min() - after[-1] > SET_BACK.joined_steps * usual_ns)
    ordered = np.sort(before)
    place = np.searchsorted(ordered, after)
    left = np.abs(after - ordered[np.maximum(place - 1, 0)])
    right = np.abs(after - ordered[np.minimum(place, len(ordered) - 1)])
    near = np.minimum(left, right) < SET_BACK.between * usual_ns
    return bool(np.count_nonzero(near) >= SET_BACK.fewest)


def newest_fall_ns(t_ns: Sequence[int]) -> int:
    """How far the clock was set back just before the newest times that show it [ns]; 0 = not.

    Args:
        t_ns: The last times in the order of arrival [ns].
    """
    row = len(t_ns) - SET_BACK.around
    if row < SET_BACK.around:
        return 0
    mean_ns = (t_ns[row - 1] - t_ns[0]) / (row - 1)
    if t_ns[row] > t_ns[row - 1] + mean_ns - SET_BACK.least_ns:
        return 0
    found = going_on(np.array(t_ns, np.int64))
    return 0 if found is None else int(found.shift_ns[row] - found.shift_ns[row - 1])


def say_set_back(sensor: str, steps: Sequence[ClockStep], report: ImportReport) -> None:
    """Count and state where the clock of a sensor was set back; its times go on without it.

    Args:
        sensor: Its name.
        steps: Where.
        report: Receives the count ``clock_jumps_back`` and the findings.
    """
    report.count("clock_jumps_back", len(steps))
    for step in steps:
        jump_s = -step.back_ns / SECOND_NS
        values: dict[str, Value] = {"whose": "sensor", "jump_s": jump_s}
        values |= {"looks": looks} if (looks := looks_like(jump_s)) else {}
        report.warn(FindingKind.CLOCK_JUMP, sensor=sensor, times="without-it", **values)
