"""The documentation on the server: every page, link and image, without internet."""

import re
from pathlib import Path

import pytest

from tests.served import served
from tests.service.running import ROOT

PAGES = sorted(path.stem for path in (ROOT / "docs").glob("*.md"))


server = served()


@pytest.mark.parametrize("name", PAGES)
def test_a_page_and_the_images_on_it_are_served(server, name):
    page = server.get(f"/docs/{name}.md")

    assert page.status_code == 200
    assert "{content}" not in page.text and "<h1>" in page.text
    for image in re.findall(r'<img src="(images/[^"]+)"', page.text):
        assert server.get(f"/docs/{image}").headers["content-type"].startswith("image/")
    for link in re.findall(r'<a href="([a-z][^":#]*\.md)', page.text):
        assert Path(link).stem in PAGES


def test_the_help_begins_with_the_tour_and_has_anchors(server):
    assert "<h1>" in server.get("/docs/").text
    assert 'id="csv-headers"' in server.get("/docs/recordings").text


@pytest.mark.parametrize(
    "name", ["..%2fREADME", "missing", "images/..%2f..%2fREADME.md", "a b", "a" * 5000]
)
def test_nothing_else_is_served(server, name):
    assert server.get(f"/docs/{name}").status_code == 404
