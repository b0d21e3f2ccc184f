"""rosbag2 folders: reads the description of the storage files in ``metadata.yaml``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path, PurePath
from typing import Any

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText, unreadable
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.recording.frame_files.folders import natural
from recon4.recording.report import ImportReport
from recon4.recording.tuning import LISTED

METADATA = "metadata.yaml"
MAX_METADATA_BYTES = 512 << 10
"""A topic takes less than 1 kB."""
_MAX_DEPTH = 20
_MAX_EVENTS = 100_000
_MAX_FILES = 100_000
_NEWEST_VERSION = 9
STORAGE_SUFFIXES = (".db3", ".mcap")


@dataclass(frozen=True, slots=True)
class BagMetadata:
    """The part of ``metadata.yaml`` that is needed to read the files."""

    files: tuple[Path, ...]
    compression: str
    """``file`` or ``message`` (always zstd), or empty."""
    messages: int
    """Expected number of messages in all files."""


def read_metadata(folder: Path) -> BagMetadata:
    """Read the description of a rosbag2.

    Raises:
        CorruptFile: If it is missing, too large, nested too deeply, has references, or is no
            description of a rosbag2.
    """
    path = folder / METADATA
    try:
        with path.open("rb") as file:
            text = file.read(MAX_METADATA_BYTES + 1)
    except OSError as error:
        raise CorruptFile(unreadable(METADATA, error)) from error
    if len(text) > MAX_METADATA_BYTES:
        raise CorruptFile(
            CodedText(
                "bag-metadata-large",
                metadata=METADATA,
                max_metadata_bytes=MAX_METADATA_BYTES,
                size=path.stat().st_size,
            )
        )
    return _metadata(folder, _load(text))


def storage_files(folder: Path, error: CorruptFile) -> tuple[Path, ...]:
    """The storage files of a folder whose description is none, in the order of their numbers.

    Args:
        folder: Where they lie.
        error: Why the description cannot be used.

    Raises:
        CorruptFile: If there are none.
    """
    files = sorted((f for f in folder.iterdir() if f.suffix in STORAGE_SUFFIXES), key=natural)
    if not files:
        raise CorruptFile(
            CodedText("bag-folder-unreadable", folder=folder.name, why=str(error))
        ) from error
    return tuple(files)


def with_files_there(folder: Path, metadata: BagMetadata, report: ImportReport) -> BagMetadata:
    """The description with the files that are there: those it lists, and those it does not.

    Args:
        folder: Where they lie.
        metadata: Its description; it has the earlier names of files that were renamed.
        report: Receives which are missing, and which it does not list.

    Raises:
        CorruptFile: If there is no file at all.
    """
    missing = [file.name for file in metadata.files if not file.is_file()]
    there = tuple(file for file in metadata.files if file.is_file())
    names = ", ".join(missing[: LISTED.few])
    if missing:
        report.outcome = "lossy"
        report.count("files_missing", len(missing))
        values: dict[str, Value] = {"files": len(missing), "missing": names}
        report.warn(FindingKind.FILES_MISSING, name=folder.name, **values)
    if not there:
        absent = CorruptFile(CodedText("bag-files-absent", metadata=METADATA, names=names))
        return replace(metadata, files=storage_files(folder, absent))
    more = _unlisted(folder, metadata)
    if more:
        listed = ", ".join(file.name for file in more[: LISTED.few])
        error = CorruptFile(CodedText("bag-files-unlisted", metadata=METADATA, names=listed))
        report.warn(FindingKind.FOLDER_DESCRIPTION, name=folder.name, error=error)
    return replace(metadata, files=(*there, *more))


def _unlisted(folder: Path, metadata: BagMetadata) -> tuple[Path, ...]:
    """Other storage files, in the order of their numbers; a player leaves copies of packed ones."""
    if metadata.compression == "file":
        return ()
    listed = {file.name for file in metadata.files}
    more = (f for f in folder.iterdir() if f.suffix in STORAGE_SUFFIXES and f.name not in listed)
    return tuple(sorted(more, key=natural))


def say_undescribed(folder: Path, error: CorruptFile, report: ImportReport) -> None:
    """Say that the files of a folder are read one by one.

    Storage files that were moved together have no description; each says by itself whether it is
    whole. A description that is damaged is a warning.
    """
    if (folder / METADATA).exists():
        report.warn(FindingKind.FOLDER_DESCRIPTION, name=folder.name, error=error)
    else:
        report.derive(DerivedKind.FILES_AS_ONE, folder=folder.name, name=METADATA)


def _load(text: bytes) -> Any:
    """The document as dictionaries, lists and strings, built while it is parsed.

    Raises:
        CorruptFile: If it is no YAML, has references, is too deep or too long.
    """
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        return _build(YAML(typ="safe", pure=True).parse(text.decode("utf-8")))
    except (YAMLError, ValueError, TypeError, AttributeError, IndexError) as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise CorruptFile(CodedText("bag-yaml", metadata=METADATA, reason=reason[:200])) from error


def _build(events: Iterator[Any]) -> Any:
    """Build a document without tags and references: every value is a string."""
    from ruamel.yaml.events import AliasEvent, CollectionEndEvent, CollectionStartEvent, ScalarEvent

    open_: list[list[Any]] = [[]]
    kinds: list[str] = ["document"]
    for number, event in enumerate(events):
        line = event.start_mark.line + 1
        if isinstance(event, AliasEvent):
            raise CorruptFile(
                CodedText(
                    "bag-yaml-reference",
                    metadata=METADATA,
                    line=str(line),
                    anchor=str(event.anchor),
                )
            )
        if len(open_) > _MAX_DEPTH or number > _MAX_EVENTS:
            raise CorruptFile(
                CodedText(
                    "bag-yaml-deep",
                    metadata=METADATA,
                    line=str(line),
                    max_depth=_MAX_DEPTH,
                    max_events=_MAX_EVENTS,
                )
            )
        if isinstance(event, CollectionStartEvent):
            open_.append([])
            kinds.append(type(event).__name__)
        elif isinstance(event, CollectionEndEvent):
            items, kind = open_.pop(), kinds.pop()
            pairs = zip(items[::2], items[1::2], strict=True)
            open_[-1].append({str(k): v for k, v in pairs} if kind.startswith("Mapping") else items)
        elif isinstance(event, ScalarEvent):
            open_[-1].append("" if event.value in {"null", "~"} else event.value)
    return open_[0][0]


def _metadata(folder: Path, document: Any) -> BagMetadata:
    try:
        about = document["rosbag2_bagfile_information"]
        version, names = int(about["version"]), list(about["relative_file_paths"])
        messages = int(about["message_count"])
        mode = str(about.get("compression_mode") or "").lower()
        compression = str(about.get("compression_format") or "")
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise CorruptFile(
            CodedText("bag-description", metadata=METADATA, why=repr(error))
        ) from error
    mode = "" if mode == "none" else mode
    if version > _NEWEST_VERSION or mode not in {"", "file", "message"}:
        raise CorruptFile(
            CodedText(
                "bag-version",
                metadata=METADATA,
                newest_version=_NEWEST_VERSION,
                version=version,
                mode=mode[:40],
            )
        )
    if mode and compression != "zstd":
        raise CorruptFile(
            CodedText("bag-compression", metadata=METADATA, compression=compression[:40])
        )
    if not names or len(names) > _MAX_FILES:
        raise CorruptFile(
            CodedText("bag-files-count", metadata=METADATA, max_files=_MAX_FILES, count=len(names))
        )
    # Only the last part of a path is used: a description cannot point outside of its folder.
    files = tuple(folder / PurePath(str(name)).name for name in names)
    return BagMetadata(files, mode, messages)
