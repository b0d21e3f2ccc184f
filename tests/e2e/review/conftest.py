"""A project to review, and its page."""

import shutil

import pytest
from playwright.sync_api import expect

from tests.review_fixtures import made, running

__all__ = ["made", "opened", "root", "running"]


@pytest.fixture(scope="module")
def office(made, running):
    """A copy of the project: processes that opened its artifacts for one test serve the next."""
    folder = running.root / "office"
    shutil.copytree(made, folder)
    return folder


@pytest.fixture
def root(made, office):
    """The project as it was made: what a test decided, judged or signed is gone."""
    for path in office.iterdir():
        if path.is_dir() and path.name != "artifacts":
            shutil.rmtree(path)
        elif path.is_file():
            path.unlink()
    shutil.copytree(made, office, ignore=shutil.ignore_patterns("artifacts"), dirs_exist_ok=True)
    return office


@pytest.fixture
def opened(running, root, page):
    page.goto(f"{running.url}/projects/{root.name}/review/")
    expect(page.locator(".queue li").first).to_be_visible()
    return page
