"""The viewer *Graph* in German: what viser itself writes is German too."""

import re
from importlib.util import find_spec
from pathlib import Path

import pytest
from playwright.sync_api import expect

from recon4.locales.languages import ENGLISH
from recon4_app.pages import LANGUAGE_COOKIE
from recon4_app.viewer.page import NOTICES
from recon4_app.viewer.words import words
from tests.e2e.conftest import looks
from tests.project_builder import build_project
from tests.served import served

pytestmark = pytest.mark.e2e

server = served(lambda root: build_project(root / "office", points=2_000))


@looks("desktop dark")
def test_notices_of_viser_are_in_the_language_of_the_page(server, page):
    page.context.add_cookies([{"name": LANGUAGE_COOKIE, "value": "de", "url": server.url}])
    page.goto(f"{server.url}/projects/office/viewer/")
    english, german = words(ENGLISH), words("de")

    expect(page.get_by_text(german("viser-software"), exact=True)).to_be_attached()  # no GPU here
    expect(page.get_by_text(german("viser-software-why"), exact=True)).to_be_attached()
    page.evaluate(
        "document.getElementById('root').append('Your browser (Firefox/80) is outdated, '"
        " + 'which may cause problems. Consider updating.')"
    )
    expect(page.locator("#root")).to_contain_text("Dieser Browser (Firefox/80) ist veraltet")
    assert page.get_by_text(english("viser-software"), exact=True).count() == 0


def test_viser_still_writes_these_notices():
    found = find_spec("viser")
    sources = (Path(found.origin).parent / "client" / "src").rglob("*.ts*")
    text = re.sub(r'"\s*\+\s*"', "", "".join(path.read_text("utf-8") for path in sources))
    english = words(ENGLISH)
    for name in NOTICES:
        parts = english(f"viser-{name}", browser="VALUE").split("VALUE")
        assert all(part in text for part in parts), name
