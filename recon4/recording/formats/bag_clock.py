"""Bags whose recorder was set back while it wrote: their messages go on in the order of the file.

By time, messages from before and after would lie between each other, or the end would come first.
Every topic goes back at one place of the file then, and a topic that was merely written after the
others does not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.clocks.names import looks_like
from recon4.recording.clocks.tuning import RECORDER_STEPS
from recon4.recording.formats.chunks import (
    MAX_TIME_NS,
    BagIndex,
    ChunkMessages,
    ChunkRef,
    RecorderStep,
)
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS

Topics = NDArray[np.int64]
Load = Callable[[ChunkRef], ChunkMessages]
Say = Callable[[Sequence[RecorderStep]], None]


@dataclass(frozen=True, slots=True)
class _Span:
    """Times of recording of what is not read."""

    begin_ns: int
    """First one before it [ns]."""
    end_ns: int
    """Last one after it [ns]."""


def rows_going_on(t_ns: Times, topic: Topics) -> tuple[Times, tuple[RecorderStep, ...]]:
    """Times of recording that go on where the recorder was set back, and where that was.

    Args:
        t_ns: In the order of the file [ns], (N,).
        topic: Number of the topic of each, (N,).
    """
    steps: list[RecorderStep] = []
    t_ns, start = t_ns.copy(), 0
    while len(steps) < RECORDER_STEPS.most:
        found = _first_step(t_ns[start:], topic[start:])
        if found is None:
            break
        row, shift_ns = start + found[0], found[1]
        t_ns[row:] += shift_ns
        steps.append(RecorderStep(row, 0, shift_ns, int(t_ns[row])))
        start = max(start, row - RECORDER_STEPS.window)
    return t_ns, tuple(steps)


def chunks_going_on(index: BagIndex, load: Load, say: Say) -> BagIndex:
    """An index whose chunks go on where the recorder was set back.

    Of a large file only chunks around a place where the times of chunks go back are read; a step
    within another chunk is found when that is read.

    Args:
        index: Of the file.
        load: Reads a chunk.
        say: States steps that are found later.
    """
    chunks = sorted(index.chunks, key=lambda chunk: chunk.offset)
    whole = sum(chunk.size for chunk in chunks) <= RECORDER_STEPS.whole_bytes
    steps: list[RecorderStep] = []
    for place in range(RECORDER_STEPS.most) if whole else _falls(chunks):
        around = slice(0, None) if whole else slice(max(0, place - 2), place + 3)
        step = _step_in(chunks, around, partial(_going_on, load, steps))
        if step is not None:
            steps.append(step)
            chunks = [_moved(chunk, steps, load) for chunk in chunks]
        elif whole:
            break
    if steps:
        index = BagIndex.of_chunks(index.topics, chunks)
        index.steps = tuple(steps)
    index.find_step = None if whole else partial(_step_within, say)
    return index


def _step_within(say: Say, offset: int, messages: ChunkMessages) -> RecorderStep | None:
    t_ns = np.array(messages.t_ns, np.int64)
    found = _first_step(t_ns, np.array(messages.connection, np.int64))
    if found is None:
        return None
    row, shift_ns = found
    step = RecorderStep(offset, row, shift_ns, int(t_ns[row]) + shift_ns)
    say([step])
    return step


def _going_on(load: Load, steps: Sequence[RecorderStep], chunk: ChunkRef) -> ChunkMessages:
    messages = load(chunk)
    messages.go_on(chunk.offset, steps)
    return messages


def _falls(chunks: Sequence[ChunkRef]) -> list[int]:
    """Chunks that begin earlier than those before them end, and have topics of the one before."""
    by_ns = [
        max(chunk.t_last_ns for chunk in chunks[max(0, place - 2) : place]) - after.t_first_ns
        if place and _share_topics(chunks, place)
        else 0
        for place, after in enumerate(chunks)
    ]
    return _deepest(np.array(by_ns, np.int64))


def _deepest(by_ns: NDArray[np.int64]) -> list[int]:
    """Rows in order of those that fall most: less deep ones are late messages of some topic."""
    falls = np.flatnonzero(by_ns > RECORDER_STEPS.least_ns)
    return np.sort(falls[np.argsort(-by_ns[falls])[: RECORDER_STEPS.most]]).tolist()


def _share_topics(chunks: Sequence[ChunkRef], place: int) -> bool:
    before, after = chunks[place - 1].connections, chunks[place].connections
    return before is None or after is None or not before.isdisjoint(after)


def _step_in(chunks: Sequence[ChunkRef], around: slice, load: Load) -> RecorderStep | None:
    """The first place in some of the chunks where the recorder was set back; None = nowhere."""
    read = []
    for chunk in chunks[around]:
        try:
            read.append((chunk.offset, load(chunk)))
        except CorruptFile:  # said when it is read for its messages
            continue
    if not read:
        return None
    ends = np.cumsum([len(one.t_ns) for _, one in read])
    outside = _Span(
        min((c.t_first_ns for c in chunks[: around.start]), default=2**62),
        max((c.t_last_ns for c in chunks[around.stop or len(chunks) :]), default=0),
    )
    t_ns = np.concatenate([np.array(one.t_ns, np.int64) for _, one in read])
    found = _first_step(
        t_ns,
        np.concatenate([np.array(one.connection, np.int64) for _, one in read]),
        outside if around.stop else None,
    )
    if found is None:
        return None
    within = int(np.searchsorted(ends, found[0], side="right"))
    first = found[0] - (int(ends[within - 1]) if within else 0)
    return RecorderStep(read[within][0], first, found[1], int(t_ns[found[0]]) + found[1])


def _moved(chunk: ChunkRef, steps: Sequence[RecorderStep], load: Load) -> ChunkRef:
    """The chunk with the times of its messages behind the last step."""
    offset, shift_ns = steps[-1].offset, steps[-1].shift_ns
    if chunk.offset < offset:
        return chunk
    if chunk.offset > offset:
        first_ns, last_ns = chunk.t_first_ns + shift_ns, chunk.t_last_ns + shift_ns
    else:
        messages = _going_on(load, steps, chunk)
        first_ns, last_ns = min(messages.t_ns), max(messages.t_ns)
    return replace(chunk, t_first_ns=first_ns, t_last_ns=last_ns)


def _first_step(t_ns: Times, topic: Topics, outside: _Span | None = None) -> tuple[int, int] | None:
    """Row of the first message after the recorder was set back, and how far times go on [ns].

    Args:
        t_ns: Times of recording in the order of the file [ns], (N,).
        topic: Number of the topic of each, (N,).
        outside: Of the file before and after these; None = they are all.
    """
    if not len(t_ns):
        return None
    newest = np.maximum.accumulate(t_ns)
    for before in _deepest(np.minimum(newest[:-1] - t_ns[1:], -np.diff(t_ns))):
        row = before + 1
        begin_ns, end_ns = int(t_ns[:row].min()), int(t_ns[row:].max())
        if outside is not None:
            begin_ns, end_ns = min(begin_ns, outside.begin_ns), max(end_ns, outside.end_ns)
        swapped = 0 <= begin_ns - end_ns < RECORDER_STEPS.joined_ns
        shift_ns = 0 if swapped else _shift(t_ns, topic, row)
        if shift_ns and max(end_ns, newest[-1]) + shift_ns < MAX_TIME_NS:
            return row, shift_ns
    return None


def _shift(t_ns: Times, topic: Topics, row: int) -> int:
    """How far times from a row on must move to go on [ns]; 0 = not all topics go back there."""
    back_ns = int(t_ns[:row].max() - t_ns[row])
    usual_ns, shift_ns = 2**62, 0
    numbers, messages = np.unique(topic, return_counts=True)
    for number in numbers[np.argsort(-messages)].tolist():  # the fastest one tells most
        before, after = (part[kind == number] for part, kind in _sides(t_ns, topic, row))
        if min(len(before), len(after)) < RECORDER_STEPS.messages:
            continue
        step_ns = int(max(np.median(np.diff(before)), np.median(np.diff(after))))
        if not 0 < 2 * step_ns < back_ns:
            continue
        # It goes on, even where one message came late, or it is written twice.
        if after[:2].max() >= before[-1] or np.isin(after, before).all():
            return 0
        if step_ns < usual_ns:
            usual_ns, shift_ns = step_ns, int(before[-1] - after[0]) + step_ns
    return shift_ns


def _sides(t_ns: Times, topic: Topics, row: int) -> tuple[tuple[Times, Topics], ...]:
    return (t_ns[:row], topic[:row]), (t_ns[row:], topic[row:])


def say_steps(name: str, steps: Sequence[RecorderStep], report: ImportReport) -> None:
    """State where the recorder of a file was set back.

    Args:
        name: Of the file.
        steps: Of its index.
        report: Receives them.
    """
    report.count("clock_jumps_back", len(steps))
    for step in steps:
        jump_s = -step.shift_ns / SECOND_NS
        values: dict[str, Value] = {"whose": "recorder", "jump_s": jump_s}
        values |= {"looks": looks} if (looks := looks_like(jump_s)) else {}
        report.warn(FindingKind.CLOCK_JUMP, sensor=name, times="without-it", **values)
