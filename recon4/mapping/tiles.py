"""The map on disk: tile after tile in compressed blocks, field by field, and ``tiles.json``.

    tiles.json    fields, bounds, CRS, and rows and origin of each tile
    tiles/        the columns (`recon4.mapping.columns`), one row per point

Rows ``start`` to ``stop`` belong to a tile; any first part of them is an even sample of the tile.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText, text_of
from recon4.mapping.columns import PackedColumns, TileColumns
from recon4.mapping.earlier_columns import EarlierColumns
from recon4.mapping.map_notes import MapCrs, MapNotes, read_map_list
from recon4.mapping.sensor_paths import range_and_incidence
from recon4.mapping.threads import Each, in_turn
from recon4.mapping.tile import DERIVED, FIELDS, Columns
from recon4.mapping.tile_order import spatial_order
from recon4.mapping.tuning import TILES
from recon4.store.checked import Altered, CheckedArtifact
from recon4.store.earlier_names import TILE_FIELDS
from recon4.store.formats import FORMATS
from recon4.store.tuning import PACKING

RAW_OFFSET = "raw_offset_m"
"""From the surface to where the point was measured; only in maps of fitted surfaces."""
Surface = Literal["fitted", "raw", "strays"]
"""Points on the surfaces fitted to all returns, or as measured, or only those left out."""
Number = TypeVar("Number", int, float)
_DERIVED_FROM = ("xyz", "normal", "t_ns", "sensor")
_MALFORMED = (ValueError, KeyError, TypeError, IndexError, OverflowError, AttributeError)
_SURFACE_TEXT: dict[Surface, str] = {
    "fitted": "on fitted surfaces",
    "raw": "as measured",
    "strays": "left out of the map",
}


def surface_text(surface: Surface) -> str:
    """Where the points of a map lie, for sheets, captions and the report."""
    return _SURFACE_TEXT[surface]


@dataclass(frozen=True, slots=True)
class Tile:
    """One cube of the map."""

    columns: TileColumns
    """Of all tiles."""
    ijk: tuple[int, int, int]
    """Index in the grid of tiles."""
    origin_m: tuple[float, float, float]
    """Corner in the map [m]; ``xyz`` is relative to it."""
    start: int
    stop: int
    strays: int
    """Points that the map leaves out, in the rows after ``stop``: stray returns, the carrier, what
    moves. All other figures are without them."""
    low_m: tuple[float, float, float]
    """Smallest coordinates of its points in the map [m]."""
    high_m: tuple[float, float, float]
    """Largest coordinates of its points in the map [m]."""
    checked: CheckedArtifact | None = None
    """Hashes that bytes must match before they are used; None = not checked."""
    raw: bool = False
    """``xyz`` is read where the points were measured, not on their surfaces."""
    left_out: bool = False
    """These are points that the map leaves out."""

    def __len__(self) -> int:
        return self.stop - self.start

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of the fields that can be read."""
        return readable_fields(self.columns)

    def read(
        self, fields: Sequence[str], *, limit: int | None = None, rows: slice | None = None
    ) -> Columns:
        """Read some fields, read-only.

        Args:
            fields: Names of `FIELDS`.
            limit: Largest number of points, an even sample of the tile; None = all.
            rows: Rows of the tile, none below 0, any positive step; None = the first ones.

        Raises:
            Altered: If the tile is checked and its bytes do not match the hashes.
            StoreError: If the map does not have a field, or a file is damaged.
        """
        taken = rows or slice(0, len(self) if limit is None else min(limit, len(self)), 1)
        within = slice(self.start + taken.start, self.start + taken.stop, taken.step or 1)
        return self._read(fields, partial(self.columns.read, rows=within))

    def read_in_space(self, fields: Sequence[str], each: Each = in_turn) -> Columns:
        """Read some fields of all points, neighbors one after the other; otherwise as `read`.

        Threads may be given for the fields and their blocks.
        """
        every = slice(self.start, self.stop, 1)
        return self._read(fields, partial(self.columns.read_in_space, rows=every, each=each))

    def _read(self, fields: Sequence[str], stored: Callable[..., Columns]) -> Columns:
        unknown = sorted(set(fields) - set(self.fields))
        if unknown:
            raise StoreError(
                CodedText("map-no-field", unknown=str(unknown), fields=str(list(self.fields)))
            )
        derived = set(fields) - set(self.columns.fields)
        needed = (set(fields) - derived) | (set(_DERIVED_FROM) if derived else set())
        moved = RAW_OFFSET in self.columns.fields and bool(
            derived or (self.raw and "xyz" in needed)
        )
        names = sorted(needed | ({RAW_OFFSET} if moved else set()))
        try:
            columns = stored(names, checked=self.checked)
        except Altered as error:
            raise Altered(
                CodedText("map-tile-changed", ijk=str(self.ijk), why=text_of(error))
            ) from error
        at = columns["xyz"] if "xyz" in columns else np.empty((0, 3), np.float32)
        measured = at + columns[RAW_OFFSET].astype(np.float32) if moved else at
        if derived:
            to_sensor_m = self.columns.paths.at(columns["t_ns"], columns["sensor"])
            to_sensor_m -= measured + np.array(self.origin_m)
            columns |= range_and_incidence(to_sensor_m, columns["normal"])
        if self.raw and "xyz" in fields:
            columns["xyz"] = measured
        return {name: columns[name] for name in fields}

    def xyz_m(self, *, limit: int | None = None) -> Array:
        """Points in the map [m], float64 (N, 3)."""
        xyz = self.read(["xyz"], limit=limit)["xyz"].astype(np.float64)
        xyz += self.origin_m
        return xyz

    def as_measured(self) -> Tile:
        """The same points where they were measured."""
        low_m, high_m = (
            np.array(self.low_m) - TILES.margin_m,
            np.array(self.high_m) + TILES.margin_m,
        )
        return replace(self, raw=True, low_m=_triple(low_m, float), high_m=_triple(high_m, float))

    def stray_part(self, tile_m: float) -> Tile:
        """What the map leaves out as a tile of its own; it lies anywhere in it."""
        low_m = _triple(self.origin_m, float)
        high_m = _triple(np.array(self.origin_m) + tile_m, float)
        rows = (self.stop, self.stop + self.strays)
        part = replace(self, start=rows[0], stop=rows[1], strays=0, left_out=True)
        return replace(part, low_m=low_m, high_m=high_m)

    def spatial_order(self) -> NDArray[np.intp]:
        """Rows of the tile in spatial order, (N,)."""
        return spatial_order(len(self))


