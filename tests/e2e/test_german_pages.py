"""The list of projects and the page of a project are German as a whole, and nothing overflows."""

import pytest
from fluent.syntax import ast
from playwright.sync_api import expect

from recon4.locales.languages import ROOT
from recon4.locales.texts import messages_of
from tests.e2e.conftest import leave_out_viewer, looks
from tests.project_builder import build_project
from tests.served import served

pytestmark = pytest.mark.e2e

PATHS = ("/", "/projects/office/")
FILES = ("shared", "projects")
SIZES = ((1280, 900), (390, 844))
SHOWN = """() => {
  document.querySelectorAll("details").forEach((one) => (one.open = true));
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const texts = [];
  while (walker.nextNode())
    if (!walker.currentNode.parentElement.closest("[lang=en]"))
      texts.push(walker.currentNode.data);
  for (const name of ["aria-label", "title", "placeholder", "label", "alt"])
    document.querySelectorAll(`[${name}]`).forEach((one) => texts.push(one.getAttribute(name)));
  return texts.map((text) => text.replaceAll(/\\s+/g, " ").trim()).filter(Boolean);
}"""
"""All texts and labels of a page, with what is folded; without what is marked as English."""


def fixed_texts(language):
    """The texts of a language that quote no value."""
    found = [one for file in FILES for one in messages_of(ROOT / language / f"{file}.ftl").values()]
    patterns = [one.value.elements for one in found if one.value]
    return {
        elements[0].value
        for elements in patterns
        if len(elements) == 1 and isinstance(elements[0], ast.TextElement)
    }


server = served(lambda root: [build_project(root / name, points=1000) for name in ("office", "b")])


@looks("desktop light")
@pytest.mark.parametrize("path", PATHS)
def test_a_german_page_shows_no_english_text(server, page, path):
    page.context.add_cookies([{"name": "recon4_language", "value": "de", "url": server.url}])
    leave_out_viewer(page)
    page.goto(server.url + path)
    expect(page.get_by_role("link", name="Hilfe", exact=True)).to_be_visible()
    expect(page.get_by_text("Kein Mangel an dieser Karte gefunden").first).to_be_visible()
    page.wait_for_load_state("networkidle")
    english = fixed_texts("en") - fixed_texts("de")

    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        shown = page.evaluate(SHOWN)
        page.wait_for_load_state("networkidle")  # what was opened reads its content
        shown += page.evaluate(SHOWN)

        assert len(set(shown)) > 50
        assert sorted(set(shown) & english) == []
        phrases = [one for one in english if " " in one]
        assert [text for text in shown if any(one in text for one in phrases)] == []
        assert page.evaluate("document.documentElement.scrollWidth - innerWidth") == 0
