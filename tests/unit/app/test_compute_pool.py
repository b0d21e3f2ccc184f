"""Real child processes."""

import asyncio
import os
import time
from dataclasses import replace
from pathlib import Path

import pytest
from msgspec import structs

from recon4.errors import ConfigError, GraphError, WrongSettings
from recon4.system.processes import ChildRegister
from recon4_app.compute_pool import pool as pool_module
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.errors import ComputeFailed
from tests import pool_functions as work

EVA = Terms(person="Eva")


def in_pool(scratch, scenario):
    """What ``scenario(pool)`` returns; the pool is closed at its end."""

    async def run():
        pool = ComputePool(scratch, children=ChildRegister(scratch.with_name("children")))
        try:
            return await scenario(pool)
        finally:
            await pool.close()

    return asyncio.run(run())


def test_work_runs_in_another_process_which_is_kept(tmp_path):
    async def twice(pool):
        return [await pool.run_interactive(Lane.SLICE, EVA, work.identity, n) for n in (7, 8)]

    (first, pid), (second, again) = in_pool(tmp_path, twice)

    assert (first, second) == (7, 8)
    assert pid == again != os.getpid()


def test_a_child_that_was_prepared_serves_the_first_call(tmp_path, monkeypatch):
    monkeypatch.setattr(pool_module, "INTERACTIVE_MODULES", ())
    monkeypatch.setattr(
        pool_module, "POOL_TIMES", structs.replace(pool_module.POOL_TIMES, spare_after_s=0.0)
    )

    async def opened_later(pool):
        pool.prepare_spare()
        while not (started := list((tmp_path / "children").glob("*-*"))):
            await asyncio.sleep(0)
        return started, await pool.run_interactive(Lane.SLICE, EVA, work.identity, 7)

    started, (found, pid) = in_pool(tmp_path / "pool", opened_later)

    assert found == 7
    assert [int(one.name.partition("-")[0]) for one in started] == [pid]


def test_background_work_and_other_files_get_a_child_of_their_own(tmp_path):
    other = replace(EVA, access=FileAccess(read=(tmp_path,)))

    async def all_kinds(pool):
        return [
            await pool.run_interactive(Lane.SLICE, EVA, work.identity, 0),
            await pool.run_interactive(Lane.SLICE, other, work.identity, 0),
            await pool.run_background(Lane.SLICE, EVA, work.identity, 0),
            await pool.run_background(Lane.SLICE, EVA, work.identity, 0),
        ]

    assert len({pid for _, pid in in_pool(tmp_path / "pool", all_kinds)}) == 4


def test_a_child_that_dies_is_replaced_and_said(tmp_path):
    async def run(pool):
        with pytest.raises(ComputeFailed, match=r"died \(killed by SIGKILL"):
            await pool.run_interactive(Lane.INSPECT, EVA, work.die)
        return await pool.run_interactive(Lane.INSPECT, EVA, work.identity, 3)

    assert in_pool(tmp_path, run)[0] == 3


def test_a_child_that_takes_too_long_is_killed(tmp_path):
    async def run(pool):
        began_s = time.monotonic()
        hurried = replace(EVA, limit_s=0.3)
        _, pid = await pool.run_interactive(Lane.INSPECT, EVA, work.identity, 0)
        with pytest.raises(ComputeFailed, match="stopped after"):
            await pool.run_interactive(Lane.INSPECT, hurried, work.pause)
        assert time.monotonic() - began_s < 60.0
        assert not Path(f"/proc/{pid}").exists()
        return await pool.run_interactive(Lane.INSPECT, EVA, work.identity, 3)

    assert in_pool(tmp_path, run)[0] == 3


def test_errors_of_the_library_come_through(tmp_path):
    async def run(pool):
        with pytest.raises(GraphError, match="hangs in the air"):
            await pool.run_interactive(Lane.INSPECT, EVA, work.refuse)
        with pytest.raises(WrongSettings) as wrong:
            await pool.run_interactive(Lane.INSPECT, EVA, work.refuse_settings)
        return wrong.value.problems

    assert in_pool(tmp_path, run) == {"map.voxel_m": "must be positive"}


def test_results_keep_their_type_and_numbers_that_are_not_finite(tmp_path):
    async def run(pool):
        return await pool.run_interactive(Lane.INSPECT, EVA, work.record)

    found = in_pool(tmp_path, run)

    assert isinstance(found, work.Found)
    assert found.tags == ("a", "b")
    assert found.error_m != found.error_m


def test_a_function_must_declare_its_result(tmp_path):
    async def run(pool):
        with pytest.raises(TypeError, match="must declare"):
            await pool.run_interactive(Lane.INSPECT, EVA, work.undeclared)

    in_pool(tmp_path, run)


def test_libraries_in_a_child_use_one_thread(tmp_path):
    async def run(pool):
        return await pool.run_interactive(Lane.INSPECT, EVA, work.threads)

    assert in_pool(tmp_path, run) == "1"


def test_what_a_call_makes_is_moved_to_its_place_and_nothing_else_stays(tmp_path):
    place = tmp_path / "kept" / "made.txt"
    terms = replace(EVA, outputs={"made.txt": place})

    async def run(pool):
        await pool.run_background(Lane.EXPORT, terms, work.make, "made.txt")
        with pytest.raises(ConfigError):
            await pool.run_background(
                Lane.EXPORT,
                replace(terms, outputs={"made.txt": tmp_path / "kept" / "other"}),
                work.make_and_refuse,
                "made.txt",
            )

    in_pool(tmp_path / "scratch", run)

    assert place.read_text() == "made"
    assert list((tmp_path / "kept").iterdir()) == [place]
    assert list((tmp_path / "scratch").iterdir()) == []
