"""The walks of a folder: which recordings it holds, and where their projects go."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import ConfigError, RecordingError
from recon4.locales.coded import CodedText
from recon4.recording.info.nearby_samples import nearby_samples
from recon4.recording.kinds import RecordingKind, contents_of, recognize

_NO_WALKS = (
    RecordingKind.IMU_CSV,
    RecordingKind.GNSS_FILE,
    RecordingKind.POSES,
    RecordingKind.LIDAR_FILE,
    RecordingKind.FRAMES,
)
"""Kinds of files that belong to a walk and are none by themselves."""
RIG_FILE = "rig.toml"
"""Name of the rig file in the folder of a walk."""
_SUFFIXES = (".pcap", ".pcapng", ".bag", ".mcap", ".db3", ".lvx", ".lvx2")


@dataclass(frozen=True, slots=True)
class WalkTask:
    """A walk that is to become a project; plain text, because it is sent to workers."""

    name: str
    """Of its project."""
    recording: str
    """Absolute path."""
    out: str
    """Absolute path of its project folder."""
    options: tuple[str, ...] = ()
    """Further arguments of ``recon4 process``."""


@dataclass(frozen=True, slots=True)
class FoundWalks:
    """What lies in a folder."""

    recordings: tuple[Path, ...]
    """In the order of their names."""
    left_out: tuple[str, ...]
    """Names of what is no walk."""


def find_walks(folder: Path) -> FoundWalks:
    """The recordings in a folder; each file, and each subfolder that is one, is a walk.

    Raises:
        ConfigError: If there is no such folder, it is a recording itself, or holds none.
    """
    if not folder.is_dir():
        raise ConfigError(CodedText("batch-no-folder", folder=str(folder)))
    contents = contents_of(folder)
    of_scans = (RecordingKind.FRAMES, RecordingKind.MANDEYE, RecordingKind.LINE_TABLES)
    if any(len(contents.kinds.get(kind, ())) > 1 for kind in of_scans):
        raise ConfigError(CodedText("batch-one", folder=str(folder)))
    files = [path for path in folder.iterdir() if path.is_file() and _is_walk(path)]
    walks = sorted([*files, *contents.folders])
    if not walks:
        raise ConfigError(CodedText("batch-none", folder=str(folder)))
    tops = {path.relative_to(folder).parts[0] for path in walks}
    others = sorted(child.name for child in folder.iterdir() if child.name not in tops)
    return FoundWalks(tuple(walks), tuple(others))


def walk_tasks(
    folder: Path, recordings: tuple[Path, ...], *, out: Path, options: tuple[str, ...]
) -> list[WalkTask]:
    """A task for each recording, with a project folder of its own.

    A walk that is a folder is given the samples and the rig file in it; ``--rig`` in the options
    stands for that of all.

    Args:
        folder: That holds the recordings.
        recordings: Of the walks.
        out: Folder of the projects.
        options: Further arguments of ``recon4 process``.

    Raises:
        ConfigError: If two recordings would become one project.
    """
    names = [_project_name(path.relative_to(folder)) for path in recordings]
    for name, count in Counter(names).items():
        if count > 1:
            both = ", ".join(
                str(one) for one, own in zip(recordings, names, strict=True) if own == name
            )
            raise ConfigError(CodedText("batch-same-name", both=both, name=name))
    return [
        WalkTask(name, str(path), str((out / name).absolute()), (*_beside(path, options), *options))
        for path, name in zip((one.absolute() for one in recordings), names, strict=True)
    ]


def _beside(walk: Path, options: tuple[str, ...]) -> Iterator[str]:
    """Options for the files that lie in the folder of a walk."""
    if not walk.is_dir():
        return
    for option, kind in (("--imu", RecordingKind.IMU_CSV), ("--gnss", RecordingKind.GNSS_FILE)):
        if file := nearby_samples([walk], kind):
            yield from (option, str(file))
    if (rig := walk / RIG_FILE).is_file() and "--rig" not in options:
        yield from ("--rig", str(rig))


def _is_walk(file: Path) -> bool:
    """Whether a file is a walk by itself; damaged ones count, their processes say what is wrong."""
    try:
        return recognize(file) not in _NO_WALKS
    except RecordingError:
        return file.suffix.lower() in _SUFFIXES


def _project_name(relative: Path) -> str:
    return "-".join(relative.with_suffix("").parts)
