"""A confined process and its parent: orders are made, everything else ends it."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import pytest

from recon4.executors.executor import Finished, InOrder
from recon4.orders.on_worker import worker_name
from recon4.orders.parent import Program, TakenOver, run_with_workers
from recon4.orders.work_log import PartReport, WorkerRecord
from tests.ordered_maps import bytes_of, make_map

ROOT = Path(__file__).parents[3]


class Untouched:
    """An executor that nothing may reach."""

    def run(self, function, tasks, say):
        raise AssertionError(tasks)


class Gone:
    """An executor that loses its scheduler after the first part."""

    def run(self, function, tasks, say):
        yield Finished(tasks[0], function(tasks[0], say))
        raise OSError("connection closed")


@pytest.fixture(autouse=True)
def _importable(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        monkeypatch.setenv(name, "1")


def run(project: Path, what: str, executor, *, log=print, who=lambda workers: None) -> int:
    program = Program("tests.order_programs", (what,), project)
    return run_with_workers(program, executor, started=lambda process: None, log=log, who=who)


@pytest.mark.parametrize(
    "executor",
    [InOrder(), pytest.param(Gone(), marks=pytest.mark.study)],
    ids=["all workers", "no scheduler after the first part"],
)
def test_a_confined_process_has_its_tiles_made_and_the_bytes_are_the_same(executor, tmp_path):
    log: list[str] = []
    seen: list[tuple[WorkerRecord, ...]] = []

    code = run(tmp_path, "map", executor, log=log.append, who=seen.append)

    (there,) = (tmp_path / "artifacts").iterdir()
    assert code == 0
    assert bytes_of(there) == bytes_of(make_map(tmp_path, None))
    assert [line for line in log if "scheduler" in line] == (
        [] if isinstance(executor, InOrder) else ["the scheduler is gone: connection closed"]
    )
    ((last,), (first,)) = seen[-1], seen[0]
    tiles = len(json.loads((there / "tiles.json").read_text("utf-8"))["tiles"])
    assert (last.name, last.part, last.failed) == (worker_name(), "", 0)
    assert last.made >= tiles if isinstance(executor, InOrder) else last.made == 1
    assert (first.part[:8], first.made) == ("map-tile", 0)


class Says:
    """A worker whose maker says this, and which fails with it, too."""

    def __init__(self, line):
        self.line = line

    def run(self, function, tasks, say):
        for task in tasks:
            say(str(task.item), f"computer 7: {self.line}")
            yield Finished(task, PartReport("computer 7", 0.5, self.line))


def test_what_workers_say_reaches_no_terminal_with_its_control_characters(tmp_path):
    (tmp_path / "artifacts" / "a").mkdir(parents=True)
    order = b'{"kind":"map-tile","folder":"artifacts/a","items":[[0,0,0]]}'
    message = struct.pack(">I", len(order)) + order
    log: list[str] = []

    run(tmp_path, message.hex(), Says("\x1b[2Jdone"), log=log.append)

    assert "computer 7: <U+001B>[2Jdone" in log
    assert not [line for line in log if not line.isprintable()]


HOSTILE = {
    "a pickle": b"\x80\x04\x95cposix\nsystem\n.",
    "another function": b'{"kind":"os.system","folder":"artifacts/a","items":[]}',
    "another folder": b'{"kind":"map-tile","folder":"artifacts/../../etc","items":[[0,0,0]]}',
}


@pytest.mark.parametrize("data", HOSTILE.values(), ids=HOSTILE.keys())
def test_a_process_that_sends_what_is_no_order_is_ended(data, tmp_path):
    message = struct.pack(">I", len(data)) + data

    with pytest.raises(TakenOver, match="taken it over"):
        run(tmp_path, message.hex(), Untouched())


def test_a_process_that_ends_in_the_midst_of_a_message_is_only_over(tmp_path):
    code = run(tmp_path, "end" + struct.pack(">I", 100).hex(), Untouched())

    assert code == 7
