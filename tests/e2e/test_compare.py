"""Two maps compared on the page of the map in a real browser."""

import io
import re

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from tests.e2e.conftest import looks
from tests.e2e.test_map_page import SHOW, at
from tests.project_builder import ROOM_M, build_project
from tests.served import served

pytestmark = pytest.mark.e2e

TOP = "camera=8,5,1.5,0,-90,14,1"
MOVED_M, FAR_M = 0.045, 2.0


def projects(root):
    for moved_m in (FAR_M, 0.0, MOVED_M):
        build_project(root / "office", points=60_000, normals=True, moved_m=moved_m)


server = served(projects)


def on_canvas(page, *, color):
    """Pixels of the map's canvas in a color: ``red`` in front, ``blue`` behind."""
    page.evaluate(SHOW, "hidden")
    png = page.locator("#map").screenshot()
    page.evaluate(SHOW, "")
    rgb = np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)
    high, low = (0, 2) if color == "red" else (2, 0)
    return int((rgb[..., high] > rgb[..., low] + 60).sum())


def shown(page, points):
    """Wait until that many points are drawn."""
    text = f"{points:,}".replace(",", ".")  # any narrow space
    expect(page.locator("#status .shown")).to_have_text(re.compile(f"^{text} of 60.000 points$"))


@looks("desktop light")
def test_the_map_before_the_last_one_is_shown_as_differences(server, page):
    page.goto(f"{server.url}/projects/office/map/?{TOP}&z=..")
    panel = page.locator("#panel section.compare")
    expect(panel.get_by_label("With")).to_have_value(re.compile("^map:"))

    panel.get_by_role("button", name="Compute differences").click()
    expect(panel.get_by_role("button", name="Differences", exact=True)).to_have_attribute(
        "aria-pressed", "true"
    )

    made = server.get("/api/projects/office/comparisons").json()["comparisons"][0]
    counts = made["found"]["counts"]
    shown(page, counts["core_points"])
    colors = page.get_by_role("region", name="Colors")
    expect(colors).to_contain_text("Differences: The map of ")
    expect(colors.get_by_label("Color by")).to_have_count(0)  # the points have none of its colors
    significant = colors.get_by_role("listitem").filter(has_text="Significant (95 %)")
    digits = re.sub(r"\D", "", significant.locator("small").text_content().split(",")[0])
    assert int(digits) == counts["significant"] > 1000
    expect(colors.locator(".ends")).to_contain_text("50 mm in front")
    assert on_canvas(page, color="red") > 1000 and on_canvas(page, color="blue") < 50
    expect(page).to_have_url(re.compile(f"compare={made['id']}"))

    panel.get_by_label("Color end [mm]").fill("200")
    panel.get_by_label("Color end [mm]").press("Enter")
    expect(page).to_have_url(re.compile("reach=200"))
    page.reload()  # the address shows the same
    shown(page, counts["core_points"])
    expect(colors.locator(".ends")).to_contain_text("200 mm in front")
    panel.get_by_role("button", name="This map only").click()
    shown(page, 60_000)
    expect(colors.get_by_label("Color by")).to_be_visible()
    assert on_canvas(page, color="red") < 50


@pytest.mark.study
@looks("desktop light")
def test_a_divider_shows_the_other_map_to_its_right(server, page):
    base = "/api/projects/office/comparisons"
    earliest = server.get(base).json()["others"][1]["id"]
    made = server.post(base, json={"against": earliest}).json()["id"]
    server.wait(made, lambda view: view["job"]["finished"])
    page.goto(f"{server.url}/projects/office/map/?{TOP}&z=..&color=plain&compare={made}&swipe=1")
    divider = page.get_by_role("slider", name="Divider between this map and the other one")
    expect(divider).to_have_value("100")
    rested(page)
    assert beyond_the_wall(page) == 0

    divider.press("Home")  # the other map fills the window
    expect(page).to_have_url(re.compile("swipe=0$"))
    rested(page)
    assert beyond_the_wall(page) > 100  # there its wall was

    box = page.locator("#map").bounding_box()
    y = box["y"] + box["height"] / 2
    page.mouse.move(box["x"], y)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"], y, steps=4)
    page.mouse.up()
    expect(divider).to_have_value("100")
    rested(page)
    assert beyond_the_wall(page) == 0
    divider.press("ArrowLeft")
    expect(page).to_have_url(re.compile(r"swipe=0\.995"))
    page.locator("#panel").get_by_role("button", name="Differences", exact=True).click()
    expect(divider).to_have_count(0)


def rested(page):
    """Wait until all points of the image are drawn."""
    expect(page.locator("#status .shown")).to_have_text(re.compile(r"points$"))
    page.wait_for_function("() => recon4Map.run.canvas.drawn.rested")


def beyond_the_wall(page):
    """Pixels that are drawn where only the other map has a wall."""
    page.evaluate(SHOW, "hidden")
    page.evaluate("() => (document.querySelector('#divider').style.visibility = 'hidden')")
    (left, y), (right, _) = at(page, ROOM_M[0] + 1.0, 2.0), at(page, ROOM_M[0] + 3.0, 2.0)
    clip = {"x": left, "y": y - 40.0, "width": right - left, "height": 80.0}
    png = page.screenshot(clip=clip)
    page.evaluate(SHOW, "")
    page.evaluate("() => (document.querySelector('#divider').style.visibility = '')")
    rgb = np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)
    return int((np.abs(rgb - rgb[0, 0]).max(axis=2) > 12).sum())
