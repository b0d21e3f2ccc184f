"""The rig page, and the rig of a project, in a real browser."""

import re
import shutil

import pytest
from playwright.sync_api import expect

from recon4.model.rig import load_rig
from recon4.recording.packets.ouster.encode import metadata_json
from recon4.review.trusted_keys import STATE
from tests.e2e.conftest import (
    first_of,
    leave_out_viewer,
    looks,
    on_both_screens,
    one_look,
    open_menu,
)
from tests.e2e.test_pages import fits
from tests.ouster_models import nominal_metadata
from tests.rig_projects import TOML, calibrated_project, tilted
from tests.served import served
from tests.service.running import SLOW, recording_with_gate, wait_for

pytestmark = pytest.mark.e2e


running = served(worker_module=SLOW)


@pytest.fixture
def server(running):
    """The server that all tests share, with nothing but a new rig ``field``."""
    for folder in running.root.iterdir():
        if folder.name != STATE:
            shutil.rmtree(folder)
    answer = running.post("/api/rigs", json={"id": "field", "copy_of": "4recon"})
    assert answer.status_code == 201
    return running


def field_of(server):
    return load_rig(server.root / "rigs/field/1/field-v1.toml")


def camera(page):
    """Yaw, pitch and pixels per meter of the drawing."""
    canvas = page.locator("rig-view canvas")
    expect(canvas).to_have_attribute("data-view", re.compile(r"\d"))
    return [float(part) for part in canvas.get_attribute("data-view").split()]


def turned_from(page, before):
    """Waits until the camera of the drawing is another one."""
    expect(page.locator("rig-view canvas")).not_to_have_attribute(
        "data-view", " ".join(f"{value:.3f}" for value in before)
    )
    return camera(page)


def colors_of(page):
    """How many colors the drawing has."""
    return page.evaluate(
        """() => {
            const canvas = document.querySelector("rig-view canvas");
            const { data } = canvas.getContext("2d")
                .getImageData(0, 0, canvas.width, canvas.height);
            return new Set(new Uint32Array(data.buffer)).size;
        }"""
    )


def drawn(canvas):
    """How many rows of pixels of a drawing have points."""
    expect(canvas).to_be_visible()
    return canvas.evaluate(
        """(canvas) => {
            const { width, height } = canvas;
            const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
            let rows = 0;
            for (let y = 0; y < height; y++)
                rows += data.subarray(4 * y * width, 4 * (y + 1) * width).some(Boolean);
            return { rows };
        }"""
    )


def test_a_rig_is_seen_as_drawing_and_numbers(server, page, look, screenshot):
    calibrated_project(server.root / "walk", rig=field_of(server), found=None)
    page.goto(server.url)
    open_menu(page)
    page.get_by_role("link", name="Rigs").click()
    page.get_by_role("link", name="field").click()

    vertical = page.get_by_role("row").filter(has_text="vertical")
    expect(vertical).to_contain_text("VLP-16")
    expect(vertical.get_by_role("cell")).to_have_text(
        ["VLP-16", "−12", "0", "0", "0", "90", "0", "0", "2369", "any"]
    )
    expect(page.get_by_role("link", name="walk")).to_be_visible()
    expect(page.get_by_role("img", name="vertical, VLP-16, at -12, 0, 0 cm")).to_be_visible()
    expect(page.get_by_text("at 90° only their difference counts")).to_be_visible()
    before = camera(page)
    assert colors_of(page) > 50
    fits(page)
    screenshot(page, "rig")

    canvas = page.locator("rig-view canvas")
    canvas.focus()
    page.keyboard.press("ArrowRight")
    yaw, _, scale = turned_from(page, before)
    assert yaw != before[0] and scale == before[2]
    page.keyboard.press("+")
    assert turned_from(page, [yaw, *before[1:]])[2] > scale
    page.keyboard.press("0")
    expect(canvas).to_have_attribute("data-view", " ".join(f"{one:.3f}" for one in before))


