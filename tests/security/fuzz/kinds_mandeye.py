"""Walks of MANDEYE devices: a file of points, and one of samples, in their folder."""

from __future__ import annotations

import json
import tempfile
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

from recon4.recording.mandeye.gnss import read_positions
from recon4.recording.mandeye.imu import read_imu
from recon4.recording.mandeye.status import read_status
from recon4.recording.report import ImportReport
from tests.security.fuzz.kind import Kind, Reading
from tests.security.fuzz.seeds_recordings import read_recording
from tests.unit.recording.test_mandeye import RIG, write_walk
from tests.unit.recording.test_mandeye_positions import write_positions
from tests.unit.recording.test_mandeye_status import DEVICE

_ONE = replace(RIG, sensors=RIG.sensors[:1])


@cache
def _files() -> dict[str, bytes]:
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "walk"
        write_walk(folder, _ONE, seconds=1.0)
        return {path.name: path.read_bytes() for path in folder.iterdir()}


def _seeds(name: str) -> tuple[bytes, ...]:
    return (_files()[name],)


def _beside(name: str, folder: Path) -> None:
    """The other files of the part, below the folder of the trial."""
    (folder / "walk").mkdir()
    for other, data in _files().items():
        if other != name:
            (folder / "walk" / other).write_bytes(data)


def _read(path: Path) -> Reading:
    found = read_recording(path.parent)
    return Reading(found.items, salvaged=found.outcome != "complete" or bool(found.findings))


def _read_samples(path: Path) -> Reading:
    report = ImportReport()
    found = read_imu(path, report)
    return Reading(len(found.samples.t_ns), salvaged=bool(report.lost()))


def _read_status(path: Path) -> Reading:
    report = ImportReport()
    found = read_status([path], report)
    return Reading(len(found.models), salvaged=bool(report.counts["status_files_damaged"]))


def _status() -> tuple[bytes, ...]:
    return (_files()["status0000.json"], json.dumps(DEVICE).encode())


def _positions(name: str) -> tuple[bytes, ...]:
    with tempfile.TemporaryDirectory() as place:
        write_positions(Path(place), ending=name.split(".")[1])
        return ((Path(place) / name).read_bytes(),)


def _read_positions(path: Path) -> Reading:
    report = ImportReport()
    return Reading(len(read_positions(path, report)), salvaged=bool(report.lost()))


KINDS = (
    Kind(
        name="laz-mandeye",
        file_name="walk/lidar0000.laz",
        seeds=partial(_seeds, "lidar0000.laz"),
        read=_read,
        prepare=partial(_beside, "lidar0000.laz"),
    ),
    Kind(
        name="csv-mandeye",
        file_name="imu0000.csv",
        seeds=partial(_seeds, "imu0000.csv"),
        read=_read_samples,
        knows_end=False,  # text has no end mark
    ),
    Kind(
        name="json-mandeye",
        file_name="status0000.json",
        seeds=_status,
        read=_read_status,
        knows_end=False,  # a folder without such a file is whole
    ),
    *(
        Kind(
            name=f"{ending}-mandeye",
            file_name=f"gnss0000.{ending}",
            seeds=partial(_positions, f"gnss0000.{ending}"),
            read=_read_positions,
            knows_end=False,
        )
        for ending in ("gnss", "nmea")
    ),
)
"""Points in a whole walk of one LiDAR; samples, the status and positions alone."""
