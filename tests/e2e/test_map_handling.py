"""How the tools of the map answer: with what was measured, once, and at the next key."""

import csv
import re

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import both_looks, looks
from tests.e2e.test_map_page import TOP, WINDOW, at, opened, rested
from tests.project_builder import build_project, put_on_site_grid
from tests.served import office, served
from tests.service.cuttable import cuttable

pytestmark = [pytest.mark.e2e, looks("desktop light")]

server = served(office(points=60_000, normals=True))


def test_what_is_read_of_a_pick_is_where_it_snapped_to_and_of_a_volume_its_figure(server, page):
    opened(page, server, "?camera=8,5,1.5,0,0,14,1&z=..")
    reading = page.locator("#status .reading")

    page.keyboard.press("m")
    page.mouse.click(*at(page, 8.0, 5.1))  # of the southern wall: `at` counts heights from 5 m
    expect(reading).to_contain_text("Snapped to")
    read = re.search(r"x (\S+)\s+y (\S+)\s+z (\S+) m", reading.inner_text()).groups()
    assert [float(x) for x in read] == pytest.approx(
        page.evaluate("recon4Map.page.draft[0].p"), abs=6e-4
    )

    opened(page, server, f"?{TOP}&z=..")
    page.keyboard.press("v")
    for corner in ((6.0, 4.0), (10.0, 4.0), (10.0, 6.0)):
        page.mouse.click(*at(page, *corner))
    page.keyboard.press("Enter")
    expect(reading).to_have_text(re.compile(r"Volume 1: [\d.]+ m³ above.*area [34]\.", re.DOTALL))


def test_measurements_of_a_link_have_their_places_in_the_crs(server, page):
    build_project(server.root / "site", points=1000)
    put_on_site_grid(server.root / "site", (1000.0, 2000.0, 100.0))
    page.goto(f"{server.url}/projects/site/map/?m=distance;1,2,0.5;3.5,2,0.5;Wall")

    with page.expect_download() as download:
        page.get_by_role("button", name="Download CSV").click()

    head, *rows = csv.reader(download.value.path().read_text().splitlines())
    places = [tuple(row[head.index(name)] for name in ("crs", "e", "n", "h")) for row in rows]
    assert places == [
        ("site grid", "1001.0000", "2002.0000", "100.5000"),
        ("site grid", "1003.5000", "2002.0000", "100.5000"),
    ]


def test_a_chosen_tool_leaves_the_image_where_it_is_and_keys_follow_a_number(server, page):
    opened(page, server)
    before = page.evaluate("recon4Map.camera()")
    page.keyboard.press("m")
    expect(page.locator("#status .reading")).to_be_visible()
    assert page.evaluate("recon4Map.camera()") == before

    page.get_by_label("From height [m]").fill("0.5")
    page.keyboard.press("Enter")
    page.keyboard.press("i")
    expect(page.get_by_role("button", name="Point", exact=True)).to_have_attribute(
        "aria-pressed", "true"
    )
    page.get_by_label("Name of this view").fill("x")
    page.keyboard.press("Escape")
    page.keyboard.press("i")
    expect(page.get_by_role("button", name="End tool")).to_be_visible()


BOX = "camera=8,5,1.5,30,-40,14,0&z=..&box=8,5,1.5,4,4,2,0"


def clip_box(page):
    return page.evaluate("recon4Map.page.state.clip.box")


