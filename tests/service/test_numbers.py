"""Numbers beyond all sense are refused in words, wherever a request carries them."""

from __future__ import annotations

import pytest

from tests.project_builder import build_project
from tests.service.running import server_thread


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=1000)
    with server_thread(root) as running:
        yield running


@pytest.mark.parametrize(
    ("path", "params"),
    [
        ("/api/audit", {"before": 10**30}),
        ("/api/audit", {"most": 10**9}),
        ("/api/jobs/0123456789abcdef/log/since", {"offset": 1 << 49}),
    ],
)
def test_of_an_address(server, path, params):
    answer = server.get(path, params=params)

    assert answer.status_code == 422 and answer.json()["error"] == "Invalid"


def test_of_picked_points(server):
    far = [[1e300, 0.0, 0.0], [0.0, 1e300, 0.0], [0.0, 0.0, -1e300]]

    answer = server.post("/api/projects/office/review/fit", json={"p_i": far, "p_j": far})

    assert answer.status_code == 422 and "p_i" in answer.json()["detail"]
