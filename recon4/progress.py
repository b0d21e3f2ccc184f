"""Progress and cancellation, without knowing who watches."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sized
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol, TypeVar

if TYPE_CHECKING:
    from recon4.model.events import Event

Item = TypeVar("Item")


class Progress(Protocol):
    """Receives the progress of a stage; must be cheap, because stages call it often."""

    def start(self, what: str, total: int, unit: str) -> None:
        """Begin a piece of work of ``total`` units (0 = unknown)."""

    def advance(self, done: int = 1) -> None:
        """Say that ``done`` more units are finished.

        Raises:
            Cancelled: If the watcher requested to stop.
        """

    def event(self, event: Event) -> None:
        """Say what was found: an edge, a warning, the end of a stage."""


@dataclass(slots=True)
class Silent:
    """Watches nothing: the default of every library call. Keeps the events, for tests."""

    events: list[Event] = field(default_factory=list)

    def start(self, what: str, total: int, unit: str) -> None:
        """Ignore."""

    def advance(self, done: int = 1) -> None:
        """Ignore."""

    def event(self, event: Event) -> None:
        """Remember."""
        self.events.append(event)


def track(
    items: Iterable[Item], progress: Progress, *, what: str, unit: str, total: int | None = None
) -> Iterator[Item]:
    """Yield the items, one unit of progress each."""
    count = total if total is not None else len(items) if isinstance(items, Sized) else 0
    progress.start(what, count, unit)
    for item in items:
        yield item
        progress.advance()
