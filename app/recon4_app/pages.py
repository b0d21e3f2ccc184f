"""The pages in `web/`: HTML files with a common head, each with a line of what it is.

    <!-- page /storage for process, link head-storage at 3 -->

That is its address, the permission it needs (``anyone``: none) and, if the bar at the top of all
pages has a link to it, the text and the place of that link. ``for`` after the place names another
permission for the link. From this line follow the route, the link and the tests of all pages.
The address of a page of one project begins with ``/projects/{project_id}/``; its link is among
those of the project.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from html import escape
from os.path import normpath
from pathlib import Path
from typing import Annotated

from fastapi import Depends, Request
from fastapi.responses import HTMLResponse
from starlette.requests import HTTPConnection

from recon4.locales.languages import ENGLISH, ROOT, best_of, languages
from recon4.locales.texts import texts
from recon4_app.network.behind import prefix_of
from recon4_app.web_files import key_of


def _folder() -> Path:
    """Of an installed package beside it, else of the checkout."""
    installed = Path(__file__).parents[1] / "recon4_web"
    return installed if installed.is_dir() else Path(__file__).parents[2] / "web"


WEB = _folder()
OF_PROJECT = "/projects/{project_id}/"
"""Begins the addresses of the pages of one project; the first of them has this address."""
HEAD_HERE = "<!-- shared/head.html -->"
"""Stands in each page where the common elements of the heads belong."""
_PAGE = re.compile(
    r"<!-- page (?P<path>/\S*) for (?P<needs>[a-z]+)"
    r"(?:, link (?P<link>[a-z-]+) at (?P<place>\d+)(?: for (?P<link_needs>[a-z]+))?)? -->\n\s*"
)
_ADDRESS = re.compile(r"""(?<=\s)((?:href|src|action)=")(?=/)""")
"""In front of each address of this server in a page; all of them begin with a slash."""
SHARED_TEXTS = "shared"
"""File of the texts that all pages have in common."""
_TEXTS = re.compile(r'<html [^>]*data-texts="([a-z -]+)"')
"""Files of texts of a page; the others have the shared ones, around content in English."""
_TEXT = re.compile(r"\{\{ ([a-z0-9-]+) \}\}")
_SCRIPT = re.compile(r'<script type="module" src="/web/([^"]+)"')
_PRELOAD = '<link rel="modulepreload" href="{}" />\n    '
_IMPORT = re.compile(r'''(?:^|;)(?:import|export)\b[^;"]*"(\.[^"]+)"''', re.MULTILINE)
"""What a module loads before it runs."""
LANGUAGE_COOKIE = "recon4_language"
"""The choice on a page; `web/shared/texts.js` sets it."""


@dataclass(frozen=True, slots=True)
class PageAddress:
    """Where a page is, who may see it, and its link in the bar at the top of all pages."""

    path: str
    """Begins with a slash; without the prefix of the server."""
    file: str
    """Relative to `web/`."""
    needs: str
    """Name of a permission; ``anyone`` = also who has not signed in."""
    link: str = ""
    """Name of the text of the link; empty = there is no link."""
    place: int = 0
    """Where the link stands among the others."""
    link_needs: str = ""
    """Permission of the people to whom the link is shown."""


_DOCS = PageAddress("/docs/", "shared/lost.html", "look", "head-help", 5, "look")
"""The documentation: not in `web/`, but in the bar."""


@cache
def page_addresses() -> tuple[PageAddress, ...]:
    """All pages, in the order of their files."""
    found = []
    for path in sorted(WEB.rglob("*.html")):
        line = _PAGE.search(path.read_text("utf-8"))
        if line is not None:
            said = line.groupdict("")
            found.append(
                PageAddress(
                    path=said["path"],
                    file=path.relative_to(WEB).as_posix(),
                    needs=said["needs"],
                    link=said["link"],
                    place=int(said["place"] or 0),
                    link_needs=said["link_needs"] or said["needs"],
                )
            )
    return tuple(found)


@cache
def page_links(language: str) -> tuple[tuple[str, str, str], ...]:
    """The links of the bar at the top of all pages, in order: permission, path, text.

    Pages of one project have the path from the project on, without a slash at its beginning.
    """
    linked = [one for one in (*page_addresses(), _DOCS) if one.link]
    return tuple(
        (
            one.link_needs,
            one.path.removeprefix(OF_PROJECT),
            texts(language, *text_files(_html(one.file)))(one.link),
        )
        for one in sorted(linked, key=lambda one: (one.place, one.path))
    )


