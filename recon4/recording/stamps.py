"""Stamps of messages against the times of their recording: single absurd ones are found."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

_OTHER_NS = 10_000_000_000
"""A stamp that is farther from its place among the others is wrong [ns]."""
_CONFIRM = 3
"""Stamps in a row that must agree on another clock: fewer are wrong ones."""


class StampClock:
    """Stamps of one topic: stamp minus time of recording changes slowly, or for good."""

    def __init__(self, head: Sequence[tuple[int, int]] = ()) -> None:
        """Prepare.

        Args:
            head: Stamp and time of recording of the first messages [ns]; the first one alone may
                be wrong.
        """
        known = [stamp - recorded for stamp, recorded in head if stamp > 0]
        self.offset_ns: int | None = int(np.median(known)) if known else None
        """Usual stamp minus time of recording; None = no stamp so far."""
        self._run, self._run_ns = 0, 0

    def is_sound(self, stamp_ns: int, recorded_ns: int) -> bool:
        """Whether a stamp is in its place; take them in order."""
        if stamp_ns <= 0:
            return False
        offset_ns = stamp_ns - recorded_ns
        if self.offset_ns is not None and abs(offset_ns - self.offset_ns) > _OTHER_NS:
            again = self._run and abs(offset_ns - self._run_ns) <= _OTHER_NS
            self._run, self._run_ns = (self._run + 1 if again else 1), offset_ns
            if self._run < _CONFIRM:
                return False
        self.offset_ns, self._run = offset_ns, 0
        return True

    def expected_ns(self, recorded_ns: int) -> int:
        """What the stamp of a message would be [ns]."""
        return recorded_ns + (self.offset_ns or 0)
