"""Opener of folders with a file per revolution of one LiDAR."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from recon4.errors import ConfigError, RecordingError, UnknownFormat
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.model.point_recipes import PointRecipe
from recon4.model.rig import Rig
from recon4.recording.clocks.jumps import without_jumps
from recon4.recording.clouds.cloud_points import model_of_points
from recon4.recording.frame_files.folders import folder_gaps, list_frames, read_frames, read_points
from recon4.recording.openers.request import OpenRequest, Recording
from recon4.recording.recipes.file_points import require_fields
from recon4.recording.rigs.choice import Stream, choose_rig
from recon4.recording.tuning import LISTED, IngestTuning
from recon4.settings.tuning import tuned


def open_frames(request: OpenRequest) -> Recording:
    """A folder of cloud files."""
    paths, settings, report = request.paths, request.settings, request.report
    if len(paths) > 1:
        raise UnknownFormat(CodedText("frames-one-folder"))
    frames = list_frames(paths[0])
    frames = replace(frames, t_ns=without_jumps(frames.t_ns, request.jumps))
    for one in frames.derived:
        report.keep(one)
    rig = request.rig
    fields = request.fields if rig is None else rig.sensors[0].fields
    period_s = frames.period_ns / 1e9
    require_fields(paths[0].name, frames.files, fields, period_s=period_s, report=report)
    if rig is None:
        model = frames_model(frames.files, fields)
        rig = choose_rig([Stream(paths[0].name, model, fields=fields)], report)
    _require_one_lidar(rig, paths[0])
    sensor = rig.sensors[0]
    gaps = folder_gaps(frames, sensor.name, tuned(IngestTuning, settings).gap_s)
    for gap in [gap for gap in gaps if gap.seconds > 0.0][: LISTED.names]:
        since_s = (gap.t_ns - int(frames.t_ns[0])) / 1e9
        report.warn(
            FindingKind.TIME_GAP,
            sensor=gap.sensor,
            start_s=since_s,
            end_s=since_s + gap.seconds,
            seconds=gap.seconds,
        )
    read = partial(read_frames, frames, sensor, settings=settings, report=report)
    return Recording(rig, read, len(frames.files) * frames.period_ns / 1e9, tuple(gaps))


def _require_one_lidar(rig: Rig, path: Path) -> None:
    """Refuse rigs of which a folder of frames has no data.

    Raises:
        UnknownFormat: If the rig has a profiler.
        ConfigError: If it has several sensors.
    """
    if rig.row_of("profiler") is not None:
        raise UnknownFormat(CodedText("frames-line-scans", file=path.name))
    if len(rig.sensors) > 1:
        raise ConfigError(CodedText("frames-one-lidar", rig=rig.name, count=len(rig.sensors)))


def frames_model(files: Sequence[Path], fields: PointRecipe | None) -> str:
    """Detect the sensor from the first readable file."""
    for file in files[:3]:
        try:
            return model_of_points(read_points(file, fields))
        except RecordingError:
            continue
    return "generic"
