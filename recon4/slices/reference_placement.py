"""Where the coordinates of a reference file belong: CRS, units and heights against the map's.

Nothing is converted silently: each step is a note that page, sheet and command show.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from recon4.errors import ConfigError, GeoreferenceError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.recording.formats.cloud_crs import (
    StatedCrs,
    horizontal_part,
    horizontal_unit_m,
    vertical_part,
)
from recon4.recording.tables.column_names import UNIT_NAMES, UNITS_M, Unit
from recon4.slices.map_crs import MapFrame
from recon4.slices.tuning import PLACEMENT

FrameAsked = Literal["auto", "map", "crs"]
"""Frame of a file's coordinates: as the file says (else the map's frame), map frame, map's CRS."""
_Convert = Callable[[Array], Array]


@dataclass(frozen=True, slots=True, eq=False)
class FilePlacement:
    """How coordinates of a file become coordinates of the map."""

    to_map: _Convert
    """Coordinates of the file (N, 3) -> points of the map [m], (N, 3)."""
    frame: Literal["map", "crs"]
    notes: tuple[CodedText, ...]
    """What was found and what was converted, as sentences."""


def place_file(
    stated: StatedCrs, own: MapFrame, *, asked: FrameAsked = "auto", unit: Unit | None = None
) -> FilePlacement:
    """How to place the coordinates of a file in the map.

    Args:
        stated: What the file says.
        own: Of the map.
        asked: What the person says of the frame of the file.
        unit: What the person says of its unit; None = as the file says, else meters.

    Raises:
        ConfigError: If the coordinates cannot be used with this map, with the reason.
    """
    if asked == "crs" and own.to_crs is None:
        raise ConfigError(CodedText("reference-local"))
    units, notes = _units_of(stated, unit)
    if asked == "map" or own.to_crs is None:
        return _in_map_frame(stated, own, units, notes=notes)
    if stated.crs is not None:
        return _from_stated(stated, own, units, notes=notes)
    if asked == "auto":
        return _in_map_frame(stated, own, units, notes=notes)
    notes.append(CodedText("note-no-crs", own=own.crs))
    return FilePlacement(lambda p: own.from_crs(p * units), "crs", tuple(notes))


def _units_of(stated: StatedCrs, unit: Unit | None) -> tuple[Array, list[CodedText]]:
    """Meters of one unit along x, y, z, and notes."""
    notes: list[CodedText] = []
    if stated.problem:
        notes.append(CodedText("note-crs-problem", problem=stated.problem))
    if unit is not None:
        notes.append(CodedText("note-unit-chosen", unit=UNIT_NAMES[unit]))
        return np.full(3, UNITS_M[unit]), notes
    across = stated.unit_m or 1.0
    up = stated.height_unit_m or (1.0 if stated.geographic else across)
    if stated.unit_m not in (None, 1.0):
        notes.append(CodedText("note-unit-converted", unit=_unit_name(across)))
    if stated.height_unit_m is None and across != 1.0:
        notes.append(CodedText("note-height-unit-unknown", unit=_unit_name(up)))
    elif up != across and not (stated.geographic and up == 1.0):
        notes.append(CodedText("note-height-unit-converted", unit=_unit_name(up)))
    return np.array([across, across, up]), notes


def _unit_name(unit_m: float) -> str:
    for unit, size in UNITS_M.items():
        if abs(size - unit_m) < 1e-9:
            return UNIT_NAMES[unit]
    return f"units of {unit_m:.9g} m"


def _in_map_frame(
    stated: StatedCrs, own: MapFrame, units: Array, *, notes: list[CodedText]
) -> FilePlacement:
    """The coordinates as they are, in meters."""
    if stated.geographic or _is_geocentric(stated):
        kind = "degrees" if stated.geographic else "earth-centered coordinates"
        reason = "the map is local" if own.to_crs is None else "the map's frame was chosen"
        raise ConfigError(
            CodedText("reference-no-projection", kind=kind, stated=stated.name, reason=reason)
        )
    if stated.crs is not None:
        why = "note-local" if own.to_crs is None else "note-frame-chosen"
        notes.append(CodedText(why, crs=stated.name))
    return FilePlacement(lambda p: p * units, "map", tuple(notes))


def _is_geocentric(stated: StatedCrs) -> bool:
    return stated.crs is not None and bool(stated.crs.is_geocentric)


def _from_stated(
    stated: StatedCrs, own: MapFrame, units: Array, *, notes: list[CodedText]
) -> FilePlacement:
    """From the file's CRS to that of the map."""
    from pyproj import CRS

    target = CRS.from_user_input(own.wkt or own.crs)
    source, target_2d = stated.crs, horizontal_part(target)
    same = not _is_geocentric(stated) and horizontal_part(source).equals(
        target_2d, ignore_axis_order=True
    )
    height_note = _heights(source, target)
    to_crs = _scaled(units) if same else _transform(stated, target, own, units=units, notes=notes)
    if same:
        notes.append(CodedText("note-same-crs", crs=stated.name))
    else:
        notes.append(CodedText("note-transformed", crs=stated.name, own=own.crs))
    if height_note is not None:
        notes.append(height_note)

    def to_map(p: Array) -> Array:
        if _is_geocentric(stated):
            _check_geocentric(p, stated)
        return own.from_crs(to_crs(p))

    return FilePlacement(to_map, "crs", tuple(notes))


