"""Frame files whose clock was set back while they were written.

In the order of their times, the frames before and after it lie between each other:

    before    0   100   200   300   400                    [ms]
    after               170   270   370   470   570
    by time   0   100 170 200 270 300 370 400 470   570    steps that are the usual one in twos

Their phase tells them apart, and the later ones go on after the earlier ones.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.clocks.set_back import ClockStep, going_on
from recon4.recording.clocks.tuning import FRAME_TIMES, SET_BACK

Rows = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class FrameClock:
    """Frames on a clock that goes on where it was set back."""

    order: Rows
    """Rows of the times as given, in the order in which they were recorded, (N,)."""
    shift_ns: Times
    """What is added to the time of each, in that order [ns], (N,)."""
    steps: tuple[ClockStep, ...]
    """Where the clock was set back."""


def clock_by_order(t_ns: Times) -> FrameClock | None:
    """Times of frames whose order is known; None if they were not set back.

    Args:
        t_ns: In the order of recording [ns], negative where damaged, (N,).
    """
    there = np.flatnonzero(t_ns >= 0)
    found = going_on(t_ns[there])
    if found is None:
        return None
    before = np.maximum(np.searchsorted(there, np.arange(len(t_ns)), side="right") - 1, 0)
    return FrameClock(np.arange(len(t_ns)), found.shift_ns[before], found.steps)


def clock_by_time(t_ns: Times, sizes: Callable[[], Sequence[int]]) -> FrameClock | None:
    """Times of frames that are only known by their times; None if no two clocks are in them.

    Args:
        t_ns: Increasing [ns], (N,).
        sizes: Gives the bytes of each frame: they are smaller while a sensor turns faster.
    """
    if len(t_ns) < FRAME_TIMES.fewest_numbers:
        return None
    steps = np.diff(t_ns)
    for about in (np.median(steps), np.percentile(steps, FRAME_TIMES.long_step_percent)):
        usual = float(np.median(steps[steps > FRAME_TIMES.between_ratio * about]))
        if usual < FRAME_TIMES.even_steps * np.median(steps):
            parts = _clocks(t_ns, sizes, usual)
            if len(parts) > 1:
                return _joined(t_ns, parts, usual)
    return None


@dataclass(frozen=True, slots=True)
class _Between:
    """Frames of two clocks that lie between each other."""

    start: int
    """Row of the first one of the second clock."""
    end: int
    """Row after the last one."""
    usual: float
    """Interval of the frames of one clock [ns]."""


def _clocks(t_ns: Times, sizes: Callable[[], Sequence[int]], usual: float) -> list[Rows]:
    """Rows of the times before, between and after the clock was set."""
    parts: list[Rows] = []
    rest = np.arange(len(t_ns))
    while len(parts) < FRAME_TIMES.most_set_back:
        found = _two_clocks(t_ns[rest], usual)
        if found is None or _turns_faster(rest[found.start : found.end], np.asarray(sizes())):
            break
        second = _phases(t_ns[rest], found)
        first, later = rest[~second], rest[second]
        hole = _hole_for(t_ns, first, later, usual=usual)
        if hole:
            parts += [first[:hole], later]
            rest = first[hole:]
            break
        parts, rest = [*parts, first], later
    return [*parts, rest]


def _two_clocks(t_ns: Times, usual: float) -> _Between | None:
    """The first stretch in which the frames of two clocks lie between each other."""
    if len(t_ns) < FRAME_TIMES.fewest_numbers:
        return None
    twos = t_ns[2:] - t_ns[:-2]
    pairs = np.abs(twos - usual) < FRAME_TIMES.pair_ratio * usual
    short = np.diff(t_ns) < FRAME_TIMES.between_ratio * usual
    alone = short & ~np.append(pairs, False) & ~np.append(False, pairs)
    if np.count_nonzero(alone) > FRAME_TIMES.alone_ratio * np.count_nonzero(short):
        return None
    edges = np.flatnonzero(np.diff(np.concatenate([[False], pairs, [False]])))
    runs = edges.reshape(-1, 2).tolist()
    for number, (begin, end) in enumerate(runs):
        low, high = max(0, begin - 2), min(len(t_ns) - 1, end + 3)
        more = high - low - float(t_ns[high] - t_ns[low]) / usual
        enough = more > FRAME_TIMES.more_frames * (end - begin + 1) / 2
        if end - begin >= FRAME_TIMES.fewest_between and enough:
            period = float(np.median(twos[begin:end]))
            for after in runs[number + 1 :]:
                end = after[1] if after[0] - end <= FRAME_TIMES.missing_steps else end
            return _Between(_first_off(t_ns[: begin + 3], period), end + 1, period)
    return None


def _first_off(t_ns: Times, usual: float) -> int:
    """Row of the one of the last two frames that is farther off the phase of the others."""
    steps = (t_ns - t_ns[-3]) / usual
    earlier = steps[-2 - FRAME_TIMES.phase_frames : -2]
    off = np.abs(steps[-2:] - 1.0 - np.median(earlier - np.rint(earlier)))
    return len(t_ns) - 2 + int(off[1] > off[0])


def _turns_faster(between: Rows, sizes: NDArray[np.int64]) -> bool:
    """Whether the frames of a stretch are smaller than the others, as of a faster rotation."""
    others = np.delete(sizes, between)
    if not len(others):
        return False
    return bool(np.median(sizes[between]) < FRAME_TIMES.smaller_ratio * np.median(others))


def _phases(t_ns: Times, found: _Between) -> NDArray[np.bool_]:
    """Which frames are of the second clock, (N,): each goes on with the one that it fits better.

    Behind the stretch all are of the clock that goes on.

    Args:
        t_ns: Increasing [ns], (N,).
        found: Where two clocks lie between each other first.
    """
    second = np.zeros(len(t_ns), np.bool_)
    start = found.start
    second[start] = True
    steps = (t_ns - t_ns[start]) / found.usual
    last = [float(steps[start - 1]), 0.0]  # of the first clock, and of the second
    for row in range(start + 1, min(found.end + 1, len(t_ns))):
        since = [float(steps[row]) - before for before in last]
        whole = [max(1, round(one)) for one in since]
        misfit = [
            abs(one - count) + FRAME_TIMES.skipped_cost * (count - 1)
            for one, count in zip(since, whole, strict=True)
        ]
        clock = int(misfit[1] < misfit[0])
        second[row] = clock
        last[clock] += whole[clock] + (since[clock] - whole[clock]) / 2.0
    second[row:] = second[row]
    return second


def _hole_for(t_ns: Times, first: Rows, later: Rows, *, usual: float) -> int:
    """Where the first clock pauses for as long as the second one runs; 0 = nowhere."""
    length = float(t_ns[later[-1]] - t_ns[later[0]]) + usual
    pauses = np.diff(t_ns[first])
    shortest = max(FRAME_TIMES.pause_ratio * length, FRAME_TIMES.joined_steps * usual)
    found = np.flatnonzero((pauses > shortest) & (t_ns[first[:-1]] >= t_ns[later[0]]))
    return int(found[0]) + 1 if len(found) else 0


def _joined(t_ns: Times, parts: Sequence[Rows], usual: float) -> FrameClock:
    """The parts one after the other; one that fits after the others keeps its times."""
    shifts, steps = [], []
    last = None
    for part in parts:
        begin = int(t_ns[part[0]])
        shift = 0
        if last is not None and begin - last < (1.0 - SET_BACK.least) * usual:
            shift = last + round(usual) - begin
            steps.append(ClockStep(last, shift))
        shifts.append(np.full(len(part), shift, np.int64))
        last = int(t_ns[part[-1]]) + shift
    return FrameClock(np.concatenate(parts), np.concatenate(shifts), tuple(steps))
