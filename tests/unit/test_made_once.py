"""What tests share is made once, for all runs beside each other."""

import pytest

from tests.made_once import made_once


@pytest.mark.parametrize("worker", [True, False])
def test_runs_that_name_one_folder_share_what_they_make(
    worker, tmp_path, tmp_path_factory, monkeypatch
):
    monkeypatch.setenv("RECON4_MADE_ONCE", str(tmp_path))
    if worker:
        monkeypatch.setenv("PYTEST_XDIST_WORKER", "gw0")
    made = []

    for _ in range(2):
        folder = made_once(tmp_path_factory, "shared", lambda out: made.append(out.mkdir()))

    assert folder == tmp_path / "shared" and len(made) == 1
