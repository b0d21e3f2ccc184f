"""The parent of a worker whose parts other workers make.

``python -m recon4_app.jobs.ordering_parent JOB_FOLDER MODULE LOCK``

The worker is confined and reaches no scheduler, so this process asks for it
(`recon4.orders.parent`). It opens no file of a user, holds the lock of the job, too, and ends as
the worker does: when it is gone, no order runs any more.
"""

from __future__ import annotations

import contextlib
import json
import logging
import os
import resource
import signal
import subprocess
import sys
import time
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

from recon4.errors import ConfigError, StoreError
from recon4.executors.chosen import chosen_cluster, read_choice
from recon4.executors.cluster import Cluster
from recon4.locales.coded import CodedText
from recon4.orders.parent import Program, TakenOver, run_with_workers
from recon4.orders.work_log import WorkerRecord
from recon4.system.stopping import StopSignals, end_process
from recon4_app.jobs.folder import JobFolder, failure
from recon4_app.jobs.limits import give_way
from recon4_app.jobs.tuning import ORDERING

log = logging.getLogger("recon4.job")


def main(stop: StopSignals) -> int:
    """Run the worker of a job to its end and return its exit code."""
    folder, module = JobFolder(Path(sys.argv[1])), sys.argv[2]
    folder.mark_worker()
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(message)s", datefmt="%H:%M:%S")
    logging.getLogger("distributed").setLevel(logging.WARNING)
    give_way()
    state = folder.path.parents[1]
    project = folder.request().project
    project.mkdir(parents=True, exist_ok=True)  # workers are asked whether they see it
    with ExitStack() as opened:
        try:
            cluster = opened.enter_context(chosen_cluster(state, read_choice(state), project))
        except (ConfigError, StoreError) as error:
            _without_workers(folder, module, str(error))
        log.info("workers: %d connected", cluster.size)
        code = _run(folder, module, project, cluster=cluster, stop=stop)
    if code < 0:
        _end_by(-code)
    return code


def _run(
    folder: JobFolder, module: str, project: Path, *, cluster: Cluster, stop: StopSignals
) -> int:
    """Run the worker, and have its orders made meanwhile."""
    lock = int(sys.argv[3])  # held by both
    program = Program(
        "recon4_app.jobs.ordering_worker", (module, str(folder.path)), project, (lock,)
    )
    shown = Shown(folder.path / "workers.json")

    def started(process: subprocess.Popen[bytes]) -> None:
        stop.request(partial(_pass_on, stop, process))

    try:
        code = run_with_workers(program, cluster, started=started, log=_say, who=shown)
    except TakenOver as error:
        log.error("%s", error)
        folder.finish(failure(CodedText("job-taken-over")))
        code = 1
    folder.mark_worker()  # what is left to do is this process's
    if stop.received is not None:
        stop.is_said()
    return code


def _without_workers(folder: JobFolder, module: str, why: str) -> None:
    """Become the worker itself: it makes all parts by threads."""
    log.warning("workers: %s: this computer makes all parts", why)
    Shown(folder.path / "workers.json").write(problem=why)
    logging.shutdown()
    command = [sys.executable, "-P", "-m", module, str(folder.path)]
    os.execv(sys.executable, command)


def _pass_on(stop: StopSignals, process: subprocess.Popen[bytes]) -> None:
    assert stop.received is not None
    process.send_signal(stop.received)


def _end_by(number: int) -> None:
    """End as the worker did, so that the server sees why."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with contextlib.suppress(OSError, ValueError):  # SIGKILL has no handler
        signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)


def _say(line: str) -> None:
    log.info("workers: %s", line)


@dataclass(slots=True)
class Shown:
    """Writes who works into a file of the job, at most a few times a second."""

    path: Path
    _due_s: float = 0.0

    def __call__(self, workers: tuple[WorkerRecord, ...]) -> None:
        """Write them, now or with a later change."""
        now_s = time.monotonic()
        if now_s >= self._due_s or not any(one.part for one in workers):
            self._due_s = now_s + ORDERING.every_s
            self.write(workers)

    def write(self, workers: tuple[WorkerRecord, ...] = (), *, problem: str = "") -> None:
        """Write the file; a full disk is reported by the work itself."""
        value = {"workers": [asdict(one) for one in workers], "problem": problem}
        beside = self.path.with_suffix(".new")
        with contextlib.suppress(OSError):
            beside.write_text(json.dumps(value), "utf-8")
            os.replace(beside, self.path)


if __name__ == "__main__":
    end_process(main)
