"""A project to review, and a server for it."""

import pytest

from tests.review_fixtures import made, root, running
from tests.service.review.reviewing import Reviewing

__all__ = ["made", "root", "running", "server"]


@pytest.fixture
def server(running, root):
    return Reviewing(running, root)
