"""The pages of a map that is not made yet."""

import json

import pytest
from playwright.sync_api import Route, expect

from tests.e2e.conftest import looks, on_both_screens, one_look
from tests.project_builder import build_project
from tests.served import served

pytestmark = pytest.mark.e2e

server = served(
    lambda root: [build_project(root / "young", with_map=False), build_project(root / "old")]
)


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


@one_look
def test_no_tool_bar_covers_that_the_map_is_made_again(server, page):
    view = json.dumps({"job": {"id": "j", "project": "old", "created": "1", "finished": ""}})
    body = f"retry: 200\nevent: job\ndata: {view}\n\n"
    page.route(
        "**/api/events", lambda route: route.fulfill(body=body, content_type="text/event-stream")
    )
    page.goto(f"{server.url}/projects/old/map/")
    news = page.locator("#news")
    expect(news).to_contain_text("is being made again")

    def nothing_covers_it(page):
        bar, said = page.locator("#bar").bounding_box(), news.bounding_box()
        assert bar["y"] + bar["height"] <= said["y"]
        assert said["y"] + said["height"] <= page.locator("#status").bounding_box()["y"]

    on_both_screens(page, nothing_covers_it)


@looks("desktop light")
def test_slices_show_a_map_that_is_made_again_and_lose_no_work_by_it(server, page):
    state = {"finished": "", "key": "before"}

    def view():
        job = {"id": "j", "project": "old", "created": "1", "finished": state["finished"]}
        return json.dumps({"job": job})

    def facts(route):
        answer = route.fetch()
        route.fulfill(response=answer, json=answer.json() | {"key": state["key"]})

    page.route("**/api/jobs/j", lambda route: route.fulfill(body=view()))
    stream = "text/event-stream"
    page.route(
        "**/api/events",
        lambda route: route.fulfill(
            body=f"retry: 200\nevent: job\ndata: {view()}\n\n", content_type=stream
        ),
    )
    opening: list[Route] = []
    page.route("**/api/projects/old/slices", lambda route: opening.append(route))
    page.route("**/api/projects/old/slices?*", lambda route: opening.append(route))
    page.goto(f"{server.url}/projects/old/slices/")
    for _ in range(2):  # what the first one says is done before the second one is asked for
        page.wait_for_event("response", lambda response: response.url.endswith("/api/events"))
    news = page.locator("#news")
    expect(news).to_be_empty()
    page.route("**/api/projects/old/slices", facts)
    page.route("**/api/projects/old/slices?*", facts)
    facts(opening[0])
    expect(news).to_have_text("This map is being made again. You see the one before.")

    with page.expect_event("domcontentloaded"):
        state.update(finished="done", key="after")
    state.update(finished="")
    expect(news).to_contain_text("is being made again")
    page.locator("#findings summary").first.focus()
    state.update(finished="done", key="newest")
    expect(news).to_contain_text("The map was made again.")
    with page.expect_event("domcontentloaded"):
        news.get_by_role("button", name="Show the new map").click()
