"""Detects the kind of a recording by its content."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from pathlib import Path

from recon4.errors import EmptyRecording, RecordingError, UnknownFormat
from recon4.locales.coded import CodedText
from recon4.recording.formats.bag_folder import STORAGE_SUFFIXES
from recon4.recording.formats.carmen import is_carmen
from recon4.recording.formats.cloud_files import (
    CLOUD_FORMATS,
    CLOUD_SUFFIXES,
    is_cloud_file,
    is_mesh,
    is_plausible_cloud,
)
from recon4.recording.formats.columns import column_names
from recon4.recording.formats.pcap import is_pcap
from recon4.recording.formats.poses import pose_format
from recon4.recording.frame_files.folders import natural
from recon4.recording.gnss.files import is_gnss_file
from recon4.recording.kind_problems import (
    is_other,
    known_kinds,
    none_inside,
    several_kinds,
    several_recordings,
    unrecognized,
)
from recon4.recording.lasers.line_tables import LINE_COLUMNS, is_line_table, table_in
from recon4.recording.lasers.tables import LASER_COLUMNS
from recon4.recording.limits import LIMITS
from recon4.recording.mandeye.folder import is_points_file
from recon4.recording.packets.companions import companion_paths, is_companion
from recon4.recording.packets.datagram_files import is_datagram_file
from recon4.recording.packets.livox.lvx import is_lvx
from recon4.recording.samples.csv_files import GNSS_HEADER, IMU_HEADER
from recon4.recording.sources import Sources


class RecordingKind(StrEnum):
    """Kinds of recordings; the value is their text in English."""

    PCAP = "packets of LiDARs (pcap)"
    LVX = "packets of Livox LiDARs (LVX)"
    BAG1 = "rosbag1"
    BAG2 = "rosbag2"
    FRAMES = f"frames ({CLOUD_FORMATS})"
    IMU_CSV = "IMU samples (CSV)"
    GNSS_FILE = "GNSS positions (CSV, RTKLIB, SBET, UBX, NovAtel, NMEA)"
    POSES = "poses (TUM or KITTI)"
    CARMEN = "CARMEN log of a 2-D laser"
    LINE_TABLES = "line scans (CSV or NPZ)"
    LASER_TABLE = "scans of a 2-D laser (CSV or NPZ)"
    MANDEYE = "walk of a MANDEYE device (LAZ and CSV)"
    LIDAR_FILE = "description of a LiDAR (JSON, CSV, YAML, XML or DAT)"

    @property
    def text(self) -> CodedText:
        """The same with its code, ``recording-NAME``."""
        return CodedText(f"recording-{self.name.lower()}", formats=CLOUD_FORMATS)


CAPTURES = (RecordingKind.PCAP, RecordingKind.LVX)
"""Kinds of files with datagrams."""
PLANAR = (RecordingKind.CARMEN, RecordingKind.LASER_TABLE)
"""Kinds with nothing but scans of a 2-D laser."""
BAGS = (RecordingKind.BAG1, RecordingKind.BAG2)
_KIND_OF_COLUMNS = {
    frozenset(LINE_COLUMNS): RecordingKind.LINE_TABLES,
    frozenset(LASER_COLUMNS): RecordingKind.LASER_TABLE,
    frozenset(IMU_HEADER[:4]): RecordingKind.IMU_CSV,
    frozenset(GNSS_HEADER[:3]): RecordingKind.GNSS_FILE,
}
_KIND_OF_SUFFIX = {
    **dict.fromkeys(STORAGE_SUFFIXES, RecordingKind.BAG2),
    **dict.fromkeys(CLOUD_SUFFIXES, RecordingKind.FRAMES),
    ".bag": RecordingKind.BAG1,
    **dict.fromkeys((".lvx", ".lvx2"), RecordingKind.LVX),
}
"""In folders, where not every file is opened."""


@dataclass(frozen=True)
class FolderContents:
    """What in a folder may be a recording, as it was when it was listed."""

    folder: Path
    kinds: dict[RecordingKind, list[str]]
    """Kinds of recordings directly in it, each with the names of its files."""
    meshes: tuple[str, ...]
    """Models of surfaces directly in it: no recordings."""

    @cached_property
    def folders(self) -> tuple[Path, ...]:
        """Subfolders that are recordings; they are looked through when somebody asks."""
        found: list[Path] = []
        _collect_folders(self.folder, found, depth=LIMITS.folder_depth)
        return tuple(found)

    @property
    def kind(self) -> RecordingKind:
        """The kind of recording that the folder is.

        Raises:
            UnknownFormat: If it is none, or several.
            EmptyRecording: If it is empty.
        """
        if len(self.kinds) == 1:
            return next(iter(self.kinds))
        raise _no_single_recording(self)

    def candidates(self) -> tuple[Path, ...]:
        """Files and subfolders that can be given as a recording on their own."""
        files = [
            self.folder / name
            for kind, names in self.kinds.items()
            for name in names
            if name != "metadata.yaml"
            and kind is not RecordingKind.MANDEYE
            and (kind is not RecordingKind.FRAMES or len(names) == 1)
        ]
        return (*files[: LIMITS.folders], *self.folders)


def recognize(path: Path) -> RecordingKind:
    """Detect the kind of recording at a path.

    Raises:
        UnknownFormat: If no reader supports it; the message lists the supported kinds.
        EmptyRecording: If the file or folder is empty.
        RecordingError: If there is no such path.
    """
    if not path.exists():
        raise RecordingError(CodedText("no-path", path=str(path)))
    try:
        return contents_of(path).kind if path.is_dir() else _file_kind(path)
    except OSError as error:
        reason = error.strerror or str(error)
        text = CodedText("path-unreadable", path=str(path), reason=reason)
        raise RecordingError(text) from error


def bag_paths(path: Path) -> list[Path]:
    """A bag file or rosbag2 folder itself; of a folder of rosbag1 files, those."""
    if path.is_file() or not list(path.glob("*.bag")):
        return [path]
    return sorted(path.glob("*.bag"), key=natural)


def capture_files(path: Path) -> list[Path]:
    """The file itself, or the capture files of a folder.

    Raises:
        RecordingError: If there is no such path.
    """
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise RecordingError(CodedText("no-path", path=str(path)))
    return sorted(filter(_is_capture_file, path.iterdir()), key=natural)


def _file_kind(path: Path) -> RecordingKind:
    with path.open("rb") as file:
        head = file.read(4096)
    if not head:
        raise EmptyRecording(CodedText("file-empty", name=path.name))
    if is_mesh(path):
        text = CodedText("recording-is-mesh", name=path.name, known=known_kinds())
        raise UnknownFormat(text)
    if is_points_file(path.name) and head.startswith(b"LASF"):
        raise UnknownFormat(CodedText("recording-is-part", name=path.name))
    for has_content, kind in _BY_CONTENT:
        if has_content(path):
            return kind
    columns = column_names(path)
    for wanted, kind in _KIND_OF_COLUMNS.items():
        if wanted <= columns:
            return kind
    # Archives and captures of others may have such lines inside.
    for reads, kind in () if is_other(head) else _BY_LINES:
        if reads(path):
            return kind
    raise UnknownFormat(unrecognized(path.name, head))


def _begins(*magic: bytes) -> Callable[[Path], bool]:
    def has_content(path: Path) -> bool:
        with path.open("rb") as file:
            return file.read(16).startswith(magic)

    return has_content


_BY_CONTENT = (
    (is_pcap, RecordingKind.PCAP),
    (is_lvx, RecordingKind.LVX),
    (_begins(b"#ROSBAG V"), RecordingKind.BAG1),
    (_begins(b"SQLite format 3\0", b"\x89MCAP"), RecordingKind.BAG2),
    (is_cloud_file, RecordingKind.FRAMES),
    (is_carmen, RecordingKind.CARMEN),
)
_BY_LINES: tuple[tuple[Callable[[Path], object], RecordingKind], ...] = (
    (is_gnss_file, RecordingKind.GNSS_FILE),
    (pose_format, RecordingKind.POSES),
    (is_companion, RecordingKind.LIDAR_FILE),
)
"""Asked last: they read more of a file."""


def located(path: Path) -> Path:
    """The folder itself, or the only recording in its subfolders if it holds none itself."""
    return _located(contents_of(path)) if path.is_dir() else path


def located_kind(path: Path) -> tuple[Path, RecordingKind]:
    """The path as `located` finds it, and its kind; a folder is listed once.

    Raises:
        RecordingError: As `recognize`.
    """
    if not path.is_dir():
        return path, recognize(path)
    contents = contents_of(path)
    found = _located(contents)
    return found, contents.kind if found == path else recognize(found)


def _located(contents: FolderContents) -> Path:
    alone = not contents.kinds and len(contents.folders) == 1
    return contents.folders[0] if alone else contents.folder


def located_sources(sources: Sources) -> Sources:
    """The sources with each folder replaced by the only recording in its subfolders, if it is so.

    Files beside packets that describe their LiDARs are sources, too.

    Raises:
        RecordingError: If no recording is given, or a file or folder does not exist.
    """
    sources.require()
    recordings = [located(path) for path in sources.recordings]
    beside = companion_paths(filter(_has_packets, recordings), sources.near)
    return replace(sources, recordings=tuple(dict.fromkeys([*recordings, *beside])))


def _has_packets(path: Path) -> bool:
    try:
        return recognize(path) in (RecordingKind.PCAP, *BAGS)
    except RecordingError:  # it is said when the recording is opened
        return False


def located_elsewhere(sources: Sources) -> list[str]:
    """A sentence for each folder in whose place a subfolder is read."""
    pairs = [(path, located(path)) for path in sources.recordings]
    return [f"{path}: its only recording is read, {used}" for path, used in pairs if used != path]


def contents_of(folder: Path) -> FolderContents:
    """List a folder: its recordings and, to a depth of `_DEPTH`, those of its subfolders.

    Raises:
        OSError: If the folder cannot be listed.
    """
    kinds, meshes = _kinds_in(folder)
    return FolderContents(folder, kinds, tuple(meshes))


def _collect_folders(folder: Path, found: list[Path], *, depth: int) -> None:
    """Append the subfolders that are recordings; nothing is searched inside of these."""
    inside = [child for child in folder.iterdir() if not child.name.startswith(".")]
    below = sorted(child for child in inside if child.is_dir() and not child.is_symlink())
    for child in below[: LIMITS.folders]:
        if len(found) >= LIMITS.folders:
            return
        try:
            kinds, _ = _kinds_in(child)
        except OSError:
            continue
        if len(kinds) == 1:
            found.append(child)
        elif depth > 1:
            _collect_folders(child, found, depth=depth - 1)


def _no_single_recording(contents: FolderContents) -> RecordingError:
    path, kinds = contents.folder, contents.kinds
    names = sorted(child.name for child in path.iterdir())
    if not names:
        return EmptyRecording(CodedText("folder-empty", name=path.name))
    candidates = contents.candidates()
    if kinds:
        held = {kind.text: files[0] for kind, files in kinds.items()}
        return UnknownFormat(several_kinds(path.name, held), candidates=candidates)
    if candidates:
        inside = [str(one.relative_to(path)) for one in candidates]
        return UnknownFormat(several_recordings(path.name, inside), candidates=candidates)
    return UnknownFormat(none_inside(path.name, names))


def _kinds_in(path: Path) -> tuple[dict[RecordingKind, list[str]], list[str]]:
    """The kinds of recordings in a folder, each with its files, and the files that are meshes."""
    kinds: dict[RecordingKind, list[str]] = {}
    meshes: list[str] = []
    for name in sorted(child.name for child in path.iterdir()):
        kind = _KIND_OF_SUFFIX.get(Path(name).suffix.lower())
        if name == "metadata.yaml":
            kind = RecordingKind.BAG2
        elif kind is RecordingKind.FRAMES and is_mesh(path / name):
            meshes.append(name)
            continue
        elif kind is RecordingKind.FRAMES and not is_plausible_cloud(path / name):
            kind = None
        elif kind is None and _is_pcap_file(path / name):
            kind = RecordingKind.PCAP
        if kind is not None:
            kinds.setdefault(kind, []).append(name)
    if parts := sorted(child.name for child in path.iterdir() if is_points_file(child.name)):
        kinds[RecordingKind.MANDEYE] = parts
    if (lines := table_in(path, "lines")) and is_line_table(lines):
        kinds[RecordingKind.LINE_TABLES] = [lines.name]
    return kinds, meshes


def _is_pcap_file(path: Path) -> bool:
    return path.is_file() and is_pcap(path)


def _is_capture_file(path: Path) -> bool:
    return path.is_file() and is_datagram_file(path)
