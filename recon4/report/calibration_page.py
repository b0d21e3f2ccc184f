"""The page of a calibration: parameters, a slice before and after, figures of the method."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from recon4.geometry.se3 import Array
from recon4.locales.coded import said
from recon4.locales.languages import ENGLISH
from recon4.model.calibration_figures import CalibrationFigures
from recon4.report.beams import beam_charts, beam_rows
from recon4.report.chart_groups import framed
from recon4.report.figures import BLUE, GREEN, ORANGE, PINK, Chart
from recon4.report.html import environment
from recon4.report.rig import RigRow, rig_charts, rig_rows
from recon4.report.translation import in_language
from recon4.report.tuning import CALIBRATION_PAGE
from recon4.store.atomic import write_text

_COLORS = (BLUE, ORANGE, GREEN, PINK)


@dataclass(frozen=True, slots=True, eq=False)
class CloudSlice:
    """Points of each LiDAR in a horizontal slice, placed by one rig."""

    name: str
    """Of the rig, as ``rig file``."""
    p_m: tuple[tuple[str, Array], ...]
    """Name of each LiDAR and its points, x and y [m], (N, 2)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationPage:
    """Content of the page."""

    title: str
    method: str
    outcome: str
    figures: CalibrationFigures | None = None
    """Of the method joint."""
    rows: Sequence[RigRow] = ()
    """Of the other methods, as their lines."""
    report_lines: tuple[str, ...] = ()
    slices: Sequence[CloudSlice] = ()


def write_calibration_page(path: Path, page: CalibrationPage, language: str = ENGLISH) -> None:
    """Write the page as one HTML file without scripts and network, in a language.

    Raises:
        StoreError: If the file cannot be written.
    """
    text = (
        environment()
        .get_template("calibration.html.jinja")
        .render(
            title=page.title,
            method=page.method,
            outcome=said(page.outcome, language),
            rows=rig_rows(page.figures) or page.rows,
            charts=framed(rig_charts(page.figures)),
            beams=beam_rows(page.figures),
            beam_charts=framed(beam_charts(page.figures)),
            slices=framed([(_chart(one), one.name) for one in page.slices]),
            thickness_m=CALIBRATION_PAGE.thickness_m,
            report_lines=[said(line, language) for line in page.report_lines],
        )
    )
    write_text(path, in_language(text, language, {}))


def _chart(one: CloudSlice) -> str:
    chart = Chart(f"slice-{one.name}", height=CALIBRATION_PAGE.height_in)
    for k, (name, p_m) in enumerate(one.p_m):
        color = _COLORS[k % len(_COLORS)]
        chart.axes.plot(*p_m.T, ".", ms=1.2, color=color, label=name, rasterized=True)
    chart.axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    return chart.svg()
