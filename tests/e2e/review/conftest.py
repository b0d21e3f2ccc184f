"""A project to review, and its page."""

import pytest
from playwright.sync_api import expect

from tests.review_fixtures import made, root, running

__all__ = ["made", "opened", "root", "running"]


@pytest.fixture
def opened(running, root, page):
    page.goto(f"{running.url}/projects/{root.name}/review/")
    expect(page.locator(".queue li").first).to_be_visible()
    return page
