"""Times of points that are nanoseconds of one clock by the definition of their message."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.clocks.names import offset_values
from recon4.recording.clocks.tuning import POINT_CLOCK
from recon4.recording.report import ImportReport


class ExactClock:
    """Moves the times of one sensor's points to the clock of the stamps of its clouds.

    The points' own clock counts: drivers repeat stamps, or give a frame that of its end. Only the
    offset of the two clocks is taken from the stamps, once, and again if it jumps.
    """

    def __init__(self, name: str, report: ImportReport) -> None:
        """Start without an offset.

        Args:
            name: Of the sensor.
            report: Receives the counts ``clock_jumps``, ``clouds_wrong_times`` and
                ``points_wrong_time``.
        """
        self._name, self._report = name, report
        self._offset_ns: int | None = None
        self.stamps_set_ns = 0
        """By how much the clock of the stamps was set while they were recorded; it is taken out of
        the stamps [ns]."""
        self._set_ns = 0
        """The part of it by which the clock of the points was set, too."""
        self._others: list[int] = []
        """Offsets by the last clouds that contradict the known one [ns]."""

    def times(self, values: Times, *, t_ns: int, period_ns: int) -> tuple[Times, NDArray[np.bool_]]:
        """Times of the points of a cloud [ns], and which are sound, (N,) each.

        Args:
            values: In firing order where all are equal, which is a fault: then they are spread over
                the time to the next cloud; (N,), N > 0.
            t_ns: Stamp of the cloud.
            period_ns: Time from cloud to cloud.
        """
        middle = int(np.sort(values)[len(values) // 2])
        sound = np.abs(values - middle) <= POINT_CLOCK.far_ns
        self._report.count("points_wrong_time", len(values) - int(np.count_nonzero(sound)))
        first = int(values[sound].min())
        if len(values) >= POINT_CLOCK.many_points and first == int(values[sound].max()):
            self._report.count("clouds_wrong_times")
            self._report.details.setdefault(
                "clouds_wrong_times",
                CodedText("detail-one-time", sensor=self._name),
            )
            values = first + (np.arange(len(values)) * period_ns) // len(values)
        return values + self.offset_ns(first, t_ns), sound

    def offset_ns(
        self, first_ns: int, t_ns: int, *, same_ns: float = POINT_CLOCK.same_clock_ns
    ) -> int:
        """Clock of the stamps minus that of the points [ns]; it stays until it jumps.

        Args:
            first_ns: First point of a cloud.
            t_ns: Stamp of the cloud.
            same_ns: The clocks are one if the first cloud is nearer to its stamp.
        """
        ahead = t_ns - first_ns
        if self._offset_ns is None:
            self._offset_ns = 0 if abs(ahead) < same_ns else ahead
            if self._offset_ns:
                self._report.derive(
                    DerivedKind.CLOCK_OF_POINTS,
                    where=self._name,
                    first=True,
                    **offset_values(-ahead * 1e-9),
                )
        if abs(ahead - self._offset_ns) <= POINT_CLOCK.jump_ns:
            self._others = []
            return self._offset_ns
        along_ns = self.stamps_set_ns - self._set_ns
        if along_ns and abs(ahead + along_ns - self._offset_ns) <= POINT_CLOCK.jump_ns:
            self._set_ns, self._offset_ns = self.stamps_set_ns, self._offset_ns - along_ns
            self._others = []
            return self._offset_ns
        self._others = [*self._others, ahead][-POINT_CLOCK.confirm :]
        if len(self._others) == POINT_CLOCK.confirm and np.ptp(self._others) < POINT_CLOCK.jump_ns:
            jump_s = (self._offset_ns - ahead) * 1e-9
            self._report.count_jump(self._name)
            self._report.warn(
                FindingKind.CLOCK_JUMP,
                sensor=self._name,
                whose="points",
                jump_s=jump_s,
                times="by-stamps",
            )
            self._offset_ns, self._others = ahead, []
        return self._offset_ns
