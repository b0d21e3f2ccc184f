"""Stamps of messages against the times of their recording: single absurd ones are found."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.tuning_times import STAMPS


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
        self.was_set = False
        """Whether the last stamp began another clock."""
        self._run, self._run_ns = 0, 0

    def is_sound(self, stamp_ns: int, recorded_ns: int) -> bool:
        """Whether a stamp is in its place; take them in order."""
        self.was_set = False
        if stamp_ns <= 0:
            return False
        offset_ns = stamp_ns - recorded_ns
        if self.offset_ns is not None and abs(offset_ns - self.offset_ns) > STAMPS.other_ns:
            again = self._run and abs(offset_ns - self._run_ns) <= STAMPS.other_ns
            self._run, self._run_ns = (self._run + 1 if again else 1), offset_ns
            if self._run < STAMPS.confirm:
                return False
            self.was_set = True
        self.offset_ns, self._run = offset_ns, 0
        return True

    def expected_ns(self, recorded_ns: int) -> int:
        """What the stamp of a message would be [ns]."""
        return recorded_ns + (self.offset_ns or 0)


def strays(t_ns: Times) -> NDArray[np.bool_]:
    """Which times are single ones of another time, far from their neighbors, (N,).

    None if there are many: then the times are only out of order.

    Args:
        t_ns: Times in order of arrival [ns], (N,).
    """
    if len(t_ns) < STAMPS.confirm:
        return np.zeros(len(t_ns), np.bool_)
    t = t_ns.astype(np.float64)  # differences of damaged times may not fit into 64 bits
    around = np.lib.stride_tricks.sliding_window_view(np.pad(t, 2, mode="reflect"), 5)
    step_ns = np.median(np.abs(np.diff(t)))
    far = np.abs(t - np.median(around, axis=1)) > max(STAMPS.other_ns, 5.0 * step_ns)
    return np.asarray(far & (np.count_nonzero(far) <= STAMPS.strays_ratio * len(t_ns)))
