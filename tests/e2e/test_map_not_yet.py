"""The pages of a map that is not made yet."""

import json

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import looks
from tests.project_builder import build_project
from tests.served import served

pytestmark = pytest.mark.e2e

server = served(lambda root: build_project(root / "young", with_map=False))


@looks("desktop light")
def test_a_project_without_points_says_so(server, page):
    page.goto(f"{server.url}/projects/young/map/")

    expect(page.locator("#message")).to_contain_text("no points in 3-D")
    expect(page.locator("#opening")).to_be_hidden()

    page.goto(f"{server.url}/projects/young/slices/")
    expect(page.locator("#message").get_by_role("link", name="Open young")).to_be_visible()
    expect(page.locator("#controls")).to_be_hidden()


@looks("phone dark")
def test_a_map_appears_once_its_job_is_done_also_one_that_failed_before(server, page):
    job = {"id": "j", "project": "young", "created": "1"}
    state = {"finished": "", "map": 404}

    def view():
        return json.dumps({"job": job | {"finished": state["finished"]}})

    page.route("**/api/jobs/j", lambda route: route.fulfill(body=view()))
    stream = "text/event-stream"
    page.route(
        "**/api/events",
        lambda route: route.fulfill(
            body=f"retry: 200\nevent: job\ndata: {view()}\n\n", content_type=stream
        ),
    )
    page.route(
        "**/api/projects/young/map?*",
        lambda route: route.fulfill(status=state["map"], body='{"key": "new", "detail": "none"}'),
    )
    page.goto(f"{server.url}/projects/young/map/")
    news = page.locator("#news")
    expect(news).to_have_text("A job is making this map. It appears here once it is made.")

    state["finished"] = "failed"
    expect(news).to_be_empty()
    state["finished"] = ""
    expect(news).to_contain_text("A job is making this map")
    with page.expect_event("domcontentloaded"):
        state.update(finished="done", map=200)
