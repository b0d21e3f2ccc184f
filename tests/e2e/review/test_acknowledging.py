"""The findings of a run in the bar of the review, and in the dialog that signs the map."""

import json

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import looks

pytestmark = pytest.mark.e2e


@looks("desktop light")
def test_a_note_of_the_bar_is_in_the_dialog_that_signs_without_a_field_for_another(root, opened):
    findings = json.loads((root / "summary.json").read_text())["findings"]
    finding = next(one for one in findings if one["level"] != "good")
    page = opened
    bar = page.locator("map-verdict")
    bar.locator("summary").first.click()
    one = bar.locator("li").filter(has_text=finding["text"])
    one.get_by_text("Acknowledge…").click()
    one.get_by_label("Note").fill("known from the site")
    one.get_by_role("button", name="Acknowledge").click()
    expect(one).to_contain_text("known from the site")

    page.get_by_role("button", name="Approve map…").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("known from the site")
    expect(dialog.get_by_text("Acknowledge…")).to_have_count(0)
