"""The folder through which server and worker communicate: plain files, so either may die any time.

request.json    the job, written by the server before the worker starts
lock            locked (flock) by the worker while it lives; the kernel releases it
pid             the worker's process and group
heartbeat       written by the worker when its work advances
cancel          created by the server: request to stop
events.jsonl    progress (`recon4_app.jobs.events`), appended by the worker
log.txt         output of the worker
room            reserved bytes, freed for the outcome when the disk is full
tmp             the worker's temporary files; emptied when it has ended
made            the file of an export
workers.json    who makes parts of it on other processes (`recon4_app.jobs.ordering_parent`)
outcome.json    how it ended, written last and atomically
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

import msgspec

from recon4.delivery.kinds import ExportedFile
from recon4.orders.work_log import WorkerRecord
from recon4.recording.info.files_near import files_near
from recon4.store.atomic import make_folders, write_json, write_text
from recon4.store.atomic import sweep as sweep_unfinished
from recon4.store.locks import trying_lock
from recon4.untrusted.typed import as_type, decoded
from recon4_app.jobs.model import Inputs
from recon4_app.jobs.reason import JobReason, reason_of
from recon4_app.jobs.tuning import JOB_FILES


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """How a worker ended by itself."""

    state: Literal["succeeded", "failed", "cancelled"]
    note: str = ""
    """Why, and what to do; in English."""
    reason: JobReason | None = None
    """Code and values of `note`; None = it has none."""
    startable: bool = True
    """False = its recording or rig cannot be used, and no project was made: running it again would
    fail alike."""
    no_space: bool = False
    """Whether the disk was full."""
    made: ExportedFile | None = None
    """The file that an export has made."""


def failure(note: str, *, startable: bool = True, no_space: bool = False) -> Outcome:
    """The outcome of a worker that failed."""
    return Outcome(
        state="failed",
        note=str(note),
        reason=reason_of(note),
        startable=startable,
        no_space=no_space,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Resource limits of a worker."""

    memory_bytes: int
    reserve_bytes: int
    """Disk space that must stay free; otherwise the worker does not begin."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerRequest:
    """What a worker is to do."""

    project: Path
    """Its folder."""
    inputs: Inputs
    limits: Limits
    near: tuple[Path, ...]
    """Files beside the recordings, which the worker may read but not list."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JobWorkers:
    """Who makes parts of a job that can be divided."""

    workers: tuple[WorkerRecord, ...] = ()
    """Those that have made a part, or make one."""
    problem: str = ""
    """Why the workers that an administrator chose are not used, in English; empty = nothing."""


