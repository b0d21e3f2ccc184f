"""Server, worker and viewer killed in the stages of a real run: nothing lost, none done twice."""

import shutil

import pytest

from recon4_app.jobs.run_progress import PIECES, STAGE_PERCENT
from tests.service import killing
from tests.service.killing import (
    IN_A_STAGE,
    STAGES,
    artifacts,
    completed,
    leftover_files,
    orphans,
    request_for,
    results,
    row_of_the_matrix,
)

pytestmark = pytest.mark.slow


@pytest.fixture
def roots(tmp_path, short_recording):
    """Two folders of projects, each with the walk."""
    for name in ("unbroken", "killed"):
        (tmp_path / name).mkdir()
        shutil.copytree(short_recording, tmp_path / name / "walk")
    return tmp_path / "unbroken", tmp_path / "killed"


def test_server_worker_and_viewer_are_killed_in_the_middle_of_stages_and_the_bytes_are_the_same(
    roots,
):
    """A row of the matrix; ``tests/benchmarks/kills.py --matrix`` runs all of them."""
    unbroken, killed = roots
    whole = killing.run(unbroken, request_for(unbroken), kills=0, seed=1)

    survived = killing.run_gated(killed, request_for(killed), row_of_the_matrix(0))

    assert [stage for _, stage in survived.hits] == list(STAGES)
    assert {victim for victim, _ in survived.hits} == set(IN_A_STAGE)
    assert orphans(killed) == []
    assert leftover_files(killed) == []
    assert results(killed / "office") == results(unbroken / "office")
    assert artifacts(killed / "office") == artifacts(unbroken / "office")
    assert set(completed(killed, survived).values()) <= {1}
    assert set(completed(unbroken, whole)) == set(STAGES)
    assert {stage for stage, _ in PIECES} <= set(STAGE_PERCENT)
    assert not list((killed / "office").rglob(".tmp-*"))


def test_the_matrix_kills_every_process_in_every_stage():
    rows = [row_of_the_matrix(row) for row in range(len(IN_A_STAGE))]

    for stage in STAGES:
        assert {row[stage] for row in rows} == set(IN_A_STAGE)
