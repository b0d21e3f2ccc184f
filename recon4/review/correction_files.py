"""Lists of corrections of classes as JSON or as a table, for ``recon4 classify``."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText, at, text_of
from recon4.model.alike import PickedThing
from recon4.model.class_corrections import Reclassified, class_named
from recon4.model.tuning import CLUSTERS
from recon4.model.volumes import Box, Brush, Prism, Sphere, Volume
from recon4.review.tuning import CORRECTION_FILES
from recon4.untrusted.bounded import read_text_limited
from recon4.untrusted.names import check_note
from recon4.untrusted.typed import as_type


@dataclass(frozen=True, slots=True)
class LikeThing:
    """All that is like the thing at a place."""

    picked: PickedThing
    most_different: float
    """More different things are left as they are; 1 = as one thing looks from two sides."""


@dataclass(frozen=True, slots=True)
class ListedCorrection:
    """A correction in a file."""

    where: str
    """File and line or number, for messages."""
    what: Reclassified | LikeThing
    why: str


class _Like(msgspec.Struct, forbid_unknown_fields=True, tag_field="shape", tag="like"):
    """A thing, in place of a volume."""

    place_m: tuple[float, float, float]
    alike: float = 1.0


class _Entry(msgspec.Struct, forbid_unknown_fields=True):
    """A correction in a JSON file."""

    volume: Volume | _Like
    to: str
    only: tuple[str, ...] = ()
    why: str = ""


def read_corrections(path: Path) -> tuple[ListedCorrection, ...]:
    """Read a list of corrections: ``.json``, else a table with a row for each.

    Raises:
        ConfigError: If the file is no such list, with the line and what was expected.
    """
    text = read_text_limited(path, CORRECTION_FILES.max_bytes, failure=ConfigError)
    of = _of_json if path.suffix.lower() == ".json" else _of_table
    found = tuple(of(text, path.name))
    if not 1 <= len(found) <= CORRECTION_FILES.most:
        raise ConfigError(
            CodedText(
                "corrections-count", file=path.name, most=CORRECTION_FILES.most, count=len(found)
            )
        )
    return found


def _of_json(text: str, name: str) -> Iterable[ListedCorrection]:
    try:
        entries = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ConfigError(CodedText("corrections-json", name=name, why=str(error))) from error
    if not isinstance(entries, list):
        raise ConfigError(CodedText("corrections-list", name=name))
    for k, entry in enumerate(entries, start=1):
        where = f"{name}, correction {k}"
        try:
            one = as_type(entry, _Entry)
        except msgspec.ValidationError as error:
            raise ConfigError(at(where, str(error))) from error
        yield _listed(where, one.volume, one.to, only=one.only, why=one.why)


def _of_table(text: str, name: str) -> Iterable[ListedCorrection]:
    header = text.partition("\n")[0]
    rows = csv.DictReader(io.StringIO(text), delimiter=";" if ";" in header else ",")
    names = {*(rows.fieldnames or ())}
    if not {"shape", "to"} <= names or names - CORRECTION_FILES.columns:
        raise ConfigError(
            CodedText(
                "corrections-columns",
                name=name,
                columns=", ".join(sorted(CORRECTION_FILES.columns)),
                names=", ".join(sorted(names)),
            )
        )
    for row in rows:
        where = f"{name}, line {rows.line_num}"
        if None in row:
            raise ConfigError(CodedText("corrections-cells", where=where))
        cells = {key: (value or "").strip() for key, value in row.items()}
        only = tuple(one for one in cells.get("only", "").split("|") if one.strip())
        try:
            volume = _volume(cells)
        except ConfigError as error:
            raise ConfigError(at(where, text_of(error))) from error
        yield _listed(where, volume, cells["to"], only=only, why=cells.get("why", ""))


def _listed(
    where: str, volume: Volume | _Like, to: str, *, only: Iterable[str], why: str
) -> ListedCorrection:
    try:
        code, codes = int(class_named(to)), tuple(int(class_named(one)) for one in only)
        what: Reclassified | LikeThing
        if isinstance(volume, _Like):
            what = LikeThing(
                PickedThing(place_m=volume.place_m, to=code, only=codes),
                check_alike(volume.alike),
            )
        else:
            what = Reclassified(volume=volume, to=code, only=codes)
        note = check_note(why, what="why") if why else ""
        return ListedCorrection(where, what, note)
    except ConfigError as error:
        raise ConfigError(at(where, text_of(error))) from error


def check_alike(value: float) -> float:
    """A limit of differences.

    Raises:
        ConfigError: If it is none, or so large that no two things would be unlike.
    """
    if not 0.0 <= value <= CLUSTERS.most_different:
        raise ConfigError(
            CodedText("corrections-alike", most_different=CLUSTERS.most_different, value=value)
        )
    return value


def _volume(cells: Mapping[str, str]) -> Volume | _Like:
    match cells["shape"]:
        case "box":
            x, y, z = (_number(cells, name) for name in ("x", "y", "z"))
            dx, dy, dz = (_number(cells, name) for name in ("dx", "dy", "dz"))
            yaw = math.radians(_number(cells, "yaw_deg", usual=0.0))
            u, v = (math.cos(yaw), math.sin(yaw), 0.0), (-math.sin(yaw), math.cos(yaw), 0.0)
            return Box(center_m=(x, y, z), size_m=(dx, dy, dz), u=u, v=v)
        case "sphere":
            x, y, z = (_number(cells, name) for name in ("x", "y", "z"))
            return Sphere(center_m=(x, y, z), radius_m=_number(cells, "radius"))
        case "prism":
            low, high = _number(cells, "low"), _number(cells, "high")
            corners = tuple((x, y) for x, y in _places(cells, "polygon", "x y"))
            return Prism(polygon_m=corners, low_m=low, high_m=high)
        case "brush":
            path = tuple((x, y, z) for x, y, z in _places(cells, "path", "x y z"))
            return Brush(path_m=path, radius_m=_number(cells, "radius"))
        case "like":
            x, y, z = (_number(cells, name) for name in ("x", "y", "z"))
            return _Like(place_m=(x, y, z), alike=_number(cells, "alike", usual=1.0))
        case other:
            raise ConfigError(CodedText("corrections-shape", other=other))


def _places(cells: Mapping[str, str], name: str, form: str) -> list[list[float]]:
    """Places of ``x y, x y, x y`` or ``x y | x y | x y``."""
    text, many = cells.get(name, ""), len(form.split())
    places = [place.split() for place in text.replace("|", ",").split(",")]
    if any(len(numbers) != many for numbers in places):
        raise ConfigError(CodedText("corrections-places", name=name, form=form, text=text[:60]))
    return [[_float(one, name) for one in numbers] for numbers in places]


def _number(cells: Mapping[str, str], name: str, *, usual: float | None = None) -> float:
    text = cells.get(name, "")
    if not text and usual is not None:
        return usual
    return _float(text, name)


def _float(text: str, name: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise ConfigError(CodedText("corrections-number", name=name, text=text[:40])) from error
