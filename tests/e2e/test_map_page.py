"""The page of the map in a real browser: what is drawn, clipped, measured and kept in links."""

import io
import re

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from tests.e2e.conftest import SCREENSHOTS, looks, show_on
from tests.project_builder import ROOM_M
from tests.served import office, served

pytestmark = pytest.mark.e2e

SHOW = """shown => document.querySelectorAll("#bar, #panel, #status, #overlay")
  .forEach((one) => (one.style.visibility = shown))"""
TOP = "camera=8,5,1.5,0,-90,14,1"
METERS_PER_PX = 14.0 * 2.0 * np.tan(np.pi / 6.0)
"""Times the height of the canvas: of the camera ``TOP``."""


WINDOW = {"width": 1200, "height": 620}
"""Without a graphics card each pixel takes processor time; the room is as wide as panels leave."""


server = served(office(points=60_000, normals=True))


def opened(page, server, query=""):
    if page.viewport_size["width"] > WINDOW["width"] and not SCREENSHOTS:
        page.set_viewport_size(WINDOW)
    page.goto(f"{server.url}/projects/office/map/{query}")
    rested(page)


def rested(page):
    """Wait until all points of the image are drawn; the page's policy forbids `eval`."""
    expect(page.locator("#status .shown")).to_have_text(re.compile(r"of 60.000 points$"))


def drawn(page):
    """Pixels of the map's canvas that are not of its background."""
    return int(is_drawn(page).sum())


def is_drawn(page):
    """Which pixels of the map's canvas are not of its background, (height, width)."""
    page.evaluate(SHOW, "hidden")
    png = page.locator("#map").screenshot()
    page.evaluate(SHOW, "")
    rgb = np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)
    return np.abs(rgb - rgb[2, 2]).max(axis=2) > 12


def at(page, x, y):
    """The pixel of a place of the map in the view ``TOP``."""
    box = page.locator("#map").bounding_box()
    px = box["height"] / METERS_PER_PX
    return box["x"] + box["width"] / 2 + (x - 8.0) * px, box["y"] + box["height"] / 2 - (
        y - 5.0
    ) * px


@looks("desktop light")
def test_the_page_says_that_the_map_is_opened_until_it_is_drawn(page, server):
    held = []
    page.route("**/sample?**", lambda route: held.append(route), times=1)
    with page.expect_request("**/sample?**"):
        page.goto(f"{server.url}/projects/office/map/")

    expect(page.locator("#opening")).to_have_text("Opening the map…")
    held.pop().continue_()
    rested(page)
    expect(page.locator("#opening")).to_be_hidden()


@looks("desktop light")
def test_what_the_page_begins_with_is_requested_once_and_beside_the_scripts(page, server):
    asked = []
    page.on("request", lambda request: asked.append(request.url.removeprefix(server.url)))
    opened(page, server)

    first = ["/api/me", "/api/projects/office", "/map?key=", "/sample?stored=xyz"]
    found = [[k for k, url in enumerate(asked) if one in url] for one in first]
    assert [len(found[0]), len(found[2]), len(found[3])] == [1, 1, 1]
    runs = next(k for k, url in enumerate(asked) if url.endswith("/map/map.js"))
    assert all(rows[0] < runs + 3 for rows in found)
    timing = "performance.getEntriesByType('resource').filter(({ name }) => name.match('/web/'))"
    page.reload()
    rested(page)
    assert page.evaluate(f"{timing}.filter(({{ transferSize }}) => transferSize > 0).length") == 0


@looks("desktop light", "phone dark")
def test_the_map_is_drawn_and_fills_the_window(server, page, screenshot):
    opened(page, server)

    assert drawn(page) > 20_000
    box, window = page.locator("#map").bounding_box(), page.viewport_size
    assert box["width"] == window["width"] and box["height"] > 0.6 * window["height"]
    expect(page.locator("#status")).to_contain_text("map frame (local), x y z, z up, meters")
    screenshot(page, "room")


