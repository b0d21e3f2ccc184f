"""Correct classes in a real browser: a polygon in a slice, the clip box on the map."""

import re

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import looks
from tests.e2e.test_map_page import rested
from tests.e2e.test_pages import fits
from tests.project_builder import ROOM_M
from tests.served import office, served

pytestmark = pytest.mark.e2e

server = served(office(points=60_000))


@looks("desktop light")
def test_points_in_a_polygon_and_in_the_clip_box_get_another_class(server, page, screenshot):
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=1.5&t=0.4&u=8&v=5&m=0.03")
    expect(page.locator(".facing strong")).to_be_visible()
    page.get_by_text("Correct classes").click()
    page.get_by_role("button", name="Draw a polygon").click()
    canvas = page.locator("slice-view canvas").first
    box = canvas.bounding_box()
    for x, y in ((-9.0, -4.0), (-9.0, 6.0), (-7.0, 6.0), (-7.0, -4.0)):  # around the wall x = 0
        place = {"x": box["width"] / 2 + x / 0.03, "y": box["height"] / 2 - y / 0.03}
        canvas.click(position=place)
    panel = page.locator("class-corrections")
    panel.get_by_role("button", name="Count the points").click()
    expect(panel.get_by_role("status")).to_have_text(re.compile(r"\d+ points, now: unclassified"))
    panel.get_by_label("Why").fill("a door that stood open")
    fits(page)
    page.set_viewport_size({"width": 1440, "height": 1600})  # the polygon and what it changes
    expect(page.locator("body.drawing")).to_have_count(0)
    panel.scroll_into_view_if_needed()
    screenshot(page, "slices-classes")
    page.set_viewport_size({"width": 1440, "height": 900})
    panel.get_by_role("button", name="Apply").click()
    expect(panel).to_contain_text("not in the map yet")
    expect(panel).to_contain_text("a door that stood open")

    box = f"box={ROOM_M[0] / 2},{ROOM_M[1] / 2},1.5,4,30,6,0"
    page.goto(f"{server.url}/projects/office/map/?{box}")
    panel = page.locator("class-corrections")
    panel.get_by_label("New class").select_option("moving")
    panel.get_by_role("button", name="Count the points").click()
    expect(panel.get_by_role("status")).to_have_text(re.compile(r"points, now: unclassified"))
    screenshot(page, "map-classes")
    panel.get_by_role("button", name="Apply").click()
    expect(panel.get_by_text("2 not in the map yet")).to_be_visible()
    panel.get_by_role("button", name="Undo").last.click()
    expect(panel.get_by_text("1 not in the map yet")).to_be_visible()


@looks("desktop light")
def test_what_a_brush_painted_gets_another_class(server, page, screenshot):
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=1.5&t=0.4&u=8&v=5&m=0.03")
    expect(page.locator(".facing strong")).to_be_visible()
    page.get_by_text("Correct classes").click()
    page.get_by_role("button", name="Brush").click()
    page.get_by_label("Radius of the brush").fill("0.3")
    page.get_by_label("Radius of the brush").press("Enter")
    page.locator("slice-view canvas").first.scroll_into_view_if_needed()
    middle = page.locator("slice-view canvas").first.bounding_box()
    x = middle["x"] + middle["width"] / 2 - 8.0 / 0.03  # the wall x = 0
    drag(page, (x, middle["y"] + middle["height"] / 2), (x + 1, middle["y"] + 60))
    screenshot(page, "slices-brush")
    counted(page)
    page.locator("class-corrections").get_by_role("button", name="Apply").click()
    expect(
        page.locator("class-corrections").get_by_text("not in the map yet").first
    ).to_be_visible()

    page.goto(f"{server.url}/projects/office/map/")
    rested(page)
    page.keyboard.press("k")
    middle = page.locator("#map").bounding_box()
    x, y = middle["x"] + middle["width"] * 0.35, middle["y"] + middle["height"] / 2
    drag(page, (x, y), (x + 200, y + 40))
    screenshot(page, "map-brush")
    counted(page)
    places = page.evaluate("window.recon4Map.page.brush.strokes.flat().length")
    assert places > 5
    page.get_by_role("button", name="Remove the last stroke").click()
    assert page.evaluate("window.recon4Map.page.brush.strokes.length") == 0


@looks("desktop light")
def test_all_things_like_a_picked_one_get_another_class(server, page, screenshot):
    correct_the_floor(server)
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=1.5&t=0.4&u=8&v=5&m=0.03")
    expect(page.locator(".facing strong")).to_be_visible()
    page.get_by_text("Correct classes").click()
    page.get_by_role("button", name="All like this").click()
    canvas = page.locator("slice-view canvas").first
    box = canvas.bounding_box()
    canvas.click(position={"x": box["width"] / 2 + 0.3 / 0.03, "y": box["height"] / 2})
    things = page.locator("class-corrections .alike-count")
    expect(things).to_contain_text("3 things alike")
    page.get_by_label("Most different").fill("0")
    expect(things).to_contain_text("1 thing alike")
    page.get_by_label("Most different").fill("1")
    page.locator(".alike input").last.uncheck()
    expect(things).to_contain_text("2 things alike")
    canvas.scroll_into_view_if_needed()
    fits(page)
    screenshot(page, "slices-alike")
    counted(page)
    page.locator("class-corrections").get_by_role("button", name="Apply").click()
    expect(things).to_have_count(0)

    page.goto(f"{server.url}/projects/office/map/?box=12,5,1.5,2,2,2,0")  # the third is left
    rested(page)
    page.keyboard.press("j")
    expect(page.get_by_role("button", name="All like this")).to_have_attribute(
        "aria-pressed", "true"
    )
    near = "target: [12, 5, 1.5], distance: 4"
    page.evaluate(f"window.recon4Map.move({{...window.recon4Map.camera(), {near}}})")
    page.keyboard.press(" ")
    expect(things).to_contain_text("1 thing alike")
    assert page.locator("#overlay line.alike").count() == 12


def correct_the_floor(server):
    """Without it floor, walls and pillars are one thing."""
    floor = {"shape": "box", "center_m": [8, 5, 0], "size_m": [40, 40, 0.04]}
    at = "/api/projects/office"
    body = {"volume": floor, "to": "ground", "map": server.get(f"{at}/map").json()["key"]}
    seq = server.post(f"{at}/review/classes/count", json=body).json()["seq"]
    noted = server.post(f"{at}/review/classes", json=body | {"seen_seq": seq})
    assert noted.status_code == 201, noted.text


def drag(page, start, end):
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*end, steps=6)
    page.mouse.up()


def counted(page):
    """Count the points that were painted."""
    panel = page.locator("class-corrections")
    panel.get_by_label("New class").select_option("moving")
    panel.get_by_role("button", name="Count the points").click()
    expect(panel.get_by_role("status")).to_have_text(re.compile(r"\d+ points, now: "))
