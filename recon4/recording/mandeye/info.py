"""Contents of a folder of a MANDEYE device, for ``recon4 info``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from recon4.locales.coded import CodedText
from recon4.recording.info.records import RecordingInfo, SensorInfo
from recon4.recording.mandeye.folder import list_walk
from recon4.recording.mandeye.read import walk_streams
from recon4.recording.openers.mandeye import walk_seconds
from recon4.recording.report import ImportReport


def describe_walk(info: RecordingInfo, folder: Path) -> RecordingInfo:
    """The LiDARs of the parts; their times and numbers of points are those of the heads.

    Raises:
        RecordingError: If no part has points, or there are several walks.
    """
    walk = list_walk(folder, ImportReport())  # what is damaged is said when it is opened
    points = sum(part.points for part in walk.parts)
    seconds = walk_seconds(walk)
    first = walk.parts[0].t_first_ns
    streams = walk_streams(walk)
    sensors = tuple(
        SensorInfo(
            label=f"{stream.label} {stream.serial}".strip(),
            model=stream.model,
            content=CodedText("content-points", files=len(walk.parts), lidars=len(streams)),
            count=points,
            rate_hz=points / seconds if seconds > 0.0 else float("nan"),
        )
        for stream in streams
    )
    with_imu = sum(part.imu is not None for part in walk.parts)
    samples = []
    if with_imu:
        samples.append(CodedText("samples-imu-files", files=with_imu, what="imu"))
    if walk.positions:
        samples.append(CodedText("samples-gnss-files", files=len(walk.positions), what="gnss"))
    last = first + round(seconds * 1e9)
    return replace(
        info,
        t_first_ns=first,
        t_last_ns=last,
        estimated=True,
        sensors=sensors,
        samples=tuple(samples),
    )
