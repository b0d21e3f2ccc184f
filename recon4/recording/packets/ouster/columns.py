"""The columns of Ouster's data packets: numbers, times, and what can be wrong with them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.limits import LIMITS
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.ouster.facts import COLUMNS_PER_TURN
from recon4.recording.packets.ouster.layouts import MAX_COLUMNS, TYPE_DATA, PacketLayout
from recon4.recording.packets.ouster.tuning import OUSTER_COLUMNS


@dataclass(frozen=True)
class Columns:
    """Columns of P packets of C columns each."""

    number: NDArray[np.int64]
    """Place in the revolution, from 0, (P, C)."""
    stamp_ns: Times
    """Clock of the sensor [ns], (P, C)."""
    valid: NDArray[np.bool_]
    """Whether it was measured, (P, C)."""

    @cached_property
    def first(self) -> NDArray[np.intp]:
        """The first valid column of each packet; 0 if there is none, (P,)."""
        return np.argmax(self.valid, axis=1)

    def at_first(self, values: NDArray[np.int64]) -> NDArray[np.int64]:
        """Values of the first valid columns, (P, C) -> (P,)."""
        return values[np.arange(len(values)), self.first]

    @property
    def since_ns(self) -> Times:
        """Time after the first valid column of the packet [ns], (P, C)."""
        return self.stamp_ns - self.at_first(self.stamp_ns)[:, None]


def columns_of(layout: PacketLayout, payloads: Payloads) -> Columns:
    """The columns of payloads of the size of the layout."""
    columns = layout.records(payloads)["columns"]
    return Columns(
        columns["number"].astype(np.int64),
        columns["stamp_ns"].astype(np.int64),
        (columns["status"] & 1).astype(np.bool_),
    )


def wrong_type(layout: PacketLayout, payloads: Payloads) -> NDArray[np.bool_]:
    """Which packets say that they are something else than points, (P,)."""
    if layout.profile.has_header:
        return np.asarray(layout.records(payloads)["header"]["type"] != TYPE_DATA)
    status = layout.records(payloads)["columns"]["status"]
    return np.asarray(((status != 0) & (status != 0xFFFFFFFF)).any(axis=1))


def wrong_numbers(columns: Columns, columns_per_turn: int) -> NDArray[np.bool_]:
    """Which packets have columns that do not follow each other, or beyond a revolution, (P,)."""
    place = columns.number - np.arange(columns.number.shape[1])
    apart = (place - columns.at_first(place)[:, None]) % columns_per_turn != 0
    return np.asarray((columns.valid & (apart | (columns.number >= columns_per_turn))).any(axis=1))


def wrong_times(columns: Columns) -> NDArray[np.bool_]:
    """Which packets have columns whose times make no sense or go back, (P,)."""
    stamp, since = columns.stamp_ns, columns.since_ns
    latest = np.maximum.accumulate(np.where(columns.valid, since, 0), axis=1)
    wrong = (
        (stamp < 0)
        | (stamp > LIMITS.latest_ns)
        | (since < latest)
        | (since > OUSTER_COLUMNS.longest_ns)
    )
    return np.asarray((columns.valid & wrong).any(axis=1))


def sound_columns(
    layout: PacketLayout, payloads: Payloads, columns_per_turn: int = MAX_COLUMNS
) -> NDArray[np.bool_]:
    """Which payloads of the size of a layout are data packets of it with a valid column, (P,)."""
    columns = columns_of(layout, payloads)
    wrong = wrong_type(layout, payloads) | wrong_times(columns)
    wrong |= wrong_numbers(columns, columns_per_turn)
    return ~wrong & columns.valid.any(axis=1)


def column_step_ns(columns: Columns) -> float:
    """Usual time from one column to the next [ns]; NaN = not known.

    The motor is not even within a packet: the time of a whole packet counts.
    """
    count = columns.valid.shape[1]
    last = count - 1 - np.argmax(columns.valid[:, ::-1], axis=1)
    passed = last - columns.first
    since = columns.since_ns[np.arange(len(last)), last]
    steps = since[passed > 0] / passed[passed > 0]
    return float(np.median(steps)) if len(steps) else float("nan")


def columns_in_turn(columns: Columns) -> int:
    """Columns in a revolution, from where the numbers of sound packets start again; 0 = not seen.

    The times tell how many columns were passed from one packet to the next.
    """
    number, stamp = columns.at_first(columns.number), columns.at_first(columns.stamp_ns)
    order = np.argsort(stamp, kind="stable")
    number, since = np.diff(number[order]), np.diff(stamp[order])
    step_ns = column_step_ns(columns)
    again = (number < 0) & (since < OUSTER_COLUMNS.pause_ns)
    if not again.any() or not step_ns > 0:
        return 0
    seen = np.median(since[again] / step_ns - number[again])
    nearest = int(COLUMNS_PER_TURN[np.argmin(np.abs(COLUMNS_PER_TURN - seen))])
    return nearest if abs(seen - nearest) < 0.05 * nearest else 0
