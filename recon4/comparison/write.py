"""Core points of a comparison as files: LAZ, CSV, and the points of the page *Map*."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.comparison.files import FIGURES_FILE, POINTS_FILE
from recon4.comparison.records import CoreDifferences, CoreState, MapDifferences
from recon4.comparison.run import MapPair, Sink, compare_maps
from recon4.comparison.tuning import PAGE_POINTS
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.plain import to_plain
from recon4.progress import Progress
from recon4.slices.map_crs import MapFrame
from recon4.store.atomic import atomic_file, write_json

ENDINGS = (".laz", ".csv", ".json")
POINT = np.dtype(
    [("p_m", "<f4", 3), ("distance", "<i2"), ("lod", "<u2"), ("state", "u1"), ("normal", "i1", 3)]
)
"""A core point for the page: coordinates in the first map [m], distance and level of detection in
steps of `PAGE_POINTS.step_m`, `CoreState`, normal in steps of 1 / 127."""


def sink_of(path: Path, frame: MapFrame, low_m: NDArray[np.float64]) -> Sink:
    """What writes core points to a file, by its ending; with ``.json`` they are not written.

    Args:
        path: ``.laz``, ``.csv`` or ``.json``.
        frame: Of the first map: coordinates are those of its CRS, if it has one.
        low_m: Smallest coordinates of the first map [m], (3,).

    Raises:
        ConfigError: If the ending is another one.
    """
    ending = path.suffix.lower()
    if ending == ".laz":
        return lambda parts: _write_laz(parts, path, frame=frame, low_m=low_m)
    if ending == ".csv":
        return lambda parts: _write_csv(parts, path, frame=frame)
    if ending == ".json":
        return exhaust
    raise ConfigError(CodedText("write-endings", endings=", ".join(ENDINGS), file=path.name))


def exhaust(parts: Iterator[CoreDifferences]) -> None:
    """Take all parts, and write nothing."""
    for _ in parts:
        pass


def write_summary(found: MapDifferences, path: Path) -> None:
    """Write a result as JSON; NaN becomes null."""
    write_json(path, to_plain(found))


def _write_csv(parts: Iterator[CoreDifferences], path: Path, *, frame: MapFrame) -> None:
    axes = ["easting_m", "northing_m", "height_m"] if frame.to_crs else ["x_m", "y_m", "z_m"]
    columns = [*axes, "nx", "ny", "nz", "distance_m", "lod_m", "points_1", "points_2", "state"]
    names = np.array([state.name.lower() for state in CoreState])
    with atomic_file(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        file.write(f"# recon4 compare, {frame.written_text}\n{','.join(columns)}\n")
        for part in parts:
            p = frame.to_crs(part.p_map) if frame.to_crs else part.p_map
            numbers = np.column_stack([p, part.normal, part.distance_m, part.lod_m])
            rows = zip(numbers.tolist(), part.points.tolist(), names[part.state], strict=True)
            file.writelines(
                f"{','.join(map(_number, row))},{ours},{theirs},{state}\n"
                for row, (ours, theirs), state in rows
            )


def _number(value: float) -> str:
    return "" if value != value else f"{value:.4f}"


def _write_laz(
    parts: Iterator[CoreDifferences],
    path: Path,
    *,
    frame: MapFrame,
    low_m: NDArray[np.float64],
) -> None:
    from recon4.export.laz import ValuePoints, write_values  # its libraries are slow to import

    def points() -> Iterator[ValuePoints]:
        for part in parts:
            p = frame.to_crs(part.p_map) if frame.to_crs else part.p_map
            yield ValuePoints(
                p,
                {
                    "distance_m": part.distance_m,
                    "lod_m": part.lod_m,
                    "state": part.state,
                    "points_1": part.points[:, 0],
                    "points_2": part.points[:, 1],
                },
            )

    corner = low_m[None]
    origin = np.floor((frame.to_crs(corner) if frame.to_crs else corner)[0])
    write_values(points(), path, crs=frame.wkt, offset_m=origin)


def write_comparison(
    pair: MapPair, laz: Path, *, core_spacing_m: float, progress: Progress
) -> MapDifferences:
    """Compare two maps, and write all that the page *Map* shows of it beside a LAZ file.

    Args:
        pair: The maps.
        laz: File of the core points, ``.laz``; `POINTS_FILE` and `FIGURES_FILE` are written beside.
        core_spacing_m: Distance of core points [m].
        progress: Counts tiles.

    Raises:
        Altered: If a map was approved and is not what was approved.
        ConfigError: If the first map has no points, or the distance is out of range.
        StoreError: If a map is damaged, or a file cannot be written (`NoSpace`: disk full).
    """
    first = pair.first
    with atomic_file(laz.parent / POINTS_FILE) as temporary, temporary.open("wb") as file:
        to_laz = sink_of(laz, first.frame, first.tiles.bounds_m[0])

        def copied(parts: Iterator[CoreDifferences]) -> Iterator[CoreDifferences]:
            for part in parts:
                file.write(page_points(part).tobytes())
                yield part

        found = compare_maps(
            pair,
            lambda parts: to_laz(copied(parts)),
            scales=pair.scales(core_spacing_m),
            progress=progress,
        )
    write_summary(found, laz.parent / FIGURES_FILE)
    return found


def page_points(part: CoreDifferences) -> NDArray[np.void]:
    """Core points as the page reads them, `POINT` (N,)."""
    out = np.zeros(len(part.state), POINT)
    out["p_m"] = part.p_map
    for name, values in (("distance", part.distance_m), ("lod", part.lod_m)):
        limits = np.iinfo(POINT[name])
        steps = np.rint(np.nan_to_num(values.astype(np.float64)) / PAGE_POINTS.step_m)
        out[name] = np.clip(steps, limits.min, limits.max)
    out["state"] = part.state
    out["normal"] = np.rint(127.0 * part.normal)
    return out
