"""Reference files of commands: read with the options about them, and how they were read said."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.tables import parse_choice
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.locales.languages import of_terminal

if TYPE_CHECKING:
    from recon4.mapping.tiles import TileSet
    from recon4.slices.map_crs import MapFrame
    from recon4.slices.reference import Reference

ReferenceOption = Annotated[
    Path | None, typer.Option(help="Cloud or mesh: the image shows the distances to it.")
]
ColumnsOption = Annotated[
    str,
    typer.Option(
        metavar="id,x,y,z",
        help="Columns of a reference as text, if their names do not tell: id, x (east), y (north), "
        "z (height), -x, -y, lat, lon, or - (not used).",
    ),
]
UnitOption = Annotated[
    str, typer.Option(help="Unit of the reference: m, dm, cm, mm, km, ft, us-ft or in.")
]
FrameOption = Annotated[
    str,
    typer.Option(
        "--frame", help="Coordinates of the reference: auto, map, or crs (that of the map)."
    ),
]


@contextmanager
def open_reference(
    path: Path | None, reading: tuple[str, str, str], *, tiles: TileSet, frame: MapFrame
) -> Iterator[Reference | None]:
    """Import a reference for the time of a command; how it was read goes to standard error.

    Args:
        path: The file; None = no reference.
        reading: The options ``--columns``, ``--unit`` and ``--frame``.
        tiles: Of the map.
        frame: Of the map.

    Raises:
        ConfigError: With a question, if columns, unit or frame are not certain.
    """
    if path is None:
        yield None
        return
    from recon4.slices.reference import load_reference
    from recon4.slices.reference_import import MapPlace, ReadAs, import_reference

    columns, unit, asked = reading
    if asked not in ("auto", "map", "crs"):
        raise ConfigError(CodedText("reference-frame", asked=asked[:40]))
    read_as = ReadAs(asked, parse_choice(columns, unit))
    with TemporaryDirectory(prefix="recon4-reference-") as scratch:
        out = Path(scratch) / "reference"
        facts = import_reference(path, out, read_as=read_as, place=MapPlace(frame, tiles.bounds_m))
        for note in facts.notes:
            sys.stderr.write(f"{facts.file}: {note.said(of_terminal())}\n")
        yield load_reference(out)
