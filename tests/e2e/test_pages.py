"""The pages of projects and jobs in a real browser."""

import os
from pathlib import Path

import pytest
from playwright.sync_api import Route, expect

from tests.e2e.conftest import leave_out_viewer, looks, on_both_screens, one_look
from tests.project_builder import build_project
from tests.served import served
from tests.service.cuttable import cuttable
from tests.service.running import SLOW, open_gate, recording_with_gate, server_thread

pytestmark = pytest.mark.e2e


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=60_000)
    build_project(root / "half", with_map=False)
    with server_thread(root) as running:
        yield running


server = served(fresh=True, worker_module=SLOW)


@pytest.fixture(scope="module")
def real():
    """Projects made from recordings, for the screenshots in the documentation."""
    folder = os.environ.get("RECON4_PROJECTS")
    if not folder:
        pytest.skip("needs finished projects in RECON4_PROJECTS")
    with server_thread(Path(folder), viewer_points=150_000) as running:
        yield running


def drawn(page):
    """The scene is drawn, and the notice about a missing GPU is closed."""
    page.frames[-1].wait_for_function("window.__viserMutable?.canvas")
    page.frame_locator("iframe").locator(".mantine-Notification-closeButton").click()
    expect(page.frame_locator("iframe").locator(".mantine-Notification-closeButton")).to_be_hidden()


def fits(page):
    """Nothing overflows to the side, and every control is large enough."""
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    small = page.evaluate(
        """[...document.querySelectorAll(
            'button, input:not([type=checkbox]), label.check, select, summary, .bar a, .files a')]
        .filter((one) => one.checkVisibility() && one.getBoundingClientRect().height < 44)
        .map((one) => one.outerHTML.slice(0, 80))"""
    )
    assert small == []


def test_the_list_shows_projects_with_state_and_thumbnail(finished, page, screenshot):
    page.goto(finished.url)

    card = page.get_by_role("listitem").filter(has_text="office")
    expect(card).to_contain_text("No problem found in this map")
    expect(card.locator("img")).to_have_js_property("complete", True)
    expect(page.get_by_role("listitem").filter(has_text="half")).to_contain_text("Not finished")
    fits(page)
    screenshot(page, "projects")


def test_a_project_shows_its_map_figures_and_results(finished, page, screenshot):
    page.goto(finished.url)

    page.get_by_role("link", name="office").click()
    viewer = page.frame_locator("iframe")

    expect(page.get_by_role("heading", name="office")).to_be_visible()
    expect(page.get_by_role("term").filter(has_text="Points in the map")).to_be_visible()
    expect(page.get_by_role("row").filter(has_text="odometry")).to_contain_text("Done")
    expect(viewer.get_by_text("map frame · z up · meters")).to_be_visible()
    expect(viewer.get_by_text("Points by normalized intensity")).to_be_attached()
    drawn(page)
    fits(page)
    screenshot(page, "project")


def test_real_projects_look_as_they_should(real, page, screenshot):
    page.goto(real.url)
    card = page.get_by_role("listitem").filter(has_text="m path").first
    expect(card.locator("img")).to_have_js_property("complete", True)
    screenshot(page, "projects")

    card.get_by_role("link").click()
    viewer = page.frame_locator("iframe")
    expect(viewer.get_by_text("Points by normalized intensity")).to_be_attached()
    drawn(page)
    fits(page)
    screenshot(page, "project")


@looks("desktop dark")
def test_layers_and_colors_follow_the_panel(finished, page):
    page.goto(f"{finished.url}/projects/office/")
    viewer = page.frame_locator("iframe")
    legend = viewer.get_by_text("Rejected, verification median > limit (2)").first

    expect(legend).to_be_visible()
    viewer.get_by_label("Color by").click()
    viewer.get_by_role("option", name="height").click()

    expect(viewer.get_by_text("m above the origin")).to_be_visible()
    expect(viewer.get_by_text("Points by height")).to_be_visible()


@looks("desktop light")
def test_a_download_and_the_report_open(finished, page):
    leave_out_viewer(page)
    page.goto(f"{finished.url}/projects/office/")

    with page.expect_download() as download:
        page.get_by_role("link", name="Trajectory, TUM").click()
    with page.expect_popup() as report:
        page.get_by_role("link", name="Quality report").click()

    assert download.value.suggested_filename == "office-trajectory.tum"
    expect(report.value.get_by_role("heading", name="Report")).to_be_visible()


def test_a_job_is_started_watched_cancelled_and_resumed(server, page, tmp_path, look, screenshot):
    leave_out_viewer(page)
    recording = recording_with_gate(tmp_path / "morning walk")
    page.goto(server.url)

    page.get_by_role("button", name="Browse…").click()
    page.get_by_role("button", name=f"{tmp_path.name}/").click()
    page.get_by_role("button", name="morning walk/").click()
    page.get_by_role("button", name="Use this folder").click()
    expect(page.get_by_label("Project name")).to_have_value("morning-walk")
    fits(page)
    screenshot(page, "new-project")
    page.get_by_role("button", name="Start").click()

    expect(page.get_by_role("heading", name="morning-walk")).to_be_visible()
    expect(page.locator("job-status")).to_contain_text("Odometry")
    expect(page.get_by_role("row").filter(has_text="frames")).to_contain_text("Done")
    page.get_by_text("Log", exact=True).click()
    expect(page.locator("job-log pre")).to_contain_text("Odometry")
    expect(page.locator("job-status")).to_contain_text("% of the run")
    fits(page)
    screenshot(page, "running")
    page.get_by_role("button", name="Cancel").click()
    expect(page.locator("job-status")).to_contain_text("Cancelled")
    expect(page.locator("job-status")).to_contain_text("what was finished is kept")

    page.get_by_role("button", name="Resume").click()
    expect(page.get_by_role("row").filter(has_text="frames")).to_contain_text("Reused")
    gate = open_gate(recording)
    expect(page.locator("#state")).to_contain_text("Finished")
    os.close(gate)
    page.reload()
    page.get_by_text("Log", exact=True).click()
    expect(page.locator("job-log pre")).to_contain_text("succeeded")


