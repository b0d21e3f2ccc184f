"""Background work that is canceled ends before what comes after it."""

import asyncio
import threading

import pytest

from recon4_app.threads import in_thread


def test_who_is_canceled_waits_for_the_thread():
    ended = threading.Event()

    async def cancel_and_look() -> bool:
        began, go = asyncio.Event(), threading.Event()
        loop = asyncio.get_running_loop()

        def work() -> None:
            loop.call_soon_threadsafe(began.set)
            go.wait()
            ended.set()

        task = asyncio.create_task(in_thread(work))
        await began.wait()
        task.cancel()
        loop.call_soon(go.set)
        with pytest.raises(asyncio.CancelledError):
            await task
        return ended.is_set()

    assert asyncio.run(cancel_and_look())


def test_results_and_errors_come_through():
    assert asyncio.run(in_thread(int, "ff", base=16)) == 255
    with pytest.raises(ValueError, match="invalid literal"):
        asyncio.run(in_thread(int, "x"))
