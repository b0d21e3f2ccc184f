"""A capture on a phone, from its start to the map, with a replayed simulated walk."""

from __future__ import annotations

import contextlib
import json
import math
import os
import re
import threading
import time
from urllib.parse import urlsplit

import msgspec
import pytest
from playwright.sync_api import expect

from recon4.errors import Cancelled
from recon4.live.replay import datagrams_of, replay
from recon4.model.rig import load_rig
from recon4.pipeline import process
from recon4.progress import Silent
from recon4.recording.sources import Sources
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4_app.live.stream_state import Cursor, StreamState
from recon4_app.live.tuning import STREAM
from tests.e2e.conftest import EXPECTED_NOISE
from tests.live_messages import pose
from tests.scan_captures import capture_server
from tests.served import served
from tests.service.cuttable import cuttable
from tests.service.running import wait_for

pytestmark = pytest.mark.e2e
WITHOUT_LINK = "made without a link"
SCREENSHOTS = os.environ.get("RECON4_SCREENSHOTS") == "1"
SECONDS, LEAST_S = 40.0, 40.0 if SCREENSHOTS else 16.0
"""The walk lasts as long as the page needs to show all of a walk under way, within these [s]."""
LONG = os.environ.get("RECON4_LONG") == "1"
"""Whether to make the whole map twice, not only its frames; takes minutes."""
NEAR_M = 1.0
OFFLINE = ("WebSocket connection to", "ERR_")
"""Console messages of Chromium about a cut link."""

GAPS = """() => new Promise((resolve) => {
  const socket = new WebSocket(`ws://${location.host}/api/live/stream`);
  socket.onopen = () => socket.send("{}");
  socket.onmessage = ({ data }) => {
    const message = typeof data === "string" ? JSON.parse(data) : {};
    if (message.gaps?.gaps.length) (socket.close(), resolve(message.gaps.gaps));
  };
})"""
"""Returns the gaps of the next message to a phone."""


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    out = tmp_path_factory.mktemp("walk")
    simulate(prepare("office", seconds=SECONDS, seed=3), out, bag=False, progress=Silent())
    return out


server = served(run=capture_server, fresh=True, below="projects", ours=load_rig("4recon"))


@pytest.fixture
def link(server):
    with cuttable(urlsplit(server.url).port) as link:
        yield link


@pytest.fixture
def look():
    return "phone", "dark"


@pytest.fixture
def page(context):
    page = context.new_page()
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda message: message.type == "error" and errors.append(message.text))
    yield page
    noise = (*EXPECTED_NOISE, *OFFLINE)
    assert [text for text in errors if not any(one in text for one in noise)] == []


def points(page):
    return int(page.locator("#map").get_attribute("data-points") or 0)


def wait_for_points(page, least):
    deadline_s = time.monotonic() + 45.0
    while points(page) < least:
        assert time.monotonic() < deadline_s, f"only {points(page)} points"
        page.wait_for_timeout(100)


class Enough(Exception):
    """The walk lasted long enough."""


@contextlib.contextmanager
def sending(server, walk):
    target, enough = server.app.state.parts.settings.sensor_bind_address, threading.Event()
    began_ns = next(datagrams_of(walk)).t_ns

    def until_enough(datagram):
        if enough.is_set() and datagram.t_ns - began_ns > LEAST_S * 1e9:
            raise Enough
        return (datagram,)

    def send():
        with contextlib.suppress(Enough):
            replay(walk, progress=Silent(), target=target, alter=until_enough)

    thread = threading.Thread(target=send)
    thread.start()
    try:
        yield
    finally:
        enough.set()
        thread.join()


def begin(page, url):
    page.goto(f"{url}/live")
    page.get_by_role("button", name="Start…").click()
    page.locator("#begin").get_by_label("Name").fill("Walk")
    expect(page.get_by_label("Rig").locator("option:checked")).to_contain_text("ours.toml")
    page.locator("#begin").get_by_label("Name").press("Enter")
    expect(page.locator("#state")).to_have_text("Recording")
    expect(page.locator("#place")).to_have_text("Walk")


def stop(page):
    page.get_by_role("button", name="Stop").click()
    page.locator("#ending").get_by_role("button", name="Stop").click()
    expect(page.get_by_role("button", name="Make the map")).to_be_visible()


def fits(page, inside="main"):
    """Nothing exceeds the page, and all controls are large enough."""
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    wrong = page.evaluate(
        """(inside) => [...document.querySelectorAll(`${inside} :is(button, a)`)].filter((one) => {
          const box = one.getBoundingClientRect();
          const fits = box.left >= 0 && box.right <= innerWidth && box.bottom <= innerHeight;
          return one.checkVisibility() && (box.height < 44 || box.width < 44 || !fits);
        }).map((one) => one.outerHTML.slice(0, 80))""",
        inside,
    )
    assert wrong == []


