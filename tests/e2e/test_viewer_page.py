"""The viewer in a real browser: keys, clicks, taps, a viewer process that is killed."""

import os
import re
import signal

import numpy as np
import pytest
from msgspec import structs
from playwright.sync_api import expect

from recon4.model.pose_graph import Reason
from recon4_app.viewer import pool
from recon4_app.viewer.client.show import start_m
from recon4_app.viewer.cloud.parts import Cloud
from recon4_app.viewer.scene.build import Content, bounds
from tests.e2e.conftest import SCREENSHOTS, looks
from tests.processes import viewer_process
from tests.project_builder import add_multiframes, build_project, loop_walk, verified_graph
from tests.service.running import server_thread

pytestmark = pytest.mark.e2e

POINTS = 60_000
FOV_RAD = np.deg2rad(75.0)


SMALL_WINDOW = {"width": 900, "height": 600}
"""Without a graphics card each pixel takes processor time."""
CAMERA = "window.__viserMutable.camera.position.toArray()"
AT_REST = f"""(first) => new Promise((resolve) => {{
  let last = first, frames = 0;
  const look = () => {{
    const now = {CAMERA};
    frames = now.every((value, k) => value === last[k]) ? frames + 1 : 0;
    last = now;
    const left = now.some((value, k) => Math.abs(value - first[k]) > 0.01);
    if (left && frames >= 10) resolve(now);
    else requestAnimationFrame(look);
  }};
  look();
}})"""
"""Position of the camera once it has left the first one and stood still for ten frames [m]."""


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=POINTS)
    add_multiframes(root / "office")
    with server_thread(root) as running:
        yield running


@pytest.fixture
def window(page, look):
    """A page whose window is small, on a desktop."""
    if look[0] == "desktop" and not SCREENSHOTS:
        page.set_viewport_size(SMALL_WINDOW)
    return page


@pytest.fixture
def viewer(finished, window, caplog):
    """The viewer alone on the page, with all of the map drawn; the relay passes all it sends."""
    page = window
    page.goto(f"{finished.url}/projects/office/viewer/")
    page.wait_for_function("window.__viserMutable?.canvas")
    expect(page.get_by_text("60 000 of 60 000 points")).to_be_attached()
    page.locator(".mantine-Notification-closeButton").click()  # there is no graphics card
    yield page
    assert "dropped a message" not in caplog.text
    assert "ignored a value" not in (finished.root / ".recon4/viewers/office.txt").read_text()


def at_first(root, aspect):
    """Position and target of a new viewer's camera [m]."""
    artifact = next((root / "office").glob("artifacts/*/tiles.json")).parent
    box = bounds(Content(cloud=Cloud(artifact), trajectory=loop_walk()))
    return start_m(box, aspect=aspect), box.center_m


def on_screen(page, root, p_map):
    """Pixel of a point of the map with the first camera."""
    box = page.evaluate("window.__viserMutable.canvas.getBoundingClientRect().toJSON()")
    eye, target = at_first(root, box["width"] / box["height"])
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    to_point = np.asarray(p_map) - eye
    x, y = to_point @ right, to_point @ np.cross(ahead, right)
    scale = box["height"] / 2.0 / np.tan(FOV_RAD / 2.0) / (to_point @ ahead)
    return box["x"] + box["width"] / 2.0 + scale * x, box["y"] + box["height"] / 2.0 + scale * y


def touch(page, look, at):
    """A click, or on a phone a tap."""
    if look[0] == "phone":
        page.touchscreen.tap(*at)
    else:
        page.mouse.click(*at)


def test_a_click_or_tap_on_a_rejected_edge_shows_the_reason_and_links_its_review(
    finished, viewer, look, screenshot
):
    graph = verified_graph(loop_walk())
    edge = next(e for e in graph.edges if e.reason is Reason.VERIFICATION)
    middle = graph.T_map_body.t[[edge.i, edge.j]].mean(axis=0)

    touch(viewer, look, on_screen(viewer, finished.root, middle))

    link = viewer.get_by_role("link", name="Open in review", include_hidden=True)
    expect(link).to_have_attribute("href", f"../../office/review/?edge={edge.i}-{edge.j}")
    expect(viewer.get_by_text("verification median > limit", exact=True)).to_be_attached()
    screenshot(viewer, "viewer-edge")


@looks("desktop dark")
def test_keys_toggle_the_intensity_and_measure_the_room(finished, viewer, screenshot):
    viewer.keyboard.press("n")
    expect(viewer.get_by_text("Points by raw intensity")).to_be_visible()

    viewer.keyboard.press("m")
    expect(viewer.get_by_role("button", name="Stop measuring")).to_be_attached()
    for corner in ((2.0, 7.5, 0.0), (14.0, 7.5, 0.0)):
        viewer.mouse.click(*on_screen(viewer, finished.root, corner))
        expect(viewer.get_by_text("x y z, m").first).to_be_attached()
        viewer.wait_for_timeout(500)
    expect(viewer.get_by_text("Horizontal", exact=True)).to_be_attached()
    row = viewer.locator("tr").filter(has_text="Distance").last.inner_text()

    assert abs(float(row.split()[1]) - 12.0) < 0.5
    screenshot(viewer, "viewer-measure")


