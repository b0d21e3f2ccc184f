"""Real child processes."""

import asyncio
import os
import signal
import time

import pytest

from app.desk import Desk
from app.errors import DeskFailed
from recon4.errors import GraphError


def identity(value):
    return value, os.getpid()


def die():
    os.kill(os.getpid(), signal.SIGKILL)


def refuse():
    raise GraphError("node 3 hangs in the air")


def threads():
    return os.environ["OMP_NUM_THREADS"]


@pytest.fixture
def desk():
    desk = Desk()
    yield desk
    desk.close()


def test_work_runs_in_another_process_which_is_kept(desk):
    async def twice():
        return await desk.run("look", identity, 7), await desk.run("look", identity, 8)

    (first, pid), (second, again) = asyncio.run(twice())

    assert (first, second) == (7, 8)
    assert pid == again != os.getpid()


def test_each_kind_of_work_has_its_own_process(desk):
    async def both():
        return await asyncio.gather(desk.run("look", identity, 1), desk.run("slices", identity, 1))

    (_, a), (_, b) = asyncio.run(both())

    assert a != b


def test_a_child_that_dies_is_replaced_and_said(desk):
    async def run():
        with pytest.raises(DeskFailed, match="died"):
            await desk.run("look", die)
        return await desk.run("look", identity, 3)

    assert asyncio.run(run())[0] == 3


def test_a_child_that_takes_too_long_is_killed(desk):
    async def run():
        began = time.monotonic()
        await desk.run("look", identity, 0)
        with pytest.raises(DeskFailed, match="stopped after"):
            await desk.run("look", signal.pause, limit_s=0.3)
        assert time.monotonic() - began < 30.0
        return await desk.run("look", identity, 3)

    assert asyncio.run(run())[0] == 3


def test_an_error_of_the_library_comes_through(desk):
    with pytest.raises(GraphError, match="hangs in the air"):
        asyncio.run(desk.run("review", refuse))


def test_libraries_in_a_child_use_one_thread(desk):
    assert asyncio.run(desk.run("look", threads)) == "1"
