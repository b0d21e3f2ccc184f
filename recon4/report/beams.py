"""Corrections of single beams: a table of each LiDAR and one chart for each quantity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from recon4.model.calibration_figures import CalibrationFigures, ParameterFigures
from recon4.report.figures import AMBER, BLUE, GRAY, GREEN, INK, ORANGE, PINK, SKY, Chart, add_bars
from recon4.report.rig import DISPLAY_UNITS
from recon4.report.tuning import BEAM_CHARTS


@dataclass(frozen=True, slots=True)
class _Quantity:
    name: str
    factor: float
    unit: str
    digits: int


_QUANTITIES = (
    _Quantity("range", 1e3, " mm", 2),
    _Quantity("elevation", *DISPLAY_UNITS["rad"], 4),
    _Quantity("azimuth", *DISPLAY_UNITS["rad"], 4),
)
_COLORS = (BLUE, ORANGE, GREEN, PINK, SKY, AMBER, GRAY, INK)


class BeamRow(NamedTuple):
    """One beam in the table."""

    name: str
    """LiDAR and ring."""
    range: str
    """With sign, standard deviation and unit; or that the walk does not show it."""
    elevation: str
    azimuth: str


def beam_rows(found: CalibrationFigures | None) -> list[BeamRow]:
    """What the recording says of each beam; empty if beams were not estimated."""
    by_beam: dict[tuple[str, str], dict[str, ParameterFigures]] = {}
    for one in found.beams if found else ():
        by_beam.setdefault((one.sensor, one.axis), {})[one.quantity] = one
    return [
        BeamRow(
            f"{sensor} {ring}",
            *(_text(of_beam.get(f"beam {quantity.name}"), quantity) for quantity in _QUANTITIES),
        )
        for (sensor, ring), of_beam in by_beam.items()
    ]


def beam_charts(found: CalibrationFigures | None) -> list[tuple[str, str]]:
    """Corrections over the beams with bars of two standard deviations, as SVG and caption."""
    out = []
    for quantity in _QUANTITIES:
        rows = [
            one
            for one in (found.beams if found else ())
            if one.quantity == f"beam {quantity.name}" and one.sd is not None
        ]
        if rows:
            caption = (
                f"Correction of the {quantity.name} of each beam; bars: two standard deviations. "
                "Beams that the walk does not show are left out."
            )
            out.append((_chart(rows, quantity), caption))
    return out


def _text(one: ParameterFigures | None, quantity: _Quantity) -> str:
    if one is None or one.sd is None or one.status == "not observable":
        return "not observable"
    change, sd = (f"{quantity.factor * v:.{quantity.digits}f}" for v in (one.change, one.sd))
    sign = "" if one.change < 0.0 else "+"
    return f"{sign}{change} ± {sd}{quantity.unit}"


def _chart(rows: Sequence[ParameterFigures], quantity: _Quantity) -> str:
    chart = Chart(f"beams-{quantity.name}", height=3.4)
    sensors = list(dict.fromkeys(one.sensor for one in rows))
    for k, sensor in enumerate(sensors):
        own = [one for one in rows if one.sensor == sensor]
        at = [(int(one.axis) + BEAM_CHARTS.apart * k / len(sensors), one.change) for one in own]
        half = [(0.0, BEAM_CHARTS.width_sd * (one.sd or 0.0)) for one in own]
        scale = [1.0, quantity.factor]
        color = _COLORS[k % len(_COLORS)]
        add_bars(chart, np.array(at) * scale, np.array(half) * scale, color=color, label=sensor)
    chart.axes.set(xlabel="ring (0 = lowest)", ylabel=f"{quantity.name} [{quantity.unit.strip()}]")
    return chart.svg(above=True)
