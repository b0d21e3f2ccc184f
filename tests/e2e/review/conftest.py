"""A project to review, and its page."""

import shutil
from functools import partial

import pytest
from playwright.sync_api import expect

from tests.review_fixtures import made, running
from tests.service.running import wait_for

__all__ = ["made", "opened", "root", "running"]


@pytest.fixture(scope="module")
def office(made, running):
    """A copy of the project: processes that opened its artifacts for one test serve the next."""
    folder = running.root / "office"
    shutil.copytree(made, folder)
    return folder


def idle(server):
    """Whether no job and no child process works on a project any more."""
    queues = server.app.state.parts.compute_pool.queues.values()
    jobs = server.get("/api/jobs").json()
    return not any(q.waiting or q.running for q in queues) and all(
        v["job"]["finished"] for v in jobs
    )


@pytest.fixture
def root(made, office, running):
    """The project as it was made: what a test decided, judged or signed is gone."""
    wait_for(partial(idle, running), "what the test before asked for ends")
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
