"""The viewer process: ``python -m app.viewer.process PROJECT IDLE_SECONDS POINTS``.

Writes ``{"port": n}`` as its only line of output; ends when its input is closed (the server is
gone) or nobody has looked for a while. It only reads the project, so it may be killed any time.
"""

from __future__ import annotations

import json
import logging
import sys
import threading
from pathlib import Path
from typing import Any

from app.viewer.panels import Panel
from app.viewer.scene import View, bounds, describe, legend
from app.viewer.show import Screen, Viewer
from app.viewer.source import ProjectSource

LOOK_EVERY_S = 1.0
"""A running job's new artifacts are looked for this often [s]."""

log = logging.getLogger(__name__)


class Seat:
    """One client: its panel, its screen and what it is shown."""

    def __init__(self, client: Any, source: ProjectSource, points: int) -> None:
        self._source = source
        self._lock = threading.Lock()
        self._screen = Screen(client, points)
        self._content = source.content(self._screen.budget)
        self._panel = Panel(client.gui, self._content, on_change=self._draw)
        self._screen.look_at(bounds(self._content))
        self._draw(self._panel.view)

    def refresh(self) -> None:
        """Show what the project has by now."""
        before = self._content
        self._content = self._source.content(self._screen.budget)
        self._panel.offer(self._content)
        self._draw(self._panel.view)
        if not before.tiles and before.trajectory is None:
            self._screen.look_at(bounds(self._content))

    def _draw(self, view: View) -> None:
        with self._lock:
            self._screen.show(describe(self._content, view))
            self._panel.explain(legend(self._content, view))


class Seats:
    """All clients of the viewer."""

    def __init__(self, source: ProjectSource, points: int) -> None:
        self._source = source
        self._points = points
        self._taken: dict[int, Seat] = {}

    def take(self, client: Any) -> None:
        """Seat a new client."""
        self._taken[client.client_id] = Seat(client, self._source, self._points)

    def leave(self, client: Any) -> None:
        """Forget a client."""
        self._taken.pop(client.client_id, None)

    def refresh(self) -> None:
        """Show everybody what is new."""
        for seat in list(self._taken.values()):
            seat.refresh()


def main(project: Path, idle_s: float, points: int) -> None:
    """Serve one project until nobody needs it."""
    answer, sys.stdout = sys.stdout, sys.stderr  # viser greets people on it
    logging.basicConfig(level=logging.WARNING, format="%(asctime)s %(name)s %(message)s")
    over = threading.Event()
    threading.Thread(target=_wait_for_end_of_input, args=(over,), daemon=True).start()
    source = ProjectSource(project)
    seats = Seats(source, points)
    viewer = Viewer(on_client=seats.take, on_leave=seats.leave)
    answer.write(json.dumps({"port": viewer.port}) + "\n")
    answer.flush()
    while not over.wait(LOOK_EVERY_S) and viewer.idle_s < idle_s:
        if source.changed():
            seats.refresh()
    viewer.stop()


def _wait_for_end_of_input(over: threading.Event) -> None:
    sys.stdin.read()
    over.set()


if __name__ == "__main__":
    main(Path(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3]))
