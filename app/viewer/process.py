"""The viewer process: ``python -m app.viewer.process PROJECT IDLE_SECONDS POINTS JOBS SOCKET``.

Listens on the Unix socket and writes ``ready`` as its only line of output. Ends at SIGTERM, when
nobody has looked for a while, and with the server, which holds the other end of its standard
input. It only reads the project, so it may be killed any time.
"""

from __future__ import annotations

import logging
import shutil
import signal
import sys
import threading
from pathlib import Path
from typing import Any

from app.viewer.client.client_session import ClientSession
from app.viewer.client.show import Viewer
from app.viewer.cloud.palette import table
from app.viewer.scene.source import ProjectSource
from recon4.processes import die_with_parent
from recon4.sandbox import Network, Policy, confine
from recon4.sandbox.limits import physical_memory_bytes
from recon4.sandbox.private_cache import use_private_cache

SHARE_OF_MEMORY = 0.7
LOOK_EVERY_S = 0.5
"""A running job's new artifacts and findings are looked for this often [s]."""

log = logging.getLogger(__name__)


class ClientSessions:
    """All clients of the viewer."""

    def __init__(self, source: ProjectSource, project: str, points: int) -> None:
        self._source, self._project, self._points = source, project, points
        self._taken: dict[int, ClientSession] = {}
        self._gone: set[int] = set()
        self._lock = threading.Lock()

    def take(self, client: Any) -> None:
        """Seat a new client."""
        seat = ClientSession(client, self._source, self._project, points=self._points)
        with self._lock:
            left = client.client_id in self._gone
            self._gone.discard(client.client_id)
            if not left:
                self._taken[client.client_id] = seat
        if left:
            seat.leave()

    def leave(self, client: Any) -> None:
        """Forget a client, also one that leaves while it is being seated in another thread."""
        with self._lock:
            seat = self._taken.pop(client.client_id, None)
            if seat is None:
                self._gone.add(client.client_id)
        if seat is not None:
            seat.leave()

    def refresh(self) -> None:
        """Show everybody what is new."""
        for seat in list(self._taken.values()):
            seat.refresh()


def main(project: Path, idle_s: float, *, points: int, jobs: Path, socket: Path) -> None:
    """Serve one project until nobody needs it.

    Args:
        project: Its folder; the folder's name is its id.
        idle_s: End after so long without a client [s].
        points: At most so many are sent to a client.
        jobs: Folder of the folders of all jobs.
        socket: Path of the Unix socket to listen on.
    """
    answer, sys.stdout = sys.stdout, sys.stderr  # viser greets people on it
    logging.basicConfig(level=logging.WARNING, format="%(asctime)s %(name)s %(message)s")
    scratch = jobs.parent / "viewers" / f"{project.name}.tmp"
    shutil.rmtree(scratch, ignore_errors=True)  # of a viewer that was killed
    confine(viewer_policy(project, jobs, scratch, socket=socket.parent))
    over = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: over.set())
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in the terminal is the server's to handle
    threading.Thread(target=table, args=("viridis",), daemon=True).start()  # slow the first time
    source = ProjectSource(project, jobs)
    seats = ClientSessions(source, project.name, points)
    viewer = Viewer(socket, on_client=seats.take, on_leave=seats.leave)
    answer.write("ready\n")
    answer.flush()
    while not over.wait(LOOK_EVERY_S) and viewer.idle_s < idle_s:
        if source.changed():
            seats.refresh()
    viewer.stop()
    shutil.rmtree(scratch, ignore_errors=True)


def viewer_policy(project: Path, jobs: Path, scratch: Path, *, socket: Path) -> Policy:
    """Read the project and how far its jobs are; listen on a Unix socket in one folder."""
    return Policy(
        read=(project, jobs, *use_private_cache(scratch)),
        write=(socket,),
        temporary=scratch,
        network=Network.UNIX,
        memory_bytes=int(SHARE_OF_MEMORY * physical_memory_bytes()),
    )


if __name__ == "__main__":
    die_with_parent(sys.stdin.fileno())
    main(
        Path(sys.argv[1]),
        float(sys.argv[2]),
        points=int(sys.argv[3]),
        jobs=Path(sys.argv[4]),
        socket=Path(sys.argv[5]),
    )
