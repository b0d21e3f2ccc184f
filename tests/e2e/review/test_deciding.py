"""Loop closures decided by keyboard, mouse and touch; a new map made, approved, exported."""

import json

import pytest
from playwright.sync_api import expect

from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, broken, read_rows
from tests.e2e.conftest import looks
from tests.e2e.review.review_page import (
    PRESSES,
    colored,
    decidable,
    fits,
    only_one_decision,
    page_fits,
    settled,
)

pytestmark = pytest.mark.e2e


@looks("desktop light")
@pytest.mark.study
def test_forty_loops_are_reviewed_without_the_mouse(opened, root):
    page = opened

    page.get_by_label("Go on to the next pair after a decision").check()
    page.keyboard.press("j")
    for k in range(40):
        decidable(page)
        page.wait_for_timeout(300)  # a key that comes again at once counts as held down
        page.keyboard.press("r" if k < 2 else "a")

    expect(page.locator("review-queue")).to_contain_text("40 decided by people")
    rows = read_rows(root)
    assert [row.kind for row in rows] == ["reject"] * 2 + ["accept"] * 38
    assert len({(row.frame_i, row.frame_j) for row in rows}) == 40
    assert broken(rows) == []
    expect(page.locator("#effect")).not_to_contain_text("solving")
    expect(page.locator("#effect")).to_contain_text("Chi-square")
    for _ in range(3):
        page.keyboard.press("Control+z")
    expect(page.locator("review-queue")).to_contain_text("37 decided by people")
    page.keyboard.press("Control+y")
    expect(page.locator("review-queue")).to_contain_text("38 decided by people")


def hold(page, key):
    """Presses a key once; the next 39 are repeats, as of a key held down."""
    for _ in range(40):
        page.keyboard.down(key)
    page.keyboard.up(key)


def hold_the_focused_button(page, key):
    page.locator("#decision").get_by_role("button", name=BUTTONS[key]).focus()
    hold(page, "Enter")


def click_twice(page, key):
    """The pair that follows is drawn already."""
    for step in ("j", "k"):
        page.keyboard.press(step)
        decidable(page)
    page.locator("#decision").get_by_role("button", name=BUTTONS[key]).dblclick(delay=0)


def press_as_a_remote_desktop(page, key):
    page.evaluate(PRESSES, key)


BUTTONS = {"a": "Accept", "r": "Reject"}
WAYS = [
    *((hold, key, onwards) for key in BUTTONS for onwards in (False, True)),
    *((press_as_a_remote_desktop, key, True) for key in BUTTONS),
    (click_twice, "a", True),
    (hold_the_focused_button, "a", True),
]
"""Ways to decide more often than meant: what is done, its key, whether the page goes on."""


@looks("desktop light")
@pytest.mark.study
def test_whatever_is_held_or_pressed_again_decides_about_one_pair(opened, root):
    page = opened
    for done, (decide, key, onwards) in enumerate(WAYS):
        page.get_by_label("Go on to the next pair after a decision").set_checked(onwards)
        page.keyboard.press("j")
        decidable(page)

        decide(page, key)

        only_one_decision(page, root, key, before=2 * done)


@looks("desktop light")
def test_nothing_is_decided_before_the_points_are_drawn(opened, root):
    page = opened
    held = []

    def hold_first(route):
        route.continue_() if held else held.append(route)

    page.route("**/review/points?**", hold_first)
    page.reload()  # requests of a loaded page may pass right after Chromium began to intercept
    expect(page.locator(".queue li").first).to_be_visible()

    with page.expect_request("**/review/points?**"):
        page.keyboard.press("j")
    expect(page.locator(".view-empty")).to_have_text("Reading points…")
    for key in ("a", "r", "Enter"):
        page.keyboard.press(key)
    expect(page.locator("#decision").get_by_role("button", name="Accept")).to_be_disabled()
    (route,) = held
    route.continue_()
    decidable(page)

    assert read_rows(root) == []
    page.keyboard.press("a")
    expect(page.locator("review-queue")).to_contain_text("1 decided by people")