@both_looks
def test_a_face_of_the_clip_box_is_dragged_and_moved_by_keys(server, page, context, look):
    opened(page, server, f"?{BOX}")
    face = page.get_by_role("slider", name="Clip box, side +x")
    before, drawn = clip_box(page), page.evaluate("recon4Map.run.canvas.drawn.frames")
    middle = face.bounding_box()
    x, y = (middle[at] + middle[size] / 2 for at, size in (("x", "width"), ("y", "height")))

    if look[0] == "phone":
        touch = context.new_cdp_session(page)
        for kind, to in (("touchStart", x), ("touchMove", x + 20), ("touchMove", x + 40)):
            where = {"type": kind, "touchPoints": [{"x": to, "y": y}]}
            touch.send("Input.dispatchTouchEvent", where)
        touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    else:
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 40, y)
        page.mouse.up()

    dragged = clip_box(page)
    assert dragged["size"][0] > before["size"][0] + 0.2
    assert dragged["size"][1:] == before["size"][1:]
    opposite = [box["center"][0] - box["size"][0] / 2 for box in (before, dragged)]
    assert opposite[0] == pytest.approx(opposite[1])
    rested(page)
    assert page.evaluate("recon4Map.run.canvas.drawn.frames") > drawn

    face.focus()
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Shift+ArrowDown")
    expect(face).to_have_attribute("aria-valuetext", f"{dragged['size'][0] - 0.45:.2f} m")
    expect(face).to_be_focused()
    assert page.evaluate("recon4Map.camera().distance") == 14  # the map has not moved


def test_what_changes_nothing_of_the_image_draws_it_not_again(server, page):
    opened(page, server, f"?{TOP}&z=..")
    page.mouse.click(*at(page, 6.0, 4.0))
    expect(page.locator("#status .reading")).to_contain_text("intensity")
    before = page.evaluate("recon4Map.run.canvas.drawn.frames")

    page.keyboard.press("i")
    page.mouse.click(*at(page, 6.0, 4.0))
    expect(page.locator("#overlay text")).to_have_text(re.compile("Point 1"))

    assert page.evaluate("recon4Map.run.canvas.drawn.frames") == before
    assert page.evaluate("recon4Map.run.canvas.drawn.rested")


def test_one_flies_as_fast_as_one_chooses(server, page):
    opened(page, server)
    page.get_by_label("Speed of the flight").select_option("16 × that of the walk")
    page.evaluate("""() => {
      const { page } = recon4Map;
      const times = (window.flown = []);
      let time = page.flight.time;
      Object.defineProperty(page.flight, "time", {
        get: () => time,
        set(next) {
          times.push([performance.now(), next]);
          time = next;
        },
      });
    }""")

    page.keyboard.press("p")
    expect(page.locator("#status .caption")).to_contain_text("s of the walk")
    while page.evaluate("flown.length") < 4:
        page.wait_for_timeout(50)
    page.keyboard.press("Escape")

    flown = np.array(page.evaluate("flown.slice(1)"))  # the first one is that of the beginning
    took_s, of_walk_s = (flown[-1] - flown[0]) * (1e-3, 1)
    assert of_walk_s / took_s == pytest.approx(16, rel=0.2)


def test_a_note_is_begun_at_once_and_an_impatient_person_makes_one(server, page):
    waiting = []
    page.route("**/notes", lambda route: waiting.append(route), times=1)
    opened(page, server, f"?{TOP}&z=..")
    page.keyboard.press("n")
    page.mouse.click(*at(page, 6.0, 4.0))
    expect(page.get_by_label("Note at")).to_be_focused()  # before the others have been read
    waiting.pop().continue_()

    page.get_by_label("Note at").fill("Crack")
    pin = page.locator("#overlay .pin.note")
    expect(pin).to_have_count(1)
    page.route("**/notes", lambda route: waiting.append(route), times=1)
    keep = page.get_by_role("button", name="Keep the note")
    with page.expect_request("**/notes"):
        keep.click()
    keep.click()
    waiting.pop().continue_()

    expect(page.locator("#panel .notes li")).to_have_count(1)
    assert len(server.get("/api/projects/office/notes").json()["notes"]) == 1
    expect(pin).to_have_count(1)