@looks("desktop light")
def test_a_clip_removes_what_is_outside(server, page):
    opened(page, server, f"?{TOP}&z=..")
    whole = drawn(page)

    page.get_by_label("From height [m]").fill("1")
    page.get_by_label("From height [m]").press("Enter")
    page.keyboard.press("Escape")
    expect(page).to_have_url(re.compile(r"z=1\.\."))
    rested(page)

    assert drawn(page) < 0.5 * whole  # no floor: walls and pillars, seen from above
    page.keyboard.press("z")
    rested(page)
    assert drawn(page) > 0.9 * whole


@looks("desktop light")
def test_a_measured_distance_is_that_of_the_walls(server, page):
    opened(page, server, f"?{TOP}&z=..")

    page.keyboard.press("m")
    page.mouse.click(*at(page, 8.0, 7.0))
    page.keyboard.press("Backspace")  # beside what was meant
    for x in (0.0, ROOM_M[0]):
        page.mouse.click(*at(page, x, 2.5))
        expect(page.locator("#status .reading")).to_contain_text("m")
    value = page.locator("#panel .value")
    expect(value).to_be_visible()

    parts = page.locator("#panel small").text_content()
    horizontal = float(re.search(r"horizontal ([\d.]+) m", parts)[1])
    assert horizontal == pytest.approx(ROOM_M[0], abs=0.01)  # not along the wall: it is square
    assert float(value.text_content().split()[0]) >= horizontal
    with page.expect_download() as download:
        page.get_by_role("button", name="Download CSV").click()
    rows = download.value.path().read_text().splitlines()
    assert len(rows) == 3 and rows[1].startswith("Distance 1,distance,1,")
    expect(page).to_have_url(re.compile("m=distance;"))

    page.locator("#map").focus()
    for count, key in ((2, "q"), (3, "v")):  # a double click ends it, or one of the right button
        page.keyboard.press(key)
        for corner in ((6.0, 4.0), (10.0, 4.0)):
            page.mouse.click(*at(page, *corner))
        if key == "q":
            page.mouse.dblclick(*at(page, 10.0, 6.0))
        else:
            page.mouse.click(*at(page, 10.0, 6.0))
            page.mouse.click(*at(page, 9.0, 7.0), button="right")
        expect(page.locator("#panel .value")).to_have_count(count)
    corners = page.evaluate("recon4Map.page.state.measurements.map(({ points }) => points.length)")
    assert corners == [2, 3, 3]
    page.keyboard.press("Escape")
    expect(page.get_by_role("button", name="Distance")).to_have_attribute("aria-pressed", "false")


@looks("desktop light")
def test_a_note_a_saved_view_and_a_profile_are_made_by_keys_and_clicks(
    server, page, screenshot, tmp_path
):
    page.emulate_media(reduced_motion="reduce")  # flights take no time
    opened(page, server, f"?{TOP}&z=..")
    panel = page.locator("#panel")
    expect(panel.get_by_role("button", name="New note")).to_be_visible()

    page.keyboard.press("n")
    page.mouse.click(*at(page, 0.0, 2.5))
    panel.get_by_label("Note at").fill("crack over the door")
    Image.new("RGB", (3000, 1500), "peru").save(tmp_path / "door.png")
    panel.get_by_label("Photo").set_input_files(tmp_path / "door.png")
    panel.get_by_role("button", name="Keep the note").click()
    note = panel.locator(".notes li")
    expect(note).to_contain_text("crack over the door")
    photo = note.get_by_role("img", name="Photo of: crack over the door")
    expect(photo).to_have_js_property("naturalWidth", 2048)
    photo.scroll_into_view_if_needed()
    screenshot(page, "map-note")
    note.get_by_role("button", name="Mark as done").click()
    expect(note).to_contain_text("✓ Done · local")
    expect(page.locator("#overlay .pin.note.done")).to_have_count(1)
    panel.get_by_label("Name of this view").fill("From above")
    panel.get_by_role("button", name="Save this view").click()

    page.locator("#map").focus()
    page.keyboard.press("r")
    with page.expect_request("**/slices/image") as asked:
        for x in (0.0, ROOM_M[0]):
            page.mouse.click(*at(page, x, 2.5))
    plot = page.get_by_role("img", name=re.compile("Profile: .* points"))
    expect(plot).to_be_visible()
    shown = plot.locator("image").bounding_box()
    assert asked.value.post_data_json["width"] == round(shown["width"]), "thin lines are lost"
    expect(page.get_by_role("link", name="DXF")).to_have_attribute("href", re.compile("flat"))
    above, below = (page.locator(one).bounding_box() for one in ("#profile", "#status"))
    assert above["y"] + above["height"] <= below["y"], "the reading covers the profile"
    screenshot(page, "room-profile")

    panel.get_by_role("button", name="crack over the door", exact=True).click()
    expect(page).to_have_url(re.compile(r"camera=-?0(\.0\d*)?,2\."))
    panel.get_by_role("button", name=re.compile("^From above")).click()
    expect(page).to_have_url(re.compile(r"camera=8,5,1\.5,0,-90,14,1"))


