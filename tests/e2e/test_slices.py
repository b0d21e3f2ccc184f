"""The page of slices in a real browser: cuts, findings, references, control points, export."""

import re

import numpy as np
import pytest
from playwright.sync_api import expect

from recon4.pipeline import process
from recon4.recording.sources import Sources
from tests.e2e.conftest import looks, on_both_screens, one_look
from tests.e2e.test_pages import fits
from tests.planar_walks import furnished_room, scanned, write_carmen
from tests.project_builder import build_project
from tests.served import served
from tests.service.running import server_thread

pytestmark = pytest.mark.e2e

STRAIGHT = np.stack([np.linspace(-2.0, 2.0, 40), np.zeros(40), np.zeros(40)], axis=1)


def projects(root):
    build_project(root / "office", points=120_000)
    build_project(root / "earlier", points=60_000)
    write_carmen(root / "walk.log", scanned(furnished_room(), STRAIGHT).scans)
    process(Sources((root / "walk.log",), None), root / "plan")


server = served(projects)


def opened(page, server, query=""):
    page.goto(f"{server.url}/projects/office/slices/{query}")
    expect(page.locator(".facing strong")).to_be_visible()
    rested(page)


def above_the_fold(page):
    """The legend of the slice and the names of all results are seen without scrolling."""
    names = page.locator(".findings > details > summary")
    boxes = [one.bounding_box() for one in [*names.all(), page.locator(".under")]]
    assert len(boxes) == 6
    assert max(box["y"] + box["height"] for box in boxes) <= page.viewport_size["height"]


def rested(page):
    expect(page.locator("body.drawing")).to_have_count(0)


def test_the_page_says_what_it_waits_for_and_how_long(server, page):
    waiting = page.locator(".waiting")
    asked = []
    page.route("**/slices/image", lambda route: asked.append(route), times=1)
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=1.5")

    expect(waiting).to_have_text(re.compile(r"Cutting the slice…\s+[2-9] s"))
    asked.pop().continue_()
    rested(page)
    expect(waiting).to_have_count(0)

    page.route("**/slices/image", lambda route: asked.append(route), times=1)
    page.keyboard.press("]")
    assert waiting.count() == 0  # an image is shown: at first only the pointer says it
    expect(waiting).to_contain_text(" s")
    asked.pop().continue_()
    rested(page)
    expect(waiting).to_have_count(0)


def test_a_slice_is_shown_with_frame_units_and_legend(server, page, screenshot):
    opened(page, server, "?kind=horizontal&z=1.5&color=intensity")

    expect(page.locator(".facing")).to_contain_text("z = 1.500 m")
    expect(page.locator(".facing")).to_contain_text("map frame (local), x y z, z up, meters")
    expect(page.get_by_role("img", name=re.compile("Slice z = 1.500 m, .* points"))).to_be_visible()
    expect(page.get_by_role("heading", level=1)).to_have_text("Slices")
    named = "canvases => canvases.every((one) => one.getAttribute('aria-label'))"
    assert page.locator("canvas").evaluate_all(named)
    expect(page.get_by_label("Low end of the colors")).to_be_visible()
    fits(page)
    if page.viewport_size["width"] > 1000:
        above_the_fold(page)
    screenshot(page, "slices")


@one_look
def test_a_2d_map_is_shown_as_the_one_slice_it_is(server, page, screenshot):
    page.goto(f"{server.url}/projects/plan/slices/")

    plan = page.get_by_role("img", name=re.compile("Floor plan"))
    expect(plan).to_be_visible()
    expect(page.locator("main")).to_contain_text("one slice at the height of the laser")
    assert plan.evaluate("image => image.decode().then(() => image.naturalWidth)") > 50
    expect(page.get_by_role("link", name="The page Project")).to_have_attribute(
        "href", "/projects/plan/"
    )
    expect(page.locator("#message, .tools")).to_have_count(0)
    on_both_screens(page, fits)
    screenshot(page, "slices-plan")


@looks("desktop light")
def test_keys_change_the_cut_and_the_address_keeps_it(server, page):
    opened(page, server, "?kind=horizontal&z=1.5")

    page.keyboard.press("]")
    expect(page.locator(".facing")).to_contain_text("z = 1.600 m")
    page.keyboard.press("PageDown")
    page.keyboard.press("[")
    expect(page.locator(".facing")).to_contain_text("z = 1.400 m")
    page.keyboard.press("-")
    expect(page.locator(".facing")).to_contain_text("5 cm thick")
    page.keyboard.press("v")
    expect(page.locator(".facing")).to_contain_text("Vertical")
    page.keyboard.press("c")
    expect(page.locator("#legend")).to_contain_text("Intensity")
    page.keyboard.press("?")
    expect(page.get_by_role("heading", name="Keys")).to_be_visible()
    page.keyboard.press("Escape")
    rested(page)
    address = page.url
    page.goto("about:blank")
    page.goto(address)

    expect(page.locator(".facing")).to_contain_text("Vertical")
    expect(page.locator(".facing")).to_contain_text("5 cm thick")


