"""Files a worker wrote after a hostile recording took it over: 0 strangers killed, 0 exceptions."""

import subprocess
import sys

import pytest

from recon4_app.jobs.events import read_events
from recon4_app.jobs.folder import JobFolder, Limits
from recon4_app.jobs.model import Inputs
from recon4_app.jobs.tuning import EVENT_LIMITS

LIMITS = Limits(memory_bytes=1 << 30, reserve_bytes=0)


@pytest.fixture
def folder(tmp_path):
    folder = JobFolder(tmp_path / "job")
    folder.prepare(Inputs(recordings=()), tmp_path / "project", LIMITS)
    return folder


@pytest.fixture
def stranger():
    """A process of the same user in a group of its own."""
    program = [sys.executable, "-c", "import sys; print(flush=True); sys.stdin.read()"]
    with subprocess.Popen(
        program, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True
    ) as process:
        process.stdout.readline()
        yield process
        process.kill()


def test_a_pid_of_another_process_is_not_killed(folder, stranger):
    (folder.path / "pid").write_text(str(stranger.pid))

    folder.kill()
    folder.end_orphans()

    assert stranger.poll() is None


@pytest.mark.parametrize("text", ["1", "0", "-1", "", "x", "9" * 5000, "[" * 100_000])
def test_a_malformed_pid_file_kills_no_process(folder, text):
    (folder.path / "pid").write_text(text)

    folder.kill()
    folder.end_orphans()


@pytest.mark.parametrize(
    "text",
    [
        *("[" * 100_000, '{"state": "succeeded", "note": [1]}', '{"state": "admin"}', "{}", "3"),
        *("\x00", '{"state": "failed", "note": "' + "x" * (1 << 20) + '"}'),
    ],
)
def test_a_malformed_outcome_counts_as_a_death(folder, text):
    (folder.path / "outcome.json").write_text(text)

    assert folder.outcome() is None


def test_a_folder_in_the_place_of_a_file_is_no_obstacle(folder, tmp_path):
    for name in ("outcome.json", "pid", "heartbeat"):
        (folder.path / name / "x").mkdir(parents=True)
    assert folder.outcome() is None
    folder.kill()

    folder.prepare(Inputs(recordings=()), tmp_path / "project", LIMITS)

    assert not (folder.path / "pid").exists()


def test_events_that_are_none_are_skipped_and_a_flood_is_read_in_pieces(tmp_path):
    path = tmp_path / "events.jsonl"
    good = b'{"kind": "run", "t": 1}\n'
    path.write_bytes(
        b"[" * 100_000 + b"\n" + b"\xff\n" + b"x" * (3 * EVENT_LIMITS.max_bytes) + b"\n" + good
    )

    found, offset, reads = [], 0, 0
    while offset < path.stat().st_size:
        events, offset = read_events(path, offset)
        found += events
        reads += 1

    assert [event.kind for event in found] == ["run"]
    assert reads >= 3
