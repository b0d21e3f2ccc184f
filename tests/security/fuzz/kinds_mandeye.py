"""Walks of MANDEYE devices: a file of points, and one of samples, in their folder."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

from tests.security.fuzz.kind import Kind, Reading
from tests.security.fuzz.seeds_recordings import read_recording
from tests.unit.recording.test_mandeye import RIG, write_walk

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
    return Reading(found.items, salvaged=found.outcome != "complete" or bool(found.warnings))


MANDEYE_KINDS = tuple(
    Kind(
        name=kind,
        file_name=f"walk/{name}",
        seeds=partial(_seeds, name),
        read=_read,
        prepare=partial(_beside, name),
        knows_end=knows_end,
    )
    for kind, name, knows_end in (
        ("laz-mandeye", "lidar0000.laz", True),
        # Text has no end mark.
        ("csv-mandeye", "imu0000.csv", False),
    )
)
"""Each of a whole walk of one LiDAR."""