@looks("desktop light")
def test_after_a_decision_keys_do_nothing_until_another_pair_is_drawn(opened, root):
    page = opened
    page.keyboard.press("j")
    decidable(page)

    for key in ("a", "a", "r", "a"):
        page.keyboard.press(key)
    expect(page.locator("#said")).to_contain_text("Next (J) shows the next pair")
    page.keyboard.press("Control+z")
    decidable(page)
    page.keyboard.press("r")
    page.keyboard.press("j")
    decidable(page)
    page.keyboard.press("a")

    expect(page.locator("review-queue")).to_contain_text("2 decided by people")
    rows = read_rows(root)
    assert [row.kind for row in rows] == ["accept", "undo", "reject", "accept"]
    assert rows[2].frame_i != rows[3].frame_i or rows[2].frame_j != rows[3].frame_j


@looks("desktop light")
def test_keys_are_listed_and_going_on_after_a_decision_is_off_at_first(opened, screenshot):
    page = opened
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_contain_text("Undo")
    screenshot(page, "review-keys")
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)

    onwards = page.get_by_label("Go on to the next pair after a decision")
    expect(onwards).not_to_be_checked()

    onwards.check()
    page.reload()
    expect(onwards).to_be_checked()  # it is remembered


def test_the_page_shows_the_effect_of_a_decision(opened, look, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    expect(page.locator("#pair")).to_contain_text(
        "Rejected automatically: outlier in the robust solution"
    )
    red, green, _ = colored(page)
    assert min(red, green) > 500
    fits(page)
    screenshot(page, "review")

    page.keyboard.press("a")

    expect(page.locator("#effect")).to_contain_text("Accepted, but does not fit")
    expect(page.locator("#effect")).to_contain_text("Largest moves of the last decision")
    expect(page.locator("#signing")).to_contain_text("decisions are not in the map")
    expect(page.get_by_role("button", name="Approve map…")).to_be_disabled()
    fits(page)
    screenshot(page, "review-effect")


@looks("desktop dark")
@pytest.mark.study
def test_the_page_shows_who_judged_a_pair_in_order(opened, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    history = page.locator("#pair .history li")
    expect(history).to_contain_text(["search accepted", "robust solve rejected"])
    expect(history.last).to_contain_text("outlier in the robust solution; squared residual")

    page.get_by_label("Reason", exact=True).fill("the same door")
    page.locator("#decision").get_by_role("button", name="Accept").click()

    expect(history.last).to_have_text("local accepted the same door (not in the map yet)")
    fits(page)
    page.get_by_role("button", name="Rebuild map").click()
    made = page.locator("#signing")
    expect(made).to_contain_text("was made with these decisions", timeout=120_000)
    expect(history.last).to_have_text("local accepted the same door")
    expect(history).to_have_count(3)
    screenshot(page, "review-history")


@looks("desktop light")
def test_what_leads_on_fits_what_the_filters_list(opened):
    page, next_pair = opened, opened.locator("#decision").get_by_role("button", name="Next")
    pair, empty = page.locator("#pair"), page.locator(".view-empty")

    page.get_by_label("Which pairs").select_option("later")

    for place in (pair, empty):
        expect(place).to_contain_text("No pair matches the filters of the list")
    expect(next_pair).to_be_disabled()
    page.get_by_label("Which pairs").select_option("loops")
    for place in (pair, empty):
        expect(place).to_contain_text("Next (J) shows the first pair")
    expect(next_pair).to_be_enabled()


@looks("phone dark")
def test_decisions_of_others_appear_without_a_click(opened, root):
    page = opened

    append(root, Decision(kind=DecisionKind.REJECT, who="Eva", why="glass", pair=(17, 77)))

    expect(page.locator("#news")).to_have_text("Meanwhile Eva rejected multiframes 17 and 77")
    expect(page.locator("review-queue")).to_contain_text("1 decided by people")
    page.get_by_role("button", name="Undo").click()
    expect(page.locator("review-queue")).to_contain_text("0 decided by people")
    expect(page.locator("#news")).to_be_empty()


@looks("phone dark")
def test_a_refused_decision_goes_on_saying_who_decided_meanwhile(opened, root):
    page = opened
    page.keyboard.press("j")
    settled(page)
    words = page.locator("#pair h2").text_content().split()
    pair = tuple(int(word) for word in words if word.isdigit())

    unheard = "**/api/projects/*/review"
    page.route(unheard, lambda route: route.abort())
    append(root, Decision(kind=DecisionKind.REJECT, who="Eva", pair=pair))
    page.keyboard.press("a")
    expect(page.locator("#message")).to_contain_text("Eva")

    page.unroute(unheard)
    append(root, Decision(kind=DecisionKind.REJECT, who="Eva", pair=(17, 77)))
    expect(page.locator("#effect")).to_contain_text("Chi-square")
    expect(page.locator("#message")).to_contain_text("Eva")
    accept = page.locator("#decision").get_by_role("button", name="Accept")
    page.route("**/api/**", lambda route: route.abort())
    accept.click()  # the same key so soon would count as held down
    expect(page.locator("#message")).to_contain_text("does not answer")
    expect(page.locator("#said")).not_to_contain_text("Decided")  # it was not
    expect(accept).to_be_enabled()


@looks("desktop dark")
def test_decide_make_a_new_map_approve_export(opened, root, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    page.keyboard.press("r")
    expect(page.locator("#signing")).to_contain_text("decisions are not in the map")

    page.get_by_role("button", name="Rebuild map").click()
    signing = page.locator("#signing")
    expect(signing).to_contain_text("was made with these decisions", timeout=120_000)
    page.get_by_role("button", name="Approve map…").click()
    page.get_by_label("Remark").fill("compared with the plan")
    page.get_by_role("button", name="Sign").click()

    expect(page.locator("#signing")).to_contain_text("✓ Approved v1 · local · ")
    page.get_by_text("Journal", exact=True).click()
    expect(page.locator("#journal")).to_contain_text("approved the map")
    screenshot(page, "review-approved")
    approval = json.loads((root / "versions" / "1" / "approval.json").read_text())
    with page.expect_popup() as report:
        page.evaluate(f"open('/api/projects/{root.name}/report')")
    expect(report.value.get_by_text("Version 1, approved by local")).to_be_visible()
    expect(report.value.get_by_text(approval["hash"])).to_be_visible()


@pytest.mark.study
@looks("desktop light")
def test_two_people_share_a_pair(opened, root, screenshot):
    page = opened
    page.keyboard.press("j")
    settled(page)
    frames = [
        int(word) for word in page.locator("#pair h2").text_content().split() if word.isdigit()
    ]
    append(root, Decision(kind=DecisionKind.REJECT, who="rita", pair=tuple(frames)))
    team = page.locator("#team")
    expect(team.locator(".agreement")).to_have_text("rita rejected it")

    team.get_by_label("Assigned to").select_option("local")
    team.get_by_label("Comment").fill("Glass on both sides: look at the door")
    team.get_by_role("button", name="Comment").click()
    team.get_by_role("button", name="Ask for a second opinion").click()

    expect(team.locator("q")).to_have_text("Glass on both sides: look at the door")
    expect(team.locator(".agreement")).to_contain_text("local asked for a second opinion")
    row = page.locator('.queue li[aria-current="true"]')
    expect(row).to_contain_text("→ local · second opinion · ✎ 1")
    expect(page.locator("#approve")).to_be_disabled()
    screenshot(page, "review-team")
    page_fits(page)
    page.keyboard.press("r")
    expect(team.locator(".agreement")).to_have_text("✓ rita and local agree: rejected")
    page.keyboard.press("s")
    expect(page.locator(".queue li").first).to_contain_text("later")
    page.get_by_label("Which pairs").select_option("later")
    expect(page.locator(".queue li")).to_have_count(1)
