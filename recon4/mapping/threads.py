"""Work on several threads with results in order."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import Protocol, TypeVar

from recon4.mapping.tuning import MAP_BUILD

Item = TypeVar("Item")
Made = TypeVar("Made")


class Each(Protocol):
    """Calls a function with each of some items: `in_turn`, or `InThreads`."""

    def __call__(self, work: Callable[[Item], Made], items: Iterable[Item], /) -> Iterator[Made]:
        """Results in the order of the items."""


def in_turn(work: Callable[[Item], Made], items: Iterable[Item], /) -> Iterator[Made]:
    """Results in the order of the items, each made when it is asked for, by this thread."""
    return map(work, items)


@dataclass(frozen=True, slots=True)
class InThreads:
    """Calls a function with each of some items in the threads of a pool."""

    pool: ThreadPoolExecutor

    def __call__(self, work: Callable[[Item], Made], items: Iterable[Item], /) -> Iterator[Made]:
        """See `in_order`."""
        return in_order(self.pool, work, items)


def in_order(
    pool: ThreadPoolExecutor, work: Callable[[Item], Made], items: Iterable[Item], /
) -> Iterator[Made]:
    """Results in the order of the items, at most one item per worker ahead."""
    waiting: deque[Future[Made]] = deque()
    try:
        for item in items:
            waiting.append(pool.submit(work, item))
            if len(waiting) > MAP_BUILD.workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        for future in waiting:
            future.cancel()
