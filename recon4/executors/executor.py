"""Runs the same function on many tasks: in this process, or on workers of a cluster.

A task is small and plain: names of files and settings. What is computed lies in files that all
workers see, so nothing of a recording is ever sent as an object.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")

Say = Callable[[str, str], None]
"""Receives lines of progress: the name of a task, and the line; an empty line only asks whether to
go on. Raises `Cancelled` if not."""


@dataclass(frozen=True, slots=True)
class Finished(Generic[Task, Result]):
    """A task that ended."""

    task: Task
    result: Result | None
    """None if no worker could finish it."""
    failure: str = ""
    """Why not."""


class Executor(Protocol):
    """Runs tasks; a context manager."""

    def run(
        self, function: Callable[[Task, Say], Result], tasks: Sequence[Task], say: Say
    ) -> Iterator[Finished[Task, Result]]:
        """Yield each task as soon as it has ended, in whatever order.

        Args:
            function: What is done with a task; importable by its name.
            tasks: Plain values.
            say: Receives the lines that the function says.
        """

    def __enter__(self) -> Executor:
        """Begin."""

    def __exit__(self, *_: object) -> None:
        """End all work that still runs."""


class InOrder:
    """One task after the other, in this process."""

    def run(
        self, function: Callable[[Task, Say], Result], tasks: Sequence[Task], say: Say
    ) -> Iterator[Finished[Task, Result]]:
        """Yield each task when it has ended, in order."""
        for task in tasks:
            yield Finished(task, function(task, say))

    def __enter__(self) -> InOrder:
        return self

    def __exit__(self, *_: object) -> None:
        """Nothing runs any more."""