@pytest.mark.study
def test_a_capture_from_its_start_to_the_map(server, link, walk, page, screenshot, tmp_path):
    begin(page, link.url)
    with sending(server, walk):
        sensors_are_shown(page)
        wait_for_points(page, 3000)
        early, gaps = points(page), page.evaluate(GAPS)
        expect(page.locator("#well")).to_have_text(re.compile(r"\d+ %"))
        well = page.locator("#well").inner_text()
        page.get_by_role("button", name="show the next").click()
        expect(page.locator("#hint")).to_have_text(re.compile(r"Not seen: .* m wide"))
        page.get_by_role("button", name="Follow").click()
        fits_both_ways(page)
        if SCREENSHOTS:
            wait_for_points(page, 40_000)
        screenshot(page, "live")
        axes_are_shown(page, screenshot)
        mark(page, "crack in the wall")
        cut_and_restore(page, link)
    wait_for_points(page, early + 1000)
    expect(page.locator("#well")).not_to_have_text(well)
    later = page.evaluate(GAPS)
    filled = [gap for gap in gaps if all(far(gap, other) for other in later)]
    assert filled, "no gap was filled"

    stop(page)
    expect(page.locator("#findings li")).to_have_count(0)
    expect(page.locator("#sensors li")).to_have_count(0)
    marks = (server.root / "walk" / "recordings" / "marks.jsonl").read_text().splitlines()
    texts = [json.loads(line).get("text") for line in marks]
    assert {"crack in the wall", WITHOUT_LINK} <= set(texts)

    page.get_by_role("button", name="Make the map").click()
    page.wait_for_url(f"{link.url}/projects/walk/")
    job = server.get("/api/projects/walk/jobs").json()[0]["job"]["id"]
    if LONG:
        server.wait(job, lambda view: view["job"]["state"] == "succeeded", max_s=600.0)
    else:
        server.wait_state(job, "running")
        server.post(f"/api/jobs/{job}/cancel")
        server.wait(job, lambda view: view["job"]["finished"])
    same_as_from_the_file(server.root / "walk", tmp_path / "again")


def fits_both_ways(page):
    """With everything shown; in landscape no bar covers the map."""
    for width, height in ((360, 640), (740, 360)):
        page.set_viewport_size({"width": width, "height": height})
        fits(page)
    right_of_bars = page.locator("#map").bounding_box()["x"]
    for bar in (".top", "#bottom"):
        box = page.locator(bar).bounding_box()
        assert box["x"] + box["width"] <= right_of_bars
    page.set_viewport_size({"width": 390, "height": 844})


def sensors_are_shown(page):
    """Rate, loss and clock of each LiDAR."""
    page.locator("#sensors").click()
    rows = page.locator("#lidars tr")
    for row, name in ((0, "horizontal"), (1, "vertical")):
        expect(rows.nth(row)).to_have_text(re.compile(rf"{name}\s*\d+/s\s*0\.\d %\s*in step"))
    page.get_by_role("button", name="Close").click()


def axes_are_shown(page, screenshot):
    """The calibration dance: what to do next, and what the walk has shown of each axis."""
    page.get_by_role("button", name="Help and more").click()
    page.get_by_role("button", name="Calibration dance…").click()
    expect(page.locator("#dance-next")).to_have_text(re.compile("Stand|Bend|Turn|Walk"))
    steps = page.locator("#dance-steps li")
    expect(steps).to_have_count(4)
    expect(steps.nth(1)).to_have_text(re.compile(r"\d+° and \d+° of 25°"))
    rotation = page.locator("#dance-axes tr").nth(0)
    expect(rotation).to_have_text(re.compile(r"rotation\s*((\d+ %|✓ observed)\s*){3}"))
    fits(page, "#dance")
    on_one_line(page.locator("#dance-axes td").nth(2), "✓ observed")
    screenshot(page, "live-dance")
    page.get_by_role("button", name="Close").click()


def on_one_line(cell, text):
    """Whether a cell with this text is no higher than with one character."""
    heights = cell.evaluate(
        """(cell, text) => ["1", text].map((shown) => {
          const copy = cell.parentElement.cloneNode(true);
          for (const one of copy.querySelectorAll("td")) one.textContent = shown;
          cell.closest("tbody").append(copy);
          const { height } = copy.getBoundingClientRect();
          copy.remove();
          return height;
        })""",
        text,
    )
    assert heights[1] == heights[0]


def mark(page, text):
    """Add a mark; Enter submits the form."""
    page.get_by_role("button", name="Mark").click()
    page.get_by_label("Note").fill(text)
    page.get_by_label("Note").press("Enter")
    expect(page.locator("#note")).to_be_hidden()


