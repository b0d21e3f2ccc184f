"""Clouds of one topic of a bag, in the order of their stamps."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from recon4.errors import CorruptFile
from recon4.locales.coded import text_of
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.recording.assembly.assembler import moved
from recon4.recording.assembly.shots import Shots
from recon4.recording.bags.messages import stamp_ns
from recon4.recording.bags.tuning import LIDAR_CHOICE
from recon4.recording.clocks.compare import note_lidar_lag
from recon4.recording.clocks.even_stamps import EvenStamps
from recon4.recording.clocks.set_back import say_set_back
from recon4.recording.clocks.stamp_order import StampOrder
from recon4.recording.clocks.stamps import StampClock
from recon4.recording.clouds.cloud_points import CloudDecoder
from recon4.recording.formats.bags import BagMessage
from recon4.recording.formats.cloud_tables import cloud_table, says_other_order, unread_fields
from recon4.recording.report import ImportReport
from recon4.recording.tuning import LISTED


class CloudReader:
    """Decodes messages of points, in the order of their stamps."""

    def __init__(
        self,
        decoder: CloudDecoder,
        offset_s: float,
        period_ns: int,
        *,
        stamps: StampClock,
        report: ImportReport,
    ) -> None:
        self._decoder, self._period_ns, self._report = decoder, period_ns, report
        self._stamps = stamps
        self._offset_ns = round(offset_s * 1e9)
        self._recent: deque[tuple[int, Any]] = deque(maxlen=LIDAR_CHOICE.copies_within)
        self._order: StampOrder[tuple[BagMessage, Any]] = StampOrder()
        self._even, self._topic = EvenStamps(), ""
        self._points_after_ns = 0
        """First point of a cloud after its stamp, before the clock was set back [ns]."""

    def push(self, message: BagMessage, cloud: Any) -> Iterator[Shots]:
        t_ns = stamp_ns(cloud.header.stamp)
        if not self._stamps.is_sound(t_ns, message.t_ns):
            self._report.count("stamps_missing" if t_ns <= 0 else "stamps_wrong")
            t_ns = self._stamps.expected_ns(message.t_ns)
        elif self._is_copy(t_ns, cloud.data):
            self._report.count("clouds_duplicate")
            return
        else:
            self._order.shift_last(self._stamps.set_before, -self._stamps.set_ns)
            t_ns += self._stamps.shift_ns
            self._decoder.stamps_set_ns = -self._stamps.shift_ns
        self._topic = message.topic
        steps = len(self._order.steps)
        certain = self._order.push(t_ns, (message, cloud))
        if self._stamps.was_set or len(self._order.steps) > steps:
            self._even.forget()
        self._even.add(t_ns + self._order.shift_ns)
        yield from self._decoded(certain)

    def flush(self) -> Iterator[Shots]:
        yield from self._decoded(self._order.flush())
        self._even.say(self._topic, self._report)
        say_set_back(self._topic, self._order.steps, self._report)
        self._report.count("clouds_late", self._order.too_late)

    def _decoded(self, clouds: Iterable[tuple[int, tuple[BagMessage, Any]]]) -> Iterator[Shots]:
        for t_ns, (message, cloud) in clouds:
            if unread := unread_fields(cloud):
                fields = ", ".join(unread[: LISTED.few])
                self._report.derive(DerivedKind.FIELDS_UNREAD, where=message.topic, fields=fields)
            try:
                other_order = says_other_order(cloud)
                if other_order:
                    self._report.count("clouds_other_order")
                    self._report.derive(DerivedKind.BYTES_ORDER, where=message.topic)
                table = cloud_table(cloud, other_order=other_order)
                shots = self._decoder.decode(table, t_ns=t_ns, period_ns=self._period_ns)
            except CorruptFile as error:
                self._report.count("messages_corrupt")
                self._report.details.setdefault("messages_corrupt", text_of(error))
                self._report.warn(FindingKind.MESSAGE_LEFT_OUT, where=message.topic, error=error)
                continue
            if len(shots):
                if self._decoder.absolute:
                    shots = self._with_points_set(shots, t_ns)
                shots = moved(shots, self._offset_ns - self._late_ns(shots, t_ns, message.t_ns))
                note_lidar_lag(message.topic, message.t_ns - int(shots.t_ns[-1]), self._report)
                yield shots

    def _with_points_set(self, shots: Shots, stamp_ns: int) -> Shots:
        """The points on the clock that goes on, if theirs is that of the stamps and was set back.

        Args:
            shots: With times of their own.
            stamp_ns: Of their cloud, on the clock that goes on.
        """
        back_ns = sum(step.back_ns for step in self._order.steps if stamp_ns > step.t_ns)
        after_ns = int(shots.t_ns[0]) - (stamp_ns - back_ns)
        if not back_ns:
            self._points_after_ns = after_ns
        set_too = abs(after_ns - self._points_after_ns) < back_ns / 2
        return moved(shots, back_ns) if set_too else shots

    def _late_ns(self, shots: Shots, stamp_ns: int, recorded_ns: int) -> int:
        """How much too late the points of a cloud are by its stamp [ns]."""
        last_ns = int(shots.t_ns[-1])
        if self._stamps.offset_ns is None and last_ns > recorded_ns:
            # Recorded when it was complete: no point is later.
            return max(self._period_ns, last_ns - recorded_ns)
        if self._decoder.absolute:
            return 0
        return self._even.late_ns(stamp_ns, shots.t_ns)

    def _is_copy(self, t_ns: int, data: Any) -> bool:
        """Whether a cloud was recorded before, as in bags that were merged."""
        copy = t_ns > 0 and any(
            t == t_ns and np.array_equal(other, data) for t, other in self._recent
        )
        self._recent.append((t_ns, data))
        return copy
