"""Who has the review of a project open now, and at which pair. Kept in memory only."""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

from recon4.review.decisions import Pair
from recon4_app.review.tuning import PRESENCE


@dataclass(frozen=True, slots=True)
class Looker:
    """A page of a person."""

    who: str
    pair: Pair | None
    """The pair it shows; None = none."""
    at_s: float
    """When it said so last."""


class Presence:
    """All open review pages of a server; thread-safe."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._pages: OrderedDict[tuple[str, str, str], Looker] = OrderedDict()

    def look(self, project: str, who: str, *, page: str, pair: Pair | None) -> list[Looker]:
        """Note which pair a page shows, and return the other pages of this project.

        Args:
            project: Its id.
            who: The person.
            page: Random name of the page in the browser.
            pair: What it shows; None = no pair.
        """
        mine = (project, who, page)
        with self._lock:
            now_s = self._clock()
            self._pages[mine] = Looker(who, pair, now_s)
            self._pages.move_to_end(mine)
            while self._is_over(now_s):
                self._pages.popitem(last=False)
            others = [
                looker for key, looker in self._pages.items() if key[0] == project and key != mine
            ]
        return sorted(others, key=lambda one: (one.who, one.pair or (-1, -1)))

    def _is_over(self, now_s: float) -> bool:
        oldest = next(iter(self._pages.values()))
        return len(self._pages) > PRESENCE.max_pages or now_s - oldest.at_s > PRESENCE.gone_s
