"""The acceptance sheet to print: limits, residuals at surveyed points, approval of the map."""

from __future__ import annotations

from dataclasses import dataclass

from jinja2 import Environment, PackageLoader, StrictUndefined

from recon4.slices.residuals import ControlReport


@dataclass(frozen=True, slots=True, kw_only=True)
class AcceptanceText:
    """Texts of the sheet beside the figures."""

    project: str
    frame: str
    """Frame, axes, unit."""
    sources: str
    """Version of the program and key of the map."""
    approval: str
    """Who approved the map, or `Not approved`."""


def render_acceptance(report: ControlReport, text: AcceptanceText) -> str:
    """The sheet as one HTML file without scripts; all names are escaped."""
    environment = Environment(
        loader=PackageLoader("recon4.slices", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["cm"] = lambda length_m: f"{100.0 * length_m:.1f}"
    template = environment.get_template("acceptance.html.jinja")
    return template.render(report=report, text=text, verdict=_verdict(report))


def _verdict(report: ControlReport) -> tuple[str, str]:
    """Level and message of the verdict."""
    if report.passed is None:
        return "note", "Nothing was checked: no point has a place in this map."
    count = report.figures[0].points
    points = f"{count} {report.judged_by} point{'s' if count != 1 else ''}"
    level, message = "good", f"The map keeps the limits at {points}."
    if not report.passed:
        level, message = "bad", f"The map does not keep the limits at {points}."
    elif report.judged_by == "control":
        level = "note"
        message = f"The map keeps the limits at {points}, but no independent point was checked."
    left = len(report.missing) + len(report.outdated)
    message = f"{message} {left} more not checked." if left else message
    return level, f"{message} {report.hint}".strip()
