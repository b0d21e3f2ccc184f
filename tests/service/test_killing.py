"""Server, worker and viewer killed in the stages of a real run: nothing lost, none done twice."""

import json
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

pytestmark = pytest.mark.study


@pytest.fixture
def root(tmp_path, short_recording):
    """A folder of projects with the walk."""
    shutil.copytree(short_recording, tmp_path / "killed" / "walk")
    return tmp_path / "killed"


def test_server_worker_and_viewer_are_killed_in_the_middle_of_stages_and_the_bytes_are_the_same(
    root, short_project
):
    """A row of the matrix; ``tests/benchmarks/kills.py --matrix`` runs all of them.

    The bytes are those of a run by the command line, which nobody killed.
    """
    survived = killing.run_gated(root, request_for(root), row_of_the_matrix(0))

    summary = json.loads((short_project / "summary.json").read_text())
    assert [stage["stage"] for stage in summary["stages"]] == list(STAGES)
    assert [stage for _, stage in survived.hits] == list(STAGES)
    assert {victim for victim, _ in survived.hits} == set(IN_A_STAGE)
    assert orphans(root) == []
    assert leftover_files(root) == []
    assert results(root / "office") == results(short_project)
    assert artifacts(root / "office") == artifacts(short_project)
    assert set(completed(root, survived).values()) <= {1}
    assert {stage for stage, _ in PIECES} <= set(STAGE_PERCENT)
    assert not list((root / "office").rglob(".tmp-*"))


def test_the_matrix_kills_every_process_in_every_stage():
    rows = [row_of_the_matrix(row) for row in range(len(IN_A_STAGE))]

    for stage in STAGES:
        assert {row[stage] for row in rows} == set(IN_A_STAGE)
