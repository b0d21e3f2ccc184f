"""Server and worker killed at random moments of a real run: nothing lost, nothing done twice."""

import shutil

import pytest

from app.jobs.overall import PIECES, SHARES
from recon4.progress import Silent
from recon4.simulation.simulate import simulate
from tests.service import killing
from tests.service.killing import artifacts, completed, request_for, results

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    folder = tmp_path_factory.mktemp("walks") / "walk"
    simulate("office", folder, seconds=5.0, seed=3, bag=False, progress=Silent())
    return folder


@pytest.fixture
def roots(tmp_path, walk):
    """Two folders of projects, each with the walk."""
    for name in ("unbroken", "killed"):
        (tmp_path / name).mkdir()
        shutil.copytree(walk, tmp_path / name / "walk")
    return tmp_path / "unbroken", tmp_path / "killed"


def test_a_run_whose_server_and_workers_are_killed_ends_in_the_same_bytes(roots):
    unbroken, killed = roots
    whole = killing.run(unbroken, request_for(unbroken), kills=0, seed=1)

    survived = killing.run(killed, request_for(killed), kills=4, seed=11)

    assert len(survived.hits) >= 3
    assert {victim for victim, _ in survived.hits} >= {"worker", "server"}
    assert results(killed / "office") == results(unbroken / "office")
    assert artifacts(killed / "office") == artifacts(unbroken / "office")
    assert set(completed(killed, survived).values()) <= {1}
    assert set(completed(unbroken, whole)) == {
        stage for stage in SHARES if stage not in ("hash", "results")
    }
    assert {stage for stage, _ in PIECES} <= set(SHARES)
    assert not list((killed / "office").rglob(".tmp-*"))
