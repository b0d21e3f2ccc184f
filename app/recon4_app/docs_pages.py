"""The documentation as pages of the server: the Markdown files of `docs/`, without internet."""

from __future__ import annotations

import html
import re
from functools import cache
from pathlib import Path

from fastapi import APIRouter, Depends, Request
from fastapi.responses import FileResponse, HTMLResponse
from markdown_it import MarkdownIt

from recon4_app.access.people import Permission, needs
from recon4_app.errors import NotFound
from recon4_app.pages import WEB, page_response

router = APIRouter(
    prefix="/docs", dependencies=[Depends(needs(Permission.LOOK))], include_in_schema=False
)
PAGE = "shared/docs.html"
"""``{title}`` and ``{content}`` are filled in."""
START = "tour"
_EMPTY_HEAD = re.compile(r"<thead>\s*<tr>\s*(?:<th>\s*</th>\s*)+</tr>\s*</thead>")
"""Of a table that has no captions: Markdown cannot leave the line out."""


@cache
def folder() -> Path:
    """The Markdown files: of an installed package inside of it, else of the checkout."""
    inside = WEB / "docs"
    return inside if inside.is_dir() else WEB.parent / "docs"


@cache
def _names(below: str, pattern: str) -> frozenset[str]:
    """Names of the files; only these can be requested."""
    return frozenset(path.name for path in (folder() / below).glob(pattern))


@router.get("/")
def docs_start(request: Request) -> HTMLResponse:
    """Show the first page of the documentation."""
    return docs_page(START, request)


@router.get("/images/{name}")
def docs_image(name: str) -> FileResponse:
    """Send an image of the documentation."""
    path = folder() / "images" / name
    if name not in _names("images", "*.*"):
        raise NotFound(f"the documentation has no image {name[:64]!r}")
    return FileResponse(path)


@router.get("/{name}")
def docs_page(name: str, request: Request) -> HTMLResponse:
    """Show a page of the documentation."""
    path = folder() / f"{name.removesuffix('.md')}.md"
    if f"{name.removesuffix('.md')}.md" not in _names("", "*.md"):
        raise NotFound(f"the documentation has no page {name[:64]!r}")
    text = path.read_text("utf-8")
    title = html.escape(text.split("\n", 1)[0].lstrip("# "))
    return page_response(PAGE, request, {"title": title, "content": rendered(text)})


def rendered(markdown: str) -> str:
    """HTML of a page; raw HTML in it is kept, because it is ours."""
    body: str = MarkdownIt("commonmark", {"html": True}).enable("table").render(markdown)
    body = _EMPTY_HEAD.sub("", body).replace("<th></th>", "<td></td>")
    # What scrolls sideways can be reached with the keyboard, too.
    body = re.sub(r"<(table|pre)>", r'<\1 tabindex="0">', body)
    return re.sub(r"<h([23])>(.*?)</h\1>", _with_anchor, body)


def _with_anchor(heading: re.Match[str]) -> str:
    plain = re.sub(r"<[^>]+>", "", heading[2]).lower()
    anchor = re.sub(r"[^\w -]", "", plain).replace(" ", "-")
    return f'<h{heading[1]} id="{anchor}">{heading[2]}</h{heading[1]}>'