def cut_and_restore(page, link):
    """The page shows the lost link, reconnects by itself, and receives only what it lacks."""
    wait_for_points(page, 25_000)
    link.cut()
    expect(page.locator("#state")).to_have_text("No link")
    warning = re.compile("No link for 2 s.*recording continues")
    expect(page.locator("#findings li")).to_have_text(warning)
    mark(page, WITHOUT_LINK)
    expect(page.locator("#message")).to_contain_text("the mark is kept on this phone")
    before = points(page)
    at = link.received
    link.restore()
    expect(page.locator("#state")).to_have_text("Recording", timeout=5000)
    wait_for_points(page, before + 1)
    received, new = link.received - at, points(page) - before
    assert received < STREAM.bytes_a_point * (new + before // 2), "what was there was sent again"


def far(gap, other):
    return sum((a - b) ** 2 for a, b in zip(gap["p"], other["p"], strict=True)) > NEAR_M**2


class FirstStage(Silent):
    """Cancels the pipeline after its first stage, unless `LONG`."""

    def start(self, what, total, unit):
        if what == "odometry" and not LONG:
            raise Cancelled("the frames are there")


def same_as_from_the_file(live, again):
    """Processing the capture file again gives the same artifacts, byte by byte."""
    rig = load_rig(live / "recordings" / "rig.toml")
    sources = Sources((live / "recordings" / "walk.pcap",), rig)
    with contextlib.suppress(Cancelled):
        process(sources, again, progress=FirstStage())
    fresh = sorted(path.name for path in (again / "artifacts").iterdir())
    assert fresh and set(fresh) <= {path.name for path in (live / "artifacts").iterdir()}
    files = sorted([*again.glob("artifacts/*/**/*.npy"), *again.glob("artifacts/*/points.zst")])
    assert {"index.npy", "points.zst"} <= {path.name for path in files}
    for file in files:
        assert file.read_bytes() == (live / file.relative_to(again)).read_bytes(), file.name


PIXELS = """(name) => {
  const canvas = document.getElementById("overlay");
  const pen = document.createElement("canvas").getContext("2d");
  pen.fillStyle = getComputedStyle(document.body).getPropertyValue(`--${name}`).trim();
  pen.fillRect(0, 0, 1, 1);
  const wanted = pen.getImageData(0, 0, 1, 1).data;
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let at = 0; at < data.length; at += 4)
    count += [0, 1, 2].every((k) => Math.abs(data[at + k] - wanted[k]) < 8);
  return count;
}"""


def walked_with_problems():
    """What a phone lacks of a round walk that lost tracking and, later, hardly saw a direction."""
    stream = StreamState()
    for k in range(300):
        angle = 2 * math.pi * k / 330
        found = {"lost": 60 <= k < 90, "weak_sd_m": 0.5 if 160 <= k < 240 else 0.01}
        p, yaw = [8 * math.cos(angle), 8 * math.sin(angle), 0.0], angle + math.pi / 2
        stream.take(pose(frame_id=k, t_ns=k * 100_000_000, p=p, yaw=yaw, **found))
    return msgspec.json.encode(stream.lacking(Cursor())[0]).decode()


def test_the_stretches_of_findings_are_marked_on_the_map(server, page, screenshot):
    sockets = []

    def relay(socket):
        socket.connect_to_server()
        sockets.append(socket)

    page.route_web_socket("**/api/live/stream", relay)
    begin(page, server.url)
    assert [page.evaluate(PIXELS, name) for name in ("bad", "poor")] == [0, 0]
    sockets[-1].send(walked_with_problems())
    page.get_by_role("button", name="Follow").click()
    page.wait_for_function(f"({PIXELS})('bad') > 150 && ({PIXELS})('poor') > 500")
    screenshot(page, "live-findings")
    a_mark_is_kept_until_it_can_be_sent(page, server)
    stop(page)  # the recorder goes on without its server otherwise


def a_mark_is_kept_until_it_can_be_sent(page, server):
    """The first request for a mark fails as without a link."""
    page.route("**/api/live/marks", lambda route: route.abort(), times=1)
    with page.expect_response("**/api/live/marks"):  # the one that fails has none
        mark(page, WITHOUT_LINK)
    file = server.root / "walk" / "recordings" / "marks.jsonl"
    wait_for(lambda: file.exists() and WITHOUT_LINK in file.read_text(), "the mark is sent")
    expect(page.locator("#message")).to_be_empty()


def test_everything_fits_on_a_small_phone_both_ways(server, page):
    page.goto(f"{server.url}/live")
    expect(page.get_by_role("button", name="Start…")).to_be_visible()
    page.get_by_role("button", name="Help and more").click()

    for width, height in ((360, 640), (390, 844), (844, 390), (667, 375)):
        page.set_viewport_size({"width": width, "height": height})
        fits(page, inside="#more")
        page.keyboard.press("Escape")
        fits(page)
        page.keyboard.press("?")
        expect(page.get_by_role("dialog")).to_be_visible()


def test_keyboard_shortcuts(server, page):
    page.goto(f"{server.url}/live")
    expect(page.get_by_role("button", name="Start…")).to_be_visible()

    page.keyboard.press("t")
    expect(page.get_by_role("button", name="3-D")).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("ArrowLeft")
    expect(page.get_by_role("button", name="Follow")).to_have_attribute("aria-pressed", "false")
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_be_visible()
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_be_hidden()
