"""Converts the timestamps of a sensor to absolute time by means of times of arrival."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.packets.hours import nearest_hour
from recon4.recording.packets.tuning import CLOCKS
from recon4.recording.report import ImportReport
from recon4.units import HOUR_NS, HOUR_US, SECOND_NS


class SensorClock:
    """Converts the timestamps of one sensor to absolute time by means of arrival times.

    The stamp tells the time within the hour, the time of arrival tells the hour. Without GPS the
    stamps of some sensors run on past the full hour, up to 2^32 µs: such times are continued, also
    over the wrap of the counter, and counted (``packets_past_hour``). Then

    - a sensor that is synchronized by GPS (its position packets prove it) or that agrees with
      the recorder's clock within half a second keeps its own time;
    - any other sensor runs freely, its stamps count from when it was switched on: they are
      shifted to the recorder's clock, by the packet that traveled fastest, and the shift follows
      the drift of the two clocks from one 10 s to the next. Where GPS drives another sensor, the
      recorder's clock counts as corrected by it. The report says so: as a note of
      the only LiDAR, whose own time is all that the points need; as a warning where the points of
      several LiDARs must fit.

    A jump of either clock (GPS lock won, recorder's clock set) leaves the output continuous, is
    counted (``clock_jumps``) and warned of. Single packets off by more than a second are dropped.
    The sensor's clock jumped where its stamps step while packets arrive evenly, and the recorder's
    where stamps go on and packets arrive earlier or later by one amount for seconds; packets that
    were held up, however long, arrive in a burst.
    """

    def __init__(
        self,
        name: str,
        *,
        packet_s: float,
        report: ImportReport,
        utc_offset_ns: int | None = None,
        alone: bool = True,
    ) -> None:
        """Prepare.

        Args:
            name: Of the sensor, for messages.
            packet_s: Time from the first shot of a packet to when it is sent [s].
            report: Where jumps and derived times are noted.
            utc_offset_ns: UTC minus time of arrival [ns] when GPS is known to drive the sensor.
            alone: Whether it is the only LiDAR.
        """
        self.past_hour = True
        """Whether its stamps count from the full hour; others are absolute, or count from when it
        was switched on."""
        self.utc_offset_ns = utc_offset_ns
        self._name, self._alone = name, alone
        self._report = report
        self._packet_ns = round(packet_s * SECOND_NS)
        self._offset_ns: int | None = None
        self._runs_on = False
        """Whether stamps past the full hour have been seen."""
        self._turned_us = 0
        """Wraps of such a counter so far [µs]."""
        self._shift_ns = 0
        self._base_ns = 0
        """UTC minus the recorder's clock, if GPS drives another sensor and not this one."""
        self._rate = 0.0
        self._since_ns = 0
        self._window: list[int] = []
        self._block: list[Times] = []
        """Arrival minus expected and minus sensor's time, (2, n), of the block being filled."""
        self._filled = 0
        self._host_jump_ns = 0
        self._free_running = False
        self._last = (0, 0)
        self._run, self._run_ns = 0, 0
        self._apart: list[tuple[int, int]] = []
        """Time and deviation [ns] of the last blocks that arrived too early or late."""
        self._went_back = False
        """Whether packets arrived before those ahead of them, since the last jump."""
        if utc_offset_ns is not None:
            report.utc_ahead_ns = utc_offset_ns

    @property
    def is_utc(self) -> bool:
        """Whether GPS drives the sensor, so that its time is UTC."""
        return self.utc_offset_ns is not None

    def push_ns(self, t_arrival_ns: Times, stamps_ns: Times) -> tuple[Times, NDArray[np.bool_]]:
        """As `push`, of stamps in ns: only their place within the hour counts."""
        t_us, rest_ns = self._within_hour(stamps_ns)
        t_ns, kept = self.push(t_arrival_ns, t_us)
        return t_ns + rest_ns, kept

    def at_ns(self, t_arrival_ns: Times, stamps_ns: Times) -> tuple[Times, NDArray[np.bool_]]:
        """As `at`, of stamps in ns."""
        t_us, rest_ns = self._within_hour(stamps_ns)
        t_ns, valid = self.at(t_arrival_ns, t_us)
        return t_ns + rest_ns, valid

    def _within_hour(self, stamps_ns: Times) -> tuple[Times, Times]:
        """Stamps [µs], of an absolute clock past the hour, and the rest below a microsecond [ns].

        A clock that counts from the hour may run on past it: `push` continues such stamps.
        """
        t_us, rest_ns = np.divmod(np.asarray(stamps_ns, np.int64), 1000)
        return (t_us if self.past_hour else t_us % HOUR_US), rest_ns

    def push(
        self, t_arrival_ns: Times, t_us: NDArray[np.integer]
    ) -> tuple[Times, NDArray[np.bool_]]:
        """Absolute times of data packets, and which of them are valid.

        Args:
            t_arrival_ns: Times of arrival [ns], (N,).
            t_us: Stamps [µs past the hour], (N,).

        Returns:
            Times [ns], (N,), and a mask, (N,); the others are counted as ``packets_wrong_clock``.
        """
        if not len(t_us):
            return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.bool_)
        if self._offset_ns is None:
            self._start(t_arrival_ns, t_us)
        parts = []
        start = 0
        while start < len(t_us):
            rows = slice(start, start + CLOCKS.block - self._filled)
            parts.append(self._push_part(t_arrival_ns[rows], t_us[rows]))
            start = rows.stop
        t_ns, kept = (np.concatenate(part) for part in zip(*parts, strict=True))
        self._count_past_hour(t_us[kept])
        return t_ns, kept

    def _count_past_hour(self, t_us: NDArray[np.integer]) -> None:
        past = int(np.count_nonzero(t_us >= HOUR_US))
        self._report.count("packets_past_hour", past)
        if past:
            self._report.derive(DerivedKind.CLOCK_PAST_HOUR, sensor=self._name)

    def _continued(self, t_us: NDArray[np.integer], expected: Times) -> NDArray[np.int64]:
        """Stamps with the wraps of a counter that runs on past the hour added [µs], (N,)."""
        raw = np.asarray(t_us, dtype=np.int64)
        self._runs_on = self._runs_on or bool(np.any(raw >= HOUR_US))
        stamps = raw + self._turned_us
        if not self._runs_on:
            return stamps
        for turned_us in (self._turned_us + CLOCKS.counter_us, self._turned_us - CLOCKS.counter_us):
            off_ns = np.abs(nearest_hour(raw + turned_us, expected) - expected)
            odd = np.abs(nearest_hour(stamps, expected) - expected) > CLOCKS.jump_ns
            stamps = np.where(odd & (off_ns < CLOCKS.jump_ns), raw + turned_us, stamps)
        return stamps

    def _push_part(
        self, t_arrival_ns: Times, t_us: NDArray[np.integer]
    ) -> tuple[Times, NDArray[np.bool_]]:
        """Packets of one block, within which the offset of the clocks is constant."""
        assert self._offset_ns is not None
        expected = t_arrival_ns + self._offset_ns
        raw, t_us = t_us, self._continued(t_us, expected)
        self._turned_us = int(t_us[-1]) - int(raw[-1])
        t_sensor = self._time(t_us, expected)
        deviation = t_sensor - expected
        steps = np.flatnonzero(self._stepped(t_arrival_ns, t_sensor, deviation))
        # Packets that come late are few: after them the others go on.
        stepped = len(steps) and np.median(np.abs(deviation[steps[0] :])) > CLOCKS.step_ns
        if stepped or np.any(self._odd(t_sensor, deviation)):
            return self._push_one_by_one(t_arrival_ns, t_us)
        t_ns = t_sensor + self._shift(t_sensor)
        self._follow(t_arrival_ns, t_sensor, deviation)
        return t_ns, np.ones(len(t_us), dtype=np.bool_)

    def at(self, t_arrival_ns: Times, t_us: NDArray[np.integer]) -> tuple[Times, NDArray[np.bool_]]:
        """Absolute times of other packets of the sensor [ns], and which are valid, (N,) each.

        Does not update the offset of the clocks.
        """
        if not len(t_us):
            return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.bool_)
        offset = self._offset_ns if self._offset_ns is not None else self._start(t_arrival_ns, t_us)
        expected = t_arrival_ns + offset
        t_sensor = self._time(self._continued(t_us, expected), expected)
        deviation = t_sensor - expected
        off_ns = np.minimum(np.abs(deviation), np.abs(deviation - self._early_ns()))
        # Less until the jump of its clock is confirmed.
        valid = off_ns <= (CLOCKS.step_ns if self._run else CLOCKS.jump_ns)
        return t_sensor + self._shift(t_sensor), valid

    def _start(self, t_arrival_ns: Times, t_us: NDArray[np.integer]) -> int:
        t_arrival_ns, t_us = t_arrival_ns[: CLOCKS.first], t_us[: CLOCKS.first]
        ahead = nearest_hour(t_us, t_arrival_ns) - t_arrival_ns
        around = (ahead - ahead[0] + HOUR_NS // 2) % HOUR_NS - HOUR_NS // 2
        # One that was measured: between two clocks, before and after a jump, lies none.
        usual = int(np.sort(around)[len(around) // 2])
        offset = int(ahead[0]) + usual
        known = self._report.utc_ahead_ns if self.utc_offset_ns is None else self.utc_offset_ns
        offset += round((known - offset) / HOUR_NS) * HOUR_NS
        if self.utc_offset_ns is not None:
            self._report.derive(
                DerivedKind.CLOCK_BY_GPS, sensor=self._name, off_s=-offset / SECOND_NS
            )
        elif abs(offset - known) > CLOCKS.same_clock_ns:
            self._free_running, self._base_ns = True, known
            behind = usual - offset - around[np.abs(around - usual) < CLOCKS.jump_ns]
            self._shift_ns = int(np.min(behind)) - self._packet_ns + known
            self._say_free_running(offset)
        self._offset_ns = offset
        expected = int(t_arrival_ns[0]) + offset
        self._since_ns = first = int(nearest_hour(t_us[:1], expected)[0])
        is_sound = abs(first - expected) <= CLOCKS.jump_ns  # it may be late
        self._last = (int(t_arrival_ns[0]), first if is_sound else expected)
        self._report_ahead()
        return offset

    def _say_free_running(self, offset_ns: int) -> None:
        self._report.count(f"clock_runs_freely_{self._name}")
        name, ahead_s, past = self._name, offset_ns / SECOND_NS, self.past_hour
        hours = not past
        if self._alone:
            self._report.derive(
                DerivedKind.CLOCK_SHIFTED, sensor=name, ahead_s=ahead_s, hours=hours, past_hour=past
            )
        else:
            self._report.warn(FindingKind.CLOCK_FREE, sensor=name, ahead_s=ahead_s, hours=hours)

    def _time(self, t_us: NDArray[np.integer], expected: Times | int) -> Times:
        """Times on the sensor's clock [ns]: of the hour of the last packet, if soon after it."""
        going_on = nearest_hour(t_us, self._last[1])
        soon = np.abs(going_on - self._last[1]) < CLOCKS.pause_ns
        return np.where(soon, going_on, nearest_hour(t_us, expected))

    def _odd(self, t_sensor: Times, deviation: Times) -> NDArray[np.bool_]:
        """Packets at which one of the clocks seems to have jumped; late ones go on."""
        goes_on = np.abs(np.diff(t_sensor, prepend=self._last[1])) <= CLOCKS.step_ns
        return (np.abs(deviation) > CLOCKS.jump_ns) & ~goes_on

    def _stepped(self, t_arrival_ns: Times, t_sensor: Times, deviation: Times) -> NDArray[np.bool_]:
        """Packets that arrive evenly, with stamps that step by less than `CLOCKS.jump_ns`."""
        arrived = np.diff(t_arrival_ns, prepend=self._last[0])
        stamped = np.diff(t_sensor, prepend=self._last[1])
        even = np.abs(arrived) <= CLOCKS.step_ns
        far = np.abs(deviation) > CLOCKS.step_ns
        return even & far & (np.abs(stamped - arrived) > CLOCKS.step_ns)

    def _follow(self, t_arrival_ns: Times, t_sensor: Times, deviation: Times) -> None:
        """Update the offset, and the shift of a free-running sensor, with the clock drift."""
        steps_ns = np.diff(t_arrival_ns, prepend=self._last[0])
        self._went_back |= bool(np.any(steps_ns < -CLOCKS.step_ns))
        self._last = (int(t_arrival_ns[-1]), int(t_sensor[-1]))
        self._block.append(np.stack([deviation, t_arrival_ns - t_sensor]))
        self._filled += len(t_sensor)
        if self._filled < CLOCKS.block:
            return
        block = np.concatenate(self._block, axis=1)
        self._block, self._filled = [], 0
        assert self._offset_ns is not None
        usual = int(np.median(block[0]))
        as_usual = abs(usual) <= CLOCKS.step_ns
        if as_usual:
            self._offset_ns += int(0.1 * usual)
            self._apart = []
            # The step may be in the second half of this block.
            self._went_back &= abs(int(block[0][-1])) > CLOCKS.step_ns
        else:
            self._confirm_apart(int(t_sensor[-1]), block[0])
        self._report_ahead()
        if as_usual:  # late packets show no drift
            self._window.append(int(np.min(block[1])))
        now = int(t_sensor[-1])
        if self._free_running and self._window and now - self._since_ns >= CLOCKS.track_ns:
            self._shift_ns = int(self._shift(now))
            usual = min(self._window) - self._host_jump_ns - self._packet_ns + self._base_ns
            error = usual - self._shift_ns
            self._rate = float(np.clip(error / CLOCKS.track_ns, -CLOCKS.max_rate, CLOCKS.max_rate))
            self._since_ns, self._window = now, []

    def _confirm_apart(self, now_ns: int, deviation: Times) -> None:
        """Take a block that is early or late, as all for seconds, for one after a jump.

        Packets that a busy recorder reads late are late by amounts that differ; none arrives before
        the one that was sent before.
        """
        usual = int(np.median(deviation))
        spread = np.abs(np.array([one for _, one in self._apart] + [usual]) - usual)
        if np.ptp(deviation) > CLOCKS.even_ns or spread.max() > CLOCKS.even_ns:
            self._apart = []
        self._apart.append((now_ns, usual))
        if now_ns - self._apart[0][0] >= (CLOCKS.back_ns if self._went_back else CLOCKS.late_ns):
            self._take_recorder_jump(usual)

    def finish(self) -> None:
        """Judge packets that were late up to the last one: by one amount is a jump."""
        if not self._apart:
            return
        (first_ns, _), (last_ns, usual) = self._apart[0], self._apart[-1]
        if abs(usual) > CLOCKS.jump_ns and last_ns - first_ns >= CLOCKS.back_ns:
            self._take_recorder_jump(usual)

    def _take_recorder_jump(self, usual: int) -> None:
        assert self._offset_ns is not None
        self._offset_ns += usual
        self._host_jump_ns -= usual
        self._window, self._apart, self._went_back = [], [], False
        self._report_jump("recorder", -usual)

    def _shift(self, t_sensor: Times | int) -> Times:
        drift = self._rate * (np.asarray(t_sensor) - self._since_ns)
        return self._shift_ns + np.rint(drift).astype(np.int64)

    def _push_one_by_one(
        self, t_arrival_ns: Times, t_us: NDArray[np.integer]
    ) -> tuple[Times, NDArray[np.bool_]]:
        t_ns = np.zeros(len(t_us), dtype=np.int64)
        kept = np.zeros(len(t_us), dtype=np.bool_)
        for row, arrival in enumerate(t_arrival_ns.tolist()):
            stamp = t_us[row : row + 1]
            kept[row] = self._accept(arrival, stamp)
            assert self._offset_ns is not None
            t_sensor = self._time(stamp, arrival + self._offset_ns)
            t_ns[row] = (t_sensor + self._shift(t_sensor))[0]
            if kept[row]:
                self._last = (arrival, int(t_sensor[0]))
        self._report.count("packets_wrong_clock", int((~kept).sum()))
        return t_ns, kept

    def _accept(self, arrival: int, stamp: NDArray[np.integer]) -> bool:
        assert self._offset_ns is not None
        t_sensor = self._time(stamp, arrival + self._offset_ns)
        deviation = t_sensor - (arrival + self._offset_ns)
        stepped = self._stepped(np.array([arrival]), t_sensor, deviation)
        arrived, stamped = self._since_last(arrival, stamp)
        goes_on = abs(arrived - stamped) <= CLOCKS.step_ns  # as late as the one before it
        if goes_on or not (stepped | self._odd(t_sensor, deviation))[0]:
            self._run = 0
            return True
        off = int(deviation[0])
        near = CLOCKS.jump_ns if abs(off) > CLOCKS.jump_ns else CLOCKS.step_ns
        self._run = self._run + 1 if self._run and abs(off - self._run_ns) < near else 1
        self._run_ns = off
        if self._run < CLOCKS.confirm:
            return False
        self._jump(arrival, stamp, off)
        return True

    def _jump(self, arrival: int, stamp: NDArray[np.integer], off_ns: int) -> None:
        """Adopt the new offset of the clocks; the one that continued evenly counts as correct."""
        assert self._offset_ns is not None
        arrived, stamped = self._since_last(arrival, stamp)
        going_on = self._last[1] + stamped
        stepped = abs(arrived) < CLOCKS.step_ns < abs(stamped)
        if abs(stamped) < CLOCKS.jump_ns and not stepped:
            jump_ns = arrived - stamped
            self._offset_ns = going_on - arrival
            self._host_jump_ns += jump_ns
            self._report_jump("recorder", jump_ns)
        else:
            early_ns = self._early_ns()
            if abs(arrived) < CLOCKS.step_ns or abs(early_ns) > CLOCKS.step_ns:
                off_ns -= early_ns
            self._offset_ns += off_ns
            self._shift_ns = int(self._shift(going_on)) - off_ns
            self._rate = 0.0
            self._report_jump("sensor", off_ns)
        self._since_ns, self._window, self._run = going_on, [], 0
        self._block, self._filled, self._apart = [], 0, []
        self._report_ahead()

    def _since_last(self, arrival: int, stamp: NDArray[np.integer]) -> tuple[int, int]:
        """From the last packet to one that arrives: by the recorder's clock, by its stamp [ns]."""
        going_on = int(nearest_hour(stamp, self._last[1])[0])
        return arrival - self._last[0], going_on - self._last[1]

    def _early_ns(self) -> int:
        """How early the last packet arrived [ns]; negative = it was held up."""
        assert self._offset_ns is not None
        return self._last[1] - self._last[0] - self._offset_ns

    def _report_ahead(self) -> None:
        assert self._offset_ns is not None
        self._report.ahead_ns[self._name] = self._offset_ns + self._shift_ns

    def _report_jump(self, whose: str, jump_ns: int) -> None:
        if whose == "recorder":
            self._report.recorder_jumps_ns.setdefault(self._name, []).append(jump_ns)
        self._report.count_jump(self._name)
        self._report.warn(
            FindingKind.CLOCK_JUMP,
            sensor=self._name,
            whose=whose,
            jump_s=jump_ns / SECOND_NS,
            times="without-it",
        )
