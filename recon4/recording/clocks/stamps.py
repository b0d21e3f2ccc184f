"""Stamps of messages against the times of their recording: single absurd ones are found."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.errors import UnknownFormat
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.clocks.names import known_offset_s, looks_like
from recon4.recording.clocks.tuning import FRAME_TIMES, STAMPS
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS


def require_forward(topic: str, head: Sequence[tuple[int, int]]) -> None:
    """Check that a topic was not recorded backward.

    Args:
        topic: Its name.
        head: Stamps and times of recording of its first messages [ns].

    Raises:
        UnknownFormat: If each stamp is earlier than the one before.
    """
    steps = np.diff([stamp for stamp, _ in head])
    if len(steps) >= STAMPS.ahead and np.all(steps < 0):
        raise UnknownFormat(CodedText("stamps-backward", topic=topic))


@dataclass(frozen=True, slots=True)
class RecorderJump:
    """One time the clock of a recorder was set, without which the times of recording go on."""

    t_ns: int
    """When it was set, in times that go on [ns]."""
    jump_ns: int
    """By how much; negative = back [ns]."""


class StampJumps:
    """By how much the clocks of the stamps of a bag were set while it was recorded."""

    def __init__(self) -> None:
        self._known_ns: list[int] = []
        self.of_recorder: list[RecorderJump] = []
        """Jumps of the recorder's clock, which may be that of the stamps, too."""

    def exact_ns(self, topic: str, measured_ns: int, report: ImportReport) -> int:
        """A jump as measured by one topic [ns]: the same for all topics, or a known difference.

        Args:
            topic: Whose stamps jumped.
            measured_ns: Later stamps minus earlier ones, less the time between them.
            report: Receives the count ``clock_jumps`` and a warning, once for all topics.
        """
        same_ns = min(STAMPS.same_jump_ns, abs(measured_ns) // 4)
        for known_ns in (*(one.jump_ns for one in self.of_recorder), *self._known_ns):
            if abs(known_ns - measured_ns) < same_ns:
                return known_ns
        jump_s = known_offset_s(measured_ns / SECOND_NS)
        self._known_ns.append(round(jump_s * SECOND_NS))
        looks = looks_like(jump_s)
        report.count("clock_jumps")
        report.warn(
            FindingKind.CLOCK_JUMP,
            sensor=topic,
            whose="sensor",
            jump_s=jump_s,
            times="without-it",
            **({"looks": looks} if looks else {}),
        )
        return self._known_ns[-1]


class StampClock:
    """Stamps of one topic: stamp minus time of recording changes slowly, or for good.

    Where it changes for good, the times of recording tell which clock was set. Stamps whose own
    clock was set go on without the jump, by `shift_ns`; those that go on as before are right, and
    the recorder paused.

    Below `STAMPS.other_ns` messages that are held up change it, too. Those arrive in a pause and a
    burst: stamps that step between messages that arrive evenly are of a clock that was set.
    """

    def __init__(
        self,
        head: Sequence[tuple[int, int]] = (),
        exact_ns: Callable[[int], int] = lambda measured_ns: measured_ns,
        of_recorder: Sequence[RecorderJump] = (),
    ) -> None:
        """Prepare.

        Args:
            head: Stamp and time of recording of the first messages [ns]; the first one alone may
                be wrong.
            exact_ns: A jump of the bag from one that was measured (`StampJumps`) [ns].
            of_recorder: Jumps of the recorder's clock: stamps by that clock show them, too.
        """
        known = [stamp - recorded for stamp, recorded in head if stamp > 0]
        self.offset_ns: int | None = int(np.median(known)) if known else None
        """Usual stamp minus time of recording; None = no stamp so far."""
        recorded = [recorded for stamp, recorded in head if stamp > 0]
        self._even_ns = STAMPS.even_ns + float(np.median(np.diff(recorded) if known[1:] else 0))
        """Messages follow each other within this, if none is held up [ns]."""
        self._usual_ns = float(self.offset_ns or 0)
        """Stamp minus time of recording, without those that were held up [ns]."""
        self.was_set = False
        """Whether the last stamp began another clock."""
        self.shift_ns = 0
        """To be added to stamps, because their clock was set."""
        self.set_before, self.set_ns = 0, 0
        """How many stamps before the last one were of the clock that it began, and by how much
        later they are [ns]: they seemed to be held up. Of meaning if it `was_set`."""
        self._exact_ns, self._of_recorder = exact_ns, of_recorder
        self._last: tuple[int, int] | None = None
        """The last sound stamp, and when it was recorded [ns]."""
        self._run, self._run_ns = 0, 0

    def is_sound(self, stamp_ns: int, recorded_ns: int) -> bool:
        """Whether a stamp is in its place; take them in order."""
        self.was_set, self.set_before, self.set_ns = False, 0, 0
        if stamp_ns <= 0:
            return False
        offset_ns = stamp_ns - recorded_ns
        if jump_ns := self._jump_with_recorder(offset_ns, recorded_ns):
            self.was_set = True
            self.shift_ns -= jump_ns
        elif self.offset_ns is not None and self._is_other(offset_ns, recorded_ns):
            far = abs(offset_ns - self.offset_ns) > STAMPS.other_ns
            near_ns = STAMPS.other_ns if far else STAMPS.step_ns // 2
            again = self._run and abs(offset_ns - self._run_ns) <= near_ns
            self._run, self._run_ns = (self._run + 1 if again else 1), offset_ns
            goes_on = far and self._goes_on(stamp_ns)
            if self._run < STAMPS.confirm:
                if not far:
                    return True
                # One that goes on was on its way when the recorder's clock was set.
                self._last = (stamp_ns, recorded_ns) if goes_on else self._last
                return goes_on
            self.was_set = True
            if not goes_on:
                usual_ns = self.offset_ns if far else round(self._usual_ns)
                self._go_on_without(offset_ns - usual_ns, recorded_ns)
            self.set_before = 0 if far else STAMPS.confirm - 1
        self._follow(offset_ns, recorded_ns)
        self.offset_ns, self._run = offset_ns, 0
        self._last = stamp_ns, recorded_ns
        return True

    def _follow(self, offset_ns: int, recorded_ns: int) -> None:
        """Update the usual offset; a burst of messages that were held up takes no time."""
        if self.was_set or self.offset_ns is None or self._last is None:
            self._usual_ns = float(offset_ns)
            return
        since_ns = min(max(recorded_ns - self._last[1], 0), self._even_ns)
        off_ns = min(max(offset_ns - self._usual_ns, -STAMPS.step_ns), STAMPS.step_ns)
        self._usual_ns += min(since_ns / STAMPS.usual_ns, 1.0) * off_ns

    def _is_other(self, offset_ns: int, recorded_ns: int) -> bool:
        """Whether a stamp seems to be of another clock: far away, or a step between even ones."""
        if self.offset_ns is None or abs(offset_ns - self.offset_ns) > STAMPS.other_ns:
            return self.offset_ns is not None
        if self._last is None or abs(offset_ns - self._usual_ns) <= STAMPS.step_ns:
            return False
        even = 0 <= recorded_ns - self._last[1] <= self._even_ns
        usual = abs(self.offset_ns - self._usual_ns) <= STAMPS.step_ns / 2
        return self._run > 0 or (even and usual)

    def _jump_with_recorder(self, offset_ns: int, recorded_ns: int) -> int:
        """By how much stamps jump as the recorder did [ns]; 0 = they do not.

        They do so soon after it was set, when messages that were on their way have arrived.
        """
        if self.offset_ns is None or self._last is None:
            return 0
        jump_ns, last_ns = offset_ns - self.offset_ns, self._last[1]
        for known in self._of_recorder:
            here = last_ns - STAMPS.travel_ns < known.t_ns <= recorded_ns
            if here and abs(jump_ns - known.jump_ns) < abs(known.jump_ns) / 2:
                return known.jump_ns
        return 0

    def _goes_on(self, stamp_ns: int) -> bool:
        return self._last is not None and 0 <= stamp_ns - self._last[0] <= STAMPS.other_ns

    def _go_on_without(self, jump_ns: int, recorded_ns: int) -> None:
        """Take out a jump of the stamps; none if the recording has a gap there, too."""
        if self._last is not None and 0 <= recorded_ns - self._last[1] <= STAMPS.other_ns:
            self.set_ns = self._exact_ns(jump_ns)
            self.shift_ns -= self.set_ns

    def expected_ns(self, recorded_ns: int) -> int:
        """What the stamp of a message would be, with the shift [ns]."""
        return recorded_ns + (self.offset_ns or 0) + self.shift_ns


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


def filled(t_ns: Times, sound: NDArray[np.bool_]) -> Times:
    """Times with those that are not sound taken from their neighbors; at an end, a step further."""
    if sound.all():
        return t_ns
    rows, known = np.flatnonzero(sound), t_ns[sound]
    filled = known[0] + np.interp(np.arange(len(t_ns)), rows, known - known[0]).astype(np.int64)
    step = int(np.median(np.diff(known))) if len(known) > 1 else FRAME_TIMES.assumed_ns
    ahead = np.minimum(np.arange(len(t_ns)) - rows[0], 0)
    behind = np.maximum(np.arange(len(t_ns)) - rows[-1], 0)
    return np.where(sound, t_ns, filled + step * (ahead + behind)).astype(np.int64)
