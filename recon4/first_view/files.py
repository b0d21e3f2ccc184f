"""Files of a map that the page *Map* reads first, beside its tiles: opened without any work.

index.json        the index (`recon4.first_view.records`)
xyz.bin           coarse points (`recon4.first_view.cubes`)
normalized.bin    the values that color them at first, or of another column
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from recon4.errors import StoreError
from recon4.first_view.cubes import write_cubes
from recon4.first_view.index import index_of
from recon4.first_view.records import MapIndex, Stored
from recon4.first_view.tuning import MAP_CHUNKS
from recon4.geometry.se3 import Array
from recon4.locales.coded import at
from recon4.mapping.tiles import TileSet
from recon4.store.atomic import write_json
from recon4.untrusted.bounded import read_bytes_limited
from recon4.untrusted.typed import decoded

if TYPE_CHECKING:
    from recon4.slices.map_crs import MapFrame

FIRST_FILES = f"first-{MAP_CHUNKS.version}"
"""Folder of these files in the artifact of a map; one of another layout has another name."""
INDEX = "index.json"


def coarse_name(stored: Stored) -> str:
    """Name of the file of coarse points."""
    return f"{stored}.bin"


def write_first_files(folder: Path, tiles: TileSet, frame: MapFrame, *, walk_m: Array) -> None:
    """Write index, coarse points and their first color.

    Args:
        folder: Is made.
        tiles: The map.
        frame: Its frame.
        walk_m: Positions of the sensors [m], (W, 3).
    """
    folder.mkdir()
    index = index_of(tiles, crs=frame.crs, frame=frame.text, walk_m=walk_m)
    write_json(folder / INDEX, msgspec.to_builtins(index, str_keys=True))
    first: tuple[Stored, ...] = ("xyz",) if index.color == "height" else ("xyz", index.color)
    for stored in first:
        with (folder / coarse_name(stored)).open("wb") as file:
            write_cubes(tiles, stored, file)


def read_index(path: Path, key: str) -> bytes:
    """The index as JSON, with the key of its map.

    Raises:
        StoreError: If it is damaged.
    """
    data = read_bytes_limited(path, MAP_CHUNKS.max_index_bytes, failure=StoreError)
    try:
        return msgspec.json.encode(replace(decoded(data, MapIndex), key=key))
    except msgspec.DecodeError as error:
        raise StoreError(at(path.name, str(error))) from error
