"""The real worker, which waits in the middle of each stage until the test lets it go on.

A gate is a file the test holds locked: the kernel lets the worker through, no clock.
"""

from __future__ import annotations

import fcntl
import sys
from pathlib import Path

from recon4.model.events import Event, StageChanged
from recon4.progress import Progress
from recon4.sandbox import Policy
from recon4.system.stopping import end_process
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.limits import worker_policy
from recon4_app.jobs.worker import main, process

AT_GATE = "waiting at the gate"


class Gated:
    """Forwards progress; waits at its gate after the first unit of work of a stage."""

    def __init__(self, progress: Progress, gates: Path) -> None:
        self._progress, self._gates = progress, gates
        self._stage = ""
        self._piece = ("", 0, "")

    def start(self, what: str, total: int, unit: str) -> None:
        self._piece = (what, total, unit)
        self._progress.start(what, total, unit)

    def advance(self, done: int = 1) -> None:
        self._progress.advance(done)
        stage, self._stage = self._stage, ""
        if stage:
            self._progress.start(AT_GATE, 0, "")
            with (self._gates / stage).open() as gate:
                fcntl.flock(gate, fcntl.LOCK_SH)
            self._progress.start(*self._piece)

    def event(self, event: Event) -> None:
        if isinstance(event, StageChanged):
            self._stage = event.stage if event.state == "running" else ""
        self._progress.event(event)


def work(folder: JobFolder, progress: Progress) -> None:
    project = folder.request().project
    process(folder, Gated(progress, project.parent / "gates"))


def policy(folder: JobFolder) -> Policy:
    """It also reads the gates."""
    project = folder.request().project
    return worker_policy(folder).adding(read=(project.parent / "gates",))


if __name__ == "__main__":
    end_process(lambda _: main(Path(sys.argv[1]), work, policy))
