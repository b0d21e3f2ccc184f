"""Tables on the page of slices: shown before use, asked where their columns are not certain."""

import re

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import looks, on_both_screens, one_look
from tests.e2e.test_pages import fits
from tests.served import office, served

pytestmark = pytest.mark.e2e


server = served(office(points=60_000))


def wall(template: str) -> str:
    places = [(0.03, y / 20, z / 10) for y in range(200) for z in range(30)]
    rows = (template.format(k=k, x=x, y=y, z=z) for k, (x, y, z) in enumerate(places))
    return "\n".join(rows)


def add(server, page, text: str) -> None:
    path = server.root / "survey.csv"
    path.write_text(text)
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=1.5")
    page.get_by_text("Compare with a reference").click()
    page.get_by_label("Path of the reference").fill(str(path))
    page.get_by_role("button", name="Add reference").click()


@one_look
def test_a_reference_without_names_is_asked_for_its_columns(server, page, screenshot):
    add(server, page, wall("{k};{y};{x};{z}"))

    question = page.get_by_role("alert").filter(has_text="the first one is like a point number")
    expect(question).to_be_visible()
    expect(page.get_by_role("cell", name="0.03").first).to_be_visible()
    expect(page.get_by_label("Meaning of column 1")).to_have_value("id")
    page.get_by_label("Meaning of column 2").select_option("y")
    expect(question).to_have_count(0)
    expect(page.get_by_role("button", name="Use these columns")).to_be_disabled()
    page.get_by_label("Meaning of column 3").select_option("x")
    expect(page.locator(".table-columns")).to_contain_text(
        "x (east) = column 3, y (north) = column 2"
    )
    on_both_screens(page, fits)
    page.get_by_role("button", name="Use these columns").scroll_into_view_if_needed()
    screenshot(page, "slices-columns")
    page.get_by_role("button", name="Use these columns").click()

    expect(page.locator("#legend")).to_contain_text("Distance to reference [cm]")
    expect(page.locator(".reference-row")).to_contain_text("x (east) = column 3")
    page.get_by_role("button", name="Remove").click()
    expect(page.get_by_role("button", name="Remove")).to_have_count(0)


@looks("desktop light")
def test_named_columns_are_shown_before_they_are_used(server, page):
    add(server, page, "Punkt;Hochwert;Rechtswert;Höhe\n" + wall("{k};{y};{x};{z}"))

    expect(page.locator(".table-columns")).to_contain_text(
        "x (east) = Rechtswert, y (north) = Hochwert"
    )
    page.get_by_role("button", name="Use these columns").click()

    expect(page.locator(".reference-row")).to_contain_text(re.compile(r"6\s000 points"))
    expect(page.locator(".reference-row")).to_contain_text("x (east) = Rechtswert")
    page.get_by_role("button", name="Remove").click()
    expect(page.get_by_role("button", name="Remove")).to_have_count(0)


@looks("desktop light")
@pytest.mark.study
def test_a_reference_as_large_as_one_in_millimeters_is_asked_for_its_unit(server, page):
    body = "\n".join(
        f"{x} {y * 500} {z * 300}" for x in (0, 9000) for y in range(20) for z in (0, 9)
    )
    add(server, page, "x y z\n" + body)
    page.get_by_role("button", name="Use these columns").click()

    expect(page.get_by_role("alert").filter(has_text="It states no unit")).to_be_visible()
    page.get_by_label("Unit of the coordinates").select_option("mm")
    page.get_by_role("button", name="Use these columns").click()

    expect(page.locator(".reference-row")).to_contain_text("millimeters")
    page.get_by_role("button", name="Remove").click()
    expect(page.get_by_role("button", name="Remove")).to_have_count(0)
