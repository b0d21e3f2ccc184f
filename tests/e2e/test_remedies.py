"""An error that names a way out has it on the page where it is read."""

import re
import shutil

import httpx
import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import leave_out_viewer, looks, on_both_screens, one_look
from tests.e2e.test_pages import fits
from tests.project_builder import build_project
from tests.served import office, served
from tests.service.running import SLOW, recording_with_gate, server_thread

pytestmark = pytest.mark.e2e

ALL_OF_IT = 1 << 60
"""More bytes than any disk has: with this reserve every disk is full."""


server = served(office(points=120_000), fresh=True, worker_module=SLOW)


@pytest.fixture
def full(tmp_path):
    """A server whose disk is full."""
    build_project(tmp_path / "office", points=60_000)
    limits = {"worker_module": SLOW, "free_disk_reserve_bytes": ALL_OF_IT}
    with server_thread(tmp_path, **limits) as running:
        yield running


def opened_by(press, page):
    """The page that opens in another tab."""
    with page.expect_popup() as opened:
        press()
    return opened.value


def opened_slices(page, server):
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=1.5")
    expect(page.locator(".facing strong")).to_be_visible()
    expect(page.locator("body.drawing")).to_have_count(0)


@one_look
def test_an_upload_without_room_leads_to_what_takes_space(full, page, screenshot):
    page.goto(full.url)
    walk = {"name": "walk.bag", "mimeType": "", "buffer": bytes(1000)}
    page.locator("upload-box input[type=file]").first.set_input_files(walk)

    box = page.locator("upload-box")
    expect(box.get_by_role("status")).to_contain_text("make room first")
    link = box.get_by_role("link", name="See what takes space")
    on_both_screens(page, fits)
    screenshot(page, "remedy-upload")
    link.focus()
    storage = opened_by(lambda: page.keyboard.press("Enter"), page)
    expect(storage.get_by_role("rowheader", name="office")).to_be_visible()
    expect(box.get_by_role("button", name="Continue")).to_be_visible()
    expect(box.get_by_role("button", name="File…")).to_be_visible()  # the same, or a smaller one


@looks("phone dark")
def test_an_export_without_room_leads_to_what_takes_space(full, page, screenshot):
    opened_slices(page, full)
    page.get_by_text("Export", exact=True).tap()

    page.get_by_role("link", name="SVG").tap()

    alert = page.get_by_role("alert").filter(has_text="GB free on the disk")
    expect(alert).to_be_visible()
    fits(page)
    alert.scroll_into_view_if_needed()
    screenshot(page, "remedy-export")
    storage = opened_by(alert.get_by_role("link").tap, page)
    expect(storage.get_by_role("rowheader", name="office")).to_be_visible()


@looks("desktop light")
@pytest.mark.study
def test_a_job_without_room_is_refused_with_the_way_to_room(full, page):
    leave_out_viewer(page)
    recording = recording_with_gate(full.root / "clouds")
    page.goto(f"{full.url}/projects/office/")
    page.get_by_text("Run again, with other settings").click()
    expect(page.get_by_label("Project name")).to_have_value("office")
    page.locator("new-job input[name=recording]").fill(str(recording))
    page.keyboard.press("Tab")
    expect(page.locator("recording-look")).to_contain_text("KITTI")
    page.get_by_role("button", name="Start").click()

    alert = page.get_by_role("alert").filter(has_text="no space: this job needs about")
    expect(alert.get_by_role("link", name="See what takes space")).to_be_visible()


@looks("desktop light")
@pytest.mark.study
def test_a_refused_export_says_why_on_the_page_and_the_next_one_is_made(server, page):
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=90")
    expect(page.locator(".facing strong")).to_be_visible()
    page.get_by_text("Export", exact=True).click()

    page.get_by_role("link", name="LAZ").click()
    alert = page.get_by_role("alert").filter(has_text="the slice holds no points")
    expect(alert).to_be_visible()
    page.get_by_label("z [m]").fill("1.5")
    page.get_by_label("z [m]").press("Enter")
    with page.expect_download() as download:
        page.get_by_role("link", name="LAZ").click()

    assert download.value.suggested_filename == "office-slice.laz"
    assert download.value.path().read_bytes()[:4] == b"LASF"
    expect(alert).to_have_count(0)


@looks("desktop light")
@pytest.mark.study
def test_a_deleted_project_whose_name_is_taken_leads_to_the_one_that_has_it(server, page):
    assert httpx.delete(f"{server.url}/api/projects/office").status_code == 200
    build_project(server.root / "office", points=60_000)
    leave_out_viewer(page)
    page.goto(server.url)
    page.get_by_text("Recently deleted").click()

    page.get_by_role("button", name="Restore office").click()
    alert = page.get_by_role("alert").filter(has_text="delete or rename it first")
    other = opened_by(alert.get_by_role("link", name="Open office").click, page)

    other.get_by_text("Rename or delete").click()
    expect(other.get_by_role("button", name="Delete…")).to_be_visible()
    other.close()


