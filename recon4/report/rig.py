"""The rig against the recording: a table and one chart for each unit of the parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from recon4.evaluation.table import number
from recon4.findings.witnesses.rig import agreement
from recon4.findings.wording import text_of
from recon4.locales.languages import ENGLISH
from recon4.model.calibration_figures import CalibrationFigures, ParameterFigures
from recon4.model.rig import RigCalibration
from recon4.model.rig_origin import RigOrigin
from recon4.report.client_words import Words
from recon4.report.figures import BLUE, GRAY, ORANGE, Chart, add_bars
from recon4.report.tuning import RIG_CHARTS

DISPLAY_UNITS = {"rad": (57.295779513082, "°"), "m": (1e3, "mm"), "s": (1e3, "ms")}
"""Factor and unit in which parameters are shown."""
_COLORS = {"consistent": BLUE, "off": ORANGE, "not observable": GRAY}
_TITLES = {"rad": "rotation [°]", "m": "position [mm]", "s": "clock [ms]"}
_NO_SERIAL = "serial number not known"


class RigRow(NamedTuple):
    """One parameter in the table."""

    name: str
    change: str
    """With sign, unit and standard deviation."""
    status: str


def rig_rows(found: CalibrationFigures | None) -> list[RigRow]:
    """What the recording says of each parameter of the rig."""
    return parameter_rows(found.parameters) if found else []


def parameter_rows(found: Iterable[ParameterFigures]) -> list[RigRow]:
    """A row for each parameter, of sensors or of single beams."""
    return [_row(one) for one in found]


def change_text(change: float, sd: float | None, unit: str) -> str:
    """A change with its sign, standard deviation if known, and unit, as ``+0.120 ± 0.010 °``."""
    factor, shown_unit = DISPLAY_UNITS[unit]
    deviation = "" if sd is None else f" ± {number(sd, 3, factor)}"
    return f"{factor * change:+z.3f}{deviation} {shown_unit}"


def row_cells(one: RigRow, words: Words) -> tuple[str, str, str]:
    """Name, change and status in a language."""
    sensor, *rest = one.name.split(" ")
    name = " ".join([sensor, *map(words.term, rest)])
    return name, words.decimal(one.change), words.term(one.status)


def rig_outcome(found: CalibrationFigures | None, language: str = ENGLISH) -> str:
    """What came of comparing and calibrating the rig, in words."""
    return text_of(agreement(found.outcome, found.statuses), language) if found else ""


def origin_rows(origin: RigOrigin | None) -> list[tuple[str, str]]:
    """Serial numbers, and date, method and standard deviations of the calibration."""
    if origin is None:
        return []
    rows = [
        (f"{one.name}, {one.model}", f"serial number {one.serial}" if one.serial else _NO_SERIAL)
        for one in origin.sensors
    ]
    note = origin.calibration
    if note is None:
        return [*rows, ("calibrated", "not known: the rig file does not say")]
    age = "" if origin.age_days is None else f", {origin.age_days} days before the walk"
    rows.append(("calibrated", f"{note.date}{age}"))
    rows.append(("method", note.method))
    return rows + [(f"standard deviation, {name}", text) for name, text in _deviations(note)]


def _deviations(note: RigCalibration) -> list[tuple[str, str]]:
    """Largest standard deviations; what was not estimated is left out."""
    parts = (
        ("rotation", note.sd_deg, "°"),
        ("position", note.sd_mm, " mm"),
        ("clock", note.sd_ms, " ms"),
        ("angle of a beam", note.sd_beam_deg, "°"),
        ("range of a beam", note.sd_beam_mm, " mm"),
        ("GNSS lever arm", note.sd_antenna_mm, " mm"),
        ("GNSS clock", note.sd_gnss_ms, " ms"),
    )
    return [(name, f"{value:g}{unit}") for name, value, unit in parts if value]


def rig_charts(found: CalibrationFigures | None) -> list[tuple[str, str]]:
    """Differences from the rig file with bars of two standard deviations, as SVG and caption."""
    out = []
    for unit, title in _TITLES.items():
        rows = [one for one in found.parameters if one.unit == unit] if found else []
        if any(one.sd is not None for one in rows):
            caption = f"Difference from the rig file, {title}; bars: two standard deviations."
            out.append((_chart(rows, unit, title), caption))
    return out


def _row(one: ParameterFigures) -> RigRow:
    return RigRow(_name(one), change_text(one.change, one.sd, one.unit), one.status)


def _name(one: ParameterFigures) -> str:
    return " ".join(part for part in (one.sensor, one.quantity, one.axis) if part)


def _chart(rows: Sequence[ParameterFigures], unit: str, title: str) -> str:
    factor, _ = DISPLAY_UNITS[unit]
    chart = Chart(f"rig-{unit}", height=0.7 + 0.26 * len(rows))
    for status, color in _COLORS.items():
        own = [(at, one) for at, one in enumerate(rows) if one.status == status and one.sd]
        if own:
            middle = np.array([(factor * one.change, at) for at, one in own])
            half = np.array(
                [(RIG_CHARTS.width_sd * factor * (one.sd or 0.0), 0.0) for _, one in own]
            )
            add_bars(chart, middle, half, color=color)
    chart.axes.axvline(0.0, color=GRAY, lw=1.0, ls="--")
    chart.axes.set(xlabel=title, ylim=(len(rows) - 0.5, -0.5))
    chart.axes.set_yticks(range(len(rows)), [f"{_name(one)}: {one.status}" for one in rows])
    return chart.svg(legend=False)
