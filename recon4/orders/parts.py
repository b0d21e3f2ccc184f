"""Parts of a stage made by workers, in their order; what they cannot make is made here."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Generic, TypeVar

from recon4.errors import StoreError
from recon4.model.events import Warned
from recon4.orders.order import OrderKind, Workers
from recon4.progress import Progress

Made = TypeVar("Made")
"""A part as the stage goes on with it."""
Part = tuple[int, ...]
"""Numbers of a part."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Parts(Generic[Made]):
    """Parts of a stage that workers make."""

    kind: OrderKind
    folder: Path
    """Holds what they need, and receives them."""
    items: Sequence[Part]
    read: Callable[[Part], Made]
    """Reads a part that a worker has left; raises StoreError if it is missing or damaged."""
    here: Callable[[Part], Made]
    """Makes a part in this process."""

    def made(self, workers: Workers, progress: Progress) -> Iterator[Made]:
        """Parts in their order, as soon as each and all before it are made.

        Args:
            workers: Who makes them.
            progress: Receives a warning for each reason why a part was made here.
        """
        failures = self._failures(workers, partial(progress.advance, 0))
        answered: dict[int, str] = {}
        said: set[str] = set()
        for number, item in enumerate(self.items):
            while number not in answered:
                which, failure = next(failures)
                answered[which] = failure
            part, why = self._read(item, answered.pop(number))
            if part is None:
                if why not in said:
                    said.add(why)
                    progress.event(Warned(text=f"made here instead of by a worker: {why}"))
                part = self.here(item)
            yield part

    def _read(self, item: Part, failure: str) -> tuple[Made | None, str]:
        """A part that was made; None and why not, if it was not."""
        if failure:
            return None, failure
        try:
            return self.read(item), ""
        except StoreError as error:
            return None, str(error)

    def _failures(self, workers: Workers, waiting: Callable[[], None]) -> Iterator[tuple[int, str]]:
        """Number of each part as it is answered, and why it was not made; empty = it was."""
        for answer in workers.make(self.kind, self.folder, self.items, waiting=waiting):
            yield answer.item, answer.failure
