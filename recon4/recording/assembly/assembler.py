"""Assembles the shots of all LiDARs into multiframes, cut by time on the rig's clock."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from recon4.errors import ConfigError
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.lidars import lidar_model
from recon4.model.multiframe import COLUMNS, Multiframe
from recon4.model.rig import Rig, Sensor
from recon4.model.trajectory import Times
from recon4.recording.assembly.even_gaps import even_pause_ns
from recon4.recording.assembly.range_limits import blind_range_m, drop_invalid
from recon4.recording.assembly.rotation_rate import nominal, rotation_of_head
from recon4.recording.assembly.shots import Shots
from recon4.recording.assembly.tuning import ASSEMBLY
from recon4.recording.clocks.compare import warn_of_lidar_clocks
from recon4.recording.clocks.names import clocks_text
from recon4.recording.report import ImportReport
from recon4.recording.tuning import PROBE, IngestTuning
from recon4.settings import IngestSettings
from recon4.settings.tuning import tuned


@dataclass(frozen=True, slots=True)
class TimeGap:
    """A gap or a jump in the times of one sensor."""

    sensor: str
    t_ns: int
    """Start [ns]."""
    seconds: float
    """Duration [s]; negative = the clock went back."""


@dataclass(slots=True)
class _Stream:
    """Shots of one sensor that wait."""

    name: str
    waiting: list[Shots] = field(default_factory=list)
    last_ns: int | None = None
    first_ns: int | None = None
    shift_ns: int = 0
    """Added to its times since its clock last went back."""
    delivers: bool = True
    """Whether it has points for multiframes; a 2-D laser has none."""
    spins: bool = True
    """Whether its rotation may set the length of a multiframe."""
    rotation_hz: float = math.nan
    """As its packets say; NaN = not known."""
    points: int = 0
    late: int = 0


def _spins(sensor: Sensor) -> bool:
    """Whether a sensor has revolutions; the pattern of a Livox never repeats."""
    return sensor.kind == "lidar" and lidar_model(sensor.model).has_rings


class Assembler:
    """Assembles shots into multiframes, each as soon as all sensors have passed its end.

    Times that go back by more than ``gap_s`` continue after the last good one (counted, and a
    `TimeGap`); jumps forward stay and are a `TimeGap`; frames without points are left out, and
    those of a small part of their time, which do not determine a pose (counted).
    """

    def __init__(
        self,
        rig: Rig,
        *,
        settings: IngestSettings,
        report: ImportReport,
        wait_s: float = ASSEMBLY.wait_s,
    ) -> None:
        """Prepare.

        Args:
            rig: The sensors; shots refer to them by row.
            settings: Rate, range limits and length of a gap.
            report: Receives counts of everything dropped.
            wait_s: A sensor that is silent for this time while another delivers no longer delays
                the frames [s].
        """
        self._settings, self._report = tuned(IngestTuning, settings), report
        self._beams = [sensor.beams for sensor in rig.sensors]
        self._blind_m = [blind_range_m(sensor) for sensor in rig.sensors]
        self._wait_ns = int(wait_s * 1e9)
        self._streams = [
            _Stream(s.name, delivers=s.kind != "laser2d", spins=_spins(s)) for s in rig.sensors
        ]
        self._expected = sum(stream.delivers for stream in self._streams)
        self._start_ns: int | None = None
        self._next = 0
        """Frames since the start, empty ones counted."""
        self._first: Multiframe | None = None
        """Waits for the second frame: it may be incomplete."""
        self._frames = 0
        """Returned so far."""
        self._usual, self._newest = 0.0, 0
        """Usual number of points of a frame but the newest, and of the newest."""
        self.duration_ns = 0
        """Length of a frame [ns]; 0 until it is known."""
        self.rotation_hz: dict[str, float] = {}
        """Measured revolutions per second of each sensor that was seen."""
        self.gaps: list[TimeGap] = []

    def push(self, shots: Shots) -> list[Multiframe]:
        """Add shots of one sensor, see `pushed`."""
        return list(self.pushed(shots))

    def pushed(self, shots: Shots) -> Iterator[Multiframe]:
        """Add shots of one sensor; take all frames: of the first second they are many.

        Raises:
            ConfigError: If the clocks of the sensors have nothing to do with each other.
        """
        kept = drop_invalid(
            self._corrected(shots),
            settings=self._settings,
            report=self._report,
            blind_m=self._blind_m[shots.sensor],
        )
        for number, part in enumerate(runs(kept, round(self._settings.gap_s * 1e9))):
            self._take(part, set_back=number > 0 or shots.set_back)
        self._streams[shots.sensor].rotation_hz = shots.rotation_hz
        if self._start_ns is not None or self._head_complete():
            yield from self._cut(final=False)

    def flush(self) -> list[Multiframe]:
        """Return the remaining multiframes; call once, at the end."""
        frames = list(self._cut(final=True))
        for stream in self._streams:
            self._report.count("points_late", stream.late)
        self._sum_up_gaps()
        warn_of_lidar_clocks(self._report)
        first, self._first = self._first, None
        return frames if first is None else [*frames, first]

    # -- taking in

    def _corrected(self, shots: Shots) -> Shots:
        """The shots with the corrections of beams that the rig file lists."""
        beams = self._beams[shots.sensor]
        if beams is None:
            return shots
        xyz, unknown = beams.apply(shots.xyz, shots.ring)
        self._report.count("points_of_beams_without_correction", unknown)
        return replace(shots, xyz=xyz)

    def _take(self, shots: Shots, *, set_back: bool) -> None:
        stream = self._streams[shots.sensor]
        first, last = int(shots.t_ns[0]) + stream.shift_ns, int(shots.t_ns.max()) + stream.shift_ns
        gap_ns = int(self._settings.gap_s * 1e9)
        if stream.last_ns is not None and first - stream.last_ns > gap_ns:
            self._note_gap(stream, first - stream.last_ns)
        newest = first if set_back else last  # clouds may overlap
        if stream.last_ns is not None and newest < stream.last_ns - gap_ns:
            step = self._shift_for(stream, stream.last_ns - first)
            stream.shift_ns += step
            last += step
        if stream.shift_ns:
            shots = moved(shots, stream.shift_ns)
        self._note_inner_gaps(stream, shots, gap_ns)
        stream.first_ns = int(shots.t_ns[0]) if stream.first_ns is None else stream.first_ns
        stream.last_ns = last if stream.last_ns is None else max(last, stream.last_ns)
        stream.points += len(shots)
        stream.waiting.append(shots)

    def _shift_for(self, stream: _Stream, back_ns: int) -> int:
        """Offset after a jump back; sensors that jump together keep their common time."""
        self._report.count("clock_jumps_back")
        self._note_gap(stream, -back_ns)
        others = [o.shift_ns - stream.shift_ns for o in self._streams if o is not stream]
        together = [shift for shift in others if abs(shift - back_ns) < PROBE.head_ns]
        return together[0] if together else back_ns

    def _note_gap(self, stream: _Stream, length_ns: int) -> None:
        assert stream.last_ns is not None
        gap = TimeGap(stream.name, stream.last_ns, length_ns / 1e9)
        self.gaps.append(gap)
        self._report.count("gaps")
        if len(self.gaps) <= 20:
            since_s = (stream.last_ns - (self._start_ns or stream.first_ns or 0)) / 1e9
            self._report.warn(
                FindingKind.TIME_GAP if length_ns > 0 else FindingKind.CLOCK_BACK,
                sensor=gap.sensor,
                start_s=since_s,
                end_s=since_s + max(0.0, gap.seconds),
                seconds=abs(gap.seconds),
            )

    def _sum_up_gaps(self) -> None:
        """State once that clouds were left out evenly, in place of each gap."""
        for stream in self._streams:
            own = [gap for gap in self.gaps if gap.sensor == stream.name]
            starts_ns = np.array([gap.t_ns for gap in own], np.int64)
            lengths_ns = np.array([1e9 * gap.seconds for gap in own])
            span_ns = stream.first_ns or 0, stream.last_ns or 0
            if every_ns := even_pause_ns(starts_ns, lengths_ns, span_ns):
                self.gaps = [gap for gap in self.gaps if gap.sensor != stream.name]
                self._report.withdraw(FindingKind.TIME_GAP, stream.name)
                self._report.counts["gaps"] -= len(own)
                about = {"every_s": 1e-9 * every_ns, "pause_s": float(np.median(lengths_ns)) * 1e-9}
                self._report.derive(DerivedKind.CLOUDS_THINNED, sensor=stream.name, **about)

    def _note_inner_gaps(self, stream: _Stream, shots: Shots, gap_ns: int) -> None:
        steps = np.diff(shots.t_ns)
        for row in np.flatnonzero(steps > gap_ns):
            stream.last_ns = int(shots.t_ns[row])
            self._note_gap(stream, int(steps[row]))

    # -- the first cut

    def _head_complete(self) -> bool:
        ends = [s.last_ns - s.first_ns for s in self._streams if s.last_ns and s.first_ns]
        least_ns = PROBE.head_ns
        if self._many_wait():
            least_ns = 0 if self._packets_tell_rotation() else ASSEMBLY.short_head_ns
        everyone = len(ends) == self._expected and min(ends, default=0) >= least_ns
        return everyone or max(ends, default=0) >= PROBE.head_ns + self._wait_ns

    def _many_wait(self) -> bool:
        waiting = (len(shots) for stream in self._streams for shots in stream.waiting)
        return sum(waiting) >= ASSEMBLY.head_points

    def _packets_tell_rotation(self) -> bool:
        return all(math.isfinite(s.rotation_hz) for s in self._streams if s.delivers and s.spins)

    def _begin(self) -> None:
        seen = [stream for stream in self._streams if stream.waiting]
        starts = [stream.first_ns for stream in seen if stream.first_ns is not None]
        if max(starts) - min(starts) > ASSEMBLY.clocks_ns:
            raise ConfigError(clocks_text([(s.name, s.first_ns or 0) for s in seen]))
        by_packets = self._many_wait() and self._packets_tell_rotation()
        for stream in seen:
            if stream.spins:
                measured = rotation_of_head(stream.waiting, PROBE.head_ns)
                self.rotation_hz[stream.name] = stream.rotation_hz if by_packets else measured
        self._start_ns = min(starts)
        self.duration_ns = round(1e9 / self._rate_hz())

    def _rate_hz(self) -> float:
        measured = [rate for rate in self.rotation_hz.values() if np.isfinite(rate)]
        requested = self._settings.rate_hz
        if not requested and not measured:
            self._report.derive(DerivedKind.FRAMES_RATE, rate_hz=ASSEMBLY.fallback_hz, assumed=True)
            return ASSEMBLY.fallback_hz
        slowest = nominal(min(measured)) if measured else requested
        if not requested:
            self._report.derive(DerivedKind.FRAMES_RATE, rate_hz=slowest, by_rotation=True)
            return slowest
        if (
            abs(slowest / requested - round(slowest / requested)) > 0.03
            or slowest < 0.97 * requested
        ):
            self._report.warn(FindingKind.RATE_UNFIT, requested_hz=requested, rotation_hz=slowest)
        return requested

    # -- cutting

    def _cut(self, *, final: bool) -> Iterator[Multiframe]:
        if not any(stream.waiting for stream in self._streams):
            return
        if self._start_ns is None:
            self._begin()
        assert self._start_ns is not None
        while any(stream.waiting for stream in self._streams):
            self._skip_empty()
            end_ns = self._start_ns + (self._next + 1) * self.duration_ns
            if not final and not self._passed(end_ns):
                break
            yield from self._emit(end_ns)

    def _passed(self, end_ns: int) -> bool:
        """Whether no sensor can still deliver points before ``end_ns``, or one is overdue."""
        reached = [s.last_ns for s in self._streams if s.last_ns is not None]
        everyone = len(reached) == self._expected and min(reached) >= end_ns + ASSEMBLY.slack_ns
        return everyone or max(reached) >= end_ns + self._wait_ns

    def _skip_empty(self) -> None:
        assert self._start_ns is not None
        earliest = min(int(shots.t_ns[0]) for s in self._streams for shots in s.waiting)
        target = (earliest - self._start_ns) // self.duration_ns
        if target > self._next:
            self._report.count("frames_empty", target - self._next)
            self._next = target

    def _emit(self, end_ns: int) -> list[Multiframe]:
        start_ns = end_ns - self.duration_ns
        parts = [part for s in self._streams for part in self._take_out(s, start_ns, end_ns)]
        self._next += 1
        if not parts:
            return []
        frame_id = self._frames + (self._first is not None)
        frame = _multiframe(parts, frame_id, start_ns, duration_ns=self.duration_ns)
        if self._too_small(frame):
            return []
        for row, stream in enumerate(self._streams):
            if stream.delivers and not np.any(frame.sensor == row):
                self._report.count(f"frames_without_{stream.name}")
        return self._released(frame)

    def _released(self, frame: Multiframe) -> list[Multiframe]:
        """The frame, with the first one before the second, unless that one is incomplete."""
        first, self._first = self._first, None
        if first is None and not self._frames:
            self._first = frame
            return []
        if first is not None and len(first) < ASSEMBLY.kept_ratio * len(frame):
            self._leave_out(first)
            self._first = _renumbered(frame, 0)
            return []
        frames = [frame] if first is None else [first, frame]
        self._frames += len(frames)
        before = self._newest if first is None else len(first)
        self._usual += 0.1 * (before - self._usual) if self._usual else before
        self._newest = len(frame)
        return frames

    def _too_small(self, frame: Multiframe) -> bool:
        """Whether all points are of a small part of the time, as beside a cloud that is missing."""
        if len(frame) >= ASSEMBLY.kept_ratio * self._usual:
            return False
        if np.ptp(frame.dt_ns) >= ASSEMBLY.kept_ratio * frame.duration_ns:
            return False
        self._leave_out(frame)
        return True

    def _leave_out(self, frame: Multiframe) -> None:
        self._report.count("frames_incomplete_dropped")
        self._report.count("points_of_incomplete_frames", len(frame))

    def _take_out(self, stream: _Stream, start_ns: int, end_ns: int) -> list[Shots]:
        taken, left = [], []
        for shots in stream.waiting:
            # Slices, not masks: a reader may hand on many frames at a time.
            start, end = np.searchsorted(shots.t_ns, [start_ns, end_ns]).tolist()
            stream.late += start
            if end > start:
                taken.append(shots.take(slice(start, end)))
            if end < len(shots):
                left.append(shots.take(slice(end, None)))
        stream.waiting = left
        return taken


def runs(shots: Shots, gap_ns: int) -> list[Shots]:
    """The shots, cut where the clock goes back."""
    if not len(shots):
        return []
    back = (np.flatnonzero(np.diff(shots.t_ns) < -gap_ns) + 1).tolist()
    ends = zip([0, *back], [*back, len(shots)], strict=True)
    return [shots.take(slice(start, end)) for start, end in ends] if back else [shots]


def moved(shots: Shots, shift_ns: int | Times) -> Shots:
    """The same shots at later times; one shift [ns], or one of each, (N,)."""
    return Shots(
        shots.sensor,
        shots.t_ns + shift_ns,
        shots.xyz,
        shots.intensity,
        shots.ring,
        shots.echo,
    )


def _multiframe(parts: list[Shots], frame_id: int, t_ns: int, *, duration_ns: int) -> Multiframe:
    columns = {
        "xyz": np.concatenate([p.xyz for p in parts]),
        "intensity": np.concatenate([p.intensity for p in parts]),
        "ring": np.concatenate([p.ring for p in parts]),
        "sensor": np.concatenate([np.full(len(p), p.sensor, np.uint8) for p in parts]),
        "echo": np.concatenate([p.echo for p in parts]),
        "dt_ns": np.concatenate([(p.t_ns - t_ns).astype(np.int32) for p in parts]),
    }
    frame = Multiframe(frame_id, t_ns, duration_ns, **columns)
    if all(a.sensor != b.sensor or a.t_ns[-1] <= b.t_ns[0] for a, b in pairwise(parts)):
        return frame
    return frame.take(np.lexsort((frame.dt_ns, frame.sensor)))


def _renumbered(frame: Multiframe, frame_id: int) -> Multiframe:
    columns = {name: getattr(frame, name) for name in COLUMNS}
    return Multiframe(frame_id, frame.t_ns, frame.duration_ns, **columns)
