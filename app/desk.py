"""Short heavy work for the pages, in child processes: the front itself stays free and safe.

One child a kind of work, so that a slice never waits for the optimizer. A child that dies or
hangs is replaced; the request it served is answered with an error, nothing else is harmed.
"""

from __future__ import annotations

import asyncio
import os
import resource
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from multiprocessing import get_context
from typing import Literal, TypeVar

from app.errors import DeskFailed
from app.settings import ONE_THREAD

T = TypeVar("T")
Kind = Literal["look", "review", "pairs", "slices", "surveys"]
"""``look``: what a recording holds, pictures; ``review``: graphs, solving, signing; ``pairs``:
points of two places, and registering them; ``slices``: pictures of cuts;
``surveys``: what takes longer, and files of unknown origin: references, exports, checks."""

MOST_MEMORY_BYTES = 12 << 30
"""Address space of a child; a hostile file ends the child, not the machine."""


class Desk:
    """Runs functions of modules in children. Arguments and results must be picklable."""

    def __init__(self) -> None:
        self._pools: dict[Kind, ProcessPoolExecutor] = {}
        self._turns: dict[Kind, asyncio.Lock] = {}

    async def run(
        self, kind: Kind, function: Callable[..., T], *args: object, limit_s: float = 120.0
    ) -> T:
        """What ``function(*args)`` returns; one call after the other within a kind.

        Raises:
            DeskFailed: If the child died or took longer than ``limit_s``.
            Recon4Error: Whatever the function raises.
        """
        async with self._turns.setdefault(kind, asyncio.Lock()):  # waiting is not counted
            return await self._run(kind, function, args, limit_s)

    async def _run(
        self, kind: Kind, function: Callable[..., T], args: tuple[object, ...], limit_s: float
    ) -> T:
        pool = self._pool(kind)
        future = asyncio.wrap_future(pool.submit(function, *args))
        try:
            return await asyncio.wait_for(future, limit_s)
        except TimeoutError as error:
            self._drop(kind, pool)
            raise DeskFailed(f"stopped after {limit_s:.0f} s; ask for less at a time") from error
        except BrokenExecutor as error:
            self._drop(kind, pool)
            raise DeskFailed(
                "the helper process died (out of memory, or a damaged file); try again"
            ) from error

    def close(self) -> None:
        """End all children."""
        for kind, pool in list(self._pools.items()):
            self._drop(kind, pool)

    def _pool(self, kind: Kind) -> ProcessPoolExecutor:
        if kind not in self._pools:
            self._pools[kind] = ProcessPoolExecutor(
                max_workers=1, mp_context=get_context("spawn"), initializer=_prepare
            )
        return self._pools[kind]

    def _drop(self, kind: Kind, pool: ProcessPoolExecutor) -> None:
        if self._pools.get(kind) is pool:
            del self._pools[kind]
        for process in list((pool._processes or {}).values()):  # there is no public way to kill
            process.kill()
        pool.shutdown(wait=False, cancel_futures=True)


def _prepare() -> None:
    """In the child, before numpy is imported."""
    os.environ.update(ONE_THREAD)
    os.setsid()  # Ctrl-C in the terminal is the server's to handle
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY_BYTES, MOST_MEMORY_BYTES))
