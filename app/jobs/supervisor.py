"""Gives waiting jobs a worker and watches the workers there are, also those of a server before.

Whether a worker lives is asked of the kernel (the lock it holds), how far it is of its files.
Files make no noise on every system, so they are looked at four times a second.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from app.errors import Conflict
from app.jobs.events import read_events
from app.jobs.exit_reasons import ending
from app.jobs.folder import JobFolder, Limits, Outcome
from app.jobs.limits import allowed_memory
from app.jobs.model import Job, JobState
from app.jobs.run_progress import RunProgress
from app.jobs.run_progress import after as further
from app.jobs.silence import allowed_silence_s
from app.jobs.status import Status, after
from app.jobs.store import JobStore
from app.settings import ServerSettings, worker_environment

log = logging.getLogger(__name__)

LOOK_EVERY_S = 0.25


class Tail:
    """What a job's events say so far."""

    def __init__(self, folder: JobFolder) -> None:
        self.status = Status()
        self.overall = RunProgress()
        self.unreadable = 0
        """Events that make no sense."""
        self._path = folder.path / "events.jsonl"
        self._offset = 0

    def read(self) -> bool:
        """Take in what was appended; whether that changed the status."""
        before = self.status
        events, self._offset = read_events(self._path, self._offset)
        for event in events:
            try:
                status, overall = after(self.status, event), further(self.overall, event)
            except (TypeError, ValueError, ArithmeticError, LookupError, AttributeError):
                self.unreadable += 1  # a worker that a file has taken over writes what it likes
            else:
                self.status, self.overall = status, overall
        return self.status != before

    def forget(self) -> None:
        """Start anew: what was said so far was another worker's."""
        self.read()
        self.status, self.overall = Status(), RunProgress()


