"""The residual table as CSV and as text for a terminal."""

from __future__ import annotations

import csv
import io
from dataclasses import astuple

from recon4.evaluation.table import text_table
from recon4.export.cells import safe_cell
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.locales.numbers import localized
from recon4.locales.texts import Shown
from recon4.recording.tables.column_names import Role
from recon4.slices.residuals import ControlReport, Residual, ResidualStatistics

UNKNOWN = "–"
"""Stands for a figure that was not measured."""


def residual_csv(report: ControlReport, *, comment: str = "") -> str:
    """The residuals in meters, and after an empty line each limit with the measured value.

    Args:
        report: The table.
        comment: Text of the first line: project, map, frame.
    """
    out = io.StringIO()
    out.write(f"# recon4 control and check points {' '.join(comment.split())}".rstrip() + "\n")
    out.write(f"# {report.verdict.text}\n# limits: {report.limits}\n")
    rows = csv.writer(out, lineterminator="\n")
    stated = ["sd_major_m", "sd_minor_m", "azimuth_deg", "sd_up_m"]
    tested = ["directions", "across_m", "sigmas", "outlier"]
    rows.writerow(["id", "role", "dE_m", "dN_m", "dU_m", "d2D_m", "d3D_m", *stated, *tested])
    for row in report.rows:
        rows.writerow([safe_cell(row.id), row.role, *_cells(row)])
    for name in report.missing:
        rows.writerow([safe_cell(name), "not found in the map"])
    for name in report.absent:
        rows.writerow([safe_cell(name), "picked where the map has no points"])
    for name in report.outdated:
        rows.writerow([safe_cell(name), "found in an earlier map only"])
    for f in report.figures:
        rows.writerow(["RMSE", f.role, *_axes(f, "rmse_m"), "", _meters(f.rmse_3d_m)])
        rows.writerow(["mean", f.role, *_axes(f, "mean_m")])
        rows.writerow(["points", f.role, *(one.points for one in f.axes)])
    if report.hint:
        out.write(f"# {report.hint}\n")
    rows.writerow([])
    rows.writerow(["limit", "role", "points", "measured_m", "limit_m", "holds"])
    for f in report.figures:
        for one in f.requirements:
            holds = {True: "yes", False: "NO", None: UNKNOWN}[one.holds]
            limit = f"{one.limit_m:.3f}"
            rows.writerow([one.label, f.role, one.points, _meters(one.value_m), limit, holds])
    return out.getvalue()


def residual_text(report: ControlReport, language: str = ENGLISH) -> str:
    """The residuals in centimeters, each limit, and the verdict.

    Args:
        report: The table, made in this language.
        language: Of the text.
    """

    def say(code: str, **values: Shown) -> str:
        return CodedText(code, **values).said(language)

    def cm(value: float | None) -> str:
        return localized(UNKNOWN if value is None else f"{100.0 * value:.1f}", language)

    def role(of: Role) -> str:
        return say("named-role", role=of)

    rows = [
        (
            f"{row.id} ({role(row.role)})",
            *(cm(d) for d in (row.east_m, row.north_m, row.d2_m, row.up_m, row.d3_m)),
        )
        for row in report.rows
    ]
    lines = [
        (
            f"{one.label} ({role(f.role)})",
            str(one.points),
            cm(one.value_m),
            cm(one.limit_m),
            one.text,
        )
        for f in report.figures
        for one in f.requirements
    ]
    head = ("dX cm", "dY cm", "H cm", "dZ cm", say("residuals-total"))
    limits = (say("residuals-limit"), say("residuals-points"), "cm", say("residuals-limit-cm"), "")
    texts = [
        text_table((say("residuals-marker"), *head), rows),
        text_table(limits, lines) if lines else "",
        say("control-not-measured", names=", ".join(report.missing)) if report.missing else "",
        report.verdict.text,
        say("residuals-limits", limits=report.limits),
        report.hint,
    ]
    return "\n".join(text for text in texts if text)


def _cells(row: Residual) -> list[str]:
    shown = (row.east_m, row.north_m, row.up_m, row.d2_m, row.d3_m)
    stated = astuple(row.stated) if row.stated else (None,) * 4
    sigmas = UNKNOWN if row.sigmas is None else f"{row.sigmas:.1f}"
    outlier = UNKNOWN if row.sigmas is None else "YES" if row.outlier else "no"
    tested = [str(row.directions), _meters(row.across_m), sigmas, outlier]
    return [*(_meters(value) for value in (*shown, *stated)), *tested]


def _axes(f: ResidualStatistics, name: str) -> list[str]:
    return [_meters(getattr(one, name)) for one in f.axes]


def _meters(value: float | None) -> str:
    return UNKNOWN if value is None else f"{value:.4f}"