def _scaled(units: Array) -> _Convert:
    return lambda p: p * units


def _check_geocentric(p: Array, stated: StatedCrs) -> None:
    low, high = PLACEMENT.earth_m
    distance = np.linalg.norm(p, axis=1)
    if len(p) and not (low < distance.min() and distance.max() < high):
        raise ConfigError(
            CodedText(
                "reference-earth-centered",
                stated=stated.name,
                distance=float(distance.min() / 1000),
            )
        )


def _heights(source: Any, target: Any) -> CodedText | None:
    """What happens to the heights; None = nothing that has to be said."""
    if source.is_geocentric:
        return None
    of_file, of_map = vertical_part(source), vertical_part(target)
    map_name = of_map.name if of_map is not None else "above the ellipsoid"
    if of_file is None and len(source.axis_info) == 2:
        return CodedText("note-height-datum-unknown", of_map=map_name)
    if of_file is None and of_map is None:
        return None
    if of_file is not None and of_map is not None and of_file.equals(of_map):
        return None
    file_name = of_file.name if of_file is not None else "above the ellipsoid"
    return CodedText("note-height-datums", of_file=file_name, of_map=map_name)


def _transform(
    stated: StatedCrs, target: Any, own: MapFrame, *, units: Array, notes: list[CodedText]
) -> _Convert:
    """Horizontal transformation; heights keep their datum.

    Raises:
        ConfigError: If PROJ knows no transformation.
    """
    geocentric = _is_geocentric(stated)
    source = stated.crs if geocentric else horizontal_part(stated.crs)
    goal = target.to_3d() if geocentric else horizontal_part(target)
    transformer = _transformer(source, goal, own, name=stated.name)
    accuracy = float(transformer.accuracy)
    if accuracy > PLACEMENT.accurate_m:
        operation = str(transformer.description)
        notes.append(CodedText("note-accuracy", accuracy_m=accuracy, operation=operation))
    sizes = units.copy()
    if stated.geographic:
        sizes[:2] = 1.0
    elif not geocentric:
        sizes[:2] /= horizontal_unit_m(stated.crs)

    def convert(p: Array) -> Array:
        x, y, z = (p * sizes).T
        found = transformer.transform(x, y, z) if geocentric else (*transformer.transform(x, y), z)
        return np.stack(found, axis=-1)

    return convert


def _transformer(source: Any, goal: Any, own: MapFrame, *, name: str) -> Any:
    import warnings

    from pyproj import Transformer
    from pyproj.aoi import AreaOfInterest
    from pyproj.exceptions import ProjError
    from pyproj.transformer import TransformerGroup

    assert own.to_crs is not None
    east, north, _ = own.to_crs(np.zeros((1, 3)))[0]
    try:
        to_degrees = Transformer.from_crs(horizontal_part(goal), "EPSG:4326", always_xy=True)
        lon, lat = to_degrees.transform(east, north)
        here: Any = AreaOfInterest(lon - 0.01, lat - 0.01, lon + 0.01, lat + 0.01)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # a missing grid is looked at below
            group = TransformerGroup(
                source, goal, always_xy=True, area_of_interest=here, allow_ballpark=False
            )
    except ProjError as error:
        raise GeoreferenceError(
            CodedText("reference-transform-failed", name=name, crs=own.crs, why=str(error))
        ) from error
    if not group.transformers:
        raise GeoreferenceError(CodedText("reference-no-operation", name=name, crs=own.crs))
    return group.transformers[0]


def check_extent(
    found: tuple[Array, Array], of_map: tuple[Array, Array] | None, *, certain: bool
) -> tuple[CodedText, ...]:
    """Compare the extent of a reference with that of the map.

    Args:
        found: Lowest and highest coordinates of the reference in the map [m], (3,) each.
        of_map: Those of the map; None = not known.
        certain: Whether its unit is stated or chosen.

    Returns:
        Sentences about what does not fit.

    Raises:
        ConfigError: If its unit is not certain and it is as large as if it were in another one.
    """
    if of_map is None or not np.isfinite(np.array([*found, *of_map])).all():
        return ()
    size, own = np.sort(found[1] - found[0]), np.sort(of_map[1] - of_map[0])
    if not certain and size[2] > 0.0:
        _ask_unit(size, own)
    gap = np.maximum(found[0] - of_map[1], of_map[0] - found[1]).max()
    if gap > PLACEMENT.beside_m:
        if gap > PLACEMENT.kilometers_m:
            return (CodedText("note-far-away", away_km=float(gap) / 1000.0),)
        return (CodedText("note-beside", away_m=float(gap)),)
    return ()


def _ask_unit(size: Array, own: Array) -> None:
    """Ask if a reference exceeds the map in every direction by more than a larger place would."""
    if np.all(size > PLACEMENT.times * np.maximum(own, PLACEMENT.small_m)):
        here, there = (
            " × ".join(f"{v:.0f}" if v > 100.0 else f"{v:.1f}" for v in sizes[::-1])
            for sizes in (own, size)
        )
        raise ConfigError(CodedText("reference-units", there=there, here=here))