@looks("desktop light")
def test_a_page_without_link_shows_the_outcome_of_its_job_later(server, context, tmp_path):
    page = context.new_page()  # its browser complains of the cut
    leave_out_viewer(page)
    recording = recording_with_gate(tmp_path / "walk")
    job = server.start("office", recording)
    server.wait_at_gate(job)
    with cuttable(int(server.url.rsplit(":", 1)[1])) as link:
        page.goto(f"{link.url}/projects/office/")
        expect(page.locator("job-status")).to_contain_text("Odometry")
        link.cut()
        expect(page.get_by_text("Connection lost")).to_be_visible()
        gate = open_gate(recording)
        server.wait_state(job, "succeeded")
        os.close(gate)
        # the first answer is none a stream can come back from by itself
        page.route("**/api/events", lambda route: route.fulfill(status=503), times=1)
        link.restore()

        expect(page.locator("#state")).to_contain_text("Finished")
        page.close()  # before the link goes


@looks("desktop light")
def test_a_job_known_before_the_stream_has_its_outcome_shown_too(server, context, tmp_path):
    page = context.new_page()  # its browser complains of the 503
    leave_out_viewer(page)
    page.route("**/api/events", lambda route: route.fulfill(status=503))
    recording = recording_with_gate(tmp_path / "walk")
    job = server.start("office", recording)
    server.wait_at_gate(job)
    page.goto(f"{server.url}/projects/office/")
    expect(page.locator("job-status")).to_contain_text("Odometry")
    gate = open_gate(recording)
    server.wait_state(job, "succeeded")
    os.close(gate)

    page.unroute("**/api/events")

    expect(page.locator("#state")).to_contain_text("Finished")
    page.close()


@looks("desktop dark")
def test_a_rejected_request_shows_its_message(server, page, look):
    page.goto(server.url)

    page.get_by_label("Or a recording on the server").fill("/etc/passwd")
    page.get_by_label("Project name").fill("office")
    page.get_by_role("button", name="Start").click()

    expect(page.locator("recording-look")).to_contain_text("recordings may only lie in")
    expect(page.get_by_role("alert").filter(has_text="nothing was started")).to_be_visible()
    assert server.get("/api/jobs").json() == []


@looks("desktop light")
def test_a_job_is_started_by_keyboard_alone(server, page, tmp_path):
    leave_out_viewer(page)
    (tmp_path / "empty.pcap").write_bytes(b"")
    recording_with_gate(tmp_path / "data" / "walk")
    build_project(server.root / "empty", with_map=False)
    page.goto(server.url)

    expect(page.get_by_role("listitem").filter(has_text="empty")).to_be_visible()
    field = page.get_by_label("Or a recording on the server")
    expect(field).to_be_visible()  # what is hidden, until the role is known, takes no focus
    field.focus()
    page.keyboard.type(str(tmp_path / "empty.pcap"))
    page.keyboard.press("Tab")
    expect(page.get_by_label("Project name")).to_have_value("empty-2")  # the other one stays
    page.keyboard.press("Tab")  # over the button Browse
    expect(page.get_by_label("Project name")).to_be_focused()
    page.keyboard.press("Enter")

    expect(page.locator("recording-look")).to_contain_text("empty.pcap")
    expect(page.get_by_role("alert").filter(has_text="nothing was started")).to_be_visible()
    assert server.get("/api/jobs").json() == []
    recording = page.get_by_label("Or a recording on the server")
    expect(recording).to_be_focused()
    page.keyboard.press("Control+A")
    page.keyboard.type(str(tmp_path / "data" / "walk"))
    page.keyboard.press("Enter")  # at once: the form looks at the recording before it starts

    expect(page.get_by_role("heading", name="walk")).to_be_visible()
    expect(page.locator("job-status")).to_contain_text("Odometry")


@looks("desktop light")
def test_what_is_typed_before_the_choices_are_known_is_not_lost(server, page, tmp_path):
    leave_out_viewer(page)
    recording_with_gate(tmp_path / "data" / "walk")
    build_project(server.root / "walk", with_map=False)
    held: list[Route] = []
    page.route("**/api/rigs", lambda route: held.append(route))
    page.goto(server.url)
    page.get_by_label("Or a recording on the server").fill(str(tmp_path / "data" / "walk"))
    with page.expect_response("**/api/look*"):
        page.keyboard.press("Enter")
    expect(page.get_by_label("Project name")).to_have_value("walk")

    held.pop().continue_()

    expect(page.get_by_role("heading", name="walk-2")).to_be_visible()
    expect(page.locator("job-status")).to_contain_text("Odometry")


@looks("desktop light")
def test_a_hostile_link_to_the_viewer_stays_on_this_server(finished, page):
    page.goto(f"{finished.url}/projects/office/viewer/?websocket=ws://127.0.0.1:9")

    expect(page.get_by_text("Controls", exact=True)).to_be_visible()


@one_look
def test_the_api_page_works_without_internet(finished, page, look, screenshot):
    page.goto(f"{finished.url}/api")

    route = page.locator("#post-api-jobs")
    route.locator("summary").click()

    expect(page.get_by_role("heading", name="Jobs")).to_be_visible()
    expect(route.get_by_role("row").filter(has_text="recordings")).to_contain_text("list of string")
    expect(route.locator(".copy pre")).to_contain_text("curl -X POST -H 'Content-Type")
    on_both_screens(page, fits)
    screenshot(page, "api")
