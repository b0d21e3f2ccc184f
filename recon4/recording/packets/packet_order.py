"""Puts the packets of one sensor in order of time, each once."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.tuning import PACKET_ORDER
from recon4.recording.report import ImportReport


@dataclass(slots=True, eq=False)
class PacketOrder:
    """Puts packets in order of time, each once.

    Packets that follow each other without a hole are given at once: none can still come between.
    """

    window_ns: int
    """Packets that are late by at most this are put in their place [ns]."""
    report: ImportReport
    _t_ns: Times = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    _payloads: Payloads = field(default_factory=lambda: np.zeros((0, 0), dtype=np.uint8))
    _given: Times = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    _behind: int = 0
    step_ns: int = 0
    """Usual time from one packet to the next [ns]; 0 = not known, then all wait."""
    is_set_back: bool = False
    """Whether packets after a clock was set back were given since a reader put this to False."""
    _is_jump_held: bool = False
    """Whether the first of these are still held."""
    _arrived_ns: int | None = None

    def push_arrived(
        self, t_ns: Times, payloads: Payloads, t_arrival_ns: Times
    ) -> tuple[Times, Payloads]:
        """As `push`, of packets whose arrival tells whether the clocks were set back together.

        Packets then arrive earlier than those before, as their stamps are: no network does that.

        Args:
            t_ns: Times of the packets [ns], (N,).
            payloads: Their bytes, N rows.
            t_arrival_ns: When they arrived [ns], (N,).
        """
        row = self._set_together(t_ns, t_arrival_ns)
        if row is not None:
            return self._over_a_jump(t_ns, payloads, row)
        return self.push(t_ns, payloads)

    def _set_together(self, t_ns: Times, t_arrival_ns: Times) -> int | None:
        """The row from which times and arrivals are earlier, of packets that are no copies."""
        if not len(t_ns):
            return None
        known = [t for t in (self._given, self._t_ns) if len(t)]
        newest = max((int(t[-1]) for t in known), default=int(t_ns[0]))
        arrived = int(t_arrival_ns[0]) if self._arrived_ns is None else self._arrived_ns
        self._arrived_ns = int(t_arrival_ns[-1])
        earlier = np.ones(len(t_ns), np.bool_)
        for times, last in ((t_ns, newest), (t_arrival_ns, arrived)):
            latest = np.maximum.accumulate(np.append(last, times[:-1]))
            earlier &= times < latest - PACKET_ORDER.together_ns
        rows = np.flatnonzero(earlier)[: PACKET_ORDER.stragglers]
        in_a_row = len(rows) == PACKET_ORDER.stragglers and rows[-1] - rows[0] == len(rows) - 1
        if not in_a_row or np.isin(t_ns[rows], np.concatenate([*known, t_ns[: rows[0]]])).any():
            return None
        return int(rows[0])

    def push(self, t_ns: Times, payloads: Payloads) -> tuple[Times, Payloads]:
        """Take packets, give those that are older than the window or whose place is sure.

        Counts ``packets_out_of_order`` (repaired), ``packets_duplicate`` (a packet with the same
        time was there) and ``packets_late`` (its place has been passed).
        """
        if not len(t_ns):
            return self._give(self._t_ns, self._payloads, 0)
        newest = max(
            (int(times[-1]) for times in (self._t_ns, self._given) if len(times)), default=0
        )
        jump = self._jump(t_ns, newest)
        if jump is not None:
            return self._over_a_jump(t_ns, payloads, jump)
        tidy = t_ns[0] > newest and np.all(t_ns[1:] > t_ns[:-1])
        t_ns = np.concatenate([self._t_ns, t_ns])
        if len(self._payloads):
            payloads = np.concatenate([self._payloads, payloads])
        if not tidy:
            t_ns, payloads = self._sorted(t_ns, payloads)
        ready = int(np.searchsorted(t_ns, t_ns[-1:] - self.window_ns)[0]) if len(t_ns) else 0
        return self._give(t_ns, payloads, max(ready, self._joined(t_ns)))

    def _joined(self, t_ns: Times) -> int:
        """How many sorted packets follow the last one given without a hole."""
        if not self.step_ns or not len(self._given):
            return 0
        steps = np.diff(t_ns, prepend=self._given[-1])
        holes = np.flatnonzero(steps > 1.5 * self.step_ns)
        return int(holes[0]) if len(holes) else len(t_ns)

    def _jump(self, t_ns: Times, newest: int) -> int | None:
        """The row from which most packets are far behind, if these are no stragglers."""
        latest = np.maximum.accumulate(np.append(newest, t_ns[:-1]))
        rows = np.flatnonzero(t_ns < latest - PACKET_ORDER.set_back_ns)
        if not len(rows) or 2 * len(rows) <= len(t_ns) - rows[0]:
            self._behind = 0
            return None
        self._behind += len(rows)
        if self._behind < PACKET_ORDER.stragglers:
            return None
        self._behind = 0
        return int(rows[0])

    def _over_a_jump(self, t_ns: Times, payloads: Payloads, row: int) -> tuple[Times, Payloads]:
        """All before a clock was set back at a row, then the rest in an order of its own."""
        parts = [self.push(t_ns[:row], payloads[:row]), self.flush()]
        self._given, self._is_jump_held = self._given[:0], True
        parts.append(self.push(t_ns[row:], payloads[row:]))
        times, packets = zip(*parts, strict=True)
        return np.concatenate(times), np.concatenate(packets)

    def _sorted(self, t_ns: Times, payloads: Payloads) -> tuple[Times, Payloads]:
        backward = np.diff(t_ns, prepend=t_ns[0]) < 0
        order = np.argsort(t_ns, kind="stable")
        t_ns, payloads = t_ns[order], payloads[order]
        kept = self._new(t_ns)
        self.report.count("packets_out_of_order", int((backward & kept[np.argsort(order)]).sum()))
        return t_ns[kept], payloads[kept]

    def flush(self) -> tuple[Times, Payloads]:
        """Give the rest."""
        return self._give(self._t_ns, self._payloads, len(self._t_ns))

    def _give(self, t_ns: Times, payloads: Payloads, ready: int) -> tuple[Times, Payloads]:
        self._t_ns, self._payloads = t_ns[ready:], payloads[ready:]
        if ready and self._is_jump_held:
            self._is_jump_held, self.is_set_back = False, True
        given = np.concatenate([self._given, t_ns[:ready]])
        keep_from = np.searchsorted(given, given[-1] - 20 * self.window_ns) if len(given) else 0
        self._given = given[keep_from:]
        return t_ns[:ready], payloads[:ready]

    def _new(self, t_ns: Times) -> NDArray[np.bool_]:
        """Which of the sorted times were not seen before and are not behind what was given."""
        repeated = np.zeros(len(t_ns), dtype=np.bool_)
        repeated[1:] = t_ns[1:] == t_ns[:-1]
        if len(self._given):
            repeated |= np.isin(t_ns, self._given)
            late = ~repeated & (t_ns < self._given[-1])
        else:
            late = np.zeros_like(repeated)
        self.report.count("packets_duplicate", int(repeated.sum()))
        self.report.count("packets_late", int(late.sum()))
        return ~(repeated | late)
