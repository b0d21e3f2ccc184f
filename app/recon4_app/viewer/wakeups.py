"""Mends how viser (pinned: 1.1.1) wakes the task that sends messages to a browser.

Every thread that queues a message sets the `asyncio.Event` of a buffer at once, and asks the loop
to set it again, for tasks that wait. But `asyncio.Event.set` does nothing to an event that is set
already. If the task has just found it unset, and another thread sets it before the task is among
those that wait, then the second one wakes nobody: the browser of that buffer gets nothing any more.
"""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field

from viser.infra import _infra
from viser.infra._async_message_buffer import AsyncMessageBuffer


class ThreadsafeEvent(asyncio.Event):
    """An event that other threads may set; who waits is woken by a `set` in the loop."""

    def set(self) -> None:
        """Set it; in the thread of its loop also wake everybody who waits, set before or not."""
        self._value = True
        try:
            asyncio.get_running_loop()
        except RuntimeError:  # of another thread, which asks the loop as well
            return
        self._value = False
        super().set()


@dataclass
class _Buffer(AsyncMessageBuffer):
    message_event: asyncio.Event = field(default_factory=ThreadsafeEvent)


def wake_every_browser() -> None:
    """Have servers of viser that are made from now on use such events."""
    _infra.AsyncMessageBuffer = _Buffer
