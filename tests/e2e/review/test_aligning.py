"""Places of a loop closure compared and aligned on the review page."""

import pytest
from playwright.sync_api import expect

from recon4.review.journal import read_rows
from tests.e2e.conftest import first_of, looks, one_look
from tests.e2e.review.review_page import colored, nearest_pixel, settled

pytestmark = pytest.mark.e2e


@looks("phone light")
def test_views_and_comparison_show_different_images(opened):
    page = opened
    page.keyboard.press("j")
    settled(page)
    seen = {tuple(colored(page))}

    for name in ("Side", "Free", "Cut", "Graph", "Odometry"):
        page.get_by_role("button", name=name, exact=True).click()
        page.wait_for_timeout(200)
        seen.add(tuple(colored(page)))

    assert len(seen) == 6
    page.get_by_label("Upright cut").check()
    for _ in range(4):
        page.keyboard.press("]")
    expect(page.locator(".view-words")).to_contain_text("at 0.20 m")


@one_look
def test_the_difference_colors_only_what_one_place_has_alone(opened, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    words = page.locator(".view-words")
    over_each_other = colored(page)

    page.keyboard.press("d")
    expect(words).to_contain_text("% of what is drawn agrees within 5 cm")
    screenshot(page, "review-difference")
    alone = colored(page)
    page.get_by_role("button", name="Difference").click()
    expect(words).to_be_empty()

    assert colored(page) == over_each_other
    assert alone[2] < over_each_other[2]  # what agrees is gray; the handle stays white
    assert 0 < alone[0] + alone[1] < over_each_other[0] + over_each_other[1]


@looks("desktop dark")
def test_a_wrong_loop_closure_is_aligned_by_keys_and_becomes_an_edge(opened, root, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    _, _, before = colored(page)

    for _ in range(8):
        page.keyboard.press("ArrowDown")
    expect(page.locator("#said")).to_have_text("Moved by hand. Enter refines from here")
    page.keyboard.press("Enter")
    expect(page.locator("#said")).to_contain_text("Enter creates the edge")
    page.wait_for_timeout(200)
    screenshot(page, "review-aligned")
    _, _, after = colored(page)
    page.keyboard.press("w")
    page.keyboard.type("was off by half a meter")
    page.keyboard.press("Escape")
    page.keyboard.press("Enter")

    expect(page.locator("review-queue")).to_contain_text("1 decided by people")
    (row,) = read_rows(root)
    assert (row.kind, row.why) == ("replace", "was off by half a meter")
    assert row.decision().measurement.error_m < 0.03
    assert after > 1.5 * before
    expect(page.locator("#effect")).to_contain_text("Chi-square")
    expect(page.locator("#effect .bad")).to_have_count(0)


@looks("desktop light")
def test_a_place_is_dragged_turned_and_dropped_again(opened):
    page = opened
    page.keyboard.press("j")
    settled(page)
    box = page.locator(".view-stage canvas").bounding_box()
    before = page.evaluate("document.querySelector('pair-view').pose")
    at = page.evaluate(
        """() => { const view = document.querySelector('pair-view');
        const p = view.pose; return view.on(p); }"""
    )
    x, y = box["x"] + at[0], box["y"] + at[1]

    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 40, y - 20, steps=4)
    page.mouse.up()
    moved = page.evaluate("document.querySelector('pair-view').pose")
    page.mouse.move(x + 40 + 66, y - 20)
    page.mouse.down()
    page.mouse.move(x + 40 + 60, y - 20 - 25, steps=4)
    page.mouse.up()
    turned = page.evaluate("document.querySelector('pair-view').pose")
    page.keyboard.press("Escape")

    assert sum(abs(a - b) for a, b in zip(before[:3], moved[:3], strict=True)) > 0.1
    assert before[3:] == pytest.approx(moved[3:])
    assert moved[:3] == pytest.approx(turned[:3])
    assert abs(sum(a * b for a, b in zip(moved[3:], turned[3:], strict=True))) < 0.995
    assert page.evaluate("document.querySelector('pair-view').pose") == pytest.approx(before)


@looks("desktop light")
def test_three_picked_pairs_align_the_second_place(opened):
    page = opened
    page.keyboard.press("j")
    settled(page)
    page.keyboard.press("p")
    box = page.locator(".view-stage canvas").bounding_box()
    said = page.locator(".view-words")

    expect(said).to_contain_text("point 1 of 3 in the first (blue)")
    for dx, dy in ((-150, -120), (150, -120), (0, 130)):
        for color in ("first", "second"):
            u, v = nearest_pixel(page, color, box["width"] / 2 + dx, box["height"] / 2 + dy)
            page.mouse.click(box["x"] + u, box["y"] + v)

    expect(page.locator("#said")).to_have_text("Moved by hand. Enter refines from here")


@first_of("desktop dark", "phone light")
def test_a_loop_closure_is_added_between_two_multiframes(opened, root, screenshot):
    page = opened

    page.get_by_role("button", name="Add loop").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("multiframe 119")
    screenshot(page, "review-moments")
    page.get_by_label("Second multiframe (orange)").fill("62")
    page.get_by_label("First multiframe (blue)").fill("31")
    page.get_by_role("button", name="Look at this pair").click()
    settled(page)
    expect(page.locator("#pair")).to_contain_text("Multiframes 31 and 62")
    expect(page.locator("#decision").get_by_role("button", name="Accept")).to_be_disabled()
    page.get_by_role("button", name="Refine").click()
    page.get_by_role("button", name="Create edge").click()

    expect(page.locator("review-queue")).to_contain_text("1 decided by people")
    (row,) = read_rows(root)
    assert (row.kind, row.frame_i, row.frame_j) == ("add", 31, 62)
