"""The acceptance sheet to print: limits, residuals at surveyed points, approval of the map."""

from __future__ import annotations

from dataclasses import dataclass

from jinja2 import Environment, PackageLoader, StrictUndefined

from recon4.slices.residual_table import UNKNOWN
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


def _in_cm(length_m: float | None) -> str:
    return UNKNOWN if length_m is None else f"{100.0 * length_m:.1f}"


def render_acceptance(report: ControlReport, text: AcceptanceText) -> str:
    """The sheet as one HTML file without scripts; all names are escaped."""
    environment = Environment(
        loader=PackageLoader("recon4.slices", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["cm"] = _in_cm
    template = environment.get_template("acceptance.html.jinja")
    return template.render(report=report, text=text)