@dataclass(frozen=True, slots=True)
class JobFolder:
    """One job's folder."""

    path: Path

    @property
    def temporary(self) -> Path:
        """Folder of the worker's temporary files."""
        return self.path / "tmp"

    @property
    def made(self) -> Path:
        """Folder of the file of an export."""
        return self.path / "made"

    def prepare(self, inputs: Inputs, project: Path, limits: Limits) -> None:
        """Write the request; remove the files of an earlier attempt."""
        make_folders(self.path)
        for path in self.path.iterdir():
            if path.is_dir() and not path.is_symlink():  # none of ours but the temporary files
                shutil.rmtree(path)
        sweep_unfinished(self.path)
        for name in ("pid", "heartbeat", "outcome.json", "workers.json"):
            (self.path / name).unlink(missing_ok=True)
        near = [str(file) for path in inputs.recordings for file in files_near(Path(path))]
        request = {
            "project": str(project),
            "inputs": asdict(inputs),
            "limits": asdict(limits),
            "near": near,
        }
        write_json(self.path / "request.json", request)

    def sweep(self) -> None:
        """Remove the temporary files of a worker that has ended, and what it made in part."""
        shutil.rmtree(self.temporary, ignore_errors=True)
        outcome = self.outcome()
        if outcome is None or outcome.made is None:
            shutil.rmtree(self.made, ignore_errors=True)
        (self.path / "room").unlink(missing_ok=True)
        sweep_unfinished(self.path)

    def request(self) -> WorkerRequest:
        """What the server wrote for the worker."""
        request = json.loads((self.path / "request.json").read_text("utf-8"))
        return WorkerRequest(
            project=Path(request["project"]),
            inputs=as_type(request["inputs"], Inputs),
            limits=as_type(request["limits"], Limits),
            near=tuple(map(Path, request["near"])),
        )

    @contextlib.contextmanager
    def try_lock(self) -> Iterator[int | None]:
        """File descriptor of the lock, None while a worker holds it."""
        with trying_lock(self.path / "lock") as descriptor:
            yield descriptor

    def alive(self) -> bool:
        """Whether a worker is alive, by its lock: a reused process number does not matter."""
        with self.try_lock() as lock:
            return lock is None

    def heartbeat_ns(self) -> int:
        """Time of the last heartbeat on the clock of the file system [ns]; 0 = none yet."""
        try:
            return (self.path / "heartbeat").stat().st_mtime_ns
        except FileNotFoundError:
            return 0

    def request_stop(self) -> None:
        """Request the worker to stop at its next unit of work."""
        (self.path / "cancel").touch()

    def stop_requested_s(self) -> float | None:
        """Seconds since the worker was requested to stop, None if it was not.

        If the clock was set back meanwhile they count from now.
        """
        try:
            since_s = time.time() - (self.path / "cancel").stat().st_mtime
        except FileNotFoundError:
            return None
        if since_s < 0.0:
            self.request_stop()
        return max(0.0, since_s)

    def kill(self, sign: signal.Signals = signal.SIGKILL) -> None:
        """Send a signal to the worker and its children. Call only while `alive`."""
        number = self.group()
        if number is not None and _is_worker_of(number, self.path):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(number, sign)

    def end_orphans(self) -> None:
        """End the children of a dead worker. Its process group id is not reused while they live."""
        number = self.group()
        if number is not None and _state(number) in ("", "Z"):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(number, signal.SIGKILL)

    def group(self) -> int | None:
        """The worker's process group from its file, None if that is not valid."""
        with contextlib.suppress(OSError, ValueError):
            number = int(_start(self.path / "pid"))
            if number > 1 and number != os.getpgrp():
                return number
        return None

    def mark_worker(self) -> None:
        """Write that this process is the worker, and the first of its group."""
        write_text(self.path / "pid", str(os.getpid()))

    def keep_room(self) -> None:
        """Reserve the disk space that the outcome needs."""
        with (self.path / "room").open("wb") as file:
            file.write(bytes(JOB_FILES.kept_bytes))
            os.fsync(file.fileno())

    def finish(self, outcome: Outcome) -> None:
        """Write the outcome; the worker's last action."""
        (self.path / "room").unlink(missing_ok=True)
        write_json(self.path / "outcome.json", asdict(outcome))

    def outcome(self) -> Outcome | None:
        """The outcome; None if the worker runs, was killed, or wrote a malformed file."""
        try:
            return decoded(_start(self.path / "outcome.json"), Outcome)
        except (OSError, msgspec.DecodeError, RecursionError):
            return None

    def workers(self) -> JobWorkers:
        """Who makes parts of it; nobody if the file is missing or malformed."""
        try:
            return decoded(_start(self.path / "workers.json"), JobWorkers)
        except (OSError, msgspec.DecodeError, RecursionError):
            return JobWorkers()

    def log_since(self, offset: int) -> tuple[str, int]:
        """Whole lines of the log from a byte offset on, and the offset for the next call."""
        try:
            with (self.path / "log.txt").open("rb") as file:
                if offset > file.seek(0, os.SEEK_END):
                    offset = 0  # it was rotated (`recon4_app.logs.rotate_grown`)
                file.seek(offset)
                data = file.read(JOB_FILES.max_log_bytes)
        except FileNotFoundError:
            return "", offset
        whole = (
            data[: data.rfind(b"\n") + 1]
            or data[: JOB_FILES.max_log_bytes * (len(data) >= JOB_FILES.max_log_bytes)]
        )
        lines = whole.decode("utf-8", "replace").splitlines()
        return "".join(f"{_printable(line)}\n" for line in lines), offset + len(whole)

    def log_tail(self, *, lines: int) -> str:
        """The last lines of the log, without control characters."""
        try:
            with (self.path / "log.txt").open("rb") as file:
                size = file.seek(0, os.SEEK_END)
                file.seek(max(0, size - 200 * lines))
                text = file.read().decode("utf-8", "replace")
        except FileNotFoundError:
            return ""
        kept = text.splitlines()[-lines:]
        return "\n".join(map(_printable, kept))


def beat(heartbeat: Path) -> None:
    """Renew the time of a heartbeat by writing it: a confined process may not set times.

    Raises:
        OSError: If it cannot be written.
    """
    heartbeat.write_bytes(b"\n")


def _start(path: Path) -> bytes:
    """The first bytes of a file of a worker; all of them, unless it is too long."""
    with path.open("rb") as file:
        return file.read(JOB_FILES.max_reply_bytes)


def _is_worker_of(number: int, folder: Path) -> bool:
    """Whether a process was started for a job's folder; the pid file may be wrong."""
    try:
        arguments = Path(f"/proc/{number}/cmdline").read_bytes().split(b"\0")
    except OSError:
        return not Path("/proc/self").exists()  # not available on macOS
    return os.fsencode(folder) in arguments


def _printable(line: str) -> str:
    return "".join(c for c in line if c.isprintable())


def _state(number: int) -> str:
    """State letter of a process, ``Z`` for a zombie; empty = no such process."""
    try:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0]
    except (OSError, IndexError):
        return ""
