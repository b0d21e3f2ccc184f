"""Detects the kind of a recording by its content and opens it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from recon4.errors import ConfigError, RecordingError, UnknownFormat
from recon4.model.laser_scans import LaserScans
from recon4.model.line_scans import LineScans
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig, load_rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.recording.assembly.assembler import LONGEST_WAIT_S, TimeGap
from recon4.recording.assembly.shots import Shots
from recon4.recording.bag_recording import BagRecording
from recon4.recording.cloud_points import model_of_points
from recon4.recording.folders import folder_gaps, list_frames, read_frames
from recon4.recording.formats.bags import Bag
from recon4.recording.formats.cloud_files import read_cloud
from recon4.recording.formats.pcap import OpenFile, open_plain
from recon4.recording.kinds import (
    BAGS,
    RECORDINGS,
    TABLES,
    RecordingKind,
    bag_paths,
    contents_of,
    pcap_files,
    recognize,
)
from recon4.recording.line_recording import WUERZBURG, LineRecording, profiler_rig
from recon4.recording.line_tables import (
    LineTableRecording,
    LineTables,
)
from recon4.recording.report import ImportReport
from recon4.recording.rig_choice import Stream, choose_rig
from recon4.recording.scan_capture import ScanCapture, scan_streams
from recon4.recording.velodyne.capture import WAIT_S, VelodynePcap
from recon4.recording.velodyne.position_packets import PositionSamples
from recon4.recording.velodyne.streams import PacketStream, require_one_capture
from recon4.settings import IngestSettings

Item = Shots | Multiframe | ImuSamples | GnssSamples | Trajectory | LineScans | LaserScans


@dataclass(frozen=True, slots=True)
class Recording:
    """A recording that can be streamed once."""

    kind: RecordingKind
    rig: Rig
    read: Callable[[], Iterator[Item]]
    """Shots, which must be assembled, or multiframes of cloud files."""
    seconds: float = 0.0
    """Approximate duration [s]; 0 = unknown."""
    gaps: tuple[TimeGap, ...] = ()
    """Gaps known before reading."""
    wait_s: float = LONGEST_WAIT_S
    """Largest lead of one sensor's shots over another's [s], see `Assembler`."""


def open_recording(
    paths: Sequence[Path],
    rig: Rig | None,
    *,
    settings: IngestSettings,
    report: ImportReport,
    open_file: OpenFile = open_plain,
) -> Recording:
    """Read the head of a recording and choose its rig.

    Args:
        paths: One recording, or several files of one kind that belong together.
        rig: The rig; None = chosen from what is in the recording.
        settings: Settings of the reader.
        report: Receives what was found and detected.
        open_file: Opens capture files; a live capture uses a tail file.

    Raises:
        RecordingError: If it cannot be read.
        ConfigError: If the rig is wrong or cannot be chosen.
    """
    folders = {path: contents_of(path) for path in paths if path.is_dir()}
    kinds = [folders[path].kind if path in folders else recognize(path) for path in paths]
    kind = _one_kind(paths, kinds, rig)
    for contents in folders.values():
        for text in contents.passed_over():
            report.derive(text)
    if kind is RecordingKind.PCAP:
        files = [f for path in paths for f in pcap_files(path)]
        require_one_capture(files)
        scanning = _scan_rig(files, rig, report)
        if scanning is not None:
            scans = ScanCapture(files, scanning, report=report, open_file=open_file)
            return Recording(kind, scanning, scans.read)
        if rig is None:
            rig = choose_rig(lidars_of_packets(files, settings, report), report)
        pcap = VelodynePcap(files, rig, settings=settings, report=report, open_file=open_file)
        read = partial(_read_pcap, pcap)
        return Recording(kind, pcap.rig, read, stream_seconds(pcap.streams), wait_s=WAIT_S)
    if kind is RecordingKind.FRAMES:
        return _open_frames(paths, rig, settings, report=report)
    if kind is RecordingKind.LINE_TABLES:
        tables = LineTableRecording(LineTables.of(paths), rig, report=report)
        return Recording(kind, tables.rig, tables.read)
    files = [f for path in paths for f in bag_paths(path)]
    bag = _open_bags(files, rig, settings, report=report)
    return Recording(kind, bag.rig, bag.read, bag.seconds)


def _open_bags(
    files: Sequence[Path], rig: Rig | None, settings: IngestSettings, *, report: ImportReport
) -> LineRecording | BagRecording:
    with_profiler = _profiler_rig(files, rig, report)
    if with_profiler is not None:
        return LineRecording(files, with_profiler, report=report, settings=settings)
    return BagRecording(files, rig, settings=settings, report=report)


def _one_kind(
    paths: Sequence[Path], kinds: Sequence[RecordingKind], rig: Rig | None
) -> RecordingKind:
    """The kind of recordings that belong together and fit the rig.

    Raises:
        UnknownFormat: If they do not, or are no recordings.
        ConfigError: If there are none.
    """
    if not paths:
        raise ConfigError("no recording given")
    if RecordingKind.LINE_TABLES in kinds and set(kinds) <= TABLES:
        return RecordingKind.LINE_TABLES
    kind = kinds[0]
    if kind in (RecordingKind.CARMEN, RecordingKind.LASER_TABLE):
        raise UnknownFormat(
            f"{paths[0].name}: {kind}: it has no points of a LiDAR; process it alone"
        )
    if kind not in RECORDINGS:
        raise UnknownFormat(f"{paths[0].name}: {kind} alone is no recording: it has no points")
    with_lines = (*BAGS, RecordingKind.PCAP)
    if rig is not None and rig.row_of("profiler") is not None and kind not in with_lines:
        raise UnknownFormat(
            f"{paths[0].name}: line scans are read from bags, tables or captures, got {kind}"
        )
    if any(other is not kind for other in kinds):
        names = ", ".join(f"{path.name} ({k})" for path, k in zip(paths, kinds, strict=True))
        raise UnknownFormat(f"recordings of one kind expected, got {names}")
    return kind


def _profiler_rig(files: Sequence[Path], rig: Rig | None, report: ImportReport) -> Rig | None:
    """The rig of a bag with line scans; None = it has none."""
    if rig is not None:
        return profiler_rig((), rig, report)
    with Bag(files, ImportReport()) as bag:
        return profiler_rig(bag.topics, None, report)


def _scan_rig(files: Sequence[Path], rig: Rig | None, report: ImportReport) -> Rig | None:
    """The rig of captured datagrams of scans; None = they are packets of LiDARs."""
    if rig is not None:
        kinds = {sensor.kind for sensor in rig.sensors if sensor.enabled}
        return rig if kinds <= {"laser2d", "profiler"} else None
    if not scan_streams(files).heads:
        return None
    report.derive(f"no rig given: line scans, the mounting of the preset {WUERZBURG} is used")
    return load_rig(WUERZBURG)


def lidars_of_packets(
    files: Sequence[Path], settings: IngestSettings, report: ImportReport
) -> list[Stream]:
    """The LiDARs in capture files that belong together.

    Raises:
        EmptyRecording: If there is none.
    """
    found = VelodynePcap(files, None, settings=settings, report=report).rig.sensors
    return [Stream(f"{s.address}:{s.port}", s.model, s.address, s.port) for s in found]


def stream_seconds(streams: Sequence[PacketStream]) -> float:
    """Duration of capture files [s]; an estimate for large files."""
    if not streams:
        return 0.0
    return (max(s.t_end_ns for s in streams) - min(s.t_first_ns for s in streams)) / 1e9


def _read_pcap(pcap: VelodynePcap) -> Iterator[Item]:
    for item in pcap.read():
        if not isinstance(item, PositionSamples):
            yield item
            continue
        if item.imu is not None:
            yield item.imu
        if item.gnss is not None:
            yield item.gnss


def _open_frames(
    paths: Sequence[Path], rig: Rig | None, settings: IngestSettings, *, report: ImportReport
) -> Recording:
    if len(paths) > 1:
        raise UnknownFormat("give the folder of the frames, not several files or folders")
    frames = list_frames(paths[0])
    if rig is None:
        rig = choose_rig([Stream(paths[0].name, frames_model(frames.files))], report)
    elif len(rig.sensors) > 1:
        raise ConfigError(
            f"a folder of frames is one LiDAR, the rig {rig.name!r} has {len(rig.sensors)}"
        )
    gaps = folder_gaps(frames, rig.sensors[0].name, settings.gap_s)
    for gap in gaps[:20]:
        report.warn(f"{gap.sensor}: {gap.seconds:.3f} s from one frame to the next")
    read = partial(read_frames, frames, rig.sensors[0], settings=settings, report=report)
    seconds = len(frames.files) * frames.period_ns / 1e9
    return Recording(RecordingKind.FRAMES, rig, read, seconds, tuple(gaps))


def frames_model(files: Sequence[Path]) -> str:
    """Detect the sensor from the first readable file."""
    for file in files[:3]:
        try:
            return model_of_points(read_cloud(file))
        except RecordingError:
            continue
    return "generic"
