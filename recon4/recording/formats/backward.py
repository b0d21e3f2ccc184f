"""Bags that were recorded backward: stamps fall while the times of recording rise.

A recording that was played in reverse is such a bag. It is read from its end to its begin, as if it
had been recorded in the order of its stamps; no more of it is in memory than of any other bag.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.model.derived_kinds import DerivedKind
from recon4.recording.clocks.tuning import STAMPS
from recon4.recording.formats.chunks import BagIndex, RawMessage
from recon4.recording.report import ImportReport


class HeadedFile(Protocol):
    """One storage file of a bag."""

    ros1: bool
    index: BagIndex
    report: ImportReport

    def messages(self, topics: set[str]) -> Iterator[RawMessage]:
        """Messages of some topics in order of time."""
        ...


def turn_round(sources: Sequence[HeadedFile], headed: set[str], report: ImportReport) -> None:
    """Read a bag from its end if the stamps of all topics fall from message to message.

    Args:
        sources: Its storage files.
        headed: Topics whose messages begin with a header.
        report: Receives that it was done, and of how many messages.
    """
    filled = [one for one in sources if one.index.message_count]
    steps = [step for one in filled for step in _steps(one, headed)]
    if not steps or not all(np.all(step < 0) for step in steps):
        return
    first_ns = min(one.index.start_time for one in filled)
    last_ns = max(one.index.end_time for one in filled) - 1
    for one in filled:
        one.index.mirror_ns = first_ns + last_ns
    messages = sum(one.index.message_count for one in filled)
    report.derive(DerivedKind.RECORDED_BACKWARD, messages=messages)


def _steps(source: HeadedFile, headed: set[str]) -> list[NDArray[np.int64]]:
    """Steps of the first stamps of each topic of a file that has enough of them [ns]."""
    stamps: dict[str, list[int]] = {}
    before, source.report = source.report, ImportReport()  # damage is said when it is read
    with suppress(CorruptFile):
        for topic, _, _, data in islice(source.messages(headed), STAMPS.head if headed else 0):
            stamps.setdefault(topic, []).append(_stamp_ns(data, ros1=source.ros1))
    source.report = before
    return [np.diff(found) for found in stamps.values() if len(found) > STAMPS.ahead]


def _stamp_ns(data: bytes, *, ros1: bool) -> int:
    """The stamp of the header with which a message begins [ns]; 0 if it ends before."""
    if len(data) < 12:
        return 0
    order = "<" if ros1 or data[1:2] != b"\0" else ">"
    seconds, nanoseconds = struct.unpack_from(f"{order}iI", data, 4)
    return int(seconds) * 1_000_000_000 + int(nanoseconds)
