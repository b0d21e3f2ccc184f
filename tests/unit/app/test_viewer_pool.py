"""Viewers that are only starting end too: with their server, and with who asked for them."""

import asyncio
from pathlib import Path

import psutil
import pytest

from recon4.system.processes import ChildRegister
from recon4_app.errors import ViewerFailed
from recon4_app.network.streams import StreamLimits, Streams
from recon4_app.viewer.pool import ViewerPool


async def _starting(state: Path) -> tuple[ViewerPool, asyncio.Task[Path], psutil.Process]:
    """A pool, a request that waits for its viewer, and that viewer before it listens."""
    children = ChildRegister(state / "children")
    limits = StreamLimits(
        max_streams=4, max_per_person=4, max_per_address=4, reserved_for_capture=0
    )
    pool = ViewerPool(
        idle_s=60.0, points=1000, state=state, sockets=Streams("viewers", limits), children=children
    )
    request = asyncio.create_task(pool.socket(state.parent / "office"))
    while not (records := list(children.folder.glob("*-*"))):
        assert not request.done()
        await asyncio.sleep(0.01)
    return pool, request, psutil.Process(int(records[0].name.partition("-")[0]))


def test_a_viewer_that_starts_ends_with_its_server(tmp_path):
    async def close() -> psutil.Process:
        pool, request, viewer = await _starting(tmp_path / "state")
        await pool.close()
        with pytest.raises(ViewerFailed):
            await pool.socket(tmp_path / "office")
        await asyncio.wait({request})
        return viewer

    assert not asyncio.run(close()).is_running()
    assert not list((tmp_path / "state" / "children").glob("*-*"))


def test_a_viewer_ends_with_the_request_that_started_it(tmp_path):
    async def cancel() -> psutil.Process:
        _, request, viewer = await _starting(tmp_path / "state")
        request.cancel()
        await asyncio.wait({request})
        return viewer

    assert not asyncio.run(cancel()).is_running()
    assert not list((tmp_path / "state" / "children").glob("*-*"))
