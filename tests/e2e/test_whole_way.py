"""The complete workflow: from a recording on the user's computer to an approved map."""

import io
import json
import re
import shutil
from pathlib import Path

import laspy
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from recon4.progress import Silent
from recon4.review.journal import broken, read_rows
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.store.hashing import hash_file
from tests.e2e.conftest import browser_context
from tests.e2e.test_pages import drawn
from tests.served import served
from tests.service.running import wait_for

pytestmark = pytest.mark.e2e
SECONDS = 20.0
VOXEL_M = 0.03
"""Coarser than the preset: this map is drawn without a graphics card."""
WORK_MS = 240_000
JUDGED = re.compile("No problem found in this map|Check this map")
"""Limit for a map on a busy computer [ms]."""


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    """Files of a backpack on the operator's computer: capture, IMU, rig."""
    made = tmp_path_factory.mktemp("simulated") / "made"
    simulate(prepare("office", seconds=SECONDS, seed=3), made, progress=Silent(), bag=False)
    folder = tmp_path_factory.mktemp("backpack") / "Office walk"
    folder.mkdir()
    for name in ("recording.pcap", "imu.csv", "rig.toml"):
        shutil.move(made / name, folder / name)
    return folder


server = served(viewer_points=100_000)


@pytest.fixture
def look():
    return "desktop", "light"


@pytest.mark.study
def test_a_recording_becomes_an_approved_map(server, walk, page, screenshot, browser):
    page.goto(server.url)
    upload(page, walk)
    screenshot(page, "tour-upload")
    start(page)
    root = server.root / "office-walk"
    watch(page, screenshot)
    toggle_in_the_viewer(page)
    look_at_the_map(page, screenshot)
    page.get_by_role("link", name="Review", exact=True).click()
    decide(page, root, screenshot)
    make_a_new_map(page)
    cut(page, screenshot)
    page.get_by_role("link", name="Review", exact=True).click()
    approve(page)
    screenshot(page, "tour-approved")
    take_away(page, root)
    signed = hashes(root / "versions" / "1")
    page.get_by_role("link", name="Review", exact=True).click()
    decide_again(page)

    assert hashes(root / "versions" / "1") == signed
    on_a_phone(browser, server)


def upload(page, walk):
    """The form detects the contents of the folder and fills in the rest."""
    page.locator("upload-box input[type=file]").nth(1).set_input_files(walk)
    expect(page.locator("upload-box")).to_contain_text("On the server")
    expect(page.locator("recording-look")).to_contain_text("VLP-16")
    expect(page.locator("recording-look")).to_contain_text("imu.csv, next to it")
    expect(page.locator("recording-look")).not_to_contain_text("No rig given")
    expect(page.get_by_label("Project name")).to_have_value("Office walk")
    expect(page.get_by_label("Preset")).to_have_value("indoor")
    expect(page.get_by_label("Rig").locator("option:checked")).to_have_text("rig.toml")


def start(page):
    page.get_by_text("All settings").click()
    page.get_by_label("Find a setting").fill("voxel")
    group = page.locator("setting-editor .group").filter(has_text="The point map")
    group.get_by_label("voxel_m").fill(str(VOXEL_M))
    page.get_by_role("button", name="Start").click()
    expect(page.get_by_role("heading", name="Office walk")).to_be_visible()


def watch(page, screenshot):
    """Stages come one after the other, and the trajectory while the job still runs."""
    row = page.get_by_role("row")
    expect(row.filter(has_text="frames")).to_contain_text("Done", timeout=WORK_MS)
    expect(page.frame_locator("iframe").get_by_text("map frame")).to_be_visible()
    expect(row.filter(has_text="odometry")).to_contain_text("Done", timeout=WORK_MS)
    expect(page.locator("job-status")).to_contain_text("% of the run")
    drawn(page)
    wait_for(lambda: lines_seen(page) > 50, "the trajectory is not drawn while the job runs")
    screenshot(page, "tour-running")
    page.evaluate("window.unwatched = true")
    expect(page.locator("#state")).to_have_text(JUDGED, timeout=WORK_MS)
    page.evaluate("window.unwatched = false")
    expect(row.filter(has_text="map")).to_contain_text("Done")