@looks("desktop light")
@pytest.mark.study
def test_control_points_that_others_keep_changing_are_read_again(server, page):
    opened_slices(page, server)
    page.get_by_text("Control and check points").click()
    survey = {"name": "p.csv", "mimeType": "text/csv", "buffer": b"ID;X;Y;Z\nA;0,02;5;1,5\n"}
    page.get_by_label("Survey file").set_input_files(survey)
    page.get_by_role("button", name=re.compile("^Use ")).click()
    row = page.get_by_role("row", name=re.compile("^A "))
    expect(row).to_be_visible()
    control = f"{server.url}/api/projects/office/slices/control"

    def another_first(route):
        if route.request.method == "PUT":
            now = httpx.get(control).json()
            assert httpx.put(control, json=now).status_code == 200
        route.continue_()

    page.route("**/slices/control", another_first)
    page.get_by_role("button", name="A on the nearest surface").click()
    expect(page.get_by_role("alert").filter(has_text="they are read again")).to_be_visible()
    page.unroute("**/slices/control")
    page.get_by_role("button", name="A on the nearest surface").click()

    expect(row).to_contain_text("-2.0")


@looks("phone dark")
@pytest.mark.study
def test_the_reference_to_remove_is_beside_the_error_that_there_are_too_many(server, page):
    plan = server.root / "plan.xyz"
    plan.write_text("\n".join(f"0.03 {y / 20} {z / 10}" for y in range(200) for z in range(30)))
    opened_slices(page, server)
    page.get_by_text("Compare with a reference").tap()

    def add():
        page.get_by_label("Path of the reference").fill(str(plan))
        page.get_by_role("button", name="Add reference").tap()
        page.get_by_role("button", name="Use these columns").tap()

    add()
    expect(page.locator(".reference-row")).to_have_count(1)
    (first,) = (server.root / "office/slices/references").iterdir()
    for k in range(19):
        shutil.copytree(first, first.with_name(f"{k:012x}"))
    opened_slices(page, server)
    page.get_by_text("Compare with a reference").tap()
    add()

    expect(page.get_by_role("alert").filter(has_text="remove one first")).to_be_visible()
    remove = page.get_by_role("button", name="Remove")
    expect(remove).to_have_count(20)
    remove.first.tap()
    expect(remove).to_have_count(19)
    page.get_by_role("button", name="Use these columns").tap()
    expect(remove).to_have_count(20)


@looks("desktop light")
def test_a_recording_in_use_is_not_deleted_and_the_reason_stays(server, page):
    uploaded = server.root / "recordings" / "walk-0123456789ab"
    recording = recording_with_gate(uploaded)
    job = server.start("walk", recording)
    server.wait_at_gate(job)
    leave_out_viewer(page)
    page.goto(f"{server.url}/storage")

    page.get_by_role("button", name="Delete… walk").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    alert = page.get_by_role("alert").filter(has_text="cancel it first")
    other = opened_by(alert.get_by_role("link", name="Open walk").click, page)
    other.get_by_role("button", name="Cancel").click()
    server.wait_state(job, "cancelled")
    other.close()
    page.get_by_role("button", name="Delete… walk").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()

    expect(page.get_by_role("rowheader", name="walk-0123456789ab")).to_have_count(0)


@looks("phone dark")
def test_a_job_that_ended_early_offers_other_settings(server, page, screenshot):
    recording = recording_with_gate(server.root / "walk")
    job = server.start("hall", recording)
    server.wait_at_gate(job)
    leave_out_viewer(page)
    waiting = server.start("attic", recording)
    page.goto(f"{server.url}/projects/attic/")
    expect(page.locator("job-status")).to_contain_text("once the jobs before it have ended")
    for one in (waiting, job):
        server.post(f"/api/jobs/{one}/cancel")
        server.wait_state(one, "cancelled")
    page.goto(f"{server.url}/projects/hall/")
    expect(page.locator("#viewer")).to_contain_text("the job ended before it had a trajectory")
    other = page.get_by_role("button", name="Other settings…")
    expect(other).to_be_in_viewport()

    other.tap()

    expect(page.locator("new-job input[name=recording]")).to_have_value(str(recording))
    expect(page.get_by_label("Preset")).to_be_visible()
    fits(page)
    screenshot(page, "remedy-other-settings")
