"""Processing recordings in a real browser: upload, summary, settings, run again, delete."""

import os
import random
import re
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import leave_out_viewer, looks
from tests.e2e.test_pages import fits
from tests.project_builder import build_project
from tests.served import served
from tests.service.running import SLOW, open_gate, recording_with_gate
from tests.unit.recording.test_mandeye import write_walk

pytestmark = pytest.mark.e2e


server = served(fresh=True, below="server", worker_module=SLOW)


@pytest.fixture
def capture(data, tmp_path):
    """A real capture on the operator's own computer."""
    return shutil.copy(
        data("packets/mrpt") / "sample_velodyne_vlp16_gps.pcap", tmp_path / "Ranní pochůzka.pcap"
    )


def chooser(page, *, folder=False):
    return page.locator("upload-box input[type=file]").nth(1 if folder else 0)


def test_an_uploaded_recording_fills_in_the_form(server, page, capture, screenshot):
    page.goto(server.url)

    chooser(page).set_input_files(capture)

    expect(page.locator("upload-box")).to_contain_text("On the server")
    expect(page.locator("recording-look")).to_contain_text("VLP-16")
    expect(page.get_by_label("Project name")).to_have_value("Ranní pochůzka")
    screenshot(page, "upload")
    page.get_by_text("All settings").click()
    page.get_by_label("Find a setting").fill("voxel")
    field = (
        page.locator("setting-editor .group")
        .filter(has_text="The point map")
        .get_by_label("voxel_m")
    )
    field.fill("7")
    field.press("Tab")
    expect(page.locator("setting-editor")).to_contain_text("voxel_m must be 0 to 1, got 7")
    fits(page)
    page.get_by_role("button", name="Start").click()
    expect(page.get_by_text("Some settings are invalid, see above")).to_be_visible()
    expect(field).to_be_focused()


@looks("desktop light")
def test_an_upload_resumes_after_the_page_was_closed(server, page, tmp_path):
    data = random.Random(3).randbytes(20_000_000)  # pieces have 8 MB
    walk = tmp_path / "walk.bag"
    walk.write_bytes(data)
    page.on("dialog", lambda dialog: dialog.accept())
    patches = 0

    def only_one(route):
        nonlocal patches
        patches += route.request.method == "PATCH"
        route.abort() if patches > 1 else route.continue_()

    page.route("**/api/uploads/files/**", only_one)
    page.goto(server.url)
    chooser(page).set_input_files(walk)
    expect(page.locator("upload-box")).to_contain_text("Interrupted")
    page.unroute("**/api/uploads/files/**")
    page.reload()

    left = page.get_by_role("list", name="Unfinished uploads")
    expect(left).to_contain_text("MB of 20 MB received. Select the same file again")
    chooser(page).set_input_files(walk)

    expect(page.locator("upload-box")).to_contain_text("On the server")
    path = Path(page.get_by_label("Or a recording on the server").input_value())
    assert path.read_bytes() == data
    assert len(server.get("/api/uploads").json()) == 1


@looks("desktop light")
def test_an_upload_is_paused_continued_and_removed(server, page, tmp_path):
    (tmp_path / "walk.bag").write_bytes(bytes(100_000_000))
    page.route(
        "**/api/uploads/files/**", lambda route: (page.wait_for_timeout(300), route.continue_())
    )
    page.goto(server.url)
    box = page.locator("upload-box")

    chooser(page).set_input_files(tmp_path / "walk.bag")
    page.get_by_role("button", name="Pause").click()
    expect(box).to_contain_text("Paused")
    page.get_by_role("button", name="Continue").click()
    expect(box).to_contain_text("B/s")
    page.get_by_role("button", name="Pause").click()
    page.get_by_role("button", name="Remove").click()

    expect(page.get_by_text("Drop a file or folder here")).to_be_visible()
    assert server.get("/api/uploads").json() == []
    page.unroute_all(behavior="ignoreErrors")  # a piece may still be held up


@looks("desktop light")
def test_a_folder_is_uploaded_with_its_names(server, page, tmp_path):
    walk = tmp_path / "KITTI walk"
    (walk / "clouds").mkdir(parents=True)
    for n in range(12):
        (walk / "clouds" / f"{n:06d}.bin").write_bytes(bytes(16 * n))
    (walk / ".DS_Store").write_bytes(b"x")
    page.goto(server.url)

    chooser(page, folder=True).set_input_files(walk)

    expect(page.locator("upload-box")).to_contain_text("KITTI walk, 12 files On the server")
    folder = Path(page.get_by_label("Or a recording on the server").input_value())
    assert sorted(p.name for p in (folder / "clouds").iterdir())[-1] == "000011.bin"
    assert (folder / "clouds" / "000011.bin").stat().st_size == 176


