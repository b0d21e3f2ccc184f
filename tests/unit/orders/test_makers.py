"""Tiles of a map made in confined processes of a worker, without a scheduler."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from msgspec import structs

from recon4.executors.executor import Finished
from recon4.model.classes import PointClass
from recon4.model.events import Warned
from recon4.orders import on_worker
from recon4.orders.on_worker import PartTask, make_part
from recon4.progress import Silent
from recon4.sandbox import ONE_THREAD, available_barriers
from recon4.store.package_versions import versions
from tests.full_disk import files_end_at
from tests.ordered_maps import DirectWorkers, bytes_of, full_inputs, make_map

ROOT = Path(__file__).parents[3]
HERE = tuple(versions().items())


@pytest.fixture(scope="module")
def inputs():
    return full_inputs()


@pytest.fixture(scope="module")
def here(inputs, tmp_path_factory):
    """The map made by threads."""
    return make_map(tmp_path_factory.mktemp("project"), None, inputs=inputs)


def warnings(progress: Silent) -> list[str]:
    return [event.text for event in progress.events if isinstance(event, Warned)]


def test_a_worker_makes_the_same_bytes_as_threads(inputs, here, tmp_path):
    progress = Silent()

    there = make_map(tmp_path, DirectWorkers(tmp_path), inputs=inputs, progress=progress)

    notes = json.loads((here / "tiles.json").read_text("utf-8"))
    assert len(notes["tiles"]) > 4
    assert str(int(PointClass.GROUND)) in notes["classes"]
    assert notes["corrected"][0] > 0
    assert bytes_of(there) == bytes_of(here)
    assert warnings(progress) == []


@pytest.mark.study
def test_a_worker_makes_the_same_bytes_of_a_raw_map(inputs, tmp_path):
    here = make_map(tmp_path, None, surface="raw", inputs=inputs)
    there = make_map(tmp_path, DirectWorkers(tmp_path), surface="raw", inputs=inputs)

    assert bytes_of(there) == bytes_of(here)


class Failing(DirectWorkers):
    """Every second tile fails; a maker left half of a file of another."""

    def make(self, kind, folder, items, *, waiting):
        for answer in super().make(kind, folder, items, waiting=waiting):
            made = folder / "made_{}_{}_{}".format(*items[answer.item])
            if answer.item == 2:
                made.write_bytes(made.read_bytes()[:100])
            failure = "lost" if answer.item % 2 else ""
            yield type(answer)(item=answer.item, failure=failure)


def test_what_workers_cannot_make_is_made_here_and_said(inputs, here, tmp_path):
    progress = Silent()

    there = make_map(tmp_path, Failing(tmp_path), inputs=inputs, progress=progress)

    assert bytes_of(there) == bytes_of(here)
    assert len(warnings(progress)) == 2
    assert "made here instead of by a worker: lost" in warnings(progress)


class FullDisk:
    """An executor whose makers can write no file of more than 4 KiB."""

    def run(self, function, tasks, say):
        for one in tasks:
            with files_end_at(4096):  # makers inherit it
                failure = function(one, say)
            yield Finished(one, failure)


def test_what_a_worker_with_a_full_disk_cannot_write_is_made_here(inputs, here, tmp_path):
    progress, workers = Silent(), DirectWorkers(tmp_path, FullDisk())

    there = make_map(tmp_path, workers, inputs=inputs, progress=progress)

    assert bytes_of(there) == bytes_of(here)
    assert warnings(progress)
    assert all("NoSpace: no space left on the disk" in one for one in warnings(progress))
    assert list(tmp_path.rglob(".tmp-*")) == []


def task(project, numbers=(0, 0, 0), *, folder="artifacts/a", versions=HERE):
    return PartTask(0, "map-tile", str(project), folder, numbers, versions)


def quiet(name, line):
    pass


def test_a_worker_with_other_versions_refuses(tmp_path):
    other = tuple((versions() | {"recon4": "9.9", "numba": "0.1"}).items())

    said = make_part(task(tmp_path, versions=other), quiet)

    assert "recon4" in said
    assert "instead of 9.9" in said
    assert "numba" in said


def test_a_worker_looks_at_the_folder_itself(tmp_path):
    (tmp_path / "artifacts").mkdir()
    (tmp_path / "artifacts" / "a").symlink_to(tmp_path)

    assert "without links" in make_part(task(tmp_path), quiet)


def test_damaged_files_of_a_folder_are_a_failure_and_no_crash_of_the_worker(tmp_path):
    folder = tmp_path / "artifacts" / "a"
    folder.mkdir(parents=True)
    (folder / "recipe.json").write_bytes(b"[" * 100_000)

    assert make_part(task(tmp_path), quiet).startswith("StoreError: recipe.json")
    assert make_part(task(tmp_path), quiet).startswith("StoreError: recipe.json")
    assert len(on_worker._idle) == 1  # it is used again
    assert on_worker._idle[0].alive


def test_a_maker_that_waits_too_long_is_ended_and_one_that_was_taken_is_not(tmp_path, monkeypatch):
    (tmp_path / "artifacts" / "a").mkdir(parents=True)
    make_part(task(tmp_path), quiet)
    taken = on_worker._idle.pop()
    on_worker._end_unused(taken)
    assert taken.alive

    monkeypatch.setattr(on_worker, "ORDERS", structs.replace(on_worker.ORDERS, idle_s=0.001))
    on_worker._give_back(taken)
    taken._process.wait(60.0)

    assert on_worker._idle == []


def test_what_a_maker_says_beside_its_reply_is_told_up_to_a_limit(tmp_path, monkeypatch):
    (tmp_path / "artifacts" / "a").mkdir(parents=True)
    allowed = on_worker.allowed_environment
    verbose = {"PYTHONVERBOSE": "1"}  # hundreds of kilobytes
    monkeypatch.setattr(on_worker, "allowed_environment", lambda given: allowed(given) | verbose)
    lines: list[str] = []

    failure = make_part(task(tmp_path), lambda name, line: lines.append(line))

    assert failure.startswith("StoreError")
    said = [line for line in lines if line.startswith(f"{on_worker.worker_name()}: import ")]
    assert len(said) > 10
    assert len("".join(lines)) < 3 * on_worker.ORDERS.said_bytes


def test_who_stops_waiting_ends_the_maker(tmp_path, monkeypatch):
    (tmp_path / "artifacts" / "a").mkdir(parents=True)
    often = structs.replace(on_worker.ORDERS, looks_every_s=0.001)  # before it has begun
    monkeypatch.setattr(on_worker, "ORDERS", often)

    with pytest.raises(ZeroDivisionError):
        make_part(task(tmp_path), lambda *_: 1 / 0)

    assert on_worker._idle == []


TAKEN_OVER = """
import json, os, socket, subprocess, sys
from pathlib import Path
from recon4.orders import maker

