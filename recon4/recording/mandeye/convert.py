"""Converts a recording of LiDARs to a folder of a MANDEYE device."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText, at
from recon4.model.finding import Finding
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.progress import Progress
from recon4.recording.assembly.shots import Shots
from recon4.recording.kinds import located_sources
from recon4.recording.mandeye.write import MandeyeWriter
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import clean_imu, gather, join
from recon4.recording.samples.csv_files import read_imu_csv
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.store.atomic import atomic_folder


@dataclass(frozen=True, slots=True)
class Converted:
    """What was written."""

    points: int
    samples: int
    lost: tuple[str, ...]
    """Counts of data that could not be read, in words."""
    findings: tuple[Finding, ...]


def convert(sources: Sources, folder: Path, *, progress: Progress) -> Converted:
    """Write the points of each LiDAR in its own frame, and the samples of the IMU.

    Args:
        sources: A recording of LiDARs; its rig numbers them.
        folder: Folder to make; it must not exist.
        progress: Counts points.

    Raises:
        ConfigError: If the folder exists, or the recording has no points of LiDARs as measured.
        RecordingError: If the recording cannot be read.
        StoreError: If the folder cannot be written.
    """
    if folder.exists():
        raise ConfigError(CodedText("folder-exists", folder=str(folder)))
    report, sources = ImportReport(), located_sources(sources)
    settings = IngestSettings()
    recording = open_recording(OpenRequest(sources.recordings, sources.rig, settings, report))
    progress.start("points", 0, "points")
    own_imu = read_imu_csv(sources.imu, report) if sources.imu else None
    imu: list[ImuSamples] = [] if own_imu is None else [own_imu]
    with atomic_folder(folder) as temporary:
        writer = MandeyeWriter(temporary, recording.rig)
        for item in recording.read():
            if isinstance(item, Multiframe):
                raise ConfigError(
                    CodedText(
                        "convert-needs-packets",
                        recordings=sources.recordings[0].name,
                        kind=recording.kind,
                    )
                )
            if isinstance(item, Shots):
                writer.push(item)
                progress.advance(len(item))
            elif isinstance(item, ImuSamples) and own_imu is None:
                gather(imu, item)
        writer.close(_cleaned(imu, recording.rig, report=report))
        if not writer.points:
            raise ConfigError(at(sources.recordings[0].name, report.why_no_points()))
    return Converted(writer.points, writer.samples, tuple(report.lost()), tuple(report.findings))


def _cleaned(parts: Sequence[ImuSamples], rig: Rig, *, report: ImportReport) -> ImuSamples | None:
    """Samples on the clock of the points and in SI units, as a map is made with them."""
    samples = join(parts)
    if samples is None:
        return None
    unit = IngestSettings().imu_gyro_unit
    offset_s = rig.imu_clock_offset_s
    return clean_imu(samples, offset_s=offset_s, jumps_ns=(), report=report, gyro_unit=unit)
