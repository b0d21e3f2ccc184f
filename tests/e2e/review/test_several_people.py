"""Several people on one pair: nothing that a person decided or typed is lost."""

import pytest
from playwright.sync_api import expect

from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from tests.e2e.conftest import looks
from tests.e2e.review.review_page import decidable, settled

pytestmark = pytest.mark.e2e


def selected(page):
    """The multiframes of the selected pair."""
    words = page.locator("#pair h2").text_content().split()
    return tuple(int(word) for word in words if word.isdigit())


@looks("desktop light")
def test_what_another_person_decides_about_ones_pair_can_be_decided_again(opened, root):
    page = opened
    page.keyboard.press("j")
    settled(page)
    page.keyboard.press("r")
    expect(page.locator("#said")).to_contain_text("Decided")
    expect(page.locator("#signing")).to_contain_text("decisions are not in the map")  # stored

    for kind in (DecisionKind.SECOND, DecisionKind.ACCEPT):
        append(root, Decision(kind=kind, who="Eva", pair=selected(page)), seen_seq=1)

    expect(page.locator("#news")).to_contain_text("Meanwhile Eva accepted")
    expect(page.locator("#said")).not_to_contain_text("Decided")
    decidable(page)
    page.keyboard.press("a")
    expect(page.locator("#team .agreement")).to_have_text("✓ Eva and local agree: accepted")


@looks("desktop light")
def test_what_was_typed_about_a_pair_stays_with_it_also_where_it_was_refused(opened):
    page = opened
    reason, comment = (
        page.get_by_role("textbox", name="Reason"),
        page.locator("#team").get_by_label("Comment"),
    )
    rows = page.locator(".queue li")
    rows.nth(0).click()
    settled(page)
    reason.fill("glass on both sides")
    comment.fill("look at the door")

    rows.nth(1).click()
    settled(page)
    expect(reason).to_have_value("")
    expect(comment).to_have_value("")

    rows.nth(0).click()
    expect(reason).to_have_value("glass on both sides")
    expect(comment).to_have_value("look at the door")
    settled(page)
    page.route("**/api/projects/*/review/**", lambda route: route.abort())

    page.locator("#decision").get_by_role("button", name="Reject").click()
    expect(page.locator("#message")).to_contain_text("does not answer")
    expect(reason).to_have_value("glass on both sides")
    comment.press("Enter")
    expect(comment).to_have_value("look at the door")
    page.get_by_label("Assigned to").select_option("local")
    expect(page.get_by_label("Assigned to")).to_have_value("")


@looks("desktop light")
def test_a_map_that_was_changed_while_its_dialog_was_open_is_signed_once_it_is_shown(opened, root):
    page = opened
    page.keyboard.press("j")
    settled(page)
    page.get_by_role("button", name="Approve map…").click()
    page.get_by_label("Remark").fill("compared with the plan")
    comment = Decision(kind=DecisionKind.COMMENT, who="Eva", pair=selected(page), why="a door")
    append(root, comment, seen_seq=0)

    page.get_by_role("button", name="Sign").click()
    expect(page.get_by_role("dialog")).to_contain_text("was changed since it was looked at")
    expect(page.get_by_label("Remark")).to_have_value("compared with the plan")
    page.get_by_role("button", name="Sign").click()

    expect(page.locator("#signing")).to_contain_text("✓ Approved v1 · local · ")
