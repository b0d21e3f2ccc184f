"""The documentation in a browser: its search, its colors and its links, from this server alone."""

import re

import pytest
from playwright.sync_api import TimeoutError, expect

from tests.e2e.axe import barriers, needs_axe
from tests.served import served

pytestmark = pytest.mark.e2e

server = served()
SEARCH_IS_READY = "() => [...document.querySelectorAll('*')].some((one) => one.shadowRoot)"
"""Its dialog is in a shadow tree; before, keys open nothing."""


def open_search(page):
    """The field of the dialog; the first keys may come before the page listens to them."""
    field = page.get_by_role("combobox", name="Search")
    for _ in range(10):
        page.keyboard.press("Control+k")
        try:
            field.wait_for(timeout=5_000)
        except TimeoutError:
            continue
        return field
    return field


def test_the_search_finds_a_page_without_internet(server, page, look, screenshot):
    page.goto(f"{server.url}/docs/")
    page.wait_for_function(SEARCH_IS_READY)
    screenshot(page, "docs-start")

    open_search(page).fill("fingerprint")
    found = page.get_by_role("option")
    expect(found.first).to_be_visible()
    screenshot(page, "docs-search")
    found.first.click()

    expect(page).to_have_url(re.compile(r"/docs/[\w-]+/[\w-]+\.html"))
    expect(page.locator("article h1")).to_be_visible()


def test_a_page_has_the_colors_the_browser_wants_and_no_more_than_its_width(
    server, page, look, screenshot
):
    page.goto(f"{server.url}/docs/reference/findings.html#gnss-clock")

    expect(page.locator("#gnss-clock")).to_be_in_viewport()
    dark = page.evaluate("() => getComputedStyle(document.body).backgroundColor")
    channels = [int(one) for one in re.findall(r"\d+", dark)[:3]]
    assert (max(channels) < 80) == (look[1] == "dark")
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
    screenshot(page, "docs-findings")


def test_the_site_leads_back_to_the_projects(server, page):
    page.goto(f"{server.url}/docs/reference/rig.html")

    page.get_by_role("link", name="Projects of this server").click()

    expect(page).to_have_url(f"{server.url}/")


@needs_axe
@pytest.mark.parametrize(
    "path",
    [
        "index.html",  # headings, lists, cards
        "how-to/slices.html",  # wide tables
        "reference/python-api.html",  # code in colors
        "explanation/odometry.html",  # equations
    ],
)
def test_a_page_has_no_barrier_that_axe_finds(server, page, path):
    page.goto(f"{server.url}/docs/{path}")
    page.wait_for_function(SEARCH_IS_READY)

    assert barriers(page) == []
