"""Has orders made: the trusted parent of a confined process, which talks to the scheduler.

It opens no file of a user. Each order is checked before anything else is done with it.
"""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Callable, Generator
from concurrent.futures import CancelledError
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from recon4.errors import Recon4Error
from recon4.executors.executor import Executor
from recon4.orders.on_worker import PartTask, make_part
from recon4.orders.order import Answer, Order, OrderRefused, receive, send
from recon4.orders.tuning import ORDERS
from recon4.store.package_versions import versions

GONE = (OSError, TimeoutError, CancelledError, RuntimeError)
"""Errors of an executor whose scheduler does not answer any more."""


class TakenOver(Recon4Error):
    """The confined process sent what recon4 never sends: it was ended."""


@dataclass(frozen=True, slots=True)
class Program:
    """A program that gives orders."""

    module: str
    """Its ``main`` takes the descriptors of orders and answers, the project and the arguments."""
    arguments: tuple[str, ...]
    project: Path
    """Below it all orders lie; workers see it under the same name."""
    pass_fds: tuple[int, ...] = ()
    """Further descriptors that it inherits."""


def run_with_workers(
    program: Program,
    executor: Executor,
    *,
    started: Callable[[subprocess.Popen[bytes]], object],
    log: Callable[[str], object],
) -> int:
    """Run a program to its end, and have its orders made meanwhile.

    Args:
        program: The program; its input is a lifeline that ends it with this process.
        executor: Open.
        started: Receives the process.
        log: Receives lines about failures of workers.

    Returns:
        Its exit code; negative = the signal that killed it.

    Raises:
        TakenOver: If it sent what is no order.
    """
    ordered, orders = os.pipe()
    answers, answered = os.pipe()
    command = [sys.executable, "-P", "-m", program.module, str(orders), str(answers)]
    with os.fdopen(ordered, "rb") as receiver, os.fdopen(answered, "wb") as sender:
        try:
            process = subprocess.Popen(
                [*command, str(program.project), *program.arguments],
                stdin=subprocess.PIPE,
                pass_fds=(orders, answers, *program.pass_fds),
                start_new_session=True,  # signals of a terminal come to this process alone
            )
        finally:
            os.close(orders)
            os.close(answers)
        server = _Server(receiver, sender, program.project, executor, log)
        with process:
            started(process)
            thread = threading.Thread(target=server.run, args=(process.kill,), daemon=True)
            thread.start()
            code = _ended(process)
        # What it had ordered is of no use any more: the executor ends it when it is closed.
        thread.join(ORDERS.looks_every_s)
    if server.refused:
        raise TakenOver(
            f"the confined process sent what is no order ({server.refused}) and was ended: a file "
            "that it read may have taken it over"
        )
    return code


def _ended(process: subprocess.Popen[bytes]) -> int:
    try:
        return process.wait()
    except BaseException:
        process.kill()
        raise


@dataclass(slots=True)
class _Server:
    """Reads orders and answers them, until the other side has ended."""

    receiver: BinaryIO
    sender: BinaryIO
    project: Path
    executor: Executor
    log: Callable[[str], object]
    refused: str = ""
    """What was wrong with a message; empty = nothing."""

    def run(self, end: Callable[[], object]) -> None:
        """Serve; ``end`` ends a process that sends what is no order."""
        try:
            while (order := receive(self.receiver, Order)) is not None:
                order.folder_in(self.project)
                with closing(self._answers(order)) as answers:
                    for answer in answers:
                        send(self.sender, answer)
        except OrderRefused as error:
            self.refused = str(error)
            end()
        except (BrokenPipeError, ValueError):
            pass  # it has ended before all was made

    def _answers(self, order: Order) -> Generator[Answer, None, None]:
        """An answer for each part; those of which nothing is heard any more have failed."""
        tasks = _tasks(order, self.project)
        left, why = set(range(len(tasks))), "not heard of again"
        try:
            for ended in self.executor.run(make_part, tasks, _say):
                failure = ended.failure or ended.result or ""
                if failure:
                    self.log(f"{order.kind} {ended.task.numbers}: {failure}")
                left.discard(ended.task.item)
                yield Answer(item=ended.task.item, failure=failure[: ORDERS.failure])
        except GONE as error:
            why = f"the scheduler is gone: {error}"
            self.log(why)
        for item in sorted(left):
            yield Answer(item=item, failure=why[: ORDERS.failure])


def _tasks(order: Order, project: Path) -> list[PartTask]:
    here = tuple(versions().items())
    below = str(project.absolute())
    return [
        PartTask(item, str(order.kind), below, order.folder, numbers, here)
        for item, numbers in enumerate(order.items)
    ]


def _say(name: str, line: str) -> None:
    """Parts say nothing; their results do."""
