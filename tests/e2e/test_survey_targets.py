"""Survey targets found in the whole map, in a real browser."""

import re

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import looks
from tests.e2e.test_control_points import choose_survey, opened
from tests.e2e.test_pages import fits
from tests.served import served
from tests.survey_targets import SITE, TRUE, build_targets

pytestmark = pytest.mark.e2e

server = served(build_targets)


def hold_first_put(route, held):
    if route.request.method == "PUT" and not held:
        held.append(route)
    else:
        route.continue_()


@looks("desktop light")
def test_a_person_takes_the_targets_that_the_survey_names(server, page, screenshot):
    rows = [[name, *(f"{x:.3f}" for x in SITE @ p), "control"] for name, p in TRUE.items()]
    table = "\n".join(",".join(row) for row in [["id", "E", "N", "H", "role"], *rows])
    opened(page, server)
    choose_survey(page, table.encode())
    held = []
    page.route("**/slices/control", lambda route: hold_first_put(route, held))
    page.get_by_role("button", name=re.compile("^Use ")).click()

    # The survey is still on its way to the server.
    page.get_by_role("button", name="Find targets in the whole map").click()
    expect(page.get_by_role("button", name="Searching")).to_be_disabled()
    held[0].continue_()

    expect(page.get_by_text(re.compile("4 of 4 surveyed points found"))).to_be_visible(
        timeout=60_000
    )
    page.get_by_label("Take P2").uncheck()
    page.get_by_role("button", name="Go to target 3").click()
    page.get_by_role("button", name="Take the chosen ones (3)").scroll_into_view_if_needed()
    fits(page)
    screenshot(page, "slices-targets")
    page.get_by_role("button", name="Take the chosen ones (3)").click()
    expect(page.get_by_text("3 points measured at their targets.")).to_be_visible()
    expect(page.locator(".verdict")).to_contain_text("coordinates of its own")


@looks("desktop light")
def test_a_search_goes_on_when_the_page_is_opened_again_and_can_be_cancelled(server, page):
    waiting = {
        "id": "0011223344556677",
        "state": "running",
        "person": "",
        "created": "",
        "note": "",
        "step": "boards",
        "fraction": 0.34,
        "kept": False,
        "of_this_map": False,
    }
    searches = "**/slices/control/targets"
    page.route(searches, lambda route: route.fulfill(json=[waiting]))
    page.route(f"{searches}/*", lambda route: route.fulfill(json=waiting))
    cancelled = []

    def cancel(route):
        cancelled.append(route.request.url)
        waiting["state"] = "cancelled"
        route.fulfill(json=waiting)

    page.route(f"{searches}/*/cancel", cancel)
    opened(page, server)
    page.get_by_text("Control and check points").click()

    expect(page.locator(".targets")).to_contain_text("board: 34 %")
    page.locator(".targets").get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("button", name="Find targets in the whole map")).to_be_enabled()
    assert len(cancelled) == 1
