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

COMPILED = """async () => {
  await import(document.querySelector("script[src*='drawer.js']").src);
  const gl = document.querySelector("#map").getContext("webgl2");
  return gl.getParameter(gl.CURRENT_PROGRAM) !== null;
}"""
"""Whether the script that compiles shaders has drawn with them, when it has run."""

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
def test_shaders_are_compiled_before_the_scripts_of_the_page_have_come(server, page):
    late = []
    page.route("**/map/map.js", lambda route: late.append(route))
    page.goto(f"{server.url}/projects/office/map/?{FLOOR},0", wait_until="commit")
    page.wait_for_selector("script[src*='drawer.js']", state="attached")
    assert page.evaluate(COMPILED)
    image = Image.open(io.BytesIO(page.locator("#map").screenshot())).convert("L")
    assert np.median(np.asarray(image)) > 200  # not black

    late[0].continue_()
    expect(page.locator("#status .shown")).to_have_text("60 000 of 60 000 points")
