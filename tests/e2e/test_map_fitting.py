"""What the page of the map shows of a clip: all of it, as large as bars and panel allow."""

import re

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import looks
from tests.e2e.test_map_page import TOP, at, opened
from tests.served import office, served

pytestmark = [pytest.mark.e2e, looks("desktop light")]

server = served(office(points=60_000))


def free(page):
    """Left, top, right and bottom of what bars, panel and caption leave of the map [px]."""
    bar, panel, status = (
        page.locator(one).bounding_box() for one in ("#bar", "#panel", "#status .caption")
    )
    return 0.0, bar["y"] + bar["height"], panel["x"], status["y"]


def clip_lines(page):
    """Left, top, right and bottom of the lines of the box or of the section [px]."""
    canvas = page.locator("#map").bounding_box()
    ends = np.array(
        page.locator("#overlay line.clip").evaluate_all(
            "lines => lines.map((one) => ['x1', 'y1', 'x2', 'y2'].map((k) => +one.getAttribute(k)))"
        )
    ).reshape(-1, 2)
    low, high = ends.min(axis=0), ends.max(axis=0)
    return low[0] + canvas["x"], low[1] + canvas["y"], high[0] + canvas["x"], high[1] + canvas["y"]


def fills(page):
    """The clip lies in the free part of the image; returns the larger ratio of it that it takes."""
    (left, top, right, bottom), (west, north, east, south) = free(page), clip_lines(page)
    assert left <= west < east <= right
    assert top <= north
    assert south <= bottom
    return max((east - west) / (right - left), (south - north) / (bottom - top))


def test_a_dragged_section_is_looked_at_beside_the_panel_and_again_after_the_slice(server, page):
    page.emulate_media(reduced_motion="reduce")
    opened(page, server, f"?{TOP}&z=..")
    page.keyboard.press("x")
    page.mouse.move(*at(page, 2.0, 5.0))
    page.mouse.down()
    page.mouse.move(*at(page, 14.0, 5.0), steps=4)
    page.mouse.up()
    expect(page).to_have_url(re.compile("section="))

    assert fills(page) > 0.9
    page.get_by_label("Color by").select_option("height")
    looked_at = page.evaluate("recon4Map.camera()")
    page.get_by_role("link", name="Open as a slice").click()
    page.get_by_role("link", name="Show in 3-D").click()
    expect(page.locator("#overlay line.clip")).to_have_count(1)

    expect(page.get_by_label("Color by")).to_have_value("height")
    assert fills(page) > 0.9
    again = page.evaluate("recon4Map.camera()")
    assert [again["yaw"], again["pitch"]] == pytest.approx(
        [looked_at["yaw"], looked_at["pitch"]], abs=1e-3
    )


def test_views_and_fit_show_all_of_the_box_and_nothing_else(server, page):
    page.emulate_media(reduced_motion="reduce")
    opened(page, server, f"?{TOP}&z=..&box=4,3,1,2,1.5,1.5,0.5")

    for way in ("f", "5", "7", "1"):
        before = page.url
        page.keyboard.press(way)
        expect(page).not_to_have_url(before)
        assert fills(page) > 0.5

        shown = page.url
        for _ in range(4):
            page.keyboard.press("-")
        expect(page).not_to_have_url(shown)
        assert fills(page) < 0.5