@looks("desktop light")
def test_a_pointer_turns_the_drawing(server, page):
    page.goto(f"{server.url}/rigs/4recon/")
    before = camera(page)
    box = page.locator("rig-view canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 50, y + 20)
    page.mouse.up()

    yaw, pitch, _ = turned_from(page, before)
    assert yaw == pytest.approx(before[0] - 50 * 0.008, abs=2e-3)
    assert pitch == pytest.approx(before[1] + 20 * 0.008, abs=2e-3)


@one_look
def test_a_rig_is_edited_into_a_new_version(server, page, look, screenshot):
    page.goto(f"{server.url}/rigs/field/")

    page.get_by_role("button", name="Edit").click()
    group = page.get_by_role("group", name="vertical", exact=True)
    pitch = group.get_by_role("group", name="Rotation").get_by_label("pitch")
    pitch.fill("400")
    expect(group.get_by_text("expected angles within ±360°")).to_be_visible()
    expect(pitch).to_have_attribute("aria-invalid", "true")
    expect(page.get_by_role("button", name="Save as a new version")).to_be_disabled()
    group.get_by_label("UDP port").fill("2368")
    expect(page.get_by_text("all send to port 2368")).to_be_visible()
    on_both_screens(page, fits)
    screenshot(page, "rig-edit")
    pitch.fill("88.6")
    group.get_by_label("UDP port").fill("2370")
    page.get_by_label("Note").fill("after the repair")
    page.get_by_role("button", name="Save as a new version").click()

    expect(page.get_by_text("Version 2 of 2, local")).to_be_visible()
    expect(page.locator("#changes li")).to_have_text(
        ["vertical: rotation about y −1.400°", "vertical: port 2369 → 2370"]
    )
    expect(page.get_by_text("after the repair")).to_be_visible()
    page.get_by_role("button", name="Show").click()
    expect(page.get_by_text("Version 1 of 2, local")).to_be_visible()
    expect(page.get_by_role("row").filter(has_text="vertical")).to_contain_text("2369")


@looks("desktop light")
def test_a_rig_is_duplicated_exported_and_imported(server, page, tmp_path):
    page.goto(f"{server.url}/rigs/4recon/")
    expect(page.get_by_text("Duplicate it to change it")).to_be_visible()
    page.get_by_role("button", name="Duplicate…").click()
    page.get_by_label("Name of the new rig").fill("field")
    page.get_by_role("button", name="Duplicate", exact=True).click()
    expect(
        page.get_by_role("alert").filter(has_text="there is a rig field already")
    ).to_be_visible()
    page.get_by_label("Name of the new rig").fill("second")
    page.get_by_role("button", name="Duplicate", exact=True).click()
    expect(page).to_have_url(f"{server.url}/rigs/second/")
    with page.expect_download() as download:
        page.get_by_role("link", name="Export TOML").click()
    assert download.value.suggested_filename == "second-v1.toml"

    (tmp_path / "hand made.toml").write_text(TOML)
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Import…").click()
    chooser.value.set_files(tmp_path / "hand made.toml")
    expect(page.get_by_label("Name of the new rig")).to_have_value("hand-made")
    page.get_by_role("button", name="Import", exact=True).click()

    expect(page).to_have_url(f"{server.url}/rigs/hand-made/")
    expect(page.get_by_role("heading", name="hand-made: field backpack")).to_be_visible()
    assert server.get("/api/rigs/hand-made/versions/1/file").text == TOML


@looks("desktop light")
def test_files_selected_with_a_rig_file_describe_its_lidars(server, page, tmp_path):
    (tmp_path / "ouster.toml").write_text(TOML.replace("VLP-16", "OS0-32", 1))
    metadata = metadata_json(nominal_metadata("OS0-32", profile="LEGACY"))
    (tmp_path / "sensor.json").write_bytes(metadata)
    page.goto(f"{server.url}/rigs")
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Import…").click()
    chooser.value.set_files([tmp_path / "sensor.json", tmp_path / "ouster.toml"])
    expect(page.get_by_text("Describes its LiDARs: sensor.json")).to_be_visible()
    page.get_by_role("button", name="Import", exact=True).click()

    expect(page).to_have_url(f"{server.url}/rigs/ouster/")
    stored = server.get("/api/rigs/ouster").json()["content"]["sensors"][0]
    assert stored["description"] == metadata.decode()


@looks("desktop light")
def test_a_file_that_is_no_rig_is_refused_with_its_mistake(server, page, tmp_path):
    (tmp_path / "broken.toml").write_text(TOML.replace("VLP-16", "VLP-17"))
    page.goto(f"{server.url}/rigs")
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Import…").click()
    chooser.value.set_files(tmp_path / "broken.toml")
    page.get_by_role("button", name="Import", exact=True).click()

    expect(page.get_by_role("alert").filter(has_text="model must be one of")).to_be_visible()


def test_a_project_shows_what_its_recording_says_of_the_rig(server, page, look, screenshot):
    calibrated_project(server.root / "walk", rig=field_of(server), found=None)
    leave_out_viewer(page)
    page.goto(f"{server.url}/projects/walk/")

    section = page.locator("rig-section")
    expect(section.get_by_text("The rig file differs from the recording")).to_be_visible()
    row = section.get_by_role("row").filter(has_text="rotation y")
    expect(row).to_contain_text("+1.358 ± 0.020°")
    expect(row).to_contain_text("✕ differs")
    expect(section.get_by_role("row").filter(has_text="IMU")).to_contain_text("not observable")
    expect(section.get_by_role("link", name="field, version 1")).to_be_visible()
    fits(page)
    screenshot(page, "project-rig")


@looks("desktop light")
def test_a_project_is_mapped_again_with_calibration(server, page):
    recording = recording_with_gate(server.root / "recording")
    calibrated_project(server.root / "again", rig=field_of(server), found=None)
    body = {"project": "again", "recordings": [str(recording)], "settings": ["map.voxel_m=0.02"]}
    job = server.post("/api/jobs", json=body).json()["job"]["id"]
    server.post(f"/api/jobs/{job}/cancel")
    server.wait_state(job, "cancelled")
    leave_out_viewer(page)
    page.goto(f"{server.url}/projects/again/")

    page.get_by_role("button", name="Calibrate and map again").click()
    jobs = wait_for(
        lambda: len(jobs := server.get("/api/projects/again/jobs").json()) == 2 and jobs, "no job"
    )

    newest = jobs[0]["job"]["inputs"]
    assert newest["recordings"] == [str(recording)]
    assert newest["settings"] == ["map.voxel_m=0.02", "calibration.mode=auto"]
    server.post(f"/api/jobs/{jobs[0]['job']['id']}/cancel")
    server.wait_state(jobs[0]["job"]["id"], "cancelled")


@first_of("desktop dark", "phone light")
def test_a_calibrated_rig_is_saved_as_a_version(server, page, look, screenshot):
    rig = field_of(server)
    calibrated_project(server.root / "walk", rig=rig, found=tilted(rig))
    leave_out_viewer(page)
    page.goto(f"{server.url}/projects/walk/")
    section = page.locator("rig-section")
    expect(section.get_by_text("Calibrated rig used for this map")).to_be_visible()
    expect(section.get_by_role("row").filter(has_text="common planes")).to_contain_text("18.3 mm")
    beams = section.get_by_text("Corrections of 2 single beams")
    beams.click()
    expect(
        section.get_by_role("row").filter(has_text="vertical 0").last.get_by_role("cell")
    ).to_have_text(["+3.50 ± 0.20 mm", "not observable", "+0.0286 ± 0.0029°"])
    beams.click()
    before, after = (
        drawn(section.get_by_role("img", name=f"Slice 20 cm thick, {name}"))
        for name in ("rig file", "calibrated")
    )
    assert before["rows"] > after["rows"] > 0
    on_both_screens(page, fits)
    screenshot(page, "project-calibrated")

    section.get_by_role("button", name="Save as a new rig version").click()
    expect(page.get_by_label("Save as")).to_have_value("field")
    page.get_by_label("Note").last.fill("new bracket")
    page.get_by_role("button", name="Save", exact=True).click()

    section.get_by_role("link", name="field, version 2").click()
    expect(page.locator("#changes li")).to_have_text(["vertical: rotation about y +1.360°"])
    page.get_by_text("Evidence of the calibration").click()
    expect(page.get_by_text("vertical rotation y: +1.358° ± 0.020°")).to_be_visible()
