"""Layers of points and lines as a GeoPackage (OGC 12-128r18, version 1.3): one SQLite file."""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from recon4.errors import StoreError
from recon4.export.geojson import MapSystem
from recon4.export.tuning import GEOPACKAGES
from recon4.geometry.se3 import Array
from recon4.georeference.crs import CrsTransform
from recon4.locales.coded import CodedText
from recon4.store.atomic import atomic_file

Value = str | int | float | None
_TYPES: Mapping[type, str] = {str: "TEXT", int: "INTEGER", float: "REAL"}
_TABLES = """
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
  description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
  CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id));
"""
_WGS84 = (
    'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
    'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]]'
)


@dataclass(frozen=True, slots=True, eq=False)
class Feature:
    """A place with its attributes."""

    p_map: Array
    """Positions in the map [m], (N, 3): none = no place, one = a point, more = a line."""
    values: Mapping[str, Value]
    """As the columns of its layer; NaN = None."""


@dataclass(frozen=True, slots=True, eq=False)
class FeatureLayer:
    """A table of features of one kind."""

    name: str
    """Of the table: lower case and ``_``."""
    title: str
    kind: Literal["POINT", "LINESTRING"]
    """Of all places: not every reader takes a mixture."""
    columns: Mapping[str, type]
    """Attribute -> ``str``, ``int`` or ``float``."""
    features: Sequence[Feature]


def write_geopackage(
    path: Path, layers: Sequence[FeatureLayer], place: MapSystem | None, *, changed: str
) -> int:
    """Write layers, and read back how many features the file has.

    Args:
        path: File to write; it appears when it is complete.
        layers: Each becomes a table.
        place: Where the map is: the file has its system. A grid of a site has no EPSG code, and a
            local map none at all (``srs_id`` -1).
        changed: Time of the contents, ISO 8601 UTC: the same map gives the same bytes.

    Raises:
        NoSpace: If the disk is full.
        StoreError: If it cannot be written, or reads back wrong.
    """
    with atomic_file(path) as temporary:
        try:
            # SQLite does not say that a file may not grow further: the system does.
            with closing(sqlite3.connect(":memory:", isolation_level=None)) as file:
                _write(file, layers, place, changed=changed)
                temporary.write_bytes(file.serialize())
            count = _count(temporary, layers)
        except sqlite3.Error as error:
            raise StoreError(
                CodedText("file-not-written", file=path.name, why=str(error))
            ) from error
        wanted = sum(len(layer.features) for layer in layers)
        if count != wanted:
            raise StoreError(CodedText("gpkg-features", file=path.name, wanted=wanted, count=count))
    return count


def _write(
    file: sqlite3.Connection,
    layers: Sequence[FeatureLayer],
    place: MapSystem | None,
    *,
    changed: str,
) -> None:
    file.execute(f"PRAGMA application_id = {GEOPACKAGES.application_id}")
    file.execute(f"PRAGMA user_version = {GEOPACKAGES.version}")
    file.execute("BEGIN")
    for statement in filter(str.strip, _TABLES.split(";")):
        file.execute(statement)
    srs_id = _write_systems(file, place)
    for layer in layers:
        _write_layer(file, layer, place, srs_id=srs_id, changed=changed)
    file.execute("COMMIT")


def _write_systems(file: sqlite3.Connection, place: MapSystem | None) -> int:
    """The systems that the standard asks for, and that of the map; its number."""
    rows: list[tuple[str, int, str, int, str, str]] = [
        ("Undefined Cartesian SRS", -1, "NONE", -1, "undefined", "map frame, meters"),
        ("Undefined geographic SRS", 0, "NONE", 0, "undefined", ""),
        ("WGS 84", 4326, "EPSG", 4326, _WGS84, "longitude, latitude"),
    ]
    srs_id = -1
    if place is not None:
        authority, _, code = place.crs.partition(":")
        is_code = isinstance(place, CrsTransform) and authority.upper() == "EPSG" and code.isdigit()
        srs_id = int(code) if is_code else GEOPACKAGES.own_system
        owner = "EPSG" if is_code else "NONE"
        rows.append((place.crs, srs_id, owner, srs_id, place.wkt, place.operation))
    unique = {row[1]: row for row in rows}
    file.executemany("INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, ?)", unique.values())
    return srs_id


def _write_layer(
    file: sqlite3.Connection,
    layer: FeatureLayer,
    place: MapSystem | None,
    *,
    srs_id: int,
    changed: str,
) -> None:
    places = [_placed(one.p_map, place) for one in layer.features]
    every = np.concatenate([*places, np.empty((0, 3))])
    bounds = [*every[:, :2].min(axis=0), *every[:, :2].max(axis=0)] if len(every) else [None] * 4
    file.execute(
        "INSERT INTO gpkg_contents VALUES (?, 'features', ?, ?, ?, ?, ?, ?, ?, ?)",
        (layer.name, layer.name, layer.title, changed, *bounds, srs_id),
    )
    file.execute(
        "INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', ?, ?, 1, 0)",
        (layer.name, layer.kind, srs_id),
    )
    columns = ", ".join(f'"{name}" {_TYPES[of]}' for name, of in layer.columns.items())
    file.execute(
        f'CREATE TABLE "{layer.name}" (fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, '
        f"geom {layer.kind}, {columns})"
    )
    marks = ", ".join("?" * (2 + len(layer.columns)))
    file.executemany(
        f'INSERT INTO "{layer.name}" VALUES ({marks})',
        (
            (number, _geometry(p, srs_id), *(_plain(one.values.get(k)) for k in layer.columns))
            for number, (one, p) in enumerate(zip(layer.features, places, strict=True), start=1)
        ),
    )


def _placed(p_map: Array, place: MapSystem | None) -> Array:
    p = np.asarray(p_map, np.float64).reshape(-1, 3)
    return place.to_crs(p) if place is not None and len(p) else p


def _geometry(p: Array, srs_id: int) -> bytes | None:
    """Header and ISO WKB with z, little-endian; an envelope for lines, as readers expect it."""
    if not len(p):
        return None
    if len(p) == 1:
        return struct.pack("<2sBBi", b"GP", 0, 0b001, srs_id) + struct.pack("<BI3d", 1, 1001, *p[0])
    low, high = p.min(axis=0), p.max(axis=0)
    envelope = struct.pack("<4d", low[0], high[0], low[1], high[1])
    head = struct.pack("<2sBBi", b"GP", 0, 0b011, srs_id) + envelope
    return head + struct.pack("<BII", 1, 1002, len(p)) + p.astype("<f8").tobytes()


def _plain(value: Value) -> Value:
    return None if isinstance(value, float) and not np.isfinite(value) else value


def _count(path: Path, layers: Sequence[FeatureLayer]) -> int:
    """How many features a file has; 0 if it is damaged."""
    with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as file:
        if file.execute("PRAGMA integrity_check").fetchone() != ("ok",):
            return 0
        tables = (f'SELECT count(*) FROM "{layer.name}"' for layer in layers)
        return sum(int(file.execute(one).fetchone()[0]) for one in tables)
