"""The map on disk: one ``.npy`` file per field, tile after tile, and ``tiles.json``.

    tiles.json           fields, bounds, CRS, and rows and origin of each tile
    tiles/<field>.npy    one row per point

Rows ``start`` to ``stop`` belong to a tile; any first part of them is an even sample of the tile.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.geometry.se3 import Array
from recon4.mapping.columns import (
    check_columns,
    column_file,
    map_rows,
    row_offset,
)
from recon4.mapping.map_notes import MapCrs, MapNotes, read_map_list
from recon4.mapping.tile import Columns, spatial_order
from recon4.mapping.tuning import TILES
from recon4.store.checked import Altered, CheckedArtifact
from recon4.store.earlier_names import TILE_FIELDS
from recon4.store.formats import FORMATS

RAW_OFFSET = "raw_offset_m"
"""From the surface to where the point was measured; only in maps of fitted surfaces."""
Surface = Literal["fitted", "raw", "strays"]
"""Points on the surfaces fitted to all returns, or as measured, or only the stray returns."""
Number = TypeVar("Number", int, float)
_MALFORMED = (ValueError, KeyError, TypeError, IndexError, OverflowError, AttributeError)
_SURFACE_TEXT: dict[Surface, str] = {
    "fitted": "on fitted surfaces",
    "raw": "as measured",
    "strays": "stray returns only",
}


def surface_text(surface: Surface) -> str:
    """Where the points of a map lie, for sheets, captions and the report."""
    return _SURFACE_TEXT[surface]


@dataclass(frozen=True, slots=True)
class Tile:
    """One cube of the map."""

    folder: Path
    """Folder of the columns."""
    fields: tuple[str, ...]
    ijk: tuple[int, int, int]
    """Index in the grid of tiles."""
    origin_m: tuple[float, float, float]
    """Corner in the map [m]; ``xyz`` is relative to it."""
    start: int
    stop: int
    strays: int
    """Stray returns in the rows after ``stop``; all other figures are without them."""
    low_m: tuple[float, float, float]
    """Smallest coordinates of its points in the map [m]."""
    high_m: tuple[float, float, float]
    """Largest coordinates of its points in the map [m]."""
    checked: CheckedArtifact | None = None
    """Hashes that bytes must match before they are used; None = not checked."""
    raw: bool = False
    """``xyz`` is read where the points were measured, not on their surfaces."""

    def __len__(self) -> int:
        return self.stop - self.start

    def read(self, fields: Sequence[str], *, limit: int | None = None) -> Columns:
        """Read some fields, memory-mapped and read-only (raw coordinates are computed).

        Args:
            fields: Names of `FIELDS`.
            limit: Largest number of points, an even sample of the tile; None = all.

        Raises:
            Altered: If the tile is checked and its bytes do not match the hashes.
            StoreError: If the map does not have a field, or a file is damaged.
        """
        unknown = sorted(set(fields) - set(self.fields))
        if unknown:
            raise StoreError(f"the map has no field {unknown}; it has {list(self.fields)}")
        count = len(self) if limit is None else min(limit, len(self))
        moved = self.raw and "xyz" in fields and RAW_OFFSET in self.fields
        needed = {*fields, RAW_OFFSET} if moved else set(fields)
        for name in sorted(needed):
            self._check(name, count)
        columns = {name: map_rows(self.folder, name, self.start, count=count) for name in needed}
        if moved:
            columns["xyz"] = columns["xyz"] + columns[RAW_OFFSET].astype(np.float32)
        return {name: columns[name] for name in fields}

    def _check(self, name: str, count: int) -> None:
        if self.checked is None or count == 0:
            return
        first, row_bytes = row_offset(name, self.start)
        try:
            file = column_file(self.folder, name)
            self.checked.check(f"tiles/{file}", first, first + count * row_bytes)
        except Altered as error:
            raise Altered(f"tile {self.ijk} of the map was changed: {error}") from error

    def xyz_m(self, *, limit: int | None = None) -> Array:
        """Points in the map [m], float64 (N, 3)."""
        return self.read(["xyz"], limit=limit)["xyz"].astype(np.float64) + self.origin_m

    def as_measured(self) -> Tile:
        """The same points where they were measured."""
        low_m, high_m = (
            np.array(self.low_m) - TILES.margin_m,
            np.array(self.high_m) + TILES.margin_m,
        )
        return replace(self, raw=True, low_m=_triple(low_m, float), high_m=_triple(high_m, float))

    def stray_part(self, tile_m: float) -> Tile:
        """The stray returns as a tile of their own; they lie anywhere in it."""
        low_m = _triple(self.origin_m, float)
        high_m = _triple(np.array(self.origin_m) + tile_m, float)
        rows = (self.stop, self.stop + self.strays)
        return replace(self, start=rows[0], stop=rows[1], strays=0, low_m=low_m, high_m=high_m)

    def spatial_order(self) -> NDArray[np.intp]:
        """Rows of the tile in spatial order, (N,)."""
        return spatial_order(len(self))


@dataclass(frozen=True, slots=True)
class TileSet:
    """A finished map."""

    tiles: tuple[Tile, ...]
    fields: tuple[str, ...]
    points: int
    tile_m: float
    """Edge of a tile [m]."""
    first_ns: int
    """Time of the first point [ns]; 0 = there are none."""
    last_ns: int
    notes: MapNotes
    surface: Surface
    """Where its points lie."""

    @staticmethod
    def open(folder: Path, checked: CheckedArtifact | None = None) -> TileSet:
        """Open the artifact of the stage ``map``.

        Args:
            folder: The artifact.
            checked: Hashes that all bytes read must match; None = not checked.

        Raises:
            Altered: If ``checked`` is given and ``tiles.json`` was changed.
            StoreError: If it is missing, damaged or of another version.
        """
        path = folder / "tiles.json"
        if checked is not None:
            checked.check("tiles.json")
        try:
            facts = read_map_list(path)
            if facts["format"] != FORMATS.tiles:
                raise StoreError(
                    f"{path.name}: expected format {FORMATS.tiles}, got {facts['format']}"
                )
            fields = tuple(TILE_FIELDS.get(name, str(name)) for name in facts["fields"])
            tiles = tuple(
                _tile(folder / "tiles", fields, row, checked=checked) for row in facts["tiles"]
            )
            points, tile_m = int(facts["points"]), float(facts["tile_m"])
            first_ns, last_ns = (int(t_ns) for t_ns in facts["time_ns"] or (0, 0))
            notes = MapNotes.of(facts)
        except _MALFORMED as error:
            raise StoreError(f"{path} is not the list of a map's tiles: {error!r}") from error
        check_columns(folder / "tiles", fields, points + sum(tile.strays for tile in tiles))
        _check_rows(tiles, points, path.name)
        surface: Surface = "fitted" if RAW_OFFSET in fields else "raw"
        return TileSet(tiles, fields, points, tile_m, first_ns, last_ns, notes, surface)

    def __len__(self) -> int:
        return self.points

    def __iter__(self) -> Iterator[Tile]:
        return iter(self.tiles)

    @property
    def crs(self) -> MapCrs | None:
        """Coordinate reference system; None = a local frame."""
        return self.notes.crs

    @property
    def strays(self) -> int:
        """Stray returns in all tiles; ``len`` is without them."""
        return sum(tile.strays for tile in self.tiles)

    def as_measured(self) -> TileSet:
        """The same map with every point where it was measured; itself if it has no surfaces."""
        if RAW_OFFSET not in self.fields:
            return self
        tiles = tuple(tile.as_measured() for tile in self.tiles)
        return replace(self, tiles=tiles, surface="raw")

    def on(self, surface: Surface) -> TileSet:
        """The same map on its surfaces or as measured, or its stray returns, if it has any."""
        if surface == "strays" and self.strays:
            return self.only_strays()
        return self.as_measured() if surface == "raw" else self

    def only_strays(self) -> TileSet:
        """The stray returns as a map of their own; its bounds are those of their tiles."""
        return replace(
            self,
            tiles=tuple(tile.stray_part(self.tile_m) for tile in self.tiles if tile.strays),
            points=self.strays,
            surface="strays",
        )

    @property
    def bounds_m(self) -> tuple[Array, Array]:
        """Smallest and largest coordinates in the map [m], (3,) each; NaN without points."""
        if not self.tiles:
            return np.full(3, np.nan), np.full(3, np.nan)
        low = np.min([tile.low_m for tile in self.tiles], axis=0)
        return low, np.max([tile.high_m for tile in self.tiles], axis=0)


def _tile(
    folder: Path,
    fields: tuple[str, ...],
    row: Mapping[str, Any],
    *,
    checked: CheckedArtifact | None,
) -> Tile:
    return Tile(
        folder,
        fields,
        _triple(row["ijk"], int),
        _triple(row["origin_m"], float),
        int(row["start"]),
        int(row["stop"]),
        int(row.get("strays", 0)),
        _triple(row["low_m"], float),
        _triple(row["high_m"], float),
        checked,
    )


def _triple(values: Any, kind: type[Number]) -> tuple[Number, Number, Number]:
    """Convert to three finite numbers.

    Raises:
        TypeError, ValueError, OverflowError: If that is not possible.
    """
    x, y, z = (kind(value) for value in values)
    if not all(map(math.isfinite, (x, y, z))):
        raise ValueError(f"expected three finite numbers, got {values}")
    return x, y, z


def _check_rows(tiles: Sequence[Tile], points: int, name: str) -> None:
    """Check that tiles follow each other without a gap and contain all points."""
    at = strays = 0
    for tile in tiles:
        if tile.start != at or tile.stop < at or tile.strays < 0:
            raise StoreError(
                f"{name}: expected a tile from point {at} on, got {tile.start} to {tile.stop}"
            )
        at = tile.stop + tile.strays
        strays += tile.strays
    at -= strays
    if at != points:
        raise StoreError(
            f"{name}: {points} points, but the tiles do not add up to them: they have {at}"
        )
