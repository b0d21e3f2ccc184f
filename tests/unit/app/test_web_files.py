"""Browsers keep the files of the pages by the key of their content."""

import asyncio
import re

import httpx
import pytest

from recon4_app.pages import page_response, web_key
from recon4_app.web_files import WebFiles, key_of
from tests.unit.app.test_page_language import asking


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "map").mkdir()
    (tmp_path / "map/map.js").write_text("one")
    return tmp_path


def ask(app, *paths, **headers):
    async def every():
        server = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=server, base_url="http://here") as client:
            return [await client.get(path, headers=headers) for path in paths]

    return asyncio.run(every())


def test_a_file_is_kept_by_the_key_of_its_content_alone(folder):
    key = key_of(folder)
    app = WebFiles(directory=folder)

    kept, plain, other = ask(
        app, f"/{key}/map/map.js", "/map/map.js", "/0123456789abcdef/map/map.js"
    )
    (again,) = ask(app, f"/{key}/map/map.js", **{"If-None-Match": kept.headers["ETag"]})

    assert [one.text for one in (kept, plain, other)] == ["one"] * 3
    assert "immutable" in kept.headers["Cache-Control"]
    assert (again.status_code, again.headers["Cache-Control"]) == (
        304,
        kept.headers["Cache-Control"],
    )
    assert not any("Cache-Control" in one.headers for one in (plain, other))


def test_what_has_changed_has_another_key_and_is_not_kept_by_the_earlier_one(folder):
    before, app = key_of(folder), WebFiles(directory=folder)

    (folder / "map/map.js").write_text("another")

    (changed,) = ask(app, f"/{before}/map/map.js")
    assert key_of(folder) != before
    assert changed.text == "another" and "Cache-Control" not in changed.headers


def test_all_files_of_a_page_have_the_key():
    page = page_response("map/map.html", asking()).body.decode()

    files = re.findall(r'(?:href|src)="/web/([^"]+)"', page)
    assert len(files) > 50 and all(one.startswith(f"{web_key()}/") for one in files)
