"""Rows of the report's tables: recorded facts with labels and units."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from typing import Any

from recon4.evaluation.site_control import control_in, statements
from recon4.evaluation.table import number
from recon4.findings.wording import word_of
from recon4.locales.languages import ENGLISH
from recon4.model.finding_kinds import FindingKind
from recon4.model.height_system import HeightSystem, height_system
from recon4.model.import_counts import count_label

Rows = list[tuple[str, str]]
_SOURCES = {
    "imu": "gravity measured by the IMU",
    "ins": "orientations of the INS",
    "floor": "the dominant floor",
    "none": "not leveled: neither an IMU nor a floor was available",
}
_NO_ROW = {"t_ns", "used", "residual_enu_m", "wkt", "warnings", "derived", "outcome"}
"""Shown as charts or separate lists, or too long for a row."""


def placed_rows(
    georeference: Mapping[str, Any], language: str = ENGLISH, *, points: bool = True
) -> Rows:
    """Rows of ``georeference.json``: leveling and georeference.

    Args:
        georeference: The record.
        language: Of reasons.
        points: Whether control and check points are among them.
    """
    level = dict(georeference.get("levelling", {}))
    out: Rows = []
    source = level.pop("source", None)
    if source is not None:
        out.append(("leveled by", _SOURCES.get(source, str(source))))
    if source != "none":
        out += _rows(level, "leveling: ")
    stated = georeference.get("georeference", {})
    inner = {name: value for name, value in stated.items() if value is not None}
    crs = dict(georeference.get("crs") or {})
    if "control" in georeference:
        _on_control(inner, crs)
    if "reason" in inner:
        inner["reason"] = word_of(FindingKind.GNSS_NOT_USED, inner["reason"], language)
    if "georeferenced" in inner:
        by_points = "no: control points alone placed it" if georeference.get("crs") else "no"
        out.append(("georeferenced", "yes" if inner.pop("georeferenced") else by_points))
    if "edges_rejected" in inner:
        out.append(("loop closures rejected by GNSS priors", str(len(inner.pop("edges_rejected")))))
    out += _rows(inner, "") + _rows(crs, "CRS: ")
    if points:
        out += _control_rows(georeference)
    shown = {"levelling", "georeference", "crs", "control"}
    rest = {k: v for k, v in georeference.items() if k not in shown}
    return out + _rows(rest, "")


def _on_control(placed: dict[str, object], crs: dict[str, object]) -> None:
    """Leave out what does not hold for a map on control points.

    Their heights are those of the survey unless the CRS has heights, and without fixes there is
    nothing to say of GNSS. The survey is in the CRS: how exact the way to WGS 84 is, is no matter.
    """
    if height_system(str(crs.get("name", "")), controlled=True) is not HeightSystem.CRS:
        placed["frame"] = "x east, y north, z up; heights of the control points"
    crs.pop("accuracy_m", None)
    if not placed.get("fixes"):
        for name in ("fixes", "fixes_usable", "fixes_used", "rmse_enu_m", "edges_rejected"):
            placed.pop(name, None)


def _control_rows(georeference: Mapping[str, object]) -> Rows:
    """Residuals of control and check points, and what may be said of the accuracy."""
    outcome = control_in(georeference)
    if outcome is None:
        return []
    out: Rows = []
    for one in outcome.points:
        east, north, up = ("–" if d is None else f"{100 * d:+z.1f}" for d in one.adjusted_m)
        alone = "; no other point controls it" if one.test and one.test.single_handed else ""
        text = f"{east} east, {north} north, {up} up [cm], map minus survey{alone}"
        out.append((f"{one.role} point {one.id}", text))
    out += [("accuracy at check points", text) for text in statements(outcome)]
    return out + [("suspected blunder", text) for text in outcome.blunders]


def imported_rows(report: Mapping[str, Any]) -> Rows:
    """Rows of ``report.json``: the import."""
    out: Rows = []
    for name, value in report.items():
        if name == "sensors":
            out += [(f"sensor {one.get('name', '')}", _sensor(one)) for one in value]
        elif name == "counts":
            out += [_count_row(count, value) for count in value]
        elif value == []:
            out.append((name, "none"))
        elif name == "gaps":
            out.append(("gaps", f"{len(value)}"))
        elif name in {"imu", "gnss"}:
            out += _rows(value, f"{name.upper()}: ") if value else [(name.upper(), "none")]
        elif name == "duration_ns":
            out.append(("length of a multiframe", quantity("duration_ms", value / 1e6)[1]))
        else:
            out += _rows({name: value}, "")
    return out


def _count_row(name: str, counts: Mapping[str, int]) -> tuple[str, str]:
    """A count in words; one of an earlier version by its name."""
    return f"count: {count_label(name)}", _text(counts[name], 0)


def quantity(name: str, value: Any) -> tuple[str, str]:
    """A name without its unit, and the value with it."""
    label = name.replace("_", " ")
    if name.endswith("_ns") and isinstance(value, int):
        if value < _FIRST_DATE_NS:
            return label.removesuffix(" ns"), f"{value / 1e9:.3f} s (a clock without a date)"
        time = datetime.fromtimestamp(value / 1e9, UTC)
        text = time.isoformat(timespec="milliseconds").replace("+00:00", "")
        return label.removesuffix(" ns"), f"{text.replace('T', ' ')} (sensor's clock, UTC)"
    for ending, unit, digits in _UNITS:
        if name.endswith(ending):
            shown = _LABELS.get(name, label.removesuffix(ending.replace("_", " ")))
            return shown, _text(value, digits) + (f" {unit}" if value is not None else "")
    return label, _text(value, 3)


_FIRST_DATE_NS = 365 * 86_400 * 10**9
"""Earlier times are relative to the start of the clock, not dates."""

_LABELS = {"lat_deg": "latitude", "lon_deg": "longitude"}

_UNITS = (
    ("lat_deg", "°", 8),
    ("lon_deg", "°", 8),
    ("_deg", "°", 3),
    ("_enu_m", "m (east, north, up)", 3),
    ("_m", "m", 3),
    ("_ms", "ms", 1),
    ("_hz", "Hz", 2),
)


def _rows(values: Mapping[str, object], prefix: str) -> Rows:
    out: Rows = []
    for name, value in values.items():
        if name in _NO_ROW:
            continue
        if isinstance(value, Mapping):
            out += _rows(value, f"{prefix}{name.replace('_', ' ')} ")
        else:
            label, text = quantity(name, value)
            out.append((prefix + (label or name), text))
    return out


def _sensor(one: Mapping[str, object]) -> str:
    parts = [str(one.get("model", ""))]
    parts += [f"{name} {one[name]}" for name in ("topic", "address", "port") if one.get(name)]
    if "points" in one:
        parts.append(f"{_text(one['points'], 0)} points")
    if one.get("rotation_hz"):
        parts.append(f"{_text(one['rotation_hz'], 2)} Hz")
    return ", ".join(part for part in parts if part)


def _text(value: Any, digits: int) -> str:
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f") if abs(value) >= 10_000 else str(value)
    if isinstance(value, float):
        return number(value + 0.0, digits)
    if isinstance(value, str):
        return value
    if isinstance(value, Iterable):
        items = list(value)
        return ", ".join(_text(v, digits) for v in items) if len(items) <= 6 else f"{len(items)}"
    return str(value)
