"""A capture of a 2-D laser on a phone: the map of a backpack with a profiler, and a corridor."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from playwright.sync_api import expect

from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.simulation.backpack import prepare_backpack, simulate_backpack
from tests.e2e.conftest import SCREENSHOTS, looks
from tests.e2e.test_live_page import fits, points, wait_for_points
from tests.planar_walks import blank_corridor, scanned, write_carmen
from tests.scan_captures import LASER, capture_server, sending
from tests.served import served

pytestmark = pytest.mark.e2e
SECONDS = 24.0 if SCREENSHOTS else 12.0


server = served(run=capture_server, fresh=True, below="projects", robot=LASER)


def begin(page, server, rig):
    page.goto(f"{server.url}/live")
    page.get_by_role("button", name="Start…").click()
    page.locator("#begin").get_by_label("Name").fill("Walk")
    page.get_by_label("Rig").select_option(rig)
    page.locator("#begin").get_by_label("Name").press("Enter")
    expect(page.locator("#state")).to_have_text("Recording")


@looks(*(("phone dark", "phone light") if SCREENSHOTS else ("phone dark",)))
@pytest.mark.study
def test_a_backpack_with_a_profiler_is_seen_on_the_phone(server, page, screenshot, tmp_path):
    rig = load_rig("wuerzburg")
    walk = tmp_path / "walk"
    prepared = prepare_backpack("hall", figure="circle", rig=rig, seconds=SECONDS, seed=3)
    simulate_backpack(prepared, walk, progress=Silent())
    begin(page, server, "wuerzburg")

    speed = 0.5 if SCREENSHOTS else 1.0  # a page that draws everything takes the processor
    with sending(server, walk / "rosbag2", rig=rig, speed=speed):
        wait_for_points(page, 1500)
        page.locator("#sensors").click()
        rows = page.locator("#lidars tr")
        expect(rows.nth(0)).to_have_text(re.compile(r"laser2d\s*\d+/s\s*–\s*in step"))
        expect(rows.nth(1)).to_have_text(re.compile(r"profiler\s*\d+/s\s*–\s*in step"))
        page.get_by_role("button", name="Close").click()
        expect(page.locator("#well")).to_have_text(re.compile(r"\d+ %"))
        expect(page.locator("#hint")).not_to_have_text(re.compile("Stand still"))
        page.get_by_role("button", name="Follow").click()
        fits(page)
        if SCREENSHOTS:
            wait_for_points(page, 35_000)
            screenshot(page, "live-wuerzburg")
    # All of the walk was sent: from here on the sensors are silent.
    expect(page.locator("#findings li.error", has_not_text="silent for")).to_have_count(0)

    page.get_by_role("button", name="Stop").click()
    page.locator("#ending").get_by_role("button", name="Stop").click()
    expect(page.get_by_role("button", name="Make the map")).to_be_visible()
    assert points(page) > 1500
    (project,) = server.get("/api/projects").json()
    stages = server.get(f"/api/projects/{project['id']}").json()["stages"]
    assert [stage["stage"] for stage in stages] == ["frames"]


@looks("phone dark")
def test_a_corridor_that_holds_nothing_is_said_in_words(server, page, screenshot, tmp_path):
    truth = np.stack([np.linspace(0.0, 12.0, 120), np.zeros(120), np.zeros(120)], axis=1)
    write_carmen(tmp_path / "corridor.log", scanned(blank_corridor(), truth, odometry=False).scans)
    begin(page, server, str(server.root / "rigs" / "robot.toml"))

    with sending(server, tmp_path / "corridor.log"):
        expect(page.locator("#sensors")).to_contain_text(re.compile(r"laser2d \d+/s"))
        expect(page.locator("#sensors")).not_to_contain_text("IMU")
        said = "Nothing holds the map along this corridor: look at a corner or an open door"
        expect(page.locator("#findings li", has_text=said)).to_be_visible()
        screenshot(page, "live-corridor")
    page.get_by_role("button", name="Help and more").click()
    expect(page.get_by_role("button", name="Calibration dance…")).to_be_hidden()
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Stop").click()
    page.locator("#ending").get_by_role("button", name="Stop").click()
    expect(page.get_by_role("button", name="Make the map")).to_be_visible()


HELD = """async () => {
  const { Camera } = await import("/web/live/camera.js");
  const camera = new Camera();
  const place = [3, -2, 0];
  const before = camera.project(place);
  camera.zoom(1.7, before);
  camera.rotate(0.8, before);
  const after = camera.project(place);
  return { off: Math.hypot(after[0] - before[0], after[1] - before[1]), px: camera.pxPerM };
}"""


@looks("phone dark")
def test_two_fingers_zoom_and_turn_about_what_they_touch_and_one_touch_turns_it_back(server, page):
    page.goto(f"{server.url}/live")
    expect(page.get_by_role("button", name="Start…")).to_be_visible()
    touch = page.context.new_cdp_session(page)

    held = page.evaluate(HELD)
    for kind, turn in (("Start", 0.0), ("Move", 0.3), ("Move", 0.8), ("End", None)):
        ends = [] if turn is None else [0.0, math.pi]
        fingers = [
            {"id": k, "x": 150 + 80 * math.cos(a + turn), "y": 350 + 80 * math.sin(a + turn)}
            for k, a in enumerate(ends)
        ]
        touch.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": fingers})

    assert held["off"] < 1e-6 and held["px"] > 40
    # A click: a busy machine holds a tap so long that Chromium takes it for a long press.
    page.get_by_role("button", name="Turn the map back").click()
    expect(page.get_by_role("button", name="Turn the map back")).to_be_hidden()