@looks("desktop light")
def test_a_walk_of_a_mandeye_device_is_uploaded_as_one_recording(server, page, tmp_path):
    write_walk(tmp_path / "Walk 7", seconds=1.0)
    sent = sorted(file.name for file in (tmp_path / "Walk 7").iterdir())
    page.goto(server.url)

    chooser(page, folder=True).set_input_files(tmp_path / "Walk 7")

    expect(page.locator("recording-look")).to_contain_text("2 LiDARs and no rig")
    expect(page.locator("recording-look")).to_contain_text("Mid-360")
    folder = Path(page.get_by_label("Or a recording on the server").input_value())
    assert sorted(file.name for file in folder.iterdir()) == sent
    assert {Path(name).suffix for name in sent} == {".csv", ".json", ".laz", ".sn"}


def test_what_takes_space_is_listed_and_a_recording_deleted_and_restored(
    server, page, capture, screenshot
):
    build_project(server.root / "office")
    page.goto(server.url)
    chooser(page).set_input_files(capture)
    expect(page.locator("upload-box")).to_contain_text("On the server")
    page.goto(f"{server.url}/storage")
    row = page.get_by_role("row").filter(has_text="Recording, uploaded")
    expect(row).to_contain_text("ranni-pochuzka")
    expect(page.locator("#disk")).to_contain_text("are free")
    screenshot(page, "storage")
    fits(page)

    row.get_by_role("button").click()
    expect(page.get_by_role("dialog")).to_contain_text("It can be restored for a week")
    page.get_by_role("button", name="Delete", exact=True).click()
    expect(page.get_by_role("row").filter(has_text="Deleted")).to_contain_text("until")
    page.get_by_role("button", name=re.compile("Restore ranni")).click()
    expect(row).to_be_visible()
    assert len(list((server.root / "recordings").iterdir())) == 1


@looks("desktop light")
def test_an_upload_can_be_removed_after_it_has_arrived(server, page, capture):
    page.goto(server.url)
    chooser(page).set_input_files(capture)
    expect(page.locator("recording-look")).to_contain_text("VLP-16")

    page.locator("upload-box").get_by_role("button", name="Remove").click()

    expect(page.get_by_label("Or a recording on the server")).to_have_value("")
    expect(page.locator("recording-look")).to_be_hidden()
    assert list((server.root / "recordings").iterdir()) == []
    assert server.get("/api/uploads").json() == []


@looks("desktop light", "phone dark")
@pytest.mark.study
def test_a_folder_of_several_recordings_offers_each_as_a_button(server, page, capture, tmp_path):
    walks = tmp_path / "walks"
    for name in ("monday", "tuesday"):
        (walks / name).mkdir(parents=True)
        shutil.copy(capture, walks / name / "walk.pcap")
    page.goto(server.url)

    chooser(page, folder=True).set_input_files(walks)
    expect(page.locator("recording-look")).to_contain_text("holds 2 recordings: monday, tuesday")
    page.get_by_role("button", name="Use tuesday").click()

    expect(page.locator("recording-look")).to_contain_text("VLP-16")
    assert page.get_by_label("Or a recording on the server").input_value().endswith("/tuesday")
    fits(page)


@looks("desktop light")
def test_a_dropped_file_is_uploaded(server, page):
    page.goto(server.url)
    transfer = page.evaluate_handle(
        """() => { const one = new DataTransfer();
        one.items.add(new File(["no recording"], "notes.txt")); return one; }"""
    )

    page.locator(".drop").dispatch_event("drop", {"dataTransfer": transfer})

    expect(page.locator("upload-box")).to_contain_text("notes.txt On the server")
    expect(page.locator("recording-look")).to_contain_text("no reader recognizes it")


@looks("desktop light")
def test_a_project_is_cloned_renamed_deleted_and_restored(server, page):
    leave_out_viewer(page)
    recording = recording_with_gate(server.root / "walk")
    job = server.start("office", recording)
    gate = open_gate(recording)
    server.wait_state(job, "succeeded")
    page.goto(f"{server.url}/projects/office/")

    page.get_by_text("Run again, with other settings").click()
    expect(page.locator("new-job input[name=recording]")).to_have_value(str(recording))
    page.get_by_label("Project name").fill("office-thin")
    page.get_by_role("button", name="Start").click()

    expect(page.get_by_role("heading", name="office-thin")).to_be_visible()
    expect(page.locator("#state")).to_contain_text("Finished")
    page.get_by_text("Rename or delete").click()
    page.get_by_label("Name", exact=True).fill(f"Kancelář {'ž' * 80}")
    page.get_by_role("button", name="Rename").click()
    expect(page.get_by_role("heading", name="Kancelář")).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    page.get_by_role("button", name="Delete…").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    expect(page.get_by_role("link", name="office")).to_be_visible()
    expect(page.get_by_role("link", name="Kancelář")).to_have_count(0)
    page.get_by_text("Recently deleted").click()
    page.get_by_role("button", name="Restore office-thin").click()

    expect(page.get_by_role("link", name="Kancelář")).to_be_visible()
    os.close(gate)
