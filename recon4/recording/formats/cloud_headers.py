"""Formats of point clouds with a header: fields, rows, encoding, checked before any row is read.

`HEADER_FORMATS` at the end is their table; whatever reads clouds takes the formats from there.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText

HEADER_BYTES = 64 * 1024
"""Largest size of a header."""
MAX_FIELDS = 256
MAX_ROW_BYTES = 64 * 1024
_MAX_COUNT = 4096
"""Values of one field: the longest descriptors of PCL have 1960."""
_PCD_TYPES = {
    **{("F", "4"): "f4", ("F", "8"): "f8"},
    **{(kind, str(size)): f"{kind.lower()}{size}" for kind in "IU" for size in (1, 2, 4, 8)},
}
_PLY_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "float32": "f4", "double": "f8", "float64": "f8"},
}
_PLY_ORDER = {"ascii": "<", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True, slots=True)
class Field:
    """One field of a row."""

    name: str
    """In lower case; empty = padding."""
    dtype: str
    """Type of one value, with byte order."""
    count: int = 1
    """Values of the field in a row; only the first is used."""

    @property
    def row_bytes(self) -> int:
        """Bytes of the field in a binary row."""
        return np.dtype(self.dtype).itemsize * self.count


@dataclass(frozen=True, slots=True)
class CloudLayout:
    """Layout of the rows after a header."""

    fields: tuple[Field, ...]
    rows: int
    encoding: str
    """``ascii``, ``binary`` or ``binary_compressed``."""
    data_at: int
    """Offset of the first row [bytes]."""

    @property
    def row_bytes(self) -> int:
        """Bytes of a binary row."""
        return sum(field.row_bytes for field in self.fields)

    def row_dtype(self) -> np.dtype[np.void]:
        """Record of one binary row; field ``k`` is ``fk``."""
        return np.dtype([(f"f{k}", f.dtype, (f.count,)) for k, f in enumerate(self.fields)])

    def named(self) -> dict[str, int]:
        """Name -> row in ``fields``; the first of those with the same name."""
        out: dict[str, int] = {}
        for k, field in enumerate(self.fields):
            if field.name:
                out.setdefault(field.name, k)
        return out


def is_ply(head: bytes) -> bool:
    """Whether the first bytes are those of a PLY file."""
    return re.match(rb"ply[ \t]*[\r\n]", head) is not None


def is_pcd(head: bytes) -> bool:
    """Whether the first `HEADER_BYTES` bytes are those of a PCD file."""
    return head[:1] in (b"#", b"V", b"F") and b"\nDATA " in head and b"FIELDS " in head


def pcd_layout(head: bytes, name: str) -> CloudLayout:
    """Read the header of a PCD file.

    Raises:
        CorruptFile: If it is damaged, with the expected and the found value.
    """
    words, at = _pcd_words(head, name)
    try:
        names, sizes, kinds = words["FIELDS"], words["SIZE"], words["TYPE"]
        counts = words.get("COUNT", ["1"] * len(names))
        fields = tuple(
            Field("" if f == "_" else f.lower(), "<" + _PCD_TYPES[k, s], whole(c))
            for f, s, k, c in zip(names, sizes, kinds, counts, strict=True)
        )
        grid = whole(words["WIDTH"][0]) * whole(words.get("HEIGHT", ["1"])[0])
        rows = whole(words.get("POINTS", [str(grid)])[0])
        encoding = words["DATA"][0]
    except (KeyError, ValueError, IndexError) as error:
        raise CorruptFile(CodedText("pcd-header", name=name, why=repr(error))) from error
    if rows != grid:
        raise CorruptFile(CodedText("pcd-size", name=name, grid=grid, rows=rows))
    if encoding not in ("ascii", "binary", "binary_compressed"):
        raise CorruptFile(CodedText("pcd-data", name=name, encoding=encoding[:40]))
    return _checked(CloudLayout(fields, rows, encoding, at), name)


def _pcd_words(head: bytes, name: str) -> tuple[dict[str, list[str]], int]:
    """Words of the lines up to DATA, and where the next line starts."""
    words: dict[str, list[str]] = {}
    at = 0
    while "DATA" not in words:
        end = head.find(b"\n", at)
        if end < 0:
            raise CorruptFile(CodedText("pcd-no-data", name=name))
        line = head[at:end].decode("latin1").split("#")[0].split()
        if line and line[0] in words:
            raise CorruptFile(CodedText("pcd-line-twice", name=name, line=line[0][:40]))
        if line:
            words[line[0]] = line[1:]
        at = end + 1
    return words, at


def ply_layout(head: bytes, name: str) -> CloudLayout:
    """Read the header of a PLY file up to the rows of its vertices.

    Raises:
        CorruptFile: If it is damaged, with the expected and the found value.
    """
    end = head.find(b"end_header")
    line_end = head.find(b"\n", end)
    if end < 0 or line_end < 0:
        raise CorruptFile(CodedText("ply-endless", name=name))
    fields: list[Field] = []
    counts: dict[str, int] = {}
    element, encoding = "", ""
    try:
        for words in filter(None, map(str.split, head[:end].decode("latin1").splitlines())):
            if words[0] == "format":
                encoding = words[1]
            elif words[0] == "element":
                element = _ply_element(words, counts, name)
            elif words[0] == "property" and element == "vertex":
                fields.append(_ply_field(words, encoding, name))
    except (KeyError, ValueError, IndexError) as error:
        raise CorruptFile(CodedText("ply-header", name=name, why=repr(error))) from error
    if "vertex" not in counts or not fields or encoding not in _PLY_ORDER:
        raise CorruptFile(CodedText("ply-vertex-missing", name=name))
    kind = "ascii" if encoding == "ascii" else "binary"
    return _checked(CloudLayout(tuple(fields), counts["vertex"], kind, line_end + 1), name)


def _ply_element(words: list[str], counts: dict[str, int], name: str) -> str:
    element = words[1]
    if not counts and element != "vertex":
        raise CorruptFile(CodedText("ply-vertex-first", name=name, element=element[:40]))
    if element in counts:
        raise CorruptFile(CodedText("ply-element-twice", name=name, element=element[:40]))
    counts[element] = whole(words[2])
    return element


def _ply_field(words: list[str], encoding: str, name: str) -> Field:
    if words[1] == "list":
        raise CorruptFile(CodedText("ply-vertex-list", name=name, words=words[-1][:40]))
    # CloudCompare writes each scalar field as scalar_NAME.
    key = words[2].lower().removeprefix("scalar_") or words[2].lower()
    return Field(key, _PLY_ORDER[encoding] + _PLY_TYPES[words[1]])


def whole(text: str) -> int:
    """A count in decimal digits.

    Raises:
        ValueError: If it is something else, or has more than 18 digits.
    """
    if not (text.isascii() and text.isdigit() and len(text) <= 18):
        raise ValueError(f"expected a count, got {text[:40]!r}")
    return int(text)


def _checked(layout: CloudLayout, name: str) -> CloudLayout:
    if not 1 <= len(layout.fields) <= MAX_FIELDS:
        raise CorruptFile(
            CodedText(
                "cloud-fields-count", name=name, max_fields=MAX_FIELDS, count=len(layout.fields)
            )
        )
    counts = [field.count for field in layout.fields]
    if min(counts) < 1 or max(counts) > _MAX_COUNT or layout.row_bytes > MAX_ROW_BYTES:
        raise CorruptFile(
            CodedText(
                "cloud-values-count",
                name=name,
                max_count=_MAX_COUNT,
                max_row_bytes=MAX_ROW_BYTES,
                counts=max(counts),
                row_bytes=layout.row_bytes,
            )
        )
    return layout


@dataclass(frozen=True, slots=True)
class HeaderFormat:
    """A format of point clouds, each file of which says in its header where its rows lie."""

    name: str
    """For messages."""
    suffix: str
    """Of the files that are frames of a folder."""
    is_of: Callable[[bytes], bool]
    """Whether the first `HEADER_BYTES` bytes are those of such a file."""
    layout: Callable[[bytes, str], CloudLayout]
    """Layout of its rows, from the same bytes and the name of the file. It raises `CorruptFile` if
    the header is damaged. Whether the file is as long as it says is checked afterwards."""


HEADER_FORMATS = (
    HeaderFormat("PCD", ".pcd", is_pcd, pcd_layout),
    HeaderFormat("PLY", ".ply", is_ply, ply_layout),
)


def header_format(head: bytes) -> HeaderFormat | None:
    """The format whose first `HEADER_BYTES` bytes these are; None = none of the table."""
    return next((one for one in HEADER_FORMATS if one.is_of(head)), None)
