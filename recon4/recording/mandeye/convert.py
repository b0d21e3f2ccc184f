"""Converts a recording of LiDARs to a folder of a MANDEYE device."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from recon4.errors import ConfigError
from recon4.model.finding import Finding
from recon4.model.multiframe import Multiframe
from recon4.model.samples import ImuSamples
from recon4.progress import Progress
from recon4.recording.assembly.shots import Shots
from recon4.recording.kinds import located_sources
from recon4.recording.mandeye.write import MandeyeWriter
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
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
        raise ConfigError(f"{folder} exists already: name a new folder")
    report, sources = ImportReport(), located_sources(sources)
    settings = IngestSettings()
    recording = open_recording(OpenRequest(sources.recordings, sources.rig, settings, report))
    progress.start("points", 0, "points")
    own_imu = read_imu_csv(sources.imu, report) if sources.imu else None
    with atomic_folder(folder) as temporary:
        writer = MandeyeWriter(temporary, recording.rig)
        if own_imu is not None:
            writer.push(own_imu)
        for item in recording.read():
            if isinstance(item, Multiframe):
                raise ConfigError(
                    f"{sources.recordings[0].name}: expected packets or messages of LiDARs, got "
                    f"{recording.kind}: they have no points of single sensors"
                )
            if isinstance(item, Shots):
                writer.push(item)
                progress.advance(len(item))
            elif isinstance(item, ImuSamples) and own_imu is None:
                writer.push(item)
        writer.close()
        if not writer.points:
            raise ConfigError(f"{sources.recordings[0].name}: {report.why_no_points()}")
    return Converted(writer.points, writer.samples, tuple(report.lost()), tuple(report.findings))
