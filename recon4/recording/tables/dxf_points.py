"""Points of a drawing (DXF) as a table of named points."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, cast

import numpy as np

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.tables.column_names import column_name
from recon4.recording.tables.tuning import DXF_POINTS

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.entities.dxfentity import DXFEntity
    from ezdxf.entities.insert import Insert

_BINARY = b"AutoCAD Binary DXF"
_BEGIN = re.compile(rb"\s*(?:999\s*\n[^\n]*\n\s*)*0\s*\r?\n\s*SECTION\s", re.ASCII)
_UNITS = {0: "m", 1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m", 7: "km", 14: "dm", 21: "us-ft"}
"""Of ``$INSUNITS``: 0 = the drawing does not say."""
Named = tuple[str, tuple[float, float, float]]


def is_dxf(data: bytes) -> bool:
    """Whether the first bytes are those of a drawing."""
    return data.startswith(_BINARY) or _BEGIN.match(data[:4096]) is not None


def dxf_table(data: bytes, name: str) -> str:
    """Points and blocks of a drawing as lines of ``id, east, north, height``.

    A block with attributes has its name from the one that is named as an id, else from the first.
    A point has the name of the nearest text, if each is the other's nearest; else its number.
    East, north and height are x, y and z: so are drawings of a survey.

    Args:
        data: The file.
        name: For messages.

    Raises:
        CorruptFile: If it is damaged, has no points, or is in a unit that is not known.
    """
    if data.startswith(_BINARY):
        raise CorruptFile(CodedText("dxf-binary", name=name))
    if data.rstrip()[-3:] != b"EOF":
        raise CorruptFile(CodedText("dxf-cut", name=name, data=repr(data[-20:])))
    drawing = _opened(data, name)
    unit = _UNITS.get(drawing.header.get("$INSUNITS", 0), "")
    if not unit:
        code = drawing.header["$INSUNITS"]
        raise CorruptFile(CodedText("dxf-unit", name=name, code=str(code)))
    space = drawing.modelspace()
    inserts = cast("Iterable[Insert]", space.query("INSERT"))
    blocks = [_block(one) for one in inserts if one.attribs]
    points = [_place(one.dxf.location) for one in space.query("POINT")]
    found = [*blocks, *_named(points, list(_texts(space)))]
    if not found:
        raise CorruptFile(CodedText("dxf-no-points", name=name))
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["id", *(f"{axis} [{unit}]" for axis in ("east", "north", "height"))])
    rows.writerows([one, *map(repr, place)] for one, place in found)
    return out.getvalue()


def _opened(data: bytes, name: str) -> Drawing:
    from ezdxf import recover
    from ezdxf.lldxf.const import DXFError

    try:
        drawing, found = recover.read(io.BytesIO(data))
    except (
        DXFError,
        OSError,
        ValueError,
        TypeError,
        KeyError,
        IndexError,
        AttributeError,
    ) as error:
        raise CorruptFile(CodedText("dxf-unreadable", name=name, said=str(error)[:200])) from error
    if found.errors:  # of a damaged drawing what is left would be read
        said = found.errors[0].message
        raise CorruptFile(CodedText("dxf-unreadable", name=name, said=said[:200]))
    return drawing


def _place(point: object) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in point)  # type: ignore[attr-defined]
    return x, y, z


def _block(block: Insert) -> Named:
    named = [one for one in block.attribs if column_name(str(one.dxf.tag)).meaning == "id"]
    text = str((named or block.attribs)[0].dxf.text).strip()
    return text or f"block {block.dxf.handle}", _place(block.dxf.insert)


def _texts(space: object) -> Iterator[Named]:
    """Texts with their places."""
    entities: Iterator[DXFEntity] = iter(space.query("TEXT MTEXT"))  # type: ignore[attr-defined]
    for one in entities:
        plain = one.plain_text() if hasattr(one, "plain_text") else ""
        if plain.strip():
            yield plain.split()[0], _place(one.dxf.insert)


def _named(points: list[tuple[float, float, float]], texts: list[Named]) -> list[Named]:
    """Points with the texts beside them as names."""
    numbers = [str(number) for number in range(1, len(points) + 1)]
    if not texts or not points or len(points) * len(texts) > DXF_POINTS.most_pairs:
        return list(zip(numbers, points, strict=True))
    at, words = np.array(points)[:, :2], np.array([place for _, place in texts])[:, :2]
    apart = np.linalg.norm(at[:, None] - words[None], axis=2)
    nearest, back = apart.argmin(axis=1), apart.argmin(axis=0)
    own = back[nearest] == np.arange(len(points))
    return [
        (texts[nearest[k]][0] if own[k] else numbers[k], place) for k, place in enumerate(points)
    ]
