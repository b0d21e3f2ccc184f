"""A message that is queued at any moment reaches its browser."""

import asyncio
import threading

import pytest
from viser.infra import _infra

from recon4_app.viewer.wakeups import ThreadsafeEvent, wake_every_browser


async def woken(event):
    """Whether a task is woken whose event another thread sets just before it waits."""
    loop = asyncio.get_running_loop()
    make, sets = loop.create_future, threading.Thread(target=event.set)

    def interrupted():
        loop.create_future = make
        sets.start()
        sets.join()
        loop.call_soon_threadsafe(event.set)  # as viser does after it
        return make()

    loop.create_future = interrupted
    waits = asyncio.ensure_future(event.wait())
    for _ in range(5):
        await asyncio.sleep(0)
    waits.cancel()
    return waits.done() and not waits.cancelled()


def test_who_begins_to_wait_while_another_thread_sets_it_is_woken():
    assert asyncio.run(woken(ThreadsafeEvent()))
    assert not asyncio.run(woken(asyncio.Event()))  # else it needs no mending


def test_buffers_of_viser_have_such_events(monkeypatch):
    monkeypatch.setattr(_infra, "AsyncMessageBuffer", _infra.AsyncMessageBuffer)
    wake_every_browser()

    async def made():
        return _infra.AsyncMessageBuffer(asyncio.get_running_loop(), persistent_messages=False)

    assert type(asyncio.run(made()).message_event) is ThreadsafeEvent


@pytest.mark.parametrize("before", [False, True])
def test_an_event_that_is_set_in_the_loop_wakes_who_waits(before):
    async def waited():
        event = ThreadsafeEvent()
        waits = asyncio.ensure_future(event.wait())
        await asyncio.sleep(0)
        if before:
            sets = threading.Thread(target=event.set)
            sets.start()
            sets.join()
        event.set()
        return await waits and event.is_set()

    assert asyncio.run(waited())
