"""Opens a recording with the openers of its kind: a table, and nothing that knows a sensor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from recon4.errors import ConfigError, UnknownFormat
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.recording.clocks.jumps import with_jumps_removed
from recon4.recording.clocks.rates import with_clock_rates
from recon4.recording.kind_problems import held_kinds
from recon4.recording.kinds import PLANAR, FolderContents, RecordingKind, contents_of, recognize
from recon4.recording.lasers.line_tables import LineTableRecording, LineTables
from recon4.recording.openers.bags import open_lidar_bag, open_line_bag
from recon4.recording.openers.captures import open_lidar_capture, open_lvx, open_scan_capture
from recon4.recording.openers.frames import open_frames
from recon4.recording.openers.mandeye import open_mandeye
from recon4.recording.openers.request import Opener, OpenRequest, Recording
from recon4.recording.report import ImportReport


@dataclass(frozen=True, slots=True)
class KindRow:
    """How recordings of one kind are opened."""

    openers: tuple[Opener, ...]
    """Asked in this order; the first one whose contents they are opens them. The last one takes
    what nobody else does, or says what is missing."""
    beside: frozenset[RecordingKind] = field(default=frozenset())
    """Kinds whose files belong to the same recording."""


_LIDAR_FILES = frozenset({RecordingKind.LIDAR_FILE})
_BAG = KindRow((open_line_bag, open_lidar_bag), _LIDAR_FILES)
Kinds = Mapping[RecordingKind, KindRow]


def open_line_tables(request: OpenRequest) -> Recording:
    """Tables of line scans, with those of the 2-D laser and the IMU beside them."""
    tables = LineTableRecording(LineTables.of(request.paths), request.rig, report=request.report)
    return Recording(tables.rig, tables.read)


KINDS: Kinds = {
    RecordingKind.PCAP: KindRow((open_scan_capture, open_lidar_capture), _LIDAR_FILES),
    RecordingKind.LVX: KindRow((open_lvx,)),
    RecordingKind.BAG1: _BAG,
    RecordingKind.BAG2: _BAG,
    RecordingKind.FRAMES: KindRow((open_frames,)),
    RecordingKind.MANDEYE: KindRow((open_mandeye,)),
    RecordingKind.LINE_TABLES: KindRow(
        (open_line_tables,), frozenset({RecordingKind.LASER_TABLE, RecordingKind.IMU_CSV})
    ),
}
"""Kinds with points. `recon4.recording.kinds` detects them."""


def open_recording(request: OpenRequest, kinds: Kinds = KINDS) -> Recording:
    """Read the head of a recording and choose its rig.

    Args:
        request: What is opened.
        kinds: The openers of each kind.

    Raises:
        RecordingError: If it cannot be read.
        ConfigError: If the rig is wrong or cannot be chosen.
    """
    paths = request.paths
    folders = {path: contents_of(path) for path in paths if path.is_dir()}
    found = [folders[path].kind if path in folders else recognize(path) for path in paths]
    kind = _one_kind(paths, found, kinds)
    for contents in folders.values():
        _say_passed_over(contents, request.report)
    for opener in kinds[kind].openers:
        recording = opener(request)
        if recording is not None:
            named = replace(recording, kind=recording.kind or str(kind))
            rated = with_clock_rates(named, request.report)
            return with_jumps_removed(rated, request.jumps)
    raise UnknownFormat(CodedText("recording-no-sensor", name=paths[0].name, kind=kind.text))


def _say_passed_over(contents: FolderContents, report: ImportReport) -> None:
    """State what is not read because the folder itself is a recording."""
    for name in contents.meshes:
        report.derive(DerivedKind.FILE_PASSED_OVER, name=name)
    if contents.folders:
        names = ", ".join(str(one.relative_to(contents.folder)) for one in contents.folders[:8])
        report.derive(DerivedKind.FOLDERS_PASSED_OVER, folders=names)


def _one_kind(
    paths: Sequence[Path],
    found: Sequence[RecordingKind],
    kinds: Kinds,
) -> RecordingKind:
    """The kind of recordings that belong together.

    Raises:
        UnknownFormat: If they do not, or are no recordings.
        ConfigError: If there are none.
    """
    if not paths:
        raise ConfigError(CodedText("recording-not-given"))
    for kind in found:
        if kind in kinds and kinds[kind].beside and set(found) <= {kind, *kinds[kind].beside}:
            return kind
    kind = found[0]
    if kind in PLANAR:
        text = CodedText("recording-planar-alone", name=paths[0].name, kind=kind.text)
        raise UnknownFormat(text)
    if kind not in kinds:
        text = CodedText("recording-without-points", name=paths[0].name, kind=kind.text)
        raise UnknownFormat(text)
    if any(other is not kind for other in found):
        held = held_kinds([(path.name, k.text) for path, k in zip(paths, found, strict=True)])
        raise UnknownFormat(CodedText("recording-one-kind", held=held))
    return kind
