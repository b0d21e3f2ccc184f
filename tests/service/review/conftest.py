"""A project to review, and a server for it."""

import shutil

import pytest

from tests.review_fixtures import made, root, running
from tests.service.review.reviewing import Reviewing

__all__ = ["made", "root", "running", "server", "unchanged"]


@pytest.fixture
def server(running, root):
    return Reviewing(running, root)


@pytest.fixture(scope="module")
def unchanged(made, running):
    """A project that tests only look at: one child process computes for all of them."""
    return Reviewing(running, shutil.copytree(made, running.root / "unchanged"))