@looks("desktop light")
def test_a_link_opens_exactly_the_same(server, page, context):
    opened(page, server, f"?{TOP}&z=..2&color=time&layers=walk&depth=0")
    before = page.url

    page.reload()
    rested(page)

    expect(page.get_by_label("Color by")).to_have_value("time")
    expect(page.get_by_label("Walk", exact=True)).to_be_checked()
    expect(page.get_by_label("To height [m]")).to_have_value("2")
    assert page.url == before


@looks("desktop light")
def test_a_drag_orbits_the_wheel_zooms_and_a_view_ends_the_flight(server, page):
    opened(page, server)

    page.keyboard.press("7")
    expect(page).to_have_url(re.compile(r"camera=[^&]*,0,-90,"))
    page.mouse.move(500, 500)
    page.mouse.wheel(0, -400)
    expect(page).not_to_have_url(re.compile(r"camera=8\.000,"))
    zoomed = page.url
    page.mouse.down()
    page.mouse.move(560, 460, steps=4)
    page.mouse.up()
    expect(page).not_to_have_url(zoomed)
    expect(page).not_to_have_url(re.compile(r"camera=[^&]*,-90,"))

    expect(page.get_by_label("Along the walk")).to_be_visible()
    fly = page.get_by_role("button", name="Fly")
    page.keyboard.press("p")
    expect(fly).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("7")
    expect(fly).to_have_attribute("aria-pressed", "false", timeout=5_000)


@looks("desktop light")
def test_a_section_leads_to_its_slice(server, page):
    opened(page, server, f"?{TOP}&z=..&section=2,5,14,5,0.5")

    link = page.get_by_role("link", name="Open as a slice")

    expect(link).to_have_attribute("href", re.compile(r"kind=vertical&a=2\.000,5\.000&b=14\.000"))
    link.click()
    expect(page.locator(".facing")).to_contain_text("Vertical")


@looks("desktop light")
def test_corners_are_those_of_the_clicks_in_their_order(server, page):
    opened(page, server, f"?{TOP}&z=..")
    first = []

    def overtaken(route):
        """Answer the first click after the second."""
        if first:
            route.fulfill(response=route.fetch())
            first.pop().continue_()
        else:
            first.append(route)

    page.route("**/map/pick", overtaken)
    page.keyboard.press("m")
    for x in (0.0, ROOM_M[0]):
        page.mouse.click(*at(page, x, 2.5))

    expect(page).to_have_url(re.compile(r"m=distance;-?0[.\d]*,[^;]*;1[56][.\d]*,"))


@looks("desktop light")
def test_keys_zoom_and_one_stands_on_the_walk_or_a_floor_and_nowhere_else(server, page):
    opened(page, server, f"?{TOP}&z=..")
    expect(page.get_by_label("Along the walk")).to_be_visible()

    page.keyboard.press("g")
    page.mouse.click(*at(page, 10.0, -1.8))

    expect(page.locator("#status .reading")).to_have_text("Click on the walk, or on a floor")
    page.keyboard.press("+")
    expect(page).to_have_url(re.compile(r"camera=8,5,1\.5,0,-90,11\.2,1"))