def _html(file: str) -> str:
    return (WEB / file).read_text("utf-8")


def html_of(file: str, prefix: str = "") -> str:
    """A page as HTML, with the shared head.

    Args:
        file: Path of the page, relative to `web/`.
        prefix: Path of the server on its host, as ``/recon4``; it is put in front of all addresses.
    """
    head = (WEB / "shared" / "head.html").read_text("utf-8")
    page = _PAGE.sub("", _html(file)).replace(HEAD_HERE, head)
    named = set(_SCRIPT.findall(page))

    def preloaded(script: re.Match[str]) -> str:
        fresh = [module for module in _imported(script[1]) if module not in named]
        named.update(fresh)
        return "".join(_PRELOAD.format(f"/web/{module}") for module in fresh) + script[0]

    page = _SCRIPT.sub(preloaded, page)
    return _ADDRESS.sub(rf"\g<1>{prefix}", page)


@cache
def _imported(script: str) -> tuple[str, ...]:
    """A script and all that it imports at any depth, relative to `web/`.

    A page names them, so that a browser requests them at once: else each level of imports is
    requested after the one before has come.
    """
    found: dict[Path, None] = {}
    left = [WEB / script]
    while left:
        module = left.pop()
        if module not in found and module.is_file():
            found[module] = None
            names = _IMPORT.findall(module.read_text("utf-8"))
            left += [Path(normpath(module.parent / name)) for name in names]
    return tuple(module.relative_to(WEB).as_posix() for module in found)


def web_key() -> str:
    """Names the content of `WEB`; it is part of the addresses of all files that a page loads."""
    return key_of(WEB)


def page_response(
    file: str, request: Request, fills: Mapping[str, str] = {}, *, head: str = ""
) -> HTMLResponse:
    """A page as the response to a request.

    Args:
        file: Path of the page, relative to `web/`.
        request: Its server may have a prefix.
        fills: HTML for the places of the page: ``title`` for ``{title}``.
        head: HTML in front of its title.
    """
    prefix = prefix_of(request.scope)
    page = html_of(file, prefix).replace(f'="{prefix}/web/', f'="{prefix}/web/{web_key()}/')
    language = language_of(request)
    page = _in_language(page, language)
    page = page.replace("<title>", f"{head}<title>", 1)
    for place, content in fills.items():
        page = page.replace(f"{{{place}}}", content)
    headers = {"Content-Language": language, "Vary": "Accept-Language, Cookie"}
    return HTMLResponse(page, headers=headers)


def language_of(connection: HTTPConnection) -> str:
    """The language that a person reads: as chosen on a page, else as the browser asks for."""
    chosen = connection.cookies.get(LANGUAGE_COOKIE, "")
    if chosen in languages():
        return chosen
    return best_of(connection.headers.get("accept-language", ""))


Language = Annotated[str, Depends(language_of)]
"""The language that the person who requests something reads."""


def text_files(page: str) -> tuple[str, ...]:
    """Names of the files of texts of a page, from its HTML."""
    named = _TEXTS.search(page)
    return (SHARED_TEXTS, *(named[1].split() if named else ()))


def _in_language(page: str, language: str) -> str:
    """A page with its texts, ``{{ name }}``, and those that its scripts ask for."""
    files = text_files(page)
    say = texts(language, *files)
    attributes = f'lang="{language}" data-languages="{" ".join(languages())}"'
    page = page.replace('lang="en"', attributes, 1)
    page = _TEXT.sub(lambda found: escape(say(found[1])), page)
    data = _texts_of_scripts(language, files) + _data("links", page_links(language))
    return page.replace("</head>", f"{data}</head>", 1)


@cache
def _texts_of_scripts(language: str, files: tuple[str, ...]) -> str:
    """What `web/shared/texts.js` reads: the Fluent files of a language, then those of English."""
    sources = [
        (one, "".join(_source(one, file) for file in files))
        for one in dict.fromkeys((language, ENGLISH))
        if one == language or texts(language, *files).lacks_some()
    ]
    return _data("texts", sources)


def _data(name: str, content: object) -> str:
    """An element whose content a script reads."""
    data = json.dumps(content, ensure_ascii=False).replace("<", r"\u003c")
    return f'<script type="application/json" id="{name}">{data}</script>\n  '


def _source(language: str, file: str) -> str:
    path = ROOT / language / f"{file}.ftl"
    return path.read_text("utf-8") + "\n" if path.is_file() else ""
