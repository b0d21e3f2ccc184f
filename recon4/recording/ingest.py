"""The stage ``frames``: reads a recording into a frame store."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np
from msgspec import to_builtins
from numpy.typing import NDArray

from recon4.errors import EmptyRecording
from recon4.geometry.se3 import SE3
from recon4.locales.coded import at
from recon4.model.clock_jump import ClockJump
from recon4.model.derived_kinds import DerivedKind
from recon4.model.events import Remarked
from recon4.model.gps_time import day_of
from recon4.model.laser_scans import LaserScans
from recon4.model.line_scans import LineScans
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress
from recon4.recording.assembly.assembler import Assembler
from recon4.recording.assembly.shots import Shots
from recon4.recording.clocks.compare import (
    GNSS_CLOCK,
    IMU_CLOCK,
    is_same_clock,
    warn_of_free_clocks,
)
from recon4.recording.clocks.jumps import samples_without_jumps, say_jumps
from recon4.recording.formats.pcap import OpenFile, open_plain
from recon4.recording.formats.poses import write_tum
from recon4.recording.gnss.files import read_gnss
from recon4.recording.gnss.records import Dating, GnssFile
from recon4.recording.kinds import RecordingKind, recognize
from recon4.recording.limits import LIMITS
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest, Recording
from recon4.recording.packets.lidar_imu import rig_of_imu_file
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import clean_gnss, clean_imu, gather, join
from recon4.recording.samples.covering import covering
from recon4.recording.samples.csv_files import read_imu_csv
from recon4.recording.samples.heights import compare_heights
from recon4.recording.samples.units import GyroUnit
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.store.frames import FrameWriter
from recon4.store.line_store import LineStoreWriter

Span = tuple[int, int]
"""Start of the first and end of the last multiframe [ns]."""
Watch = Callable[[Multiframe | ImuSamples | GnssSamples | LaserScans], None]
"""Receives contents of a recording as they come in."""


@dataclass(slots=True)
class _Samples:
    """IMU samples, fixes and poses of a recording."""

    lines: LineStoreWriter
    """Receives line scans and scans of a 2-D laser."""
    imu: list[ImuSamples] = field(default_factory=list)
    gnss: list[GnssSamples] = field(default_factory=list)
    gnss_file: GnssFile | None = None
    poses: list[Trajectory] = field(default_factory=list)
    gyro_unit: GyroUnit = "auto"
    jumps: Sequence[ClockJump] = ()
    """Where all clocks were set ahead."""

    @classmethod
    def of_files(
        cls, sources: Sources, out: Path, *, settings: IngestSettings, report: ImportReport
    ) -> _Samples:
        """Those of the files beside the recording."""
        imu, gnss = sources.imu, sources.gnss
        return cls(
            LineStoreWriter(out),
            imu=[read_imu_csv(imu, report)] if imu else [],
            gnss_file=read_gnss(gnss, report) if gnss else None,
            gyro_unit=settings.imu_gyro_unit,
            jumps=sources.jumps,
        )

    def keep(self, item: ImuSamples | GnssSamples | Trajectory | LineScans | LaserScans) -> None:
        """Add samples."""
        if isinstance(item, LineScans):
            self.lines.append_lines(item)
            return
        if isinstance(item, LaserScans):
            self.lines.append_scans(item)
            return
        if isinstance(item, ImuSamples):
            gather(self.imu, item)
        elif isinstance(item, GnssSamples):
            gather(self.gnss, item)
        else:
            self.poses.append(item)


@dataclass(slots=True)
class _IngestSpan:
    """Counts of the multiframes written."""

    t_first_ns: int = 0
    duration_ns: int = 0
    """Duration of a frame; 0 = none was written."""
    t_last_ns: int = 0
    points: NDArray[np.int64] = field(default_factory=lambda: np.zeros(256, np.int64))
    """Of each sensor."""
    jumps_ns: list[int] = field(default_factory=list)
    """How far the times went back, each time [ns]."""

    def add(self, frame: Multiframe) -> None:
        """Count a frame."""
        if not self.duration_ns:
            self.t_first_ns, self.duration_ns = frame.t_ns, frame.duration_ns
        self.t_last_ns = frame.t_ns + frame.duration_ns
        self.points += np.bincount(frame.sensor, minlength=256)

    @property
    def span(self) -> Span:
        return self.t_first_ns, self.t_last_ns


@dataclass(frozen=True, slots=True)
class _Receivers:
    """Who receives the contents of a recording."""

    writer: FrameWriter
    """Multiframes."""
    samples: _Samples
    """Everything else."""
    watch: Watch
    """Samples and scans as read, besides."""


@dataclass(frozen=True, slots=True)
class LiveSource:
    """How a running capture differs from a finished recording."""

    open_file: OpenFile = open_plain
    """Opens the capture file; reads wait for bytes not written yet."""
    watch: Watch = lambda item: None
    """Called with each multiframe as soon as it is cut, before it is written, and with samples and
    scans of a 2-D laser as read, before they are cleaned."""
    report: ImportReport = field(default_factory=ImportReport)
    """Receives repairs and warnings as they happen."""
    opened: Callable[[Rig], None] = lambda rig: None
    """Called before anything is read, with the rig and what the recording tells of it."""


def ingest(
    sources: Sources,
    out: Path,
    *,
    settings: IngestSettings,
    progress: Progress,
    live: LiveSource | None = None,
) -> None:
    """Read a recording into a frame store.

    Args:
        sources: The recording; CSV files of IMU and GNSS samples may be among its paths. A rig
            that is chosen from the recording is reported.
        out: Folder of the store.
        settings: Settings of the reader.
        progress: Receives multiframes written, gaps and warnings.
        live: A running capture; None = a finished recording.

    Raises:
        RecordingError: If the recording cannot be read or has no points.
        ConfigError: If rig, clocks or units are wrong.
        StoreError: If the store cannot be written.
    """
    report = (live := live or LiveSource()).report
    sources = _sort_out(sources)
    paths = sources.recordings
    given = _Samples.of_files(sources, out, settings=settings, report=report)
    recording = _opened(sources, live, settings=settings)
    assembler = Assembler(recording.rig, settings=settings, report=report, wait_s=recording.wait_s)
    with FrameWriter(out, recording.rig) as writer:
        found = _Samples(given.lines)
        receivers = _Receivers(writer, found, live.watch)
        written = _write_frames(recording, assembler, receivers, progress=progress)
        if not written.duration_ns:
            raise EmptyRecording(at(paths[0].name, report.why_no_points(recording.seen)))
        imu = _imu(given, found, recording.rig, written=written, report=report)
        gnss = _gnss(given, found, recording.rig, written=written, report=report)
        _write_poses(out, found.poses, report)
        say_jumps(sources.jumps, written.t_first_ns, report)
        counts = found.lines.close()
        about = _summary(recording, assembler, written, report=report)
        about |= {"recordings": [path.name for path in paths], "frames": len(writer)}
        about |= dict(zip(("line_scans", "laser2d_scans"), counts, strict=True))
        about |= {"points": writer.points, "imu": _about(imu), "gnss": _about(gnss)}
        writer.add(imu=imu, gnss=gnss, report=about)
    for finding in report.findings:
        progress.event(Remarked(finding=finding))


def _opened(sources: Sources, live: LiveSource, *, settings: IngestSettings) -> Recording:
    """The recording, with the rig of the samples that are used."""
    recording = open_recording(
        OpenRequest(
            sources.recordings,
            sources.rig,
            settings,
            live.report,
            open_file=live.open_file,
            jumps=sources.jumps,
        )
    )
    if sources.imu is not None:
        recording = replace(recording, rig=rig_of_imu_file(recording.rig, sources.rig))
    live.opened(recording.rig)
    return recording


def _sort_out(sources: Sources) -> Sources:
    """The sources with CSV files among the recordings moved to their place."""
    imu, gnss = sources.imu, sources.gnss
    files = [path for path in sources.recordings if not path.is_dir()]
    for path in files if len(sources.recordings) > 1 else ():
        kind = recognize(path)
        if kind is RecordingKind.IMU_CSV and imu is None:
            imu = path
        if kind is RecordingKind.GNSS_FILE and gnss is None:
            gnss = path
    recordings = tuple(path for path in sources.recordings if path not in (imu, gnss))
    return replace(sources, recordings=recordings, imu=imu, gnss=gnss)


def _write_frames(
    recording: Recording, assembler: Assembler, receivers: _Receivers, *, progress: Progress
) -> _IngestSpan:
    """Write the multiframes as they are cut, and keep the other contents."""
    written = _IngestSpan()
    for item in _items(recording, assembler):
        if not isinstance(item, Multiframe):
            receivers.samples.keep(item)
            if isinstance(item, ImuSamples | GnssSamples | LaserScans):
                receivers.watch(item)
            continue
        if not written.duration_ns:
            count = round(recording.seconds * 1e9 / item.duration_ns)
            progress.start("frames", count, "multiframe")
        receivers.watch(item)
        receivers.writer.append(item)
        written.add(item)
        progress.advance()
    written.jumps_ns = [-round(gap.seconds * 1e9) for gap in assembler.gaps if gap.seconds < 0]
    return written


def _items(
    recording: Recording, assembler: Assembler
) -> Iterator[Multiframe | ImuSamples | GnssSamples | Trajectory | LineScans | LaserScans]:
    """The contents of a recording, with shots assembled to multiframes."""
    for item in recording.read():
        if isinstance(item, Shots):
            yield from assembler.pushed(item)
        else:
            yield item
    yield from assembler.flush()


# -- samples


def _imu(
    given: _Samples, found: _Samples, rig: Rig, *, written: _IngestSpan, report: ImportReport
) -> ImuSamples | None:
    samples = join(given.imu or found.imu)
    if samples is None:
        report.derive(DerivedKind.IMU_ABSENT)
        return None
    if given.imu and found.imu:
        report.derive(DerivedKind.SAMPLES_OF_FILE, imu=True)
    offset_s = rig.imu_clock_offset_s
    if not given.imu and not is_same_clock(IMU_CLOCK, offset_s, report):
        return None
    if not offset_s:
        warn_of_free_clocks(report, imu_file=bool(given.imu))
    clean = clean_imu(
        samples,
        offset_s=offset_s,
        jumps_ns=[*written.jumps_ns, *(-jump for jump in report.recorder_set_ns)],
        report=report,
        gyro_unit=given.gyro_unit,
    )
    clean = samples_without_jumps(clean, given.jumps)
    return covering(clean, written.span, bool(given.imu), report=report)


def _gnss(
    given: _Samples, found: _Samples, rig: Rig, *, written: _IngestSpan, report: ImportReport
) -> GnssSamples | None:
    from_file, recorded = _dated(given.gnss_file, written, report), join(found.gnss)
    samples = from_file or recorded
    if samples is None:
        return None
    if from_file and recorded:
        compare_heights(from_file, recorded, report)
        report.derive(DerivedKind.SAMPLES_OF_FILE, gnss=True)
    offset_s = rig.gnss_time_offset_s
    if not from_file and not is_same_clock(GNSS_CLOCK, offset_s, report):
        return None
    clean = clean_gnss(samples, offset_s=offset_s, report=report)
    clean = samples_without_jumps(clean, given.jumps)
    return covering(clean, written.span, given.gnss_file is not None, report=report)


def _dated(file: GnssFile | None, written: _IngestSpan, report: ImportReport) -> GnssSamples | None:
    """The positions of a file, on the day or in the week of the points if it tells none."""
    if file is None:
        return None
    samples = file.dated(written.t_first_ns)
    if file.dating is not Dating.UTC and len(samples):
        report.derive(
            DerivedKind.POSITIONS_DATED,
            format=file.format,
            day=day_of(int(samples.t_ns[0])).isoformat(),
            dateless=file.dating is Dating.DAY,
            weekless=file.dating is Dating.WEEK,
        )
    return samples


def _write_poses(out: Path, parts: Sequence[Trajectory], report: ImportReport) -> None:
    """Keep the poses of an ``Odometry`` topic beside the frames; nothing is computed from them."""
    parts = [part for part in parts if len(part)]
    if not parts:
        return
    t_ns = np.concatenate([part.t_ns for part in parts])
    T = SE3(
        np.concatenate([part.T_a_b.R for part in parts]),
        np.concatenate([part.T_a_b.t for part in parts]),
    )
    later = np.diff(np.maximum.accumulate(t_ns), prepend=np.int64(-1)) > 0
    report.count("poses", int(np.count_nonzero(later)))
    report.derive(DerivedKind.POSES_KEPT)
    write_tum(out / "poses.tum", Trajectory(t_ns[later], T[later]))


# -- report


def _summary(
    recording: Recording, assembler: Assembler, written: _IngestSpan, *, report: ImportReport
) -> dict[str, object]:
    report.warn_of_losses()
    gaps = [*recording.gaps, *assembler.gaps]
    return {
        "kind": recording.kind,
        "outcome": report.outcome,
        "rig": recording.rig.name,
        "sensors": [
            {
                "name": sensor.name,
                "model": sensor.model,
                "topic": sensor.topic,
                "address": sensor.address,
                "port": sensor.port,
                "points": int(written.points[row]),
                "rotation_hz": _number(assembler.rotation_hz.get(sensor.name)),
            }
            for row, sensor in enumerate(recording.rig.sensors)
        ],
        "duration_ns": written.duration_ns,
        "t_first_ns": written.t_first_ns,
        "t_last_ns": written.t_last_ns,
        "counts": dict(sorted(report.counts.items())),
        "gaps": [asdict(gap) for gap in gaps[: LIMITS.gaps]],
        "derived": to_builtins(report.derived),
        "findings": to_builtins(report.findings),
    }


def _number(value: float | None) -> float | None:
    return None if value is None or not np.isfinite(value) else round(float(value), 4)


def _about(samples: ImuSamples | GnssSamples | None) -> dict[str, object] | None:
    if samples is None:
        return None
    span_s = float(samples.t_ns[-1] - samples.t_ns[0]) / 1e9
    rate = (len(samples) - 1) / span_s if span_s > 0 else None
    return {
        "samples": len(samples),
        "rate_hz": _number(rate),
        "t_first_ns": int(samples.t_ns[0]),
        "t_last_ns": int(samples.t_ns[-1]),
    }
