"""The list of many projects: found, ordered, tagged and archived by keyboard alone."""

import json
import os

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import one_look
from tests.project_builder import build_project
from tests.served import served

pytestmark = pytest.mark.e2e


def many(root):
    build_project(root / "p0", points=1000)
    facts = json.loads((root / "p0" / "project.json").read_text())
    for n in range(1, 100):
        folder = root / f"p{n}"
        folder.mkdir()
        walk = [{"name": "walk.pcap", "bytes": 1, "sha256": f"{n // 2:064x}"}]
        named = facts | {"name": f"Walk {n}", "inputs": walk if n > 95 else []}
        (folder / "project.json").write_text(json.dumps(named))
        os.link(root / "p0" / "summary.json", folder / "summary.json")
    build_project(root / "hall", points=1000)


server = served(many)


@one_look
def test_projects_are_found_ordered_tagged_and_archived(page, server):
    asked = []
    page.on("request", lambda one: one.url.endswith("/api/projects") and asked.append(one))
    page.goto(f"{server.url}/")
    cards = page.locator(".card")
    expect(page.get_by_role("button", name="Show more: 53 are left")).to_be_attached()
    expect(cards).to_have_count(48)
    expect(page.get_by_label("Preset")).to_have_value("indoor")  # the form has read all it needs
    assert len(asked) == 1

    page.get_by_label("Find a project").press_sequentially("walk 9")
    expect(cards).to_have_count(19)
    page.get_by_label("Order").select_option("name")
    expect(cards.first).to_contain_text("Walk 9")
    expect(cards.last).to_contain_text("Walk 99")
    page.get_by_label("Show").select_option("twins")
    expect(cards).to_have_count(4)
    expect(cards.first).to_contain_text("Same recording as Walk 97")
    assert page.url.endswith("/?find=walk+9&order=name&show=twins")

    page.goto(f"{server.url}/?find=hall")
    page.get_by_role("button", name="Organize hall").focus()
    page.keyboard.press("Enter")
    tags = page.get_by_label("Tags, with commas between")
    expect(tags).to_be_focused()
    page.keyboard.type("Brno, 2026")
    page.keyboard.press("Enter")
    expect(page.get_by_role("button", name="2026")).to_be_visible()
    page.get_by_role("button", name="Brno").press("Enter")
    expect(page.get_by_label("Show")).to_have_value("tag:Brno")

    page.get_by_role("button", name="Organize hall").press("Enter")
    page.get_by_role("checkbox", name="Archived").press("Space")
    page.keyboard.press("Enter")
    expect(page.get_by_text("No project is like that")).to_be_visible()
    page.get_by_label("Show").select_option("archived")
    expect(cards).to_have_count(1)
