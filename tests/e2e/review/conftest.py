"""A project to review, and its page."""

import shutil

import pytest
from playwright.sync_api import expect

from tests.review_project import make
from tests.service.running import server_thread


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made") / "office"
    make(folder)
    return folder


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    with server_thread(tmp_path_factory.mktemp("served"), worker="tests.review_project") as one:
        yield one


@pytest.fixture
def root(made, running):
    folder = running.root / f"office{len(list(running.root.iterdir()))}"
    shutil.copytree(made, folder)
    return folder


@pytest.fixture
def opened(running, root, page):
    page.goto(f"{running.url}/projects/{root.name}/review/")
    expect(page.locator(".queue li").first).to_be_visible()
    return page
