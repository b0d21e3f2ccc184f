"""A fair queue: small calls before large ones, turns between people, a bounded length."""

from __future__ import annotations

import asyncio
from collections import Counter
from dataclasses import dataclass, field

from recon4.locales.coded import CodedText
from recon4_app.compute_pool.model import Quota
from recon4_app.compute_pool.tuning import FAIRNESS
from recon4_app.errors import TooMany


@dataclass(eq=False, slots=True, kw_only=True)
class Slot:
    """The right to run one call, from `FairQueue.acquire` to `FairQueue.release`."""

    person: str
    large: bool
    passed: int = 0
    """Number of small calls that passed it."""
    granted: asyncio.Future[None] = field(
        default_factory=lambda: asyncio.get_running_loop().create_future()
    )


class FairQueue:
    """The slots of one lane."""

    def __init__(self, name: str, quota: Quota) -> None:
        self._name, self._quota = name, quota
        self._waiting: list[Slot] = []
        self._running: list[Slot] = []
        self._served: dict[str, int] = {}
        """Person -> number of the last call granted to them."""
        self._grants = 0

    @property
    def waiting(self) -> int:
        """Calls that wait."""
        return len(self._waiting)

    @property
    def running(self) -> int:
        """Calls that run."""
        return len(self._running)

    @property
    def granted(self) -> int:
        """Number of calls that were granted a slot."""
        return self._grants

    async def acquire(self, person: str, *, large: bool = False) -> Slot:
        """Wait for a slot; a canceled wait takes none.

        Raises:
            TooMany: If too many calls of this person, or of all, wait already.
        """
        slot = Slot(person=person, large=large)
        self._waiting.append(slot)
        self._grant()
        if not slot.granted.done():
            self._reject_excess(slot)
        try:
            await slot.granted
        except asyncio.CancelledError:
            if slot in self._running:
                self.release(slot)
            else:
                self._waiting.remove(slot)
            raise
        return slot

    def release(self, slot: Slot) -> None:
        """Release a slot to the next call."""
        self._running.remove(slot)
        self._grant()

    def _reject_excess(self, slot: Slot) -> None:
        quota = self._quota
        own = sum(one.person == slot.person for one in self._waiting)
        if own <= quota.waiting_per_person and len(self._waiting) <= quota.waiting:
            return
        self._waiting.remove(slot)
        lane = str(self._name)
        reason = (
            CodedText("own-waiting", limit=quota.waiting_per_person, name=slot.person, lane=lane)
            if own > quota.waiting_per_person
            else CodedText("all-waiting", limit=quota.waiting, lane=lane)
        )
        raise TooMany(
            reason,
            retry_after_s=quota.retry_after_s,
        )

    def _grant(self) -> None:
        while len(self._running) < self._quota.slots and (slot := self._next()) is not None:
            self._waiting.remove(slot)
            self._running.append(slot)
            if not slot.large:
                for other in self._waiting:
                    other.passed += other.large
            self._grants += 1
            self._remember(slot.person)
            slot.granted.set_result(None)

    def _next(self) -> Slot | None:
        """The next call: small first, then the person served least recently, then first come."""
        running = Counter(slot.person for slot in self._running)
        large = sum(slot.large for slot in self._running)
        eligible = [
            slot
            for slot in self._waiting
            if running[slot.person] < self._quota.per_person
            and (not slot.large or large < self._quota.large_slots)
        ]
        return min(
            eligible,
            key=lambda slot: (
                slot.large and slot.passed < FAIRNESS.max_passed,
                running[slot.person],
                self._served.get(slot.person, 0),
            ),
            default=None,
        )

    def _remember(self, person: str) -> None:
        """Record who was served; remove people without waiting calls."""
        self._served[person] = self._grants
        if len(self._served) > 1000:
            present = {slot.person for slot in (*self._waiting, *self._running)}
            self._served = {one: n for one, n in self._served.items() if one in present}
