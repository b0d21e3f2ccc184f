"""HTTP route of the texts of pages: the Fluent files of a language, as the pages read them."""

from __future__ import annotations

from fastapi import APIRouter, Depends
from fastapi.responses import FileResponse

from recon4.locales.languages import ENGLISH, ROOT, languages
from recon4_app.access.people import Permission, needs
from recon4_app.errors import NotFound

page = APIRouter()


@page.get(
    "/texts/{language}/{file}.ftl",
    include_in_schema=False,
    dependencies=[Depends(needs(Permission.LOOK))],
)
def read_texts(language: str, file: str) -> FileResponse:
    """A file of texts; 404 if there is none of this name."""
    path = ROOT / language / f"{file}.ftl"
    known = {one.stem for one in ROOT.glob(f"{ENGLISH}/*.ftl")}
    if language not in languages() or file not in known or not path.is_file():
        raise NotFound(f"no texts {file[:40]} in {language[:20]}")
    return FileResponse(path, media_type="text/plain; charset=utf-8")
