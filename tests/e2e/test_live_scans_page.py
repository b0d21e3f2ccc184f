"""A capture of a 2-D laser on a phone: the map of a backpack with a profiler, and a corridor."""

from __future__ import annotations

import re
import threading
from contextlib import contextmanager

import numpy as np
import pytest
from playwright.sync_api import expect

from recon4.live.replay import replay
from recon4.model.rig import format_rig, load_rig, parse_rig
from recon4.progress import Silent
from recon4.simulation.backpack import prepare_backpack, simulate_backpack
from tests.e2e.conftest import EXPECTED_NOISE, SCREENSHOTS
from tests.e2e.test_live_page import fits, points, wait_for_points
from tests.loopback import an_address
from tests.planar_walks import blank_corridor, scanned, write_carmen
from tests.service.running import server_thread

pytestmark = pytest.mark.e2e
SECONDS = 24.0 if SCREENSHOTS else 12.0
LASER = parse_rig('name = "robot"\n[[sensor]]\nname = "laser2d"\nkind = "laser2d"', where="test")


@pytest.fixture
def server(tmp_path):
    root = tmp_path / "projects"
    (root / "rigs").mkdir(parents=True)
    (root / "rigs" / "robot.toml").write_text(format_rig(LASER))
    with server_thread(root, live_address=an_address()) as running:
        yield running


@pytest.fixture
def look(request):
    return getattr(request, "param", ("phone", "dark"))


@pytest.fixture
def page(context):
    page = context.new_page()
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda message: message.type == "error" and errors.append(message.text))
    yield page
    assert [text for text in errors if not any(one in text for one in EXPECTED_NOISE)] == []


@contextmanager
def sending(server, recording, **how):
    target = server.app.state.parts.settings.live_address
    how = {"progress": Silent(), "target": target, **how}
    thread = threading.Thread(target=replay, args=(recording,), kwargs=how)
    thread.start()
    yield
    thread.join()


def begin(page, server, rig):
    page.goto(f"{server.url}/live")
    page.get_by_role("button", name="Start…").click()
    page.get_by_label("Place", exact=True).fill("Hall")
    page.get_by_label("Project name").fill("walk")
    page.get_by_label("Rig").select_option(rig)
    page.get_by_label("Project name").press("Enter")
    expect(page.locator("#state")).to_have_text("Recording")


@pytest.mark.parametrize("look", [("phone", "dark"), ("phone", "light")], indirect=True, ids=str)
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
        expect(rows.nth(0)).to_have_text(re.compile(r"laser2d\d+/s–in step"))
        expect(rows.nth(1)).to_have_text(re.compile(r"profiler\d+/s–in step"))
        page.get_by_role("button", name="Close").click()
        expect(page.locator("#well")).to_have_text(re.compile(r"\d+ %"))
        expect(page.locator("#hint")).not_to_have_text(re.compile("Stand still"))
        page.get_by_role("button", name="Follow").click()
        fits(page)
        if SCREENSHOTS:
            wait_for_points(page, 35_000)
            screenshot(page, "live-wuerzburg")
    expect(page.locator("#findings li.error")).to_have_count(0)

    page.get_by_role("button", name="Stop").click()
    page.locator("#ending").get_by_role("button", name="Stop").click()
    expect(page.get_by_role("button", name="Make the map")).to_be_visible()
    assert points(page) > 1500
    (project,) = server.get("/api/projects").json()
    stages = server.get(f"/api/projects/{project['id']}").json()["stages"]
    assert [stage["stage"] for stage in stages] == ["frames"]


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
