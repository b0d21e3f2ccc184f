"""The documentation site (``make site``) as pages of the server: with its search, no internet."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Mapping
from functools import cache
from hashlib import sha256
from pathlib import Path

from fastapi import APIRouter, Depends, Request
from fastapi.responses import FileResponse, RedirectResponse, Response

from recon4.locales.coded import CodedText
from recon4_app.access.middleware.origin import PAGE_POLICY
from recon4_app.access.people import Permission, needs
from recon4_app.errors import NotFound
from recon4_app.network.behind import public_path
from recon4_app.pages import WEB

router = APIRouter(
    prefix="/docs", dependencies=[Depends(needs(Permission.LOOK))], include_in_schema=False
)
_STYLE_OF_THE_SEARCH = "sha256-NwSx/R2V/U4jnW0Tq5pQ53Y/rzPVJ4dqE7D6UTA/J1k="
"""Its dialog adds one sheet of styles (zensical 0.0.73); with another the browser names the hash
that it expects."""
_INLINE_SCRIPT = re.compile(r"<script>(.*?)</script>", re.DOTALL)


@cache
def folder() -> Path:
    """The built site: of an installed package inside of it, else of the checkout."""
    inside = WEB / "docs"
    return inside if inside.is_dir() else WEB.parent / "site"


@cache
def files() -> Mapping[str, Path]:
    """Address below ``/docs/`` -> file; only these can be requested.

    Raises:
        NotFound: If the site was not built.
    """
    found = [path for path in folder().rglob("*") if path.is_file()]
    if not found:
        raise NotFound(CodedText("documentation-missing"))
    return {path.relative_to(folder()).as_posix(): path for path in found}


@cache
def _addresses() -> Mapping[str, str]:
    """Name of a page -> its address: ``review`` -> ``how-to/review.html``."""
    return {Path(one).stem: one for one in files() if one.endswith(".html")}


@router.get("/{address:path}")
def docs_file(address: str, request: Request) -> Response:
    """Send a file of the site; the name of a page alone leads to it."""
    path = files().get(address or "index.html")
    if path is None:
        page = _addresses().get(address.removesuffix(".md").rpartition("/")[2])
        if page is None:
            raise NotFound(CodedText("documentation-page-unknown", page=address[:64]))
        return RedirectResponse(public_path(request.scope, f"/docs/{page}"))
    if path.suffix != ".html":
        return FileResponse(path)
    return FileResponse(path, headers={"Content-Security-Policy": policy_of(path)})


@cache
def policy_of(page: Path) -> str:
    """The policy of other pages, which admits also the small scripts that are part of this one."""
    scripts = _INLINE_SCRIPT.findall(page.read_text("utf-8"))
    hashes = {b64encode(sha256(one.encode()).digest()).decode() for one in scripts}
    allowed = " ".join(f"'sha256-{one}'" for one in sorted(hashes))
    styles = f"style-src 'self' '{_STYLE_OF_THE_SEARCH}'"
    return f"{PAGE_POLICY}; {styles}; script-src 'self' {allowed}"