def lines_seen(page):
    """Pixels of the viewer in the color of the trajectory."""
    image = Image.open(io.BytesIO(page.locator("#viewer").screenshot())).convert("RGB")
    red, green, blue = np.moveaxis(np.asarray(image)[:, :700].astype(int), 2, 0)
    return int(((red > 180) & (green > 110) & (blue < 90)).sum())


def toggle_in_the_viewer(page):
    viewer = page.frame_locator("iframe")
    expect(viewer.get_by_text("Points by normalized intensity")).to_be_visible()
    viewer.locator("body").press("n")
    expect(viewer.get_by_text("Points by raw intensity")).to_be_visible()
    viewer.locator("body").press("n")
    expect(viewer.get_by_text("Points by normalized intensity")).to_be_visible()


def select_next(page):
    """Select the next pair and wait for its points."""
    page.keyboard.press("j")
    expect(page.locator(".view-empty")).to_be_empty()
    expect(page.locator("#pair dl")).to_be_visible()
    expect(page.locator("#decision").get_by_role("button", name="Reject")).to_be_enabled()


def decide(page, root, screenshot):
    """By keys alone: a wrong acceptance is reported and undone, an accepted loop is rejected."""
    expect(page.locator("review-queue li").first).to_be_visible()
    expect(page.get_by_label("Go on to the next pair after a decision")).not_to_be_checked()
    page.get_by_label("Which pairs").select_option("doubt")
    page.evaluate("document.activeElement.blur()")
    select_next(page)
    decided(page, "a", 1)
    expect(page.locator("#effect")).to_contain_text("Accepted, but does not fit")
    screenshot(page, "tour-review")
    decided(page, "Control+z", 0)
    expect(page.locator("#effect")).not_to_contain_text("does not fit")
    page.get_by_label("Which pairs").select_option("kept")
    page.evaluate("document.activeElement.blur()")
    select_next(page)
    decided(page, "r", 1)

    chi2 = page.locator("#effect div").filter(has_text="Chi-square, all decisions").locator("dd")
    expect(chi2).to_contain_text("→")
    before, after = (float(x) for x in chi2.inner_text().split("→"))
    assert after < before
    expect(page.locator("#signing")).to_contain_text("decisions are not in the map")
    expect(page.get_by_role("button", name="Approve map…")).to_be_disabled()
    rows = read_rows(root)
    assert [row.kind for row in rows] == ["accept", "undo", "reject"]
    assert broken(rows) == []


def look_at_the_map(page, screenshot):
    page.get_by_role("link", name="Map", exact=True).click()
    shown = page.locator("#status .shown")
    expect(shown).to_have_text(re.compile("points$"), timeout=WORK_MS)  # at rest
    screenshot(page, "tour-map")


def decided(page, key, count):
    page.keyboard.press(key)
    expect(page.locator("review-queue")).to_contain_text(f"{count} decided by people")
    expect(page.locator("#effect")).not_to_contain_text("solving", ignore_case=True)


def make_a_new_map(page):
    """The decisions are a stage of the next run; stages that do not depend on them are reused."""
    page.get_by_role("button", name="Rebuild map").click()
    expect(page.locator("#signing")).to_contain_text("A job waits or runs")
    page.get_by_role("link", name="Project", exact=True).click()
    row = page.get_by_role("row")
    expect(row.filter(has_text="graph")).to_contain_text("Reused")
    page.evaluate("window.unwatched = true")
    expect(row.filter(has_text="review")).to_contain_text("Done", timeout=WORK_MS)
    expect(page.locator("#state")).to_have_text(JUDGED, timeout=WORK_MS)