def test_a_refused_clipboard_leads_to_the_address(server, page):
    page.add_init_script(
        "navigator.clipboard.writeText = () => Promise.reject(new Error('not allowed'))"
    )
    opened(page, server)

    page.keyboard.press("l")

    expect(page.locator("#status .reading")).to_contain_text("The address of this page")
    expect(page.locator("#message")).to_be_empty()


@looks("phone dark")
def test_the_panel_of_a_phone_leaves_what_a_tool_says(server, page):
    opened(page, server, f"?{TOP}&z=..")
    page.get_by_role("button", name="Distance", exact=True).tap()
    for x in (6.0, 10.0):
        page.touchscreen.tap(*at(page, x, 4.0))
    expect(page.locator("#status .reading")).to_contain_text("Distance 1")

    page.get_by_role("button", name="Panel", exact=True).tap()

    panel, reading, bar = (
        page.locator(one).bounding_box() for one in ("#panel", "#status .reading", "#bar")
    )
    assert panel["y"] + panel["height"] <= reading["y"]
    assert panel["y"] >= bar["y"] + bar["height"]


def test_who_is_faster_than_the_server_loses_no_measurement(server, page):
    opened(page, server, f"?{TOP}&z=..")
    late = []
    page.route("**/pick", lambda route: late.append(route))

    page.keyboard.press("q")
    for corner in ((6.0, 4.0), (10.0, 4.0), (10.0, 6.0), (6.0, 6.0)):
        with page.expect_request("**/pick"):
            page.mouse.click(*at(page, *corner))
    page.keyboard.press("Enter")
    page.keyboard.press("m")
    with page.expect_request("**/pick"):
        page.mouse.click(*at(page, 7.0, 5.0))
    expect(page.get_by_role("button", name="Distance", exact=True)).to_have_attribute(
        "aria-pressed", "true"
    )
    while late:
        with page.expect_response("**/pick"):
            late.pop().continue_()  # the last one first

    expect(page.locator("#panel .value")).to_have_text(re.compile(r"^8\.0\d\d m²$"))
    expect(page.locator("#status .reading")).to_contain_text("x 7.0")
    assert len(page.evaluate("recon4Map.page.draft")) == 1


def test_a_note_half_written_is_not_lost_by_a_reload_unasked(server, page):
    opened(page, server, f"?{TOP}&z=..")
    asked = []
    page.on("dialog", lambda dialog: asked.append(dialog.type) or dialog.accept())
    page.keyboard.press("n")
    page.mouse.click(*at(page, 6.0, 4.0))
    expect(page.locator("#panel textarea")).to_be_focused()
    page.keyboard.type("Crack")
    page.reload()
    rested(page)
    assert asked == ["beforeunload"]

    page.reload()
    rested(page)
    assert asked == ["beforeunload"]


def test_a_map_whose_server_was_gone_goes_on_when_it_is_back(server, context):
    page = context.new_page()  # its browser complains of the cut
    page.set_viewport_size(WINDOW)
    with cuttable(int(server.url.rsplit(":", 1)[1])) as link:
        page.goto(f"{link.url}/projects/office/map/?{TOP}&z=..")
        rested(page)
        link.cut()
        expect(page.get_by_text("Connection lost")).to_be_visible()
        page.mouse.click(*at(page, 9.0, 5.5))
        expect(page.locator("#message")).to_contain_text("does not answer")
        link.restore()

        expect(page.locator("#message")).to_have_text("")
        page.mouse.click(*at(page, 9.0, 5.5))
        expect(page.locator("#status .reading")).to_contain_text("x 9.0")
        page.close()  # before the link goes


def test_a_double_click_is_one_end_of_a_distance(server, page):
    opened(page, server, f"?{TOP}&z=..")
    page.keyboard.press("m")
    with page.expect_response("**/pick"):
        page.mouse.dblclick(*at(page, 6.5, 5.5))
    page.mouse.click(*at(page, 9.5, 5.5))

    expect(page.locator("#panel .value")).to_have_text(re.compile(r"^3\.0\d\d m$"))
