"""The folder through which server and worker talk: plain files, so either may die at any time.

request.json    the job, written by the server before the worker starts
lock            held (flock) by the worker as long as it lives; the kernel lets go of it
pid             the worker's process and group
heartbeat       touched by the worker every second
cancel          made by the server: please stop
events.jsonl    how far it is (`app.jobs.events`), appended by the worker
log.txt         what the worker said
outcome.json    how it ended, written last and whole
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import signal
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

from app.jobs.model import Inputs
from recon4.store.atomic import write_json


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """How a worker ended on its own."""

    state: Literal["succeeded", "failed", "cancelled"]
    note: str = ""
    """Why, and what to do."""


@dataclass(frozen=True, slots=True)
class JobFolder:
    """One job's folder."""

    path: Path

    def prepare(self, inputs: Inputs, project: Path) -> None:
        """Write the request; clear what an earlier attempt left."""
        self.path.mkdir(parents=True, exist_ok=True)
        for name in ("pid", "heartbeat", "outcome.json"):
            (self.path / name).unlink(missing_ok=True)
        request = {"project": str(project), "inputs": asdict(inputs)}
        write_json(self.path / "request.json", request)

    def request(self) -> tuple[Path, Inputs]:
        """Project folder and inputs."""
        request = json.loads((self.path / "request.json").read_text("utf-8"))
        inputs = request["inputs"]
        for name in ("recordings", "settings"):
            inputs[name] = tuple(inputs[name])
        return Path(request["project"]), Inputs(**inputs)

    @contextlib.contextmanager
    def try_lock(self) -> Iterator[int | None]:
        """File descriptor of the lock, None while a worker holds it."""
        descriptor = os.open(self.path / "lock", os.O_RDWR | os.O_CREAT, 0o600)
        try:
            yield descriptor if _lock(descriptor) else None
        finally:
            os.close(descriptor)

    def alive(self) -> bool:
        """Whether a worker lives; never fooled by a process number used again."""
        with self.try_lock() as lock:
            return lock is None

    def silent_s(self) -> float:
        """Seconds since the last heartbeat (since the request when there was none)."""
        for name in ("heartbeat", "request.json"):
            with contextlib.suppress(FileNotFoundError):
                return time.time() - (self.path / name).stat().st_mtime
        return 0.0

    def ask_to_stop(self) -> None:
        """Ask the worker to stop at its next unit of work."""
        (self.path / "cancel").touch()

    def asked_to_stop_s(self) -> float | None:
        """Seconds since the worker was asked to stop, None if it was not."""
        try:
            return time.time() - (self.path / "cancel").stat().st_mtime
        except FileNotFoundError:
            return None

    def kill(self) -> None:
        """End the worker and its children at once. Call only while `alive`."""
        with contextlib.suppress(FileNotFoundError, ProcessLookupError, ValueError):
            os.killpg(int((self.path / "pid").read_text()), signal.SIGKILL)

    def finish(self, outcome: Outcome) -> None:
        """Say how it ended; the worker's last deed."""
        write_json(self.path / "outcome.json", asdict(outcome))

    def outcome(self) -> Outcome | None:
        """How it ended, None if it has not or was killed."""
        try:
            return Outcome(**json.loads((self.path / "outcome.json").read_text("utf-8")))
        except FileNotFoundError:
            return None

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
        return "\n".join("".join(c for c in line if c.isprintable()) for line in kept)


def _lock(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
