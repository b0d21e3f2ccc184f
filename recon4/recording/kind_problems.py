"""What is said of a file or folder that is not one recording: texts with a code."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from recon4.locales.coded import CodedText
from recon4.recording.formats.cloud_files import CLOUD_FORMATS
from recon4.recording.tuning import LISTED

_OTHERS = {
    b"\xff\xd8\xff": "jpeg",
    b"\x89PNG": "png",
    b"PK\x03\x04": "zip",
    b"\x1f\x8b": "gzip",
    b"\xfd7zXZ": "xz",
    b"\x28\xb5\x2f\xfd": "zstd",
    b"BZh": "bzip2",
    b"7z\xbc\xaf": "7z",
    b"%PDF": "pdf",
    b"LASF": "las",
    b"ASTM-E57": "e57",
    b"\x7fELF": "elf",
    b"\x34\xcd\xb2\xa1": "pcap",
    b"\xa1\xb2\xcd\x34": "pcap",
    b"snoop\0\0\0": "snoop",
}
"""First bytes of files that are no recordings -> what they are, as `looks-like` names it."""
_PTX = re.compile(rb"\d+\s*\n\d+\s*\n(?:\S+[ \t]+\S+[ \t]+\S+\s*\n){4}")
"""Columns, rows, position and axes of the scanner, a line each."""
_PACKED = frozenset({".gz", ".xz", ".zst", ".bz2", ".zip", ".7z"})


def known_kinds() -> CodedText:
    """That, and which, kinds of recordings are known."""
    return CodedText("recordings-known", formats=CLOUD_FORMATS)


def is_other(head: bytes) -> bool:
    """Whether the first bytes are those of a file that is no recording."""
    return head.startswith(tuple(_OTHERS))


def unrecognized(name: str, head: bytes) -> CodedText:
    """That no reader recognizes a file, and what it may be by its first bytes."""
    what = "ptx" if _PTX.match(head) else ""
    what = what or next((one for magic, one in _OTHERS.items() if head.startswith(magic)), "")
    known = CodedText("looks-like", what=what)
    looks = known if what else CodedText("looks-unknown", bytes=head[:8].hex(" "))
    return CodedText("recording-unrecognized", name=name, looks=looks, known=known_kinds())


def several_kinds(name: str, held: Mapping[CodedText, str]) -> CodedText:
    """That a folder holds recordings of several kinds.

    Args:
        name: Of the folder.
        held: Text of each kind -> one of its files.
    """
    pairs = [(file, kind) for kind, file in held.items()]
    return CodedText("recording-of-kinds", name=name, number=len(held), held=held_kinds(pairs))


def held_kinds(pairs: Sequence[tuple[str, CodedText]]) -> CodedText:
    """Files with the text of their kinds, as a list; of many the first few."""
    one, *others = (CodedText("held-one", file=file, kind=kind) for file, kind in pairs)
    for other in others[: LISTED.few - 1]:
        one = CodedText("held-more", first=one, next=other)
    return one


def several_recordings(name: str, candidates: Sequence[str]) -> CodedText:
    """That a folder holds several recordings, by their paths in it."""
    held = _listed(candidates)
    return CodedText("recording-of-several", name=name, number=len(candidates), held=held)


def none_inside(name: str, names: Sequence[str]) -> CodedText:
    """That a folder holds no recording.

    Args:
        name: Of the folder.
        names: What is in it.
    """
    packed = sum(Path(one).suffix.lower() in _PACKED for one in names)
    unpack = CodedText("recording-unpack", number=packed)
    remedy = unpack if packed else known_kinds()
    return CodedText("recording-none-inside", name=name, held=_listed(names), remedy=remedy)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[: LISTED.names]) + " …" * (len(names) > LISTED.names)
