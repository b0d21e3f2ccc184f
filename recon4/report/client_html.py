"""The report for the client as one HTML file, without scripts: it works without a network.

It says what the PDF says: both lay out the same record.
"""

from __future__ import annotations

from base64 import b64encode

from recon4.model.finding import Level
from recon4.report.client import ClientReport, Drawing
from recon4.report.findings import LEVEL_STYLES
from recon4.report.html import environment


def client_html(report: ClientReport) -> str:
    """The report as HTML text. All texts are escaped; drawings are images, which run nothing."""
    page = environment().get_template("client.html.jinja")
    return page.render(report=report, image=_image, color=_color)


def _image(drawing: Drawing) -> str:
    return f"data:image/svg+xml;base64,{b64encode(drawing.svg.encode()).decode()}"


def _color(level: str) -> str:
    return LEVEL_STYLES[Level(level)]
