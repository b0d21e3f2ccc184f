"""Fixtures of tests that review a project: the project, made once, and a server of copies of it.

A `conftest.py` imports what it offers to its tests: `made`, `running` and `root`.
"""

import shutil
from pathlib import Path

import pytest

from tests.made_once import made_once
from tests.review_project import make
from tests.service.running import server_thread


def copy_made(factory: pytest.TempPathFactory, target: Path) -> None:
    """Copy the project, which takes six seconds of a processor to make, to a path."""
    shutil.copytree(made_once(factory, "reviewed-office", make), target)


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    return made_once(tmp_path_factory, "reviewed-office", make)


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    with server_thread(
        tmp_path_factory.mktemp("served"), worker_module="tests.review_project"
    ) as one:
        yield one


@pytest.fixture
def root(made, running):
    """A copy of the project, known to the server."""
    folder = running.root / f"office{len(list(running.root.iterdir()))}"
    shutil.copytree(made, folder)
    return folder
