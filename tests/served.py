"""The fixture `server` of a file of tests, in a line: ``server = served(office(points=1000))``."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from tests.project_builder import build_project
from tests.service.running import server_thread

Fill = Callable[[Path], object]
"""Makes what the server serves, in its empty folder."""


def served(
    fill: Fill | None = None,
    *,
    run: Callable[..., AbstractContextManager[Any]] = server_thread,
    fresh: bool = False,
    below: str = "",
    **settings: Any,
) -> Any:
    """A fixture: a server that runs for the tests of a file.

    Args:
        fill: Makes what it serves; None = nothing.
        run: ``run(root, **settings)`` starts it; ``secure_server`` has TLS and login.
        fresh: A server of its own for each test, on the test's ``tmp_path``.
        below: Folder in ``tmp_path`` that a fresh one serves, for tests with files beside it.
        settings: Those of the server.
    """

    def opened(root: Path) -> Iterator[Any]:
        if fill is not None:
            fill(root)
        with run(root, **settings) as running:
            yield running

    if fresh:

        @pytest.fixture
        def server(tmp_path: Path) -> Iterator[Any]:
            root = tmp_path / below
            root.mkdir(exist_ok=True)
            yield from opened(root)

    else:

        @pytest.fixture(scope="module")
        def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
            yield from opened(tmp_path_factory.mktemp("projects"))

    return server


def office(**options: Any) -> Fill:
    """A finished project ``office``, see `build_project`."""
    return partial(_office, **options)


def _office(root: Path, **options: Any) -> None:
    build_project(root / "office", **options)
