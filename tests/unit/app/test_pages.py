"""The pages as the server sends them."""

import re

import pytest
from fastapi import APIRouter

from recon4_app import pages
from recon4_app.page_routes import add_page
from recon4_app.pages import HEAD_HERE, WEB, html_of, page_addresses, page_links

PAGES = sorted(
    path.relative_to(WEB).as_posix() for path in WEB.rglob("*.html") if path.name != "head.html"
)


@pytest.mark.parametrize("file", PAGES)
def test_a_page_has_the_shared_head_once(file):
    html = html_of(file)

    assert html.startswith("<!doctype html>") and HEAD_HERE not in html
    head = html[: html.index("</head>")]
    for once in ("<meta charset=", '<meta name="viewport"', "/web/shared/base.css"):
        assert head.count(once) == html.count(once) == 1, once


@pytest.mark.parametrize("file", PAGES)
def test_every_file_of_a_head_exists(file):
    files = re.findall(r'(?:href|src)="/web/([^"]+)"', html_of(file))

    assert files
    assert [name for name in files if not (WEB / name).is_file()] == []


def test_a_page_names_what_its_script_imports_at_any_depth():
    html = html_of("projects/index.html", "/maps")

    vendor = ("shared/vendor/fluent/scope", "shared/vendor/lit-html/directive-helpers")
    for module in ("projects/organize", "shared/http", *vendor):
        assert html.count(f'<link rel="modulepreload" href="/maps/web/{module}.js" />') == 1
    assert html.index("modulepreload") < html.index('<script type="module"')


def test_what_two_scripts_import_is_named_once_before_the_first_that_needs_it():
    html = html_of("map/map.html")

    named = re.findall(r'<link rel="modulepreload" href="/web/([^"]+)" />', html)
    scripts = re.findall(r'<script type="module" src="/web/([^"]+)"', html)
    assert scripts == ["map/opening.js", "map/map.js"]
    assert len(set(named)) == len(named) and not set(named) & set(scripts)
    first, later = html.split('<template id="later">')
    assert '"/web/map/shaders.js"' in first and '"/web/map/bar.js"' in later


@pytest.fixture
def one_page(tmp_path, monkeypatch):
    """Writes the line of the only page of `web/`, and gives what is read from it."""

    def write(line):
        (tmp_path / "hall").mkdir()
        (tmp_path / "hall" / "hall.html").write_text(f"<head>\n    {line}\n    <title></title>")
        monkeypatch.setattr(pages, "WEB", tmp_path)
        return page_addresses.__wrapped__()

    return write


def test_a_page_says_its_address_its_permission_and_its_link(one_page):
    (found,) = one_page("<!-- page /hall for look, link head-hall at 7 for process -->")

    assert (found.path, found.file, found.needs) == ("/hall", "hall/hall.html", "look")
    assert (found.link, found.place, found.link_needs) == ("head-hall", 7, "process")


def test_a_page_for_a_permission_that_there_is_not_stops_the_server(one_page):
    (found,) = one_page("<!-- page /hall for everybody -->")

    with pytest.raises(ValueError, match="everybody"):
        add_page(APIRouter(), found)


def test_the_line_of_a_page_is_not_sent():
    assert "<!-- page" not in html_of("storage/storage.html")


def test_links_are_in_the_order_of_their_places_and_in_the_language():
    paths = [path for _, path, _ in page_links("en")]

    assert [path for path in paths if path[:1] != "/"] == ["", "map/", "review/", "slices/"]
    assert [path for path in paths if path[:1] == "/"] == [
        "/live",
        "/rigs",
        "/storage",
        "/api",
        "/docs/",
        "/people",
    ]
    assert ("process", "/storage", "Speicher") in page_links("de")