@looks("desktop light")
def test_escape_ends_measuring_a_list_names_keys_and_the_scrubber_shows_multiframes(
    viewer, screenshot
):
    viewer.keyboard.press("m")
    expect(viewer.get_by_text("Stop measuring (M)")).to_be_attached()
    viewer.keyboard.press("Escape")
    expect(viewer.get_by_text("Measure a distance (M)")).to_be_attached()

    keys = viewer.get_by_role("dialog", name="Keys")
    viewer.keyboard.press("?")
    expect(keys).to_contain_text("View from above")
    viewer.keyboard.press("Escape")
    expect(keys).to_be_hidden()
    viewer.get_by_role("button", name="Keys").click()
    expect(keys).to_be_visible()
    viewer.keyboard.press("Escape")
    expect(keys).to_be_hidden()

    viewer.get_by_role("combobox", name="Show").click()
    viewer.get_by_role("option", name="map and multiframe").click()
    expect(viewer.get_by_text("Multiframe 0 of 599, at 0.0 s")).to_be_visible()
    viewer.evaluate("document.activeElement.blur()")  # keys are for the map again
    viewer.keyboard.press("p")
    expect(viewer.get_by_text(re.compile(r"Multiframe [1-9]\d* of 599, at"))).to_be_visible()
    viewer.keyboard.press("p")

    screenshot(viewer, "viewer-multiframe")


@looks("desktop dark")
def test_a_viewer_that_is_killed_comes_back_with_camera_and_colors(finished, viewer):
    viewer.keyboard.press("n")
    expect(viewer.get_by_text("Points by raw intensity")).to_be_visible()
    first = viewer.evaluate(CAMERA)
    viewer.keyboard.press("7")
    before = viewer.evaluate(AT_REST, first)

    process = viewer_process(finished.root)
    legend = viewer.get_by_text("Points by raw intensity")
    legend.evaluate(
        "(old) => old.setAttribute('data-old', '')"
    )  # a quick return would look as none
    os.kill(process.pid, signal.SIGKILL)

    expect(viewer.locator("[data-old]")).to_have_count(0)
    expect(legend).to_be_visible()
    np.testing.assert_allclose(viewer.evaluate(CAMERA), before, atol=1e-3)


@looks("desktop light")
def test_a_key_shows_fitted_surfaces_then_points_as_measured_then_stray_returns(
    tmp_path, window, screenshot
):
    page = window
    build_project(tmp_path / "office", points=20_000, strays=5)
    with server_thread(tmp_path) as running:
        strays = running.get("/api/projects/office/slices").json()["strays"]
        page.goto(f"{running.url}/projects/office/viewer/")
        page.wait_for_function("window.__viserMutable?.canvas")
        expect(page.get_by_text("20 000 of 20 000 points")).to_be_attached()
        lie = page.get_by_role("combobox", name="Points lie (R)")

        for caption, choice in (
            (f"On fitted surfaces, {strays} points left out", "on fitted surfaces"),
            (f"As measured, {strays} points left out", "as measured"),
            (f"Only the {strays} points left out", "left out of the map"),
        ):
            expect(page.get_by_text(caption, exact=True)).to_be_attached()
            expect(lie).to_have_value(choice)
            screenshot(page, f"viewer-{choice.replace(' ', '-')}")
            page.keyboard.press("r")

        expect(page.get_by_text(re.compile("On fitted surfaces"))).to_be_attached()


@looks("desktop light")
def test_a_viewer_that_does_not_start_says_so_over_the_thumbnail_and_is_tried_again(
    finished, window, monkeypatch, screenshot
):
    page = window
    build_project(finished.root / "hall", points=20_000)
    with monkeypatch.context() as patch:
        patch.setattr(pool, "VIEWER_POOL", structs.replace(pool.VIEWER_POOL, starts_within_s=0.0))
        page.goto(f"{finished.url}/projects/hall/viewer/")
        cover = page.locator("#cover")
        expect(cover).to_contain_text("the viewer of hall does not start")
        assert cover.locator("img").evaluate("image => image.naturalWidth") > 0
        screenshot(page, "viewer-cover")

    expect(cover).to_have_count(0, timeout=60_000)
    expect(page.get_by_text("20 000 of 20 000 points")).to_be_attached()


@looks("desktop light")
def test_keys_of_the_map_work_on_the_project_page_without_a_click(finished, page):
    page.goto(f"{finished.url}/projects/office/")
    inside = page.frame_locator("iframe")
    expect(inside.get_by_text("60 000 of 60 000 points")).to_be_attached()

    page.keyboard.press("m")

    expect(inside.get_by_text("Stop measuring (M)")).to_be_attached()
