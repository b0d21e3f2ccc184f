"""Starts workers for waiting jobs and watches all workers, also those of an earlier server.

A worker is alive while it holds its file lock; its progress is in its files. File notifications
are not available on every system, so the files are polled four times a second.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from recon4.errors import StoreError
from recon4.executors.chosen import read_choice
from recon4.locales.coded import CodedText
from recon4.system.stopping import SIGNALS
from recon4_app.errors import Conflict
from recon4_app.jobs.events import read_events
from recon4_app.jobs.folder import JobFolder, Limits, Outcome
from recon4_app.jobs.limits import allowed_memory
from recon4_app.jobs.model import Job, JobKind, JobState
from recon4_app.jobs.reason import said_before
from recon4_app.jobs.run_progress import RunProgress
from recon4_app.jobs.run_progress import after as progress_after
from recon4_app.jobs.silence import SilenceClock, allowed_silence_s
from recon4_app.jobs.status import JobStatus, after
from recon4_app.jobs.store import JobStore
from recon4_app.jobs.tuning import SUPERVISOR_TIMES
from recon4_app.settings import ServerSettings, worker_environment
from recon4_app.threads import in_thread

log = logging.getLogger(__name__)

WORKERS = {
    JobKind.EXPORT: "recon4_app.jobs.export_worker",
    JobKind.COMPARE: "recon4_app.jobs.compare_worker",
    JobKind.TARGETS: "recon4_app.jobs.target_worker",
}
"""Modules that do what is made of a finished map."""


class Tail:
    """Reads the events of a job as they are appended."""

    def __init__(self, folder: JobFolder) -> None:
        self.status = JobStatus()
        self.run = RunProgress()
        self.unreadable = 0
        """Number of events with numbers out of range."""
        self._path = folder.path / "events.jsonl"
        self._offset = 0

    def read(self) -> bool:
        """Read the appended events; whether they changed the status."""
        before = self.status
        events, self._offset = read_events(self._path, self._offset)
        for event in events:
            try:
                status, run = after(self.status, event), progress_after(self.run, event)
            except ArithmeticError:
                self.unreadable += 1  # a worker that a hostile file took over may write anything
            else:
                self.status, self.run = status, run
        return self.status != before

    def forget(self) -> None:
        """Reset: the events so far are those of another worker."""
        self.read()
        self.status, self.run = JobStatus(), RunProgress()


class Supervisor:
    """Runs the queue; one a server."""

    def __init__(self, store: JobStore, settings: ServerSettings) -> None:
        self._store = store
        self._settings = settings
        self._workers: dict[str, subprocess.Popen[bytes]] = {}
        self._tails: dict[str, Tail] = {}
        self._clocks: dict[str, SilenceClock] = {}
        """Of running jobs."""
        self._hung: dict[str, float] = {}
        """Jobs whose worker is being ended -> time without progress [s]."""
        self._loop: asyncio.AbstractEventLoop | None = None
        self._wake = asyncio.Event()
        self._news = asyncio.Event()
        self.news_ended = False
        """Whether the server ends: those who wait for news get none any more."""
        self.version = 0
        """Number of changes of jobs so far."""
        self._touched: dict[str, int] = {}
        self._asked: set[str] = set()

    # -- used by routes

    def folder(self, job_id: str) -> JobFolder:
        """The folder of a job's files."""
        return JobFolder(self._settings.state / "jobs" / job_id)

    def status(self, job: Job) -> JobStatus:
        """The status of a job."""
        if job.state is JobState.QUEUED:
            return JobStatus()
        return self._tail(job).status

    def run_progress(self, job: Job) -> RunProgress:
        """The progress of a job's whole run."""
        if job.state is JobState.QUEUED:
            return RunProgress()
        run = self._tail(job).run
        return replace(run, over=True) if job.state is JobState.SUCCEEDED else run

    def touched_since(self, version: int) -> list[str]:
        """Jobs that changed after that version."""
        touched = list(self._touched.items())  # a copy: the event loop adds meanwhile
        return [job_id for job_id, since in touched if since > version]

    def wake(self, job: Job) -> None:
        """Process the queue now, because a job was added or changed. Thread-safe."""
        self._asked.add(job.id)
        if self._loop is not None:
            self._loop.call_soon_threadsafe(self._wake.set)

    async def news(self, version: int, *, timeout_s: float) -> None:
        """Wait for a later version than this, at most ``timeout_s``, or until `end_news`."""
        if version == self.version and not self.news_ended:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(timeout_s):
                    await self._news.wait()

    def end_news(self) -> None:
        """Let those end who wait for news: the server ends."""
        self.news_ended = True
        self._news.set()

    def cancel(self, job: Job) -> Job:
        """Remove a job from the queue, or request its worker to stop.

        Raises:
            Conflict: If it has ended already.
        """
        if job.over:
            raise Conflict(CodedText("job-over", job=job.id, state=str(job.state)))
        if job.state is JobState.QUEUED:
            try:
                job = self._store.change(job, job.to(JobState.CANCELLED, finished=now()))
            except Conflict:  # it was started after the caller read it
                return self.cancel(self._store.get(job.id))
        else:
            self.folder(job.id).request_stop()
        self.wake(job)
        return job

    # -- the loop

    async def run(self) -> None:
        """Process the queue until cancelled."""
        self._loop = asyncio.get_running_loop()
        while True:
            self._wake.clear()
            asked, self._asked = self._asked, set()
            try:
                changed = await in_thread(self.step)
            except Exception:
                log.exception("the queue could not be processed; trying again")
                changed = set()
            self._publish(changed | asked)
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(SUPERVISOR_TIMES.look_every_s):
                    await self._wake.wait()

    def _publish(self, jobs: set[str]) -> None:
        if jobs:
            self.version += 1
            self._touched |= dict.fromkeys(jobs, self.version)
            self._news.set()
            self._news = asyncio.Event()

    def step(self) -> set[str]:
        """Check every worker and the queue once; ids of the jobs that changed."""
        running = self._store.in_state(JobState.RUNNING)
        changed = {job.id for job in running if self._alone(self._watch, job)}
        return changed | {job.id for job in self._next() if self._alone(self._start, job)}

    def _next(self) -> Iterator[Job]:
        """Jobs to be started; each kind waits for others of its kind only."""
        most = {
            JobKind.PROCESS: self._settings.max_running_jobs,
            JobKind.EXPORT: self._settings.max_running_exports,
            JobKind.COMPARE: self._settings.max_running_exports,
            JobKind.TARGETS: self._settings.max_running_exports,
        }
        for job in self._store.in_state(JobState.RUNNING):
            most[job.kind] -= 1
        for job in self._store.in_state(JobState.QUEUED):
            if most[job.kind] > 0:
                most[job.kind] -= 1
                yield job

    def _alone(self, step: Callable[[Job], bool], job: Job) -> bool:
        """Run a step for one job; a failure does not affect the others. Whether the job changed."""
        try:
            return step(job)
        except Conflict:  # cancelled since it was read: nothing to do
            return True
        except Exception:
            log.exception("job %s: trying again", job.id)
            return False

    def close(self) -> None:
        """Detach from the workers: they go on and the next server adopts them."""
        for worker in self._workers.values():
            if worker.poll() is None:
                worker.returncode = 0  # not ours to wait for any more
        self._workers.clear()

    def _tail(self, job: Job) -> Tail:
        """The events of a job, read from the beginning at the first call."""
        if job.id not in self._tails:
            self._tails[job.id] = Tail(self.folder(job.id))
            self._tails[job.id].read()
        return self._tails[job.id]

    def _start(self, job: Job) -> bool:
        folder = self.folder(job.id)
        limits = Limits(
            memory_bytes=allowed_memory(self._settings.worker_memory_bytes),
            reserve_bytes=self._settings.free_disk_reserve_bytes,
        )
        folder.prepare(job.inputs, self._settings.root.resolve() / job.project, limits)
        self._tail(job).forget()
        with folder.try_lock() as lock:
            # The state is stored first: after a kill between the two lines the next server finds a
            # running job without a worker, which it can repair.
            started = job.started or now()
            attempt = job.attempt + 1
            self._store.change(job, job.to(JobState.RUNNING, attempt=attempt, started=started))
            if lock is not None:
                self._workers[job.id] = _spawn(self._program(job, lock), folder.path, lock)
        return True

    def _program(self, job: Job, lock: int) -> tuple[str, ...]:
        """The module that does a job, and arguments behind its folder."""
        module = WORKERS.get(job.kind, self._settings.worker_module)
        if job.kind is not JobKind.PROCESS or not self._has_workers():
            return (module,)
        return ("recon4_app.jobs.ordering_parent", module, str(lock))

    def _has_workers(self) -> bool:
        """Whether an administrator chose workers for parts of jobs."""
        try:
            return read_choice(self._settings.state).used
        except StoreError:
            log.exception("the choice of workers cannot be read: jobs run without")
            return False

    def _watch(self, job: Job) -> bool:
        changed = self._tail(job).read()
        folder = self.folder(job.id)
        if folder.alive():
            self._end_if_stuck(job, folder)
            return changed
        code = self._exit_code(job)
        folder.end_orphans()
        folder.sweep()
        with contextlib.suppress(OSError):  # not empty: there is a project
            (self._settings.root.resolve() / job.project).rmdir()
        self._tail(job).read()
        self._store.change(job, self._ended(job, folder.outcome(), code))
        self._workers.pop(job.id, None)
        self._hung.pop(job.id, None)
        self._clocks.pop(job.id, None)
        return True

    def _exit_code(self, job: Job) -> int | None:
        """Exit code of a worker that released its lock; None if it has another parent."""
        worker = self._workers.get(job.id)
        if worker is None:
            return None
        try:
            return worker.wait(5.0)  # the lock is released shortly before the process ends
        except subprocess.TimeoutExpired:
            worker.kill()
            return worker.wait()

    def _end_if_stuck(self, job: Job, folder: JobFolder) -> None:
        clock = self._clocks.setdefault(job.id, SilenceClock())
        asked_s = folder.stop_requested_s()
        silent_s = clock.silent_s(folder.heartbeat_ns(), folder.group())
        if asked_s is not None and asked_s > self._settings.stop_within_s:
            folder.kill()
        elif job.id in self._hung:
            folder.kill()  # it had one polling interval to log where it hangs
        elif silent_s > self._allowed_silence_s(job):
            self._hung[job.id] = silent_s
            log.warning("worker %s made no progress for %.0f s: killed", job.id, silent_s)
            folder.kill(signal.SIGABRT)  # it writes the stack of every thread to its log

    def _allowed_silence_s(self, job: Job) -> float:
        status = self._tail(job).status
        return allowed_silence_s(job.kind, status, self._settings.hung_after_s)

    def _ended(self, job: Job, outcome: Outcome | None, code: int | None) -> Job:
        """The job after its worker is gone."""
        if outcome is not None:
            made = None if job.kind is JobKind.PROCESS else outcome.made
            note = said_before(outcome.reason, outcome.note)
            return job.to(JobState(outcome.state), finished=now(), note=note, made=made)
        if self.folder(job.id).stop_requested_s() is not None:
            note = CodedText("job-stopped-early")
            return job.to(JobState.CANCELLED, finished=now(), note=note)
        how, number = exit_reason(code)
        if job.id in self._hung:
            how, number = "silent", round(self._hung[job.id])
        status = self._tail(job).status
        about: dict[str, str | int] = {
            "how": how,
            "number": number,
            "stage": status.stage,
            "what": status.what,
        }
        again, died = "worker-continues", "worker-died"
        if job.kind is not JobKind.PROCESS:
            again, died = "map-worker-continues", "map-worker-died"
        if job.attempt < self._settings.max_job_attempts:
            return job.to(JobState.QUEUED, note=CodedText(again, **about))
        note = CodedText(died, attempts=job.attempt, **about)
        return job.to(JobState.FAILED, finished=now(), note=note)


def now() -> str:
    """Current time, UTC, ISO 8601."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def _spawn(program: tuple[str, ...], folder: Path, lock: int) -> subprocess.Popen[bytes]:
    """Start a worker that holds the lock from its start and survives the server."""
    worker, *arguments = program
    with (folder / "log.txt").open("ab") as output:
        return subprocess.Popen(
            [sys.executable, "-P", "-m", worker, str(folder), *arguments],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            env=worker_environment(),
            pass_fds=(lock,),
            start_new_session=True,
        )


_STOPPED = {128 + number: -number for number in SIGNALS}
"""Exit code of a worker that a signal stopped in order -> what the kernel reports of a signal."""


def exit_reason(code: int | None) -> tuple[str, int]:
    """How a worker ended, from its exit code; None = no server saw it end.

    Returns:
        ``unseen``, ``code``, ``signal`` or the name of a signal, and the number of code or signal.
    """
    if code is None:
        return "unseen", 0
    code = _STOPPED.get(code, code)
    if code >= 0:
        return "code", code
    try:
        return signal.Signals(-code).name, -code
    except ValueError:
        return "signal", -code
