"""Control and check points on the page of slices, in a real browser."""

import re

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import looks, on_both_screens, one_look
from tests.e2e.test_pages import fits
from tests.served import office, served

pytestmark = pytest.mark.e2e


server = served(office(points=120_000))


def opened(page, server, query=""):
    page.goto(f"{server.url}/projects/office/slices/{query}")
    expect(page.locator(".facing strong")).to_be_visible()
    expect(page.locator("body.drawing")).to_have_count(0)


def choose_survey(page, data):
    """Open the control points and choose a survey file with these bytes."""
    page.get_by_text("Control and check points").click()
    survey = {"name": "p.csv", "mimeType": "text/csv", "buffer": data}
    page.get_by_label("Survey file").set_input_files(survey)


@one_look
def test_a_survey_is_imported_checked_and_exported(server, page, screenshot):
    opened(page, server)

    choose_survey(page, b"ID;X;Y;Z\nA;0,02;5;1,5\nB;16,01;4;1,2\nC;8;0,15;1,4\nD;8;5;20\n")
    expect(page.get_by_text("is 0.02 the easting")).to_be_visible()
    page.get_by_role("button", name=re.compile("^Use ")).click()
    expect(page.locator(".verdict")).to_contain_text("– No verdict: no point is measured")
    expect(page.locator(".verdict")).to_contain_text("4 more not measured")
    page.get_by_role("button", name="A on the nearest surface").click()
    row = page.get_by_role("row", name=re.compile("^A "))
    expect(row.get_by_role("cell")).to_contain_text(["check", "-2.0", "–", "–", "–", "–", "-2.0"])
    page.get_by_role("button", name="All on the nearest surface").click()

    expect(
        page.get_by_role("alert").filter(has_text="No flat surface within 30 cm of D")
    ).to_be_visible()
    expect(page.locator(".verdict")).to_contain_text("– No verdict at the check points")
    expect(page.get_by_role("row", name="mean height")).to_contain_text("– not measured")
    expect(page.get_by_text(re.compile(r"RMSE \(points\) E 1.6 \(2\)"))).to_be_visible()
    page.get_by_text("Limits: mean 14 cm").click()
    page.get_by_label("Mean height [cm]").fill("3")
    page.get_by_label("Distances between points [cm]").fill("")
    page.get_by_role("button", name="Set limits").click()
    expect(
        page.get_by_text(
            "distances not required; σ of survey and picking 1 cm (limits of this job)"
        )
    ).to_be_visible()
    expect(page.get_by_role("row", name="mean height")).to_contain_text("≤ 3.0")
    on_both_screens(page, fits)
    page.locator(".verdict").scroll_into_view_if_needed()
    screenshot(page, "slices-control")
    with page.expect_popup() as sheet:
        page.get_by_role("link", name="Sheet to print and sign").click()
    expect(sheet.value.get_by_text("– No verdict at the check points")).to_be_visible()
    expect(sheet.value.get_by_text("mean 14 cm horizontal, 3 cm height")).to_be_visible()
    page.get_by_role("button", name="Clear A", exact=True).click()
    expect(page.locator(".verdict")).to_contain_text("2 more not measured")
    page.get_by_role("button", name="Usual limits").click()  # the form is still open
    expect(page.get_by_text("(usual limits)")).to_be_visible()


@looks("desktop light")
def test_a_plan_and_a_section_measure_a_point_in_all_components(server, page):
    opened(page, server, "?kind=horizontal&z=1.5&t=0.4&u=8&v=5&m=0.05")
    choose_survey(page, b"ID;E;N;Z\nA;8;0,03;1,5\n")
    page.get_by_role("button", name=re.compile("^Use ")).click()
    cells = page.get_by_role("row", name=re.compile("^A ")).get_by_role("cell")

    def picked(u, v):
        page.locator("slice-view").first.scroll_into_view_if_needed()
        box = page.locator("slice-view").first.bounding_box()
        page.mouse.click(
            box["x"] + box["width"] / 2 + (u[0] - u[1]) / 0.05,
            box["y"] + box["height"] / 2 - (v[0] - v[1]) / 0.05,
        )
        expect(page.locator(".readout")).to_contain_text("x y z")
        page.get_by_role("button", name="A is the picked point").click()

    picked((8, 8), (0, 5))
    expect(cells.nth(3)).to_have_text("–")
    expect(cells.nth(1)).not_to_have_text("–")
    page.keyboard.press("Escape")
    opened(page, server, "?kind=vertical&a=0,0&b=16,0&t=0.2&u=8&v=1.5&m=0.05")
    page.get_by_text("Control and check points").click()
    picked((8, 8), (1.5, 1.5))

    for column in range(1, 6):
        expect(cells.nth(column)).to_have_text(re.compile(r"^-?\d"))


@looks("desktop light")
def test_a_survey_with_heights_above_sea_level_is_explained(server, page, screenshot):
    opened(page, server)

    choose_survey(page, b"ID;E;N;Z\nA;0,02;5;-42,7\nB;16,01;4;-43,0\n")
    page.get_by_role("button", name=re.compile("^Use ")).click()

    hint = page.get_by_text("All 2 points of the survey are below the map by")
    expect(hint).to_contain_text("heights above sea level (orthometric)")
    hint.scroll_into_view_if_needed()
    fits(page)
    screenshot(page, "slices-other-heights")


@looks("desktop dark")
@pytest.mark.study
def test_two_tabs_measure_control_points_and_neither_overwrites_the_other(server, page):
    opened(page, server, "?kind=horizontal&z=1.5")
    other = page.context.new_page()  # its browser complains of the 409
    choose_survey(page, b"ID;X;Y;Z\nA;0,02;5;1,5\nB;16,01;4;1,2\n")
    page.get_by_role("button", name=re.compile("^Use ")).click()
    expect(page.locator(".verdict")).to_contain_text("2 more not measured")
    opened(other, server, "?kind=horizontal&z=1.5")
    other.get_by_text("Control and check points").click()
    expect(other.locator(".verdict")).to_contain_text("2 more not measured")

    page.get_by_role("button", name="A on the nearest surface").click()
    expect(page.locator(".verdict")).to_contain_text("1 more not measured")
    other.get_by_role("button", name="B on the nearest surface").click()

    expect(other.locator(".verdict")).not_to_contain_text("more not measured")
    expect(other.get_by_role("row", name=re.compile("^A "))).to_contain_text("-2.0")
    other.close()


@looks("desktop light")
def test_a_survey_that_is_being_read_is_named_until_it_is_shown(server, page):
    held = []
    page.route("**/control/preview", lambda route: held.append(route))
    opened(page, server)

    with page.expect_request("**/control/preview"):
        choose_survey(page, b"ID;X;Y;Z\nA;0,02;5;1,5\n")
    read = page.get_by_text("p.csv is being read")
    expect(read).to_be_visible()
    held[0].continue_()

    expect(page.get_by_text("is 0.02 the easting")).to_be_visible()
    expect(read).to_have_count(0)
