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
from recon4.recording.clocks.set_back import SetBack
from recon4.recording.clocks.stamp_order import StampOrder
from recon4.recording.clocks.stamps import StampClock
from recon4.recording.clouds.cloud_points import CloudDecoder
from recon4.recording.formats.bags import BagMessage
from recon4.recording.formats.cloud_tables import cloud_table, unread_fields
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
        self._set_back = SetBack()

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
        if self._stamps.was_set:
            self._even.forget()
        self._even.add(t_ns)
        self._topic = message.topic
        yield from self._decoded(self._order.push(t_ns, (message, cloud)))

    def flush(self) -> Iterator[Shots]:
        yield from self._decoded(self._order.flush())
        self._even.say(self._topic, self._report)
        self._report.count("clouds_late", self._order.too_late)

    def _decoded(self, clouds: Iterable[tuple[int, tuple[BagMessage, Any]]]) -> Iterator[Shots]:
        for t_ns, (message, cloud) in clouds:
            if unread := unread_fields(cloud):
                fields = ", ".join(unread[: LISTED.few])
                self._report.derive(DerivedKind.FIELDS_UNREAD, where=message.topic, fields=fields)
            try:
                table = cloud_table(cloud)
                shots = self._decoder.decode(table, t_ns=t_ns, period_ns=self._period_ns)
            except CorruptFile as error:
                self._report.count("messages_corrupt")
                self._report.details.setdefault("messages_corrupt", text_of(error))
                self._report.warn(FindingKind.MESSAGE_LEFT_OUT, where=message.topic, error=error)
                continue
            if len(shots):
                shots = moved(shots, self._offset_ns - self._late_ns(shots, t_ns, message.t_ns))
                note_lidar_lag(message.topic, message.t_ns - int(shots.t_ns[-1]), self._report)
                self._say_set_back(message.topic, int(shots.t_ns[0]))
                yield shots

    def _say_set_back(self, topic: str, start_ns: int) -> None:
        if back_ns := self._set_back.back_ns(start_ns):
            jump_s = -1e-9 * back_ns
            self._report.warn(
                FindingKind.CLOCK_JUMP, sensor=topic, whose="sensor", jump_s=jump_s, times="used"
            )

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
