"""The XML section of an E57 file, checked before a library sees it.

libE57 gives it to Xerces, which fetches document types, entities and schemas from any address a
file names, and recurses over nested elements. An E57 file needs none of that (ASTM E2807).

The file consists of pages of 1024 bytes: 1020 of data and their CRC-32C, big-endian. Offsets in
the header are physical, lengths logical, that is, without the checksums.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText, text_of

_HEADER = struct.Struct("<8sIIQQQQ")
_PAGE, _DATA = 1024, 1020
MAX_XML_BYTES = 16 << 20
MAX_DEPTH = 64
MAX_ELEMENTS = 1_000_000
MAX_ATTRIBUTES = 64
"""Of one element."""
_SCHEMA_NAMESPACE = "http://www.w3.org/2001/XMLSchema-instance"
_CRC32C = 0x82F63B78
"""The polynomial of Castagnoli, reflected."""


def check_e57_xml(path: Path) -> None:
    """Check that the XML section of an E57 file is small, plain XML that refers to nothing.

    Raises:
        CorruptFile: If it is damaged, too large or too deep, or refers to something outside.
    """
    try:
        _check(_xml_section(path))
    except _Refused as error:
        raise CorruptFile(CodedText("e57-xml", file=path.name, why=text_of(error))) from None
    except expat.ExpatError as error:
        raise CorruptFile(CodedText("e57-xml-unsound", file=path.name, why=str(error))) from None


def e57_coordinate_metadata(path: Path) -> str:
    """The coordinate reference system that an E57 file states as text; empty = none.

    Raises:
        CorruptFile: As `check_e57_xml`.
    """
    check_e57_xml(path)
    found: list[str] = []
    inside: list[str] = []
    parser = expat.ParserCreate(namespace_separator=" ")

    def text(data: str) -> None:
        if len(inside) == 2 and inside[-1].endswith("coordinateMetadata"):
            found.append(data)

    parser.StartElementHandler = lambda name, attributes: inside.append(name)
    parser.EndElementHandler = lambda name: inside.pop()
    parser.CharacterDataHandler = text
    parser.Parse(_xml_section(path), True)
    return "".join(found).strip()


class _Refused(Exception):
    """What is wrong with the XML section."""


def _xml_section(path: Path) -> bytes:
    """The section without its checksums, which are verified.

    Raises:
        _Refused: If the header or a checksum is wrong.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(_HEADER.size)
        if len(head) < _HEADER.size:
            raise _Refused(CodedText("e57-header-cut", size=_HEADER.size, count=len(head)))
        _, _, _, _, offset, length, page_size = _HEADER.unpack(head)
        if page_size != _PAGE:
            raise _Refused(CodedText("e57-page-size", page=_PAGE, page_size=str(page_size)))
        if length > MAX_XML_BYTES:
            raise _Refused(
                CodedText("e57-xml-large", length=str(length), max_xml_bytes=MAX_XML_BYTES)
            )
        first, within = divmod(offset, _PAGE)
        if within > _DATA:
            raise _Refused(CodedText("e57-xml-begin", offset=str(offset)))
        count = -(-(within + length) // _DATA)
        if (first + count) * _PAGE > size:
            raise _Refused(CodedText("e57-xml-end", first=str((first + count) * _PAGE), size=size))
        file.seek(first * _PAGE)
        pages = np.frombuffer(file.read(count * _PAGE), np.uint8).reshape(-1, _PAGE)
    data = np.ascontiguousarray(pages[:, :_DATA])
    expected = np.ascontiguousarray(pages[:, _DATA:]).view(">u4").ravel()
    wrong = np.flatnonzero(_checksums(data) != expected)
    if len(wrong):
        raise _Refused(CodedText("e57-checksum", first=str(first + wrong[0]), count=len(wrong) - 1))
    return data.tobytes()[within : within + length]


def _checksums(pages: NDArray[np.uint8]) -> NDArray[np.uint32]:
    """CRC-32C of each row, all rows at once."""
    table = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        table = (table >> np.uint32(1)) ^ (table & np.uint32(1)) * np.uint32(_CRC32C)
    value = np.full(len(pages), 0xFFFFFFFF, np.uint32)
    for column in pages.T:
        value = table[(value ^ column) & 0xFF] ^ (value >> np.uint32(8))
    return value ^ np.uint32(0xFFFFFFFF)


@dataclass
class _Counts:
    depth: int = 0
    elements: int = 0

    def begin(self, name: str, attributes: dict[str, str]) -> None:
        self.depth += 1
        self.elements += 1
        if self.depth > MAX_DEPTH:
            raise _Refused(CodedText("xml-deep", max_depth=MAX_DEPTH))
        if self.elements > MAX_ELEMENTS:
            raise _Refused(CodedText("xml-elements", max_elements=MAX_ELEMENTS))
        if len(attributes) > MAX_ATTRIBUTES:
            raise _Refused(
                CodedText("xml-attributes", name=name[:80], max_attributes=MAX_ATTRIBUTES)
            )
        for attribute in attributes:
            if attribute.startswith(_SCHEMA_NAMESPACE):
                raise _Refused(CodedText("xml-schema"))

    def end(self, name: str) -> None:
        self.depth -= 1


def _check(xml: bytes) -> None:
    """Parse without building anything.

    Raises:
        _Refused: If it is not plain.
        expat.ExpatError: If it is not sound.
    """
    try:
        xml.decode("utf-8")
    except UnicodeDecodeError as error:
        raise _Refused(CodedText("xml-utf8", reason=error.reason, start=error.start)) from None
    counts = _Counts()
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.XmlDeclHandler = _only_utf8
    parser.StartDoctypeDeclHandler = _refuse_doctype
    parser.ProcessingInstructionHandler = _refuse_instruction
    parser.StartElementHandler, parser.EndElementHandler = counts.begin, counts.end
    parser.Parse(xml, True)


def _only_utf8(version: str, encoding: str | None, standalone: int) -> None:
    if encoding is not None and encoding.lower() not in ("utf-8", "us-ascii"):
        raise _Refused(CodedText("xml-encoding", encoding=encoding[:40]))


def _refuse_doctype(name: str, system: str | None, public: str | None, internal: int) -> None:
    raise _Refused(CodedText("xml-doctype"))


def _refuse_instruction(target: str, data: str) -> None:
    raise _Refused(CodedText("xml-instruction", target=target[:40]))
