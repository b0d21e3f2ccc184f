"""Barriers on a page, as axe-core finds them: names of controls, structure, contrast."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Page

_AXE = Path(__file__).parents[2] / "node_modules" / "axe-core" / "axe.min.js"
_RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"]

needs_axe = pytest.mark.skipif(not _AXE.exists(), reason="no npm: axe-core is not installed")


def barriers(page: Page) -> list[tuple[str, str]]:
    """Rule and element of each violation on the page as it is now."""
    page.evaluate(_AXE.read_text("utf-8"))
    found = page.evaluate("(tags) => axe.run(document, { runOnly: tags, iframes: false })", _RULES)
    return [(one["id"], node["html"][:120]) for one in found["violations"] for node in one["nodes"]]
