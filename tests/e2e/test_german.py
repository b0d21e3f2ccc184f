"""Pages in German: nothing of what they show is English."""

import pytest
from playwright.sync_api import expect

from recon4.locales.languages import ENGLISH, ROOT
from recon4.locales.texts import messages_of, texts
from recon4_app.pages import LANGUAGE_COOKIE, html_of, text_files
from tests.e2e.conftest import looks, on_both_screens
from tests.e2e.review.review_page import page_fits
from tests.project_builder import build_project
from tests.served import served

pytestmark = pytest.mark.e2e

SHOWN = """() => [document.title, ...[...document.querySelectorAll("body *:not(script)")].flatMap(
  (one) => [
    ...[...one.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE)
      .map((node) => node.data.replace(/\\s+/g, " ").trim()),
    ...["title", "aria-label", "placeholder", "alt"].map((name) => one.getAttribute(name)),
  ]).filter(Boolean)]"""
"""All texts of a page, also of what is closed, and those that a screen reader says."""
ROWS = """() => new Set([...document.querySelectorAll("#tools button")]
  .filter((one) => one.checkVisibility()).map((one) => one.offsetTop)).size"""
"""Rows of the tool bar of *Slices*."""
CUT = """() => [...document.querySelectorAll(".bar *")]
  .filter((one) => one.clientWidth && one.scrollWidth > one.clientWidth + 1)
  .map((one) => one.textContent)"""
"""What does not fit into the head of a page."""
OUTSIDE = """(buttons) => buttons.map((one) => {
  const { left, top, width, height } = one.getBoundingClientRect();
  const over = document.elementFromPoint(left + width / 2, top + height / 2);
  return !one.checkVisibility() || one.contains(over) ? "" : one.textContent.trim();
}).filter(Boolean)"""
"""Buttons that are shown and cannot be pressed."""
CUT_CHOICES = """() => [...document.querySelectorAll("#findings select")].filter((one) => {
  const copy = one.cloneNode(true);
  [...copy.options].filter(({ value }) => value !== one.value).forEach((other) => other.remove());
  copy.style.cssText = "position: absolute; width: auto; max-width: none";
  one.parentElement.append(copy);
  const whole_px = copy.offsetWidth;
  copy.remove();
  return one.checkVisibility() && one.offsetWidth + 1 < whole_px;
}).map((one) => one.selectedOptions[0].text)"""
"""What is chosen in lists that are too narrow for it."""
OF_THE_PAGE = {
    "review": ("Prüfung von office · recon4", "#pair h2", "Multiframes"),
    "map": ("Karte · office · recon4", "#status .shown", "Punkten"),
    "slices": ("Schnitte · office · recon4", ".caption", "Diese Karte"),
}
"""Its title, and where it has which word once it is drawn."""

server = served(lambda root: build_project(root / "office", points=6_000, normals=True))


def english_of(files):
    """English texts that are others in German and quote nothing."""
    english, german = texts(ENGLISH, *files), texts("de", *files)
    found = set()
    for name in (one for file in files for one in messages_of(ROOT / ENGLISH / f"{file}.ftl")):
        try:
            found |= {english(name)} - {german(name)}
        except KeyError:  # it quotes a value, or has parts only
            continue
    return found


def bars_fit(page):
    """The tool bars take two rows at most; what has no room there is in lists that fit."""
    rows = "new Set([...document.querySelectorAll('#bar .group')].map((one) => one.offsetTop)).size"
    assert page.evaluate(rows) <= 2
    assert page.locator("#bar button").evaluate_all(OUTSIDE) == []
    for opener in page.locator("#bar .more:visible").all():
        opener.click()
        expect(page.locator("#bar .list button").first).to_be_visible()
        assert page.locator("#bar .list button").evaluate_all(OUTSIDE) == []
        page.keyboard.press("Escape")
        expect(page.locator("#bar .list")).to_have_count(0)
        expect(opener).to_be_focused()


@looks("desktop light")
@pytest.mark.parametrize("name", OF_THE_PAGE)
def test_a_german_page_has_no_english_text(server, page, name):
    title, place, word = OF_THE_PAGE[name]
    url = f"{server.url}/projects/office/{name}/"
    page.context.add_cookies([{"name": LANGUAGE_COOKIE, "value": "de", "url": server.url}])
    page.goto(url)
    if name == "review":
        expect(page.locator("review-queue li").first).to_be_visible()
        page.keyboard.press("j")
    expect(page.locator(place).first).to_contain_text(word)
    expect(page).to_have_title(title)

    english = english_of(text_files(html_of(f"{name}/{name}.html")))

    if name == "slices":
        assert page.evaluate(ROWS) == 1
        page.get_by_text("Vergleich mit einer Referenz").click()
        expect(page.get_by_role("button", name="Vergleichen", exact=True)).to_be_visible()
        assert page.evaluate(CUT_CHOICES) == []
    if name != "review":
        page.set_viewport_size({"width": 1024, "height": 500})
        page.keyboard.press("?")
        assert page.locator("#help").evaluate("(one) => one.scrollTop") == 0
        assert page.evaluate(CUT) == []
    if name == "map":
        page.keyboard.press("Escape")
        bars_fit(page)
    assert len(english) > 200
    assert sorted(english & set(page.evaluate(SHOWN))) == []
    on_both_screens(page, bars_fit if name == "map" else page_fits)