class Supervisor:
    """The queue's engine; one a server."""

    def __init__(self, store: JobStore, settings: ServerSettings) -> None:
        self._store = store
        self._settings = settings
        self._workers: dict[str, subprocess.Popen[bytes]] = {}
        self._tails: dict[str, Tail] = {}
        self._beats: dict[str, tuple[int, float]] = {}
        """Running jobs -> heartbeat seen last, and when on the monotonic clock [s]."""
        self._hung: dict[str, float] = {}
        """Jobs whose worker is being ended -> how long it made no progress [s]."""
        self._loop: asyncio.AbstractEventLoop | None = None
        self._wake = asyncio.Event()
        self._news = asyncio.Event()
        self.version = 0
        """Counts whatever happened to any job."""
        self._touched: dict[str, int] = {}
        self._asked: set[str] = set()

    # -- asked by routes

    def folder(self, job_id: str) -> JobFolder:
        """Where a job's files are."""
        return JobFolder(self._settings.state / "jobs" / job_id)

    def status(self, job: Job) -> Status:
        """How far a job is."""
        if job.state is JobState.QUEUED:
            return Status()
        return self._tail(job).status

    def overall(self, job: Job) -> RunProgress:
        """How far its whole run is."""
        if job.state is JobState.QUEUED:
            return RunProgress()
        overall = self._tail(job).overall
        return replace(overall, over=True) if job.state is JobState.SUCCEEDED else overall

    def touched_since(self, version: int) -> list[str]:
        """Jobs that something happened to after that version."""
        return [job_id for job_id, touched in self._touched.items() if touched > version]

    def wake(self, job: Job) -> None:
        """A job was added or changed: look at the queue now. From any thread."""
        self._asked.add(job.id)
        if self._loop is not None:
            self._loop.call_soon_threadsafe(self._wake.set)

    async def news(self, version: int, *, timeout_s: float) -> None:
        """Wait until there is a later version than that, at most so long."""
        if version == self.version:
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._news.wait(), timeout_s)

    def cancel(self, job: Job) -> Job:
        """Take a job out of the queue, or ask its worker to stop.

        Raises:
            Conflict: If it is over already.
        """
        if job.over:
            raise Conflict(f"job {job.id} is {job.state} already")
        if job.state is JobState.QUEUED:
            try:
                job = self._store.change(job, job.to(JobState.CANCELLED, finished=now()))
            except Conflict:  # it was started between the caller's look and ours
                return self.cancel(self._store.get(job.id))
        else:
            self.folder(job.id).ask_to_stop()
        self.wake(job)
        return job

    # -- the engine

    async def run(self) -> None:
        """Watch until cancelled."""
        self._loop = asyncio.get_running_loop()
        while True:
            self._wake.clear()
            asked, self._asked = self._asked, set()
            try:
                changed = await asyncio.to_thread(self.step)
            except Exception:
                log.exception("the queue could not be looked after; trying again")
                changed = set()
            self._tell(changed | asked)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._wake.wait(), LOOK_EVERY_S)

    def _tell(self, jobs: set[str]) -> None:
        if jobs:
            self.version += 1
            self._touched |= dict.fromkeys(jobs, self.version)
            self._news.set()
            self._news = asyncio.Event()

    def step(self) -> set[str]:
        """Look at every worker and the queue once; ids of the jobs that changed."""
        running = self._store.in_state(JobState.RUNNING)
        changed = {job.id for job in running if self._alone(self._watch, job)}
        free = self._settings.running_jobs - len(self._store.in_state(JobState.RUNNING))
        waiting = self._store.in_state(JobState.QUEUED)[: max(0, free)]
        return changed | {job.id for job in waiting if self._alone(self._start, job)}

    def _alone(self, step: Callable[[Job], bool], job: Job) -> bool:
        """Take a step with one job; if it fails the others go on. Whether the job changed."""
        try:
            return step(job)
        except Conflict:  # cancelled since it was read: nothing to do
            return True
        except Exception:
            log.exception("job %s: trying again", job.id)
            return False

    def close(self) -> None:
        """Leave the workers alone: they go on and the next server adopts them."""
        for worker in self._workers.values():
            if worker.poll() is None:
                worker.returncode = 0  # not ours to wait for any more
        self._workers.clear()

    def _tail(self, job: Job) -> Tail:
        """Its events, read from the beginning when nobody has yet."""
        if job.id not in self._tails:
            self._tails[job.id] = Tail(self.folder(job.id))
            self._tails[job.id].read()
        return self._tails[job.id]

    def _start(self, job: Job) -> bool:
        folder = self.folder(job.id)
        limits = Limits(
            memory_bytes=allowed_memory(self._settings.memory_bytes),
            reserve_bytes=self._settings.reserve_bytes,
        )
        folder.prepare(job.inputs, self._settings.root.resolve() / job.project, limits)
        self._tail(job).forget()
        with folder.try_lock() as lock:
            # The state comes first: a server killed between the two lines finds a running job
            # without a worker, which is the case it knows how to repair.
            started = job.started or now()
            attempt = job.attempt + 1
            self._store.change(job, job.to(JobState.RUNNING, attempt=attempt, started=started))
            if lock is not None:
                self._workers[job.id] = _spawn(self._settings.worker, folder.path, lock)
        return True

    def _watch(self, job: Job) -> bool:
        changed = self._tail(job).read()
        folder = self.folder(job.id)
        if folder.alive():
            self._end_if_stuck(job, folder)
            return changed
        code = self._exit_code(job)
        folder.end_orphans()
        folder.sweep()
        self._tail(job).read()
        self._store.change(job, self._ended(job, folder.outcome(), code))
        self._workers.pop(job.id, None)
        self._hung.pop(job.id, None)
        self._beats.pop(job.id, None)
        return True

    def _exit_code(self, job: Job) -> int | None:
        """How a worker that let go of its lock ended; None if a server before was its parent."""
        worker = self._workers.get(job.id)
        if worker is None:
            return None
        try:
            return worker.wait(5.0)  # the lock goes a moment before the process
        except subprocess.TimeoutExpired:
            worker.kill()
            return worker.wait()

    def _end_if_stuck(self, job: Job, folder: JobFolder) -> None:
        asked_s, silent_s = folder.asked_to_stop_s(), self._silent_s(job, folder)
        if asked_s is not None and asked_s > self._settings.stop_within_s:
            folder.kill()
        elif job.id in self._hung:
            folder.kill()  # it had the time of one look to say where it hangs
        elif silent_s > allowed_silence_s(self._tail(job).status, self._settings.hung_after_s):
            self._hung[job.id] = silent_s
            log.warning("worker %s made no progress for %.0f s: killed", job.id, silent_s)
            folder.kill(signal.SIGABRT)  # it writes into its log where every thread is

    def _silent_s(self, job: Job, folder: JobFolder) -> float:
        """Seconds since the heartbeat was last seen to change, on a clock that never jumps."""
        now_s, beat_ns = time.monotonic(), folder.heartbeat_ns()
        seen_ns, since_s = self._beats.get(job.id, (None, now_s))
        if beat_ns != seen_ns:
            since_s = now_s
        self._beats[job.id] = beat_ns, since_s
        return now_s - since_s

    def _ended(self, job: Job, outcome: Outcome | None, code: int | None) -> Job:
        """The job after its worker is gone."""
        if outcome is not None:
            return job.to(JobState(outcome.state), finished=now(), note=outcome.note)
        where, how = self._tail(job).status.where, ending(code)
        if job.id in self._hung:
            how = f"made no progress for {self._hung[job.id]:.0f} s and was killed"
        if self.folder(job.id).asked_to_stop_s() is not None:
            return job.to(JobState.CANCELLED, finished=now(), note="stopped on request")
        if job.attempt < self._settings.attempts:
            note = f"the worker {how}, {where}; it goes on after the last finished stage"
            return job.to(JobState.QUEUED, note=note)
        note = (
            f"the worker died {job.attempt} times: last it {how}, {where}; perhaps the recording "
            "is damaged or too large for this computer: see the log, then resume"
        )
        return job.to(JobState.FAILED, finished=now(), note=note)


def now() -> str:
    """This moment, UTC, ISO 8601."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def _spawn(worker: str, folder: Path, lock: int) -> subprocess.Popen[bytes]:
    """Start a worker that holds the lock from its first moment and survives the server."""
    with (folder / "log.txt").open("ab") as output:
        return subprocess.Popen(
            [sys.executable, "-m", worker, str(folder)],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            env=worker_environment(),
            pass_fds=(lock,),
            start_new_session=True,
        )