def test_a_drag_on_the_overview_makes_a_vertical_cut(server, page, screenshot):
    opened(page, server)
    above = page.locator("slice-above:not([aria-busy])")
    above.scroll_into_view_if_needed()
    box = above.bounding_box()
    middle = box["y"] + box["height"] / 2

    page.mouse.move(box["x"] + box["width"] * 0.3, middle)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] * 0.5, middle, steps=3)
    page.mouse.move(box["x"] + box["width"] * 0.7, middle, steps=3)
    page.mouse.up()

    expect(page.locator(".facing")).to_contain_text(re.compile(r"azimuth (89\.[5-9]|90\.[0-5])°"))
    rested(page)
    screenshot(page, "slices-vertical")


@looks("desktop dark", "phone light")
def test_a_distance_is_measured_between_two_points_of_the_map(server, page):
    opened(page, server, "?kind=horizontal&z=1.5&t=0.4&u=8&v=5&m=0.05")
    view = page.locator("slice-view").first
    box = view.bounding_box()
    to_px = lambda u, v: (  # noqa: E731
        box["x"] + box["width"] / 2 + (u - 8) / 0.05,
        box["y"] + box["height"] / 2 - (v - 5) / 0.05,
    )

    page.keyboard.press("m")
    page.mouse.click(*to_px(8.0, 0.0))
    expect(page.locator(".readout")).to_contain_text("x y z")
    page.mouse.click(*to_px(8.0, 10.0))

    reading = page.locator(".readout")
    expect(reading).to_contain_text("Distance")
    horizontal = float(re.search(r"horizontal ([\d.]+) m", reading.inner_text())[1])
    assert horizontal == pytest.approx(10.0, abs=0.5)


@one_look
def test_two_slices_stand_side_by_side_and_move_together(server, page, screenshot):
    opened(page, server, "?kind=horizontal&z=1.5")

    page.get_by_label("Map beside").select_option("project:earlier")
    second = page.locator("slice-view").nth(1)
    on_both_screens(page, lambda _: expect(second).to_be_visible())
    expect(page.locator(".caption.second")).to_contain_text("Project earlier")
    rested(page)
    screenshot(page, "slices-beside")
    page.get_by_role("button", name="Swipe").click()

    expect(page.get_by_label("Swipe between the two slices")).to_be_visible()
    frames = page.locator("slice-view").evaluate_all("views => views.map((view) => view.frame)")
    assert frames[0] == frames[1]


@looks("desktop light")
def test_no_double_wall_is_found_where_there_is_none(server, page):
    opened(page, server)

    page.get_by_text("Double walls", exact=True).click()
    page.get_by_role("button", name="Find double walls").click()

    expect(page.locator(".verdict")).to_contain_text(re.compile("No double wall|Not checked"))


@looks("desktop light")
def test_a_panel_that_is_opened_is_in_view_below_a_long_one(server, page):
    opened(page, server)
    for text in ("Control and check points", "Compare with a reference", "Export"):
        page.get_by_text(text, exact=True).first.click()
        panel = page.locator("#findings > details", has_text=text).first
        expect(panel).to_have_attribute("open", "")
        outer, inner = (one.bounding_box() for one in (page.locator("#findings"), panel))
        bottom = outer["y"] + outer["height"] + 1
        assert inner["y"] + inner["height"] <= bottom or inner["y"] <= outer["y"] + 1


@looks("desktop light")
@pytest.mark.study
def test_findings_are_those_of_the_map_that_is_shown(server, page):
    (server.root / "wall.xyz").write_text("\n".join(f"0 {y / 20} 1.5" for y in range(200)))
    opened(page, server, "?source=project:earlier&kind=horizontal&z=1.5")
    expect(page.locator(".caption").first).to_contain_text("Project earlier")

    page.get_by_text("Double walls", exact=True).click()
    with page.expect_request(re.compile("doubles.*source=project%3Aearlier")):
        page.get_by_role("button", name="Find double walls").click()
    expect(page.locator(".verdict")).to_be_visible()
    page.get_by_text("Compare with a reference").click()
    page.get_by_label("Path of the reference").fill(str(server.root / "wall.xyz"))
    page.get_by_role("button", name="Add reference").click()
    page.get_by_role("button", name="Use these columns").click()
    expect(page.locator("#legend")).to_contain_text("Distance to reference [cm]")
    with page.expect_request("**/compare") as asked:
        page.get_by_role("button", name="Compare", exact=True).click()
    expect(page.get_by_role("row", name=re.compile("Mean of all points"))).to_be_visible()
    page.get_by_role("button", name="Remove").click()
    expect(page.get_by_role("button", name="Remove")).to_have_count(0)

    assert asked.value.post_data_json["source"] == "project:earlier"