def tried(reach):
    try:
        reach()
    except OSError:
        return False
    return True

def attack(line, folder):
    project = folder.parents[1]
    places = {
        "socket": lambda: socket.socket().close(),
        "program": lambda: subprocess.run(["/bin/true"]),
        "change": lambda: (project / "project.json").write_text("x"),
        "beside": lambda: (folder.parent / "other").write_text("x"),
        "read": lambda: (project.parent / "secret").read_text(),
        "link": lambda: (folder / "link").symlink_to("/etc"),
        "result": lambda: (folder / "made").write_text("x"),
    }
    found = [name for name, reach in places.items() if tried(reach)]
    return maker.PartReply(failure=",".join(found))

maker._made = attack
maker.main()
"""


@pytest.mark.skipif(
    not {"files", "calls"} <= {barrier.name for barrier in available_barriers() if barrier.holds},
    reason="this kernel has no Landlock or no seccomp",
)
def test_a_maker_that_a_file_took_over_writes_its_folder_and_nothing_else(tmp_path):
    project = tmp_path / "project"
    folder = project / "artifacts" / "a"
    folder.mkdir(parents=True)
    (project / "project.json").write_text("before")
    (tmp_path / "secret").write_text("token")
    read, lifeline = os.pipe()

    ended = subprocess.run(
        [sys.executable, "-c", TAKEN_OVER, str(read), str(project), str(folder)],
        input=b"{}\n",
        stdout=subprocess.PIPE,
        pass_fds=(read,),
        env={**os.environ, **ONE_THREAD, "PYTHONPATH": str(ROOT)},
        check=True,
    )
    os.close(read)
    os.close(lifeline)

    assert json.loads(ended.stdout) == {"failure": "result"}
    assert (project / "project.json").read_text() == "before"