@dataclass(frozen=True, slots=True)
class TileSet:
    """A finished map."""

    tiles: tuple[Tile, ...]
    columns: TileColumns
    """Of all tiles."""
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
    def open(
        folder: Path, checked: CheckedArtifact | None = None, *, kept_bytes: int = 0
    ) -> TileSet:
        """Open the artifact of the stage ``map``.

        Args:
            folder: The artifact.
            checked: Hashes that all bytes read must match; None = not checked.
            kept_bytes: Memory for what is unpacked and may be needed again.

        Raises:
            Altered: If ``checked`` is given and ``tiles.json`` was changed.
            StoreError: If it is missing, damaged or of another version.
        """
        path = folder / "tiles.json"
        if checked is not None:
            checked.check("tiles.json")
        try:
            facts = read_map_list(path)
            if facts["format"] not in FORMATS.read_tiles:
                known = "{}, {} or {}".format(*FORMATS.read_tiles)
                raise StoreError(f"{path.name}: expected format {known}, got {facts['format']}")
            fields = tuple(TILE_FIELDS.get(name, str(name)) for name in facts["fields"])
            parts = _parts(facts["tiles"], int(facts["points"]))
            columns: TileColumns
            if facts["format"] == FORMATS.earlier_tiles:
                columns = EarlierColumns.open(folder / "tiles", fields, int(parts[-1]))
            else:
                columns = PackedColumns.open(
                    folder / "tiles", fields, parts, checked=checked, kept_bytes=kept_bytes
                )
                if facts["format"] == FORMATS.coarse_tiles:
                    columns = replace(columns, position_step_m=PACKING.step_m)
            tiles = tuple(_tile(columns, row, checked=checked) for row in facts["tiles"])
            points, tile_m = int(facts["points"]), float(facts["tile_m"])
            first_ns, last_ns = (int(t_ns) for t_ns in facts["time_ns"] or (0, 0))
            notes = MapNotes.of(facts)
        except _MALFORMED as error:
            raise StoreError(CodedText("map-list", file=str(path), why=repr(error))) from error
        _check_rows(tiles, points, path.name)
        surface: Surface = "fitted" if RAW_OFFSET in columns.fields else "raw"
        return TileSet(tiles, columns, points, tile_m, first_ns, last_ns, notes, surface)

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of the fields that can be read."""
        return readable_fields(self.columns)

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
        """Points in all tiles that the map leaves out; ``len`` is without them."""
        return sum(tile.strays for tile in self.tiles)

    def class_counts(self) -> dict[int, int]:
        """Code of each class that the map has -> number of its points, also of those left out.

        A map of an earlier version, which has no such counts, is read.
        """
        if self.notes.classes or "classification" not in self.fields:
            return dict(self.notes.classes)
        counts = np.zeros(256, np.int64)
        for tile in (*self, *self.only_strays()):
            given = tile.read(["classification"])["classification"]
            counts += np.bincount(given, minlength=256)
        return {code: int(counts[code]) for code in np.flatnonzero(counts).tolist()}

    def as_measured(self) -> TileSet:
        """The same map with every point where it was measured; itself if it has no surfaces."""
        if RAW_OFFSET not in self.fields:
            return self
        tiles = tuple(tile.as_measured() for tile in self.tiles)
        return replace(self, tiles=tiles, surface="raw")

    def on(self, surface: Surface) -> TileSet:
        """The same map on its surfaces or as measured, or what it leaves out, if anything."""
        if surface == "strays" and self.strays:
            return self.only_strays()
        return self.as_measured() if surface == "raw" else self

    def only_strays(self) -> TileSet:
        """What the map leaves out as one of its own; its bounds are those of the tiles."""
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


def readable_fields(columns: TileColumns) -> tuple[str, ...]:
    """Fields that are stored or follow from others."""
    follow = columns.paths.known and set(_DERIVED_FROM) <= set(columns.fields)
    known = {*columns.fields, *(DERIVED if follow else ())}
    return tuple(name for name in FIELDS if name in known)


def _parts(tiles: Any, points: int) -> NDArray[np.int64]:
    """Where the points and those left out of each listed tile begin, and the last ones end."""
    rows = [int(row[name]) for row in tiles for name in ("start", "stop")]
    return np.array([*rows, points + sum(int(row.get("strays", 0)) for row in tiles)], np.int64)


def _tile(columns: TileColumns, row: Mapping[str, Any], *, checked: CheckedArtifact | None) -> Tile:
    return Tile(
        columns,
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