def cut(page, screenshot):
    """Slices: a step, raw and normalized intensity, no double wall."""
    page.get_by_role("link", name="Slices", exact=True).click()
    facing = page.locator(".facing")
    expect(facing).to_contain_text("points")
    at = facing.locator("strong").inner_text()
    page.keyboard.press("]")
    expect(facing.locator("strong")).not_to_have_text(at)
    colors = page.get_by_label("Color by")
    colors.select_option("intensity")
    expect(page.locator("#legend")).to_contain_text("Intensity")
    colors.select_option("normalized")
    expect(page.locator("#legend")).to_contain_text("ormalized")
    expect(page.locator("body.drawing")).to_have_count(0)
    expect(facing).to_contain_text("Draft: not approved")
    screenshot(page, "tour-slice")
    page.locator("summary").get_by_text("Double walls").click()
    page.get_by_role("button", name="Find double walls").click()
    expect(page.locator(".verdict")).to_contain_text("No double wall found")
    expect(page.get_by_role("row").filter(has_text="✓ single").first).to_be_visible()


def approve(page):
    expect(page.locator("#signing")).to_contain_text("was made with these decisions")
    page.get_by_role("button", name="Approve map…").click()
    page.get_by_label("Remark").fill("walked through it, all walls single")
    page.get_by_role("button", name="Sign").click()
    expect(page.locator("#signing")).to_contain_text("✓ Approved v1 · local · ")
    page.get_by_text("Journal", exact=True).click()
    expect(page.locator("#journal")).to_contain_text("approved the map")


def take_away(page, root):
    """The map as LAZ and the report contain the approval."""
    page.get_by_role("link", name="Project", exact=True).click()
    expect(page.locator("#approval")).to_contain_text("✓ Approved v1 · local · ")
    with page.expect_download() as download:
        page.locator("#files").get_by_role("link", name=re.compile("LAZ")).click()
    with page.expect_popup() as report:
        page.get_by_role("link", name="Quality report").click()
    hash = json.loads((root / "versions" / "1" / "approval.json").read_text())["hash"]
    expect(report.value.get_by_text("Version 1, approved by local")).to_be_visible()
    expect(report.value.get_by_text(hash)).to_be_visible()
    report.value.close()
    assert hash in approval_in(download.value.path())


def approval_in(laz: Path) -> str:
    """The record of the approval in a LAZ file."""
    with laspy.open(laz) as file:
        assert file.header.point_count > 100_000
        found = [*file.header.vlrs, *(file.evlrs or [])]
        records = [one.record_data_bytes() for one in found if one.user_id == "recon4"]
    assert len(records) == 1
    return records[0].decode()


def decide_again(page):
    """After another decision the map is a draft again."""
    expect(page.locator("#signing")).to_contain_text("✓ Approved")
    select_next(page)
    page.keyboard.press("r")
    expect(page.locator("#signing")).to_contain_text(
        "changed since: later decisions are not in this map"
    )
    expect(page.get_by_role("button", name="Approve map…")).to_be_disabled()


def hashes(folder):
    return {path.name: hash_file(path) for path in folder.iterdir()}


PAGES = {
    "": ".card img",
    "projects/office-walk/": "#figures dl",
    "projects/office-walk/review/": "review-queue li",
    "projects/office-walk/slices/": ".facing strong",
}
"""An element that every page of a project shows once it is loaded."""


def on_a_phone(browser, server):
    """Every page fits, can be touched, and reports no error."""
    complaints: list[str] = []
    with browser_context(browser, ("phone", "dark")) as context:
        page = context.new_page()
        page.on("pageerror", lambda error: complaints.append(str(error)))
        for path, shows in PAGES.items():
            page.goto(f"{server.url}/{path}")
            expect(page.locator(shows).first).to_be_visible()
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), path
            assert low(page) == [], path
    assert complaints == []


def low(page):
    """Controls that are too low to touch."""
    return page.evaluate(
        """[...document.querySelectorAll('button:not(.link), select, summary, .bar a')]
        .filter((one) => one.checkVisibility() && one.getBoundingClientRect().height < 40)
        .map((one) => one.outerHTML.slice(0, 80))"""
    )
