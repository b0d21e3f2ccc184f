"""A reference that does not lie on the map is found and aligned by pairs, in a real browser."""

import re

import numpy as np
import pytest
from playwright.sync_api import expect

from recon4.geometry.se3 import SE3
from tests.e2e.conftest import on_both_screens, one_look
from tests.e2e.test_pages import fits
from tests.project_builder import build_project, room_points
from tests.served import served

pytestmark = pytest.mark.e2e

TURNED = SE3.from_rpy(0.0, 0.0, np.pi / 2, t=[13.0, -3.0, 0.1])
CORNERS_M = [(0.0, 0.0), (16.0, 0.0), (16.0, 10.0)]
CLICK = """(view, p) => {
  const canvas = view.querySelector("canvas").getBoundingClientRect();
  const [u, v] = view.on(p);
  return [canvas.x + u, canvas.y + v];
}"""


def projects(root):
    build_project(root / "office", points=40_000, normals=True)
    np.savetxt(root / "turned.xyz", TURNED @ room_points(np.random.default_rng(5), 15_000))


server = served(projects)


@one_look
@pytest.mark.study
def test_a_turned_reference_is_found_and_aligned_by_three_pairs(server, page, screenshot):
    page.goto(f"{server.url}/projects/office/slices/?kind=horizontal&z=1.5")
    expect(page.locator(".facing strong")).to_be_visible()
    page.get_by_text("Compare with a reference").click()
    page.get_by_label("Path of the reference").fill(str(server.root / "turned.xyz"))
    page.get_by_role("button", name="Add reference").click()
    page.get_by_role("button", name="Use these columns").click()
    expect(page.locator("#legend")).to_contain_text("Distance to reference [cm]")

    page.get_by_role("button", name="Compare", exact=True).click()
    expect(page.locator(".verdict.bad")).to_contain_text("does not fit")
    expect(page.locator("table.unfit")).to_be_visible()
    page.get_by_role("button", name="Align by ICP").click()
    expect(page.get_by_role("alert").filter(has_text="use Align by pairs")).to_be_visible()

    page.get_by_role("button", name="Align by pairs").click()
    dialog = page.get_by_role("dialog", name=re.compile("Align turned.xyz"))
    view = dialog.locator("pair-view")
    button = dialog.get_by_role("button", name="Pick three pairs")
    expect(dialog.get_by_label("Position of the cut")).to_be_visible()
    button.click()
    for k, (x, y) in enumerate(CORNERS_M, start=1):
        for text, at in (
            (f"Pick point {k} of 3 in the map (blue)", np.array([x, y, 1.5])),
            (f"Pick point {k} of 3 in the reference (orange)", TURNED @ np.array([x, y, 1.5])),
        ):
            expect(dialog.get_by_text(text)).to_be_visible()
            middle = np.array([8.0, 5.0, 1.5])
            place = view.evaluate(CLICK, (at - middle).tolist())
            page.mouse.click(*place)

    result = dialog.get_by_text("3 pairs, largest residual")
    expect(result).to_contain_text("✓ The reference fits")
    on_both_screens(page, fits)
    screenshot(page, "slices-align")
    dialog.get_by_role("button", name="Close").click()
    expect(page.locator(".reference-row")).to_contain_text("✓ The reference fits")
    page.get_by_role("button", name="Compare", exact=True).click()
    expect(page.locator(".verdict.good")).to_contain_text("The reference fits")
    expect(page.get_by_role("img", name="Histogram of the signed distances")).to_be_visible()
    on_both_screens(page, fits)
    page.get_by_role("link", name="Download CSV").scroll_into_view_if_needed()
    screenshot(page, "slices-reference")

    page.get_by_role("button", name="Undo alignment").click()
    expect(page.locator(".reference-row")).to_contain_text("alignment: none")
    page.get_by_role("button", name="Remove").click()
    expect(page.get_by_role("button", name="Remove")).to_have_count(0)
