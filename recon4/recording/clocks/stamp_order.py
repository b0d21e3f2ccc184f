"""Puts the messages of one topic into the order of their stamps: some are recorded late."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Generic, TypeVar

from recon4.recording.clocks.set_back import ClockStep, newest_fall_ns
from recon4.recording.clocks.tuning import SET_BACK, STAMPS

Item = TypeVar("Item")


@dataclass(slots=True)
class StampOrder(Generic[Item]):
    """Order of the messages of one topic.

    A busy computer records some messages after those that follow them. Such a message is put
    where its stamp says. If the stamps stay earlier, the clock was set back: then the order of
    recording is kept, and where they follow each other well enough (`set_back.py`), they go on.
    """

    too_late: int = 0
    """Messages left out because later ones had been handed on before."""
    steps: list[ClockStep] = field(default_factory=list)
    """Where the clock was set back, and the stamps go on."""
    shift_ns: int = 0
    """What is added to stamps for that by now [ns]."""
    _arrived_ns: list[int] = field(default_factory=list)
    """The last stamps in the order of recording, with the shift [ns]."""
    _held: list[tuple[int, Item]] = field(default_factory=list)
    """Stamps [ns] and messages, as recorded."""
    _newest_ns: int | None = None
    """Stamp of the last message handed on."""

    def push(self, stamp_ns: int, item: Item) -> list[tuple[int, Item]]:
        """Add a message in the order of recording; returns those whose order is certain."""
        self._held.append((stamp_ns + self.shift_ns, item))
        self._arrived_ns = [*self._arrived_ns, stamp_ns + self.shift_ns][-SET_BACK.recent :]
        self._go_on()
        count = len(self._held)
        waits = count <= STAMPS.most_ahead and self._may_be_set_back()
        return self._next(ended=False) if count > STAMPS.ahead and not waits else []

    def _go_on(self) -> None:
        """Let the newest stamps go on if they show that the clock was set back."""
        back_ns = newest_fall_ns(self._arrived_ns)
        newest = [stamp for stamp, _ in self._held[-SET_BACK.around :]]
        if back_ns and newest == self._arrived_ns[-SET_BACK.around :]:
            self.steps.append(ClockStep(self._arrived_ns[-SET_BACK.around - 1], back_ns))
            self.shift_last(SET_BACK.around, back_ns)
            self.shift_ns += back_ns

    def _may_be_set_back(self) -> bool:
        """Whether too few stamps came since one went back to say why."""
        newest = self._arrived_ns[-SET_BACK.around :]
        return any(after < before for before, after in pairwise(newest))

    def shift_last(self, count: int, shift_ns: int) -> None:
        """Move messages that were added last and not handed on; their clock had been set."""
        for row in range(max(0, len(self._held) - count), len(self._held)):
            stamp_ns, item = self._held[row]
            self._held[row] = stamp_ns + shift_ns, item
        for row in range(max(0, len(self._arrived_ns) - count), len(self._arrived_ns)):
            self._arrived_ns[row] += shift_ns

    def flush(self) -> list[tuple[int, Item]]:
        """The remaining messages."""
        found = []
        while self._held:
            found += self._next(ended=True)
        return found

    def _next(self, *, ended: bool) -> list[tuple[int, Item]]:
        """The next message; nothing if it is too late."""
        stamps = [stamp for stamp, _ in self._held]
        newest_ns = min(stamps) if self._newest_ns is None else self._newest_ns
        row = 0
        if stamps[0] >= newest_ns or _is_late(stamps, newest_ns, ended=ended):
            for k in range(1, len(stamps)):
                earlier = stamps[k] < stamps[row]
                if earlier and _is_late(stamps[k:], max(stamps[:k]), ended=ended):
                    row = k
            if stamps[row] < newest_ns:
                self.too_late += 1
                self._held.pop(row)
                return []
        self._newest_ns = stamps[row]
        return [self._held.pop(row)]


def _is_late(stamps: list[int], before_ns: int, *, ended: bool) -> bool:
    """Whether stamps go on after an earlier one, or end so soon that no clock was set."""
    return max(stamps) >= before_ns or (ended and len(stamps) < STAMPS.set_back)
