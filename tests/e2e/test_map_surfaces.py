"""Surfaces of the map at rest, as a person sees them from near."""

import io

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

from tests.e2e.conftest import looks
from tests.served import office, served

pytestmark = pytest.mark.e2e

FLOOR = "z=..0.02&color=plain&camera=8,5,0,30,-40,7"

server = served(office(points=60_000, normals=True))


@looks("desktop light")
@pytest.mark.parametrize("parallel", [0, 1])
def test_a_floor_seen_from_near_has_hardly_holes_and_no_steps(server, page, parallel):
    page.goto(f"{server.url}/projects/office/map/?{FLOOR},{parallel}")
    expect(page.locator("#status .shown")).to_have_text("60 000 of 60 000 points")
    png = page.locator("#map").screenshot()
    image = np.asarray(Image.open(io.BytesIO(png)).convert("L")).astype(float)
    floor = image[300:600, 300:900]  # beside bars and panel
    # As squares 8 to 11 % of it are holes; circles of randomly placed points leave 1 % open.
    assert (np.abs(floor - np.median(floor)) > 25).mean() < 0.025
    beside = np.abs(np.diff(floor, axis=1))
    assert (beside > 3).mean() < 0.02  # edges of squares


@looks("desktop light")
def test_the_first_image_is_drawn_before_the_other_scripts_of_the_page_have_come(server, page):
    late = []
    page.route("**/map/map.js", lambda route: late.append(route))
    page.goto(f"{server.url}/projects/office/map/?{FLOOR},0", wait_until="commit")
    expect(page.locator("#opening")).to_be_hidden()
    image = Image.open(io.BytesIO(page.locator("#map").screenshot())).convert("L")
    ground, floor = np.percentile(np.asarray(image), [99, 1])
    assert ground > 200 and floor < 200
    before = page.locator("#map").bounding_box()
    assert page.locator("#bar button").count() == 0

    late[0].continue_()
    expect(page.locator("#status .shown")).to_have_text("60 000 of 60 000 points")
    assert page.locator("#map").bounding_box() == before
