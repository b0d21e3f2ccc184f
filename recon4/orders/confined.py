"""Gives orders: the side of the confined process, which can reach no scheduler itself."""

from __future__ import annotations

import os
import select
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import BinaryIO

from recon4.orders.order import Answer, Order, OrderKind, OrderRefused, Workers, receive, send
from recon4.orders.tuning import ORDERS

_workers: Workers | None = None


class OrderingWorkers:
    """Workers that the parent of this process asks."""

    def __init__(self, orders: BinaryIO, answers: BinaryIO, project: Path) -> None:
        """Send nothing yet.

        Args:
            orders: Where the parent reads.
            answers: Where it writes.
            project: The folder below which all orders lie.
        """
        self._orders = orders
        self._answers = answers
        self._project = project.resolve()

    def make(
        self,
        kind: OrderKind,
        folder: Path,
        items: Sequence[tuple[int, ...]],
        *,
        waiting: Callable[[], None],
    ) -> Iterator[Answer]:
        """As `Workers.make`.

        Raises:
            OrderRefused: If an answer is none of this order.
        """
        below = folder.resolve().relative_to(self._project).as_posix()
        send(self._orders, Order(kind=kind, folder=below, items=tuple(items)))
        left = set(range(len(items)))
        while left:
            self._wait(waiting)
            answer = receive(self._answers, Answer)
            if answer is None or answer.item not in left:
                raise OrderRefused(f"expected an answer of a part, got {answer}")
            left.remove(answer.item)
            yield answer

    def _wait(self, waiting: Callable[[], None]) -> None:
        """Wait until there is something to read."""
        while not select.select([self._answers], [], [], ORDERS.looks_every_s)[0]:
            waiting()


def order_from_parent(orders: int, answers: int, project: Path) -> None:
    """Have the stages of this process give orders to its parent.

    Args:
        orders: Descriptor where the parent reads.
        answers: Descriptor where it writes.
        project: The folder below which all orders lie.
    """
    global _workers
    # An answer is waited for by its descriptor, so none may stay behind in a buffer.
    _workers = OrderingWorkers(
        os.fdopen(orders, "wb"), os.fdopen(answers, "rb", buffering=0), project
    )


def workers_of_this_process() -> Workers | None:
    """Who makes parts of its stages; None = its own threads."""
    return _workers