@one_look
def test_a_reference_is_compared_and_shown(server, page):
    path = server.root / "walls.xyz"
    rows = [
        f"{x} {y / 20:.2f} {z / 10:.1f}"
        for x in (0.03, 16.03)
        for y in range(200)
        for z in range(30)
    ]
    path.write_text("\n".join(rows))
    opened(page, server, "?kind=horizontal&z=1.5")

    page.get_by_text("Compare with a reference").click()
    page.get_by_label("Path of the reference").fill(str(path))
    page.get_by_role("button", name="Add reference").click()
    page.get_by_role("button", name="Use these columns").click()
    expect(page.locator("#legend")).to_contain_text("Distance to reference [cm]")
    page.get_by_label("Slices to compare").select_option("this")
    page.get_by_role("button", name="Compare", exact=True).click()

    expect(page.get_by_role("row", name=re.compile("Mean of all points"))).to_be_visible()
    expect(page.get_by_role("link", name="Download CSV")).to_be_visible()
    on_both_screens(page, fits)
    page.get_by_role("button", name="Remove").click()
    expect(page.get_by_role("button", name="Remove")).to_have_count(0)


@looks("phone light")
def test_an_invalid_reference_is_rejected_and_another_uploaded_and_shown(server, page):
    rows = "\n".join(f"0.03 {y / 20:.2f} {z / 10:.1f}" for y in range(200) for z in range(30))
    opened(page, server, "?kind=horizontal&z=1.5")

    page.get_by_text("Compare with a reference").click()
    note = {"name": "note.ply", "mimeType": "text/plain", "buffer": b"Dear Sir or Madam"}
    page.get_by_label("Reference file").set_input_files(note)
    expect(page.get_by_role("alert").filter(has_text="note.ply")).to_be_visible()
    expect(page.get_by_role("button", name="Upload file…")).to_be_enabled()
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Upload file…").click()
    late = []
    page.route("**/references/preview", lambda route: late.append(route), times=1)
    with page.expect_request("**/references/preview"):
        chooser.value.set_files(
            {"name": "sent.xyz", "mimeType": "text/plain", "buffer": rows.encode()}
        )
    expect(page.get_by_role("button", name="Add reference")).to_be_disabled()  # it is being added
    late.pop().continue_()
    page.get_by_role("button", name="Use these columns").click()

    expect(page.locator("#legend")).to_contain_text("Distance to reference [cm]")
    expect(page.locator(".reference-row")).to_contain_text(re.compile(r"6\s000 points"))
    expect(page.get_by_label("Upload of the reference")).to_be_hidden()
    page.get_by_role("button", name="Remove").click()
    expect(page.get_by_role("button", name="Remove")).to_have_count(0)


def test_tools_take_two_rows_at_most_and_are_large_enough_to_touch(server, page):
    opened(page, server, "?kind=horizontal&z=1.5&besideColor=time")

    tools = page.locator("#tools button, #tools select")
    boxes = [box for box in (one.bounding_box() for one in tools.all()) if box]

    assert len(boxes) == 11
    assert len({round(box["y"] / 20) for box in boxes}) <= 2
    assert min(box["height"] for box in boxes) >= 44
    assert min(box["width"] for box in boxes) >= 44
    fits(page)


@looks("desktop light")
def test_a_sheet_is_downloaded(server, page):
    opened(page, server, "?kind=horizontal&z=1.5")

    page.get_by_text("Export", exact=True).click()
    with page.expect_download() as download:
        page.get_by_role("link", name="SVG").click()

    assert download.value.suggested_filename == "office-slice.svg"
    assert download.value.path().stat().st_size > 5000


@looks("desktop light")
def test_a_slice_says_which_surface_it_shows(tmp_path, page):
    build_project(tmp_path / "office", points=60_000, strays=5)
    with server_thread(tmp_path) as running:
        opened(page, running, "?kind=horizontal&z=1.5&thickness=0.2")
        for said in ("on fitted surfaces", "as measured", "left out of the map"):
            image = page.get_by_role("img", name=re.compile(f"points {said}"))
            expect(image).to_be_visible()
            page.keyboard.press("r")
            rested(page)

        expect(page.get_by_role("img", name=re.compile("on fitted surfaces"))).to_be_visible()
