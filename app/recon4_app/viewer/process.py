"""The viewer process: ``-m recon4_app.viewer.process PROJECT IDLE_SECONDS POINTS JOBS SOCKET``.

Listens on the Unix socket and writes ``ready`` as its only line of output. Ends at SIGTERM, after
some time without clients, and with the server, which has the other end of its standard input. It
only reads the project, so it may be killed any time.
"""

from __future__ import annotations

import logging
import shutil
import sys
import threading
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from recon4.sandbox import Network, Policy, confine
from recon4.sandbox.limits import physical_memory_bytes
from recon4.sandbox.private_cache import cached_elsewhere
from recon4.system.processes import die_with_parent
from recon4.system.stopping import StopSignals, end_process, leave_terminal_to_parent
from recon4_app.viewer.client.client_session import ClientSession
from recon4_app.viewer.client.show import Viewer
from recon4_app.viewer.cloud.palette import table
from recon4_app.viewer.scene.source import ProjectSource
from recon4_app.viewer.scratch import scratch_of
from recon4_app.viewer.tuning import VIEWER_PROCESS

log = logging.getLogger(__name__)


class ClientSessions:
    """All clients of the viewer."""

    def __init__(self, source: ProjectSource, project: str, points: int) -> None:
        self._source, self._project, self._points = source, project, points
        self._sessions: dict[int, ClientSession] = {}
        self._gone: set[int] = set()
        self._lock = threading.Lock()

    def take(self, client: Any) -> None:
        """Begin the session of a new client."""
        session = ClientSession(client, self._source, self._project, points=self._points)
        with self._lock:
            left = client.client_id in self._gone
            self._gone.discard(client.client_id)
            if not left:
                self._sessions[client.client_id] = session
        if left:
            session.leave()

    def leave(self, client: Any) -> None:
        """End a client's session, also while it is being created in another thread."""
        with self._lock:
            session = self._sessions.pop(client.client_id, None)
            if session is None:
                self._gone.add(client.client_id)
        if session is not None:
            session.leave()

    def refresh(self) -> None:
        """Refresh all sessions."""
        for session in list(self._sessions.values()):
            session.refresh()


@dataclass(frozen=True, slots=True, kw_only=True)
class Viewing:
    """What a viewer process is started with."""

    project: Path
    """Folder of the project; its name is the project's id."""
    idle_s: float
    """End after this long without a client [s]."""
    points: int
    """Most points sent to one client."""
    jobs: Path
    """Folder of the folders of all jobs."""
    socket: Path
    """Unix socket to listen on."""


def main(viewing: Viewing, stop: StopSignals) -> int:
    """Serve one project until a signal, or until it has been idle for some time; returns 0."""
    project, jobs, socket = viewing.project, viewing.jobs, viewing.socket
    answer, sys.stdout = sys.stdout, sys.stderr  # viser prints to it
    logging.basicConfig(level=logging.WARNING, format="%(asctime)s %(name)s %(message)s")
    scratch = scratch_of(jobs.parent, project.name)
    confine(viewer_policy(project, jobs, scratch, socket=socket.parent))
    over = threading.Event()
    stop.request(over.set)
    threading.Thread(target=table, args=("viridis",), daemon=True).start()  # slow the first time
    source = ProjectSource(project, jobs)
    sessions = ClientSessions(source, project.name, viewing.points)
    viewer = Viewer(socket, on_client=sessions.take, on_leave=sessions.leave)
    answer.write("ready\n")
    answer.flush()
    while not over.wait(VIEWER_PROCESS.look_every_s) and viewer.idle_s < viewing.idle_s:
        if source.changed():
            sessions.refresh()
    viewer.stop()
    shutil.rmtree(scratch, ignore_errors=True)
    return 0


def viewer_policy(project: Path, jobs: Path, scratch: Path, *, socket: Path) -> Policy:
    """The sandbox policy: read the project and its jobs, listen on a Unix socket in one folder."""
    return Policy(
        read=(project, jobs, *cached_elsewhere(scratch)),
        write=(socket,),
        temporary=scratch,
        network=Network.UNIX,
        memory_bytes=int(VIEWER_PROCESS.memory_fraction * physical_memory_bytes()),
    )


if __name__ == "__main__":
    die_with_parent(sys.stdin.fileno())
    leave_terminal_to_parent()
    viewing = Viewing(
        project=Path(sys.argv[1]),
        idle_s=float(sys.argv[2]),
        points=int(sys.argv[3]),
        jobs=Path(sys.argv[4]),
        socket=Path(sys.argv[5]),
    )
    end_process(partial(main, viewing))
