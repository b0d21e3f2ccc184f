"""``kill -9`` at any moment, then the same command again: the same result, nothing done twice."""

import random
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from recon4.progress import Silent
from recon4.store.verify import verify_files
from tests.unit.store.small_pipeline import results, run_all

PROGRAM = [sys.executable, "-m", "tests.unit.store.small_pipeline"]
ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def killed_before():
    """Runs a pipeline up to an operation on a file; whether it was killed there."""
    with subprocess.Popen(
        PROGRAM, cwd=ROOT, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as program:
        assert program.stdin is not None and program.stdout is not None

        def run(operation: int, root: Path) -> bool:
            program.stdin.write(f"{operation} {root}\n")
            program.stdin.flush()
            code = int(program.stdout.readline())
            assert code in {0, -signal.SIGKILL}
            return code != 0

        yield run
        program.stdin.close()
    assert program.returncode == 0


@pytest.fixture(scope="module")
def expected(tmp_path_factory) -> dict[str, bytes]:
    root = tmp_path_factory.mktemp("unbroken") / "project"
    run_all(root)
    return results(root)


@pytest.mark.parametrize("part", range(4))
def test_a_kill_before_any_file_operation_leaves_a_project_that_resumes(
    tmp_path, expected, killed_before, part
):
    operation, kills = 1 + part, 0
    while killed_before(operation, tmp_path / str(operation)):
        root = tmp_path / str(operation)
        run_all(root)

        assert results(root) == expected
        assert verify_files(root, Silent()).damaged == ()
        assert [p for p in root.rglob(".tmp-*")] == []
        operation, kills = operation + 4, kills + 1
    assert kills >= 10


def test_a_run_killed_repeatedly_gives_the_same_result(tmp_path, expected, killed_before):
    root = tmp_path / "project"
    for operation in range(4, 40, 4):
        killed_before(operation, root)

    run_all(root)

    assert results(root) == expected


def test_kills_at_random_times_lose_nothing(tmp_path, expected):
    rng = random.Random(11)
    for k in range(6):
        root = tmp_path / str(k)
        child = subprocess.Popen([*PROGRAM, str(root)], cwd=ROOT)
        try:
            child.wait(timeout=rng.uniform(0.05, 0.3))
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
        run_all(root)

        assert results(root) == expected
        assert verify_files(root, Silent()).damaged == ()


def test_a_renamed_artifact_without_a_record_is_adopted(tmp_path):
    first = run_all(tmp_path / "project")
    (tmp_path / "project" / "ledger.sqlite").unlink()

    second = run_all(tmp_path / "project")

    assert {name: run.reused for name, run in second.runs.items()} == dict.fromkeys(
        first.runs, True
    )
    assert second.runs["count"].done == first.runs["count"].done


def test_an_artifact_the_ledger_does_not_know_is_not_trusted_with_a_flipped_bit(tmp_path):
    first = run_all(tmp_path / "project")
    path = first.runs["total"].artifact.folder / "total.txt"
    path.write_bytes(b"9" + path.read_bytes()[1:])
    (tmp_path / "project" / "ledger.sqlite").unlink()

    second = run_all(tmp_path / "project")

    assert {name: run.reused for name, run in second.runs.items()} == {
        "count": True,
        "scale": True,
        "total": False,
    }
