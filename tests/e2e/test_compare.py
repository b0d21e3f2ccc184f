"""Two maps compared on the page of the map in a real browser."""

import io
import re

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from tests.e2e.conftest import looks
from tests.e2e.test_map_page import SHOW
from tests.project_builder import build_project
from tests.served import served

pytestmark = pytest.mark.e2e

TOP = "camera=8,5,1.5,0,-90,14,1"
MOVED_M = 0.05


def projects(root):
    build_project(root / "office", points=150_000, normals=True)
    build_project(root / "office", points=150_000, normals=True, moved_m=MOVED_M)


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
    expect(page.locator("#status .shown")).to_have_text(re.compile(f"^{text} of 150.000 points$"))


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
    significant = panel.get_by_role("listitem").filter(has_text="Significant (95 %)")
    digits = re.sub(r"\D", "", significant.locator("small").text_content().split(",")[0])
    assert int(digits) == counts["significant"] > 1000
    expect(panel.locator(".ends")).to_contain_text("50 mm in front")
    assert on_canvas(page, color="red") > 1000 and on_canvas(page, color="blue") < 50
    expect(page).to_have_url(re.compile(f"compare={made['id']}"))

    panel.get_by_label("Color end [mm]").fill("200")
    panel.get_by_label("Color end [mm]").press("Enter")
    expect(page).to_have_url(re.compile("reach=200"))
    page.reload()  # the address shows the same
    shown(page, counts["core_points"])
    expect(panel.locator(".ends")).to_contain_text("200 mm in front")
    panel.get_by_role("button", name="This map only").click()
    expect(page.locator("#status .shown")).to_have_text(re.compile(r"^60.\d{3} of .*points$"))
    assert on_canvas(page, color="red") < 50