@looks("desktop light")
def test_fit_shows_all_of_the_map_again_from_where_one_looks(server, page):
    page.emulate_media(reduced_motion="reduce")
    opened(page, server)
    show_on(page, "desktop")
    page.keyboard.press("7")
    expect(page).to_have_url(re.compile(r"camera=[^&]*,0,-90,"))
    whole = page.url

    for way in (
        lambda: page.keyboard.press("f"),
        lambda: page.get_by_role("button", name="Fit", exact=True).click(),
    ):
        for key in ("+", "+", "ArrowUp"):
            page.keyboard.press(key)
        expect(page).not_to_have_url(whole)
        way()
        expect(page).to_have_url(whole)

    rested(page)
    canvas, bars, caption = (
        page.locator(one).bounding_box() for one in ("#map", "#bar", "#status")
    )
    rows = canvas["y"] + np.flatnonzero(is_drawn(page).any(axis=1))
    assert rows[0] >= bars["y"] + bars["height"] and rows[-1] < caption["y"]


@looks("desktop light")
def test_a_browser_without_webgl_says_so(server, page):
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")

    page.goto(f"{server.url}/projects/office/map/")

    expect(page.locator("#message")).to_contain_text("WebGL 2 is missing or switched off")


def pinched(page, middle, before_px, after_px):
    """Two fingers on the map move apart, or together."""
    touch = page.context.new_cdp_session(page)

    def send(kind, apart_px):
        fingers = [{"x": middle[0] + s * apart_px / 2, "y": middle[1], "id": s} for s in (-1, 1)]
        points = [] if kind == "touchEnd" else fingers
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    send("touchStart", before_px)
    for part in (0.25, 0.5, 0.75, 1.0):
        send("touchMove", before_px + part * (after_px - before_px))
    send("touchEnd", after_px)


@looks("phone dark")
def test_fingers_measure_zoom_and_stand_on_the_walk(server, page):
    page.emulate_media(reduced_motion="reduce")
    opened(page, server, f"?{TOP}&z=..")
    reading = page.locator("#status .reading")

    def tap(name):
        if not page.get_by_role("button", name=name, exact=True).is_visible():
            page.get_by_role("toolbar", name="Tools").get_by_role("button", name="More").tap()
        page.get_by_role("button", name=name, exact=True).tap()

    tap("Distance")
    page.touchscreen.tap(*at(page, 6.0, 4.0))
    expect(reading).to_contain_text("σ of the pose")
    page.touchscreen.tap(*at(page, 10.0, 4.0))
    expect(reading).to_have_text(re.compile(r"Distance 1: (3\.9|4\.)"))

    tap("Area")
    for corner in ((6.0, 4.0), (10.0, 4.0), (10.0, 6.0)):
        page.touchscreen.tap(*at(page, *corner))
    page.get_by_role("button", name="Done").tap()
    expect(reading).to_contain_text("Area 1: ")
    for before_px, after_px, distance in ((80, 160, "7"), (160, 80, "14")):
        pinched(page, at(page, 8.0, 5.0), before_px, after_px)
        expect(page).to_have_url(re.compile(rf"camera=[^&]*,0,-90,{distance},1"))
    assert page.evaluate("recon4Map.page.draft.length") == 0  # two fingers pick nothing
    page.get_by_role("button", name="End tool").tap()
    expect(page.get_by_role("button", name="End tool")).to_have_count(0)

    tap("Stand here")
    page.touchscreen.tap(*at(page, 8.0, 8.0))
    expect(page).to_have_url(re.compile("standing=1"))
    x, y, _ = page.evaluate("recon4Map.camera().target")
    assert np.hypot(x - 8.0, y - 8.0) == pytest.approx(2.0, abs=0.1)  # two meters ahead of the eyes
