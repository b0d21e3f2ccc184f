"""The pages in `web/`: HTML files with a common head."""

from __future__ import annotations

from pathlib import Path

from fastapi.responses import HTMLResponse

WEB = Path(__file__).parents[1] / "web"
HEAD_HERE = "<!-- shared/head.html -->"
"""Stands in each page where the common elements of the heads belong."""


def html_of(file: str) -> str:
    """A page as HTML, with the shared head.

    Args:
        file: Path of the page, relative to `web/`.
    """
    head = (WEB / "shared" / "head.html").read_text("utf-8")
    return (WEB / file).read_text("utf-8").replace(HEAD_HERE, head)


def page_response(file: str) -> HTMLResponse:
    """A page as the response to a request; `file` is relative to `web/`."""
    return HTMLResponse(html_of(file))
