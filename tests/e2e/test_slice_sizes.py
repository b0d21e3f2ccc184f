"""A slice in a view that gets another size."""

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import looks
from tests.project_builder import ROOM_M
from tests.served import office, served

pytestmark = [pytest.mark.e2e, looks("desktop light")]

server = served(office(points=20_000))

WINDOW = "() => document.querySelector('slice-view').wanted.window"
WIDTH = "() => document.querySelector('slice-view').clientWidth"


def seen(page, condition, width_px):
    """What the view shows when its width meets the condition."""
    page.wait_for_function(f"(px) => ({WIDTH})() {condition} px", arg=width_px)
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => setTimeout(done)))")
    return page.evaluate(WINDOW)


def test_all_of_a_slice_stays_in_sight_when_a_result_is_opened(server, page):
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=1.5")
    expect(page.locator(".facing strong")).to_be_visible()
    expect(page.locator("body.drawing")).to_have_count(0)
    whole, width = page.evaluate(WINDOW), page.evaluate(WIDTH)
    assert whole["left"] < 0.0
    assert whole["right"] >= ROOM_M[0]

    export = page.locator(".findings summary", has_text="Export")
    export.click()
    narrow = seen(page, "<", width)
    assert narrow["left"] < 0.0
    assert narrow["right"] >= ROOM_M[0]

    export.click()
    again = seen(page, "===", width)
    assert again == pytest.approx(whole, abs=0.05)


def test_on_a_tablet_the_slice_begins_right_below_the_names_of_results(server, page):
    page.set_viewport_size({"width": 1024, "height": 768})
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=1.5")
    expect(page.locator(".facing strong")).to_be_visible()

    names, tools = (page.locator(one) for one in (".findings > details", ".tools"))
    bottom = max(box["y"] + box["height"] for box in (one.bounding_box() for one in names.all()))
    assert 0 <= tools.bounding_box()["y"] - bottom <= 20
