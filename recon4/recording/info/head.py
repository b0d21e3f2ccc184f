"""What the first second of a recording holds, or all of a small one, for ``recon4 info``."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from recon4.model.derived import Derived
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.assembly.assembler import TimeGap, runs
from recon4.recording.assembly.range_limits import drop_invalid
from recon4.recording.assembly.rotation_rate import rotation_rate
from recon4.recording.assembly.shots import Shots
from recon4.recording.clocks.compare import (
    GNSS_CLOCK,
    IMU_CLOCK,
    is_same_clock,
    warn_of_free_clocks,
    warn_of_lidar_clocks,
)
from recon4.recording.openers.request import Recording
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import clean_gnss, clean_imu, gather, join
from recon4.recording.tuning import PROBE, IngestTuning
from recon4.settings import IngestSettings
from recon4.settings.tuning import tuned


@dataclass(slots=True)
class RecordingHead:
    """What the first second of a recording holds, or all of a small one."""

    rotation_hz: dict[int, float] = field(default_factory=dict)
    """Of each sensor row [Hz]; NaN = not known."""
    imu: list[ImuSamples] = field(default_factory=list)
    gnss: list[GnssSamples] = field(default_factory=list)
    points: int = 0
    """Within the limits of the range."""
    last_ns: dict[int, int] = field(default_factory=dict)
    """Of each sensor row, the newest time since its clock last went back [ns]."""
    jumps: list[TimeGap] = field(default_factory=list)
    """Where a clock goes back."""

    @property
    def set_back_ns(self) -> int:
        """By how much the clock of a sensor was set back in all, at most [ns]."""
        names = {jump.sensor for jump in self.jumps}
        sums_s = [sum(-j.seconds for j in self.jumps if j.sensor == name) for name in names]
        return round(max(sums_s, default=0.0) * 1e9)

    def note_jump(self, shots: Shots, rig: Rig, gap_s: float) -> None:
        """Find out whether the clock of a sensor goes back by more than a gap."""
        for number, part in enumerate(runs(shots, round(gap_s * 1e9))):
            newest = int(part.t_ns.max())
            last = self.last_ns.get(shots.sensor, newest)
            set_back = number > 0 or shots.set_back
            if (int(part.t_ns[0]) if set_back else newest) < last - gap_s * 1e9:
                back_s = 1e-9 * (int(part.t_ns[0]) - last)
                self.jumps.append(TimeGap(rig.sensors[shots.sensor].name, last, back_s))
            else:
                newest = max(newest, last)
            self.last_ns[shots.sensor] = newest


def read_head(
    recording: Recording, settings: IngestSettings, *, whole: bool, report: ImportReport
) -> RecordingHead:
    """Rotation rate of each sensor row, and the samples beside the points.

    Args:
        recording: Read up to its first second.
        settings: Limits of the range.
        whole: Read the rest too, for the counts of the report.
        report: Receives the counts of points that are not usable.
    """
    shots: dict[int, list[Shots]] = {}
    head = RecordingHead()
    beyond = False
    start_ns: int | None = None
    for number, item in enumerate(recording.read()):
        if isinstance(item, ImuSamples):
            gather(head.imu, item)
        if isinstance(item, GnssSamples):
            gather(head.gnss, item)
        head.points += _usable_points(item, settings, report)
        if isinstance(item, Shots) and len(item):
            head.note_jump(item, recording.rig, tuned(IngestTuning, settings).gap_s)
        if isinstance(item, Shots) and len(item) and not beyond:
            shots.setdefault(item.sensor, []).append(item)
            start_ns = int(item.t_ns[0]) if start_ns is None else start_ns
            everyone = len(shots) == len(recording.rig.sensors)
            beyond = everyone and int(item.t_ns[-1]) - start_ns > PROBE.head_ns
        beyond |= isinstance(item, Multiframe) or number >= PROBE.head_items
        if beyond and not whole:
            break
    for row, parts in shots.items():
        t_ns, xyz = (np.concatenate([getattr(p, name) for p in parts]) for name in ("t_ns", "xyz"))
        first = t_ns <= t_ns[0] + PROBE.head_ns  # a pause may follow the first of them
        head.rotation_hz[row] = rotation_rate(t_ns[first], xyz[first])
    return head


def kind_of_walk(rig: Rig) -> Derived:
    """Which workflow a recording with points has, and what decides that."""
    row = rig.row_of("profiler")
    if row is None:
        names = ", ".join(sensor.topic or sensor.name for sensor in rig.sensors)
        return Derived(kind=DerivedKind.WALK_LIDAR, values={"sensors": names})
    sensor = rig.sensors[row]
    moved_by = sensor.head_topic or ("constant-head" if sensor.head_rate_rad_s else "head")
    values: dict[str, Value] = {"sensor": sensor.topic or sensor.name, "moved_by": moved_by}
    return Derived(kind=DerivedKind.WALK_PROFILER, values=values)


def _usable_points(item: object, settings: IngestSettings, report: ImportReport) -> int:
    if isinstance(item, Shots):
        return len(drop_invalid(item, settings=settings, report=report))
    return len(item.xyz) if isinstance(item, Multiframe) else 0


def judge_samples(
    head: RecordingHead, rig: Rig, settings: IngestSettings, *, whole: bool, report: ImportReport
) -> None:
    """Say of IMU and GNSS what processing will: clock, unit, channels that were not measured.

    A receiver may have no fix yet in the first second: only all positions are judged.
    """
    warn_of_lidar_clocks(report)
    imu, gnss = join(head.imu), join(head.gnss) if whole else None
    offset_s = rig.imu_clock_offset_s
    if is_same_clock(IMU_CLOCK, offset_s, report) and imu is not None:
        if not offset_s:
            warn_of_free_clocks(report, imu_file=False)
        unit = settings.imu_gyro_unit
        clean_imu(imu, offset_s=offset_s, jumps_ns=(), report=report, gyro_unit=unit)
    offset_s = rig.gnss_time_offset_s
    if is_same_clock(GNSS_CLOCK, offset_s, report) and gnss is not None:
        clean_gnss(gnss, offset_s=offset_s, report=report)
