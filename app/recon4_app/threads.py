"""Blocking work of the server's background tasks, in threads that end before the server does."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


async def in_thread(function: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> R:
    """Call a function in a thread; who is canceled meanwhile waits for its end.

    `asyncio.to_thread` leaves the thread alone: it would write to files of a server that has
    closed and sealed them.
    """
    work = asyncio.ensure_future(asyncio.to_thread(function, *args, **kwargs))
    try:
        return await asyncio.shield(work)
    finally:
        await asyncio.wait({work})
