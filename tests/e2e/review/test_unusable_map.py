"""A map that must not be used looks so, and is approved only with a reason."""

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import leave_out_viewer, looks, on_both_screens, one_look
from tests.e2e.review.review_page import fits, page_fits
from tests.review_project import LOST, judge

pytestmark = pytest.mark.e2e


REASON = "only the hall is used; it was checked by total station"


@pytest.fixture
def unusable(root):
    """The project as after a walk on which tracking was lost in a corridor."""
    stretch = {
        **{"start_s": 2.0, "end_s": 9.5, "direction": "horizontal", "degeneracy": 0.0011},
        **{"from_m": [0.5, 1.0, 0.0], "to_m": [1.2, -0.4, 0.0]},
    }
    judge(root, usability="do not use", reasons=[LOST], unobserved=[stretch])
    return root


@one_look
def test_an_unusable_map_looks_so_and_is_signed_only_with_a_reason(unusable, opened, screenshot):
    page, bar = opened, opened.locator("map-verdict")
    expect(bar).to_contain_text("Do not use this map")
    expect(bar).to_contain_text(LOST)
    on_both_screens(page, fits)
    screenshot(page, "review-unusable")

    page.get_by_role("button", name="Approve map…").click()
    dialog, sign = page.get_by_role("dialog"), page.get_by_role("button", name="Sign", exact=True)
    for text in ("Do not use this map", LOST, "2 s to 10 s: a horizontal direction", "Multiframes"):
        expect(dialog).to_contain_text(text)
    expect(sign).to_be_disabled()
    page.get_by_label("Reason (required)").fill("  .        ")
    expect(sign).to_be_disabled()
    page.get_by_label("Reason (required)").fill(REASON)
    screenshot(page, "review-sign-unusable")
    sign.click()

    expect(page.locator("#signing")).to_contain_text(
        f"in spite of the verdict “do not use”: “{REASON}"
    )
    assert REASON in (unusable / "report.html").read_text()


@one_look
def test_slices_and_project_say_that_a_map_is_unusable(running, unusable, page, screenshot):
    leave_out_viewer(page)
    page.goto(f"{running.url}/projects/{unusable.name}/slices/")
    bar = page.locator("map-verdict")
    expect(bar).to_contain_text("Do not use this map")
    bar.locator("summary").click()
    expect(bar).to_contain_text("Hardly observable")
    on_both_screens(page, page_fits)
    screenshot(page, "slices-unusable")

    page.goto(f"{running.url}/projects/{unusable.name}/")
    expect(page.locator("#state")).to_contain_text("Do not use this map")
    expect(page.locator("#verdict")).to_contain_text("2 s to 10 s: a horizontal direction")


@looks("phone dark")
def test_an_error_while_the_pairs_are_read_stays_on_the_page(running, root, page):
    page.route("**/api/projects/*/review", lambda route: route.abort())

    name = page.request.get(f"{running.url}/api/projects/{root.name}").json()["name"]
    page.goto(f"{running.url}/projects/{root.name}/review/")

    expect(page.locator("page-head")).to_contain_text(name)  # it is read after the pairs
    expect(page.locator("#message")).to_contain_text("does not answer")
