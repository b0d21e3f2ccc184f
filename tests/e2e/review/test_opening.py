"""What the review page says until it knows its loop closures."""

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import looks

pytestmark = [pytest.mark.e2e, looks("desktop light")]


def test_the_page_says_that_it_sorts_loop_closures_and_not_that_there_are_none(running, root, page):
    waiting = []
    page.route("**/review/queue", lambda route: waiting.append(route), times=1)
    with page.expect_request("**/review/queue"):
        page.goto(f"{running.url}/projects/{root.name}/review/")

    expect(page.locator("#pair")).to_contain_text("Sorting the loop closures…")
    expect(page.locator("review-queue [role=status]")).to_be_empty()

    waiting.pop().continue_()
    expect(page.locator("#pair")).to_contain_text("Next (J) shows the first pair")
    expect(page.locator("review-queue [role=status]")).to_contain_text("0 decided by people")


def test_a_page_that_cannot_be_read_does_not_go_on_sorting(running, root, page):
    page.route("**/review/queue", lambda route: route.abort(), times=1)
    page.goto(f"{running.url}/projects/{root.name}/review/")

    expect(page.locator("#message")).not_to_be_empty()
    expect(page.locator("#pair")).to_contain_text("Nothing to review")
