"""Small files beside a recording that describe its LiDARs: metadata, tables of angles.

They are found once, before a recording is opened (`companion_paths`), and are sources like it: a
changed file makes a new map. Readers use those that are given.
"""

from __future__ import annotations

from base64 import b64decode, b64encode
from binascii import Error as NoBase64
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from os import PathLike
from pathlib import Path

from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig, Sensor, load_rig
from recon4.recording.info.files_near import COMPANION_SUFFIXES, files_near
from recon4.recording.limits import LIMITS
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import Companion, same_start

_BYTES = "data:application/octet-stream;base64,"
"""What a description begins with whose file is no text (RFC 2397): a binary table of angles."""


def described_in(rig: Rig | None) -> list[Companion]:
    """The descriptions of sensors in a rig file."""
    sensors = rig.sensors if rig is not None else ()
    return [
        Companion(f"{s.name} (rig file)", _content_of(s.description))
        for s in sensors
        if s.description
    ]


def with_descriptions(rig: Rig, files: Sequence[Path]) -> tuple[Rig, dict[str, str]]:
    """As `described_by` the files beside the rig file.

    Args:
        rig: The rig.
        files: Files beside its own.
    """
    return described_by(rig, companions_of(files))


def load_described_rig(rig: str | PathLike[str]) -> tuple[Rig, dict[str, str]]:
    """A shipped rig or a rig file, with the files beside it as `described_by` them.

    Args:
        rig: Name of a shipped rig, or path of a ``.toml``.

    Raises:
        ConfigError: If it cannot be read.
    """
    path = Path(rig)
    return with_descriptions(load_rig(rig), files_near(path) if path.suffix else [])


def described_by(rig: Rig, found: Sequence[Companion]) -> tuple[Rig, dict[str, str]]:
    """A rig whose LiDARs have some files as descriptions, where that is certain.

    A file is of the LiDAR that its name begins with, or of the only one of its family. A
    description in the rig file stays.

    Args:
        rig: The rig.
        found: The files.

    Returns:
        The rig, and by names of LiDARs those of their files.
    """
    used: dict[str, str] = {}
    sensors = []
    for sensor in rig.sensors:
        alike = [s for s in rig.sensors if _maker(s) == _maker(sensor)]
        fit = [one for one in found if not sensor.description and _is_described(sensor, one)]
        own = [one for one in fit if one.name.startswith(sensor.name)] or fit * (len(alike) == 1)
        if len(own := _most_alike(own)) == 1:
            used[sensor.name] = own[0].name
            sensors.append(replace(sensor, description=_description_of(own[0].content)))
        else:
            sensors.append(sensor)
    return replace(rig, sensors=tuple(sensors)), used


def _description_of(content: bytes) -> str:
    """A file as the description of a sensor: its text, or its bytes as a data URL."""
    try:
        return content.decode()
    except UnicodeDecodeError:
        return _BYTES + b64encode(content).decode()


def _content_of(description: str) -> bytes:
    """The file that a description is; bytes that are damaged stay text, which describes nothing."""
    if description.startswith(_BYTES):
        with suppress(NoBase64):
            return b64decode(description.removeprefix(_BYTES), validate=True)
    return description.encode()


def _most_alike(found: list[Companion]) -> list[Companion]:
    """The files whose names are most like that of a recording among the files, if there is one."""
    best = max((one.likeness for one in found), default=0)
    return [one for one in found if one.likeness == best]


def _maker(sensor: Sensor) -> str:
    return lidar_model(sensor.model).maker


def _is_described(sensor: Sensor, companion: Companion) -> bool:
    """Whether the family of a LiDAR reads a file."""
    families = [one for one in FAMILIES if sensor.kind == "lidar" and one.name == _maker(sensor)]
    return any(family.describes(companion) for family in families)


def is_companion(path: Path) -> bool:
    """Whether a file describes a LiDAR, by its contents."""
    return bool(companions_of([path]))


def companion_paths(recordings: Iterable[Path], near: Iterable[Path] = ()) -> list[Path]:
    """The files near some recordings that describe a LiDAR, by their contents.

    Args:
        recordings: Files or folders.
        near: What `files_near` found before the process was confined: it may not list folders.
    """
    listed = [file for recording in recordings for file in files_near(recording)]
    return [path for path in dict.fromkeys([*near, *listed]) if is_companion(path)]


def companions_of(paths: Sequence[Path]) -> list[Companion]:
    """The files among sources that describe a LiDAR.

    Args:
        paths: Recordings, files or folders, and such files.
    """
    others = [path.stem for path in paths if path.suffix.lower() not in COMPANION_SUFFIXES]
    small = (path for path in dict.fromkeys(paths) if path.suffix.lower() in COMPANION_SUFFIXES)
    found = (_read(path, others) for path in small)
    return [one for one in found if one is not None]


def _read(path: Path, recordings: Sequence[str]) -> Companion | None:
    try:
        if not path.is_file() or path.stat().st_size > LIMITS.companion_bytes:
            return None
        content = path.read_bytes()
    except OSError:  # gone, or of somebody else
        return None
    alike = (same_start(path.stem, name) for name in recordings)
    one = Companion(path.name, content, max(alike, default=0))
    return one if any(family.describes(one) for family in FAMILIES) else None
