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
from recon4.executors.executor import Executor, Finished
from recon4.orders.on_worker import PartTask
from recon4.orders.order import Answer, Order, OrderRefused, receive, send
from recon4.orders.tuning import ORDERS
from recon4.orders.work_log import PartReport, WorkerRecord, WorkLog, report_part
from recon4.store.package_versions import versions
from recon4.untrusted.names import visible

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
    who: Callable[[tuple[WorkerRecord, ...]], object] = lambda workers: None,
) -> int:
    """Run a program to its end, and have its orders made meanwhile.

    Args:
        program: The program; its input is a lifeline that ends it with this process.
        executor: Open.
        started: Receives the process.
        log: Receives lines of workers and about them, without control characters.
        who: Receives who works, after each change and in any thread.

    Returns:
        Its exit code; negative = the signal that killed it.

    Raises:
        TakenOver: If it sent what is no order.
    """
    ordered, orders = os.pipe()
    answers, answered = os.pipe()
    command = [sys.executable, "-P", "-m", program.module, str(orders), str(answers)]
    # Without a buffer: to close one that the other side has not read would fail.
    with os.fdopen(ordered, "rb") as receiver, os.fdopen(answered, "wb", buffering=0) as sender:
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
        server = _Server(receiver, sender, program.project, executor, WorkLog(who, log))
        with process:
            started(process)
            code = server.serve(process)
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
    work: WorkLog
    refused: str = ""
    """What was wrong with a message; empty = nothing."""

    def serve(self, process: subprocess.Popen[bytes]) -> int:
        """Serve a process until it has ended; its exit code."""
        thread = threading.Thread(target=self.run, args=(process.kill,), daemon=True)
        thread.start()
        code = _ended(process)
        # What it had ordered is of no use any more: the executor ends it when it is closed.
        thread.join(ORDERS.looks_every_s)
        return code

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
        except BrokenPipeError:
            pass  # it has ended before all was made
        except BaseException:
            if not self.sender.closed:  # else it has ended, and nobody waits for an answer
                end()
                raise

    def _answers(self, order: Order) -> Generator[Answer, None, None]:
        """An answer for each part; those of which nothing is heard any more have failed."""
        tasks = _tasks(order, self.project)
        left, why = set(range(len(tasks))), "not heard of again"

        def say(name: str, line: str) -> None:
            self._heard(order, name, line)

        self.work.order()
        try:
            for ended in self.executor.run(report_part, tasks, say):
                failure = visible(self._failure(ended), most=ORDERS.failure)
                if failure:
                    self.work.log(f"{order.kind} {ended.task.numbers}: {failure}")
                left.discard(ended.task.item)
                yield Answer(item=ended.task.item, failure=failure)
        except GONE as error:
            why = f"the scheduler is gone: {error}"
            self.work.log(why)
        finally:
            self.work.over()
        for item in sorted(left):
            yield Answer(item=item, failure=why[: ORDERS.failure])

    def _failure(self, ended: Finished[PartTask, PartReport]) -> str:
        """Why a part could not be made; empty if it is made."""
        item = str(ended.task.item)
        if ended.result is None:
            self.work.lost(item)
            return ended.failure
        self.work.ends(item, ended.result)
        return ended.result.failure

    def _heard(self, order: Order, item: str, line: str) -> None:
        """A line of a worker: who begins a part, what its maker said, or nothing."""
        worker, _, said = line.partition(": ")
        if said:
            self.work.log(visible(line, most=ORDERS.failure))
        elif worker:
            self.work.begins(item, worker, f"{order.kind} {order.items[int(item)]}")


def _tasks(order: Order, project: Path) -> list[PartTask]:
    here = tuple(versions().items())
    below = str(project.absolute())
    return [
        PartTask(item, str(order.kind), below, order.folder, numbers, here)
        for item, numbers in enumerate(order.items)
    ]
