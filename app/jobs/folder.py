"""The folder through which server and worker talk: plain files, so either may die at any time.

request.json    the job, written by the server before the worker starts
lock            held (flock) by the worker as long as it lives; the kernel lets go of it
pid             the worker's process and group
heartbeat       touched by the worker every second
cancel          made by the server: please stop
events.jsonl    how far it is (`app.jobs.events`), appended by the worker
log.txt         what the worker said
room            some bytes that make way for the last words when the disk is full
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
from recon4.store.atomic import make_folders, write_json

KEPT_BYTES = 64 << 10
MOST_LOG_BYTES = 256 << 10


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """How a worker ended on its own."""

    state: Literal["succeeded", "failed", "cancelled"]
    note: str = ""
    """Why, and what to do."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What a worker may take of this computer."""

    memory_bytes: int
    reserve_bytes: int
    """It does not begin when less of the disk than this would stay free."""


@dataclass(frozen=True, slots=True)
class JobFolder:
    """One job's folder."""

    path: Path

    def prepare(self, inputs: Inputs, project: Path, limits: Limits) -> None:
        """Write the request; clear what an earlier attempt left."""
        make_folders(self.path)
        for name in ("pid", "heartbeat", "outcome.json"):
            (self.path / name).unlink(missing_ok=True)
        request = {"project": str(project), "inputs": asdict(inputs), "limits": asdict(limits)}
        write_json(self.path / "request.json", request)

    def request(self) -> tuple[Path, Inputs]:
        """Project folder and inputs."""
        request = json.loads((self.path / "request.json").read_text("utf-8"))
        inputs = request["inputs"]
        for name in ("recordings", "settings"):
            inputs[name] = tuple(inputs[name])
        return Path(request["project"]), Inputs(**inputs)

    def limits(self) -> Limits:
        """What the worker may take."""
        return Limits(**json.loads((self.path / "request.json").read_text("utf-8"))["limits"])

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

    def end_orphans(self) -> None:
        """End the children a dead worker left. Its number is not another's while they live."""
        with contextlib.suppress(FileNotFoundError, ProcessLookupError, ValueError):
            number = int((self.path / "pid").read_text())
            if _state(number) in ("", "Z"):
                os.killpg(number, signal.SIGKILL)

    def keep_room(self) -> None:
        """Take the room the last words need, while there is some."""
        with (self.path / "room").open("wb") as file:
            file.write(bytes(KEPT_BYTES))
            os.fsync(file.fileno())

    def finish(self, outcome: Outcome) -> None:
        """Say how it ended; the worker's last deed."""
        (self.path / "room").unlink(missing_ok=True)
        write_json(self.path / "outcome.json", asdict(outcome))

    def outcome(self) -> Outcome | None:
        """How it ended, None if it has not or was killed."""
        try:
            return Outcome(**json.loads((self.path / "outcome.json").read_text("utf-8")))
        except FileNotFoundError:
            return None

    def log_since(self, offset: int) -> tuple[str, int]:
        """Whole lines of the log from a byte offset on, and the offset to ask from next time."""
        try:
            with (self.path / "log.txt").open("rb") as file:
                file.seek(offset)
                data = file.read(MOST_LOG_BYTES)
        except FileNotFoundError:
            return "", offset
        whole = (
            data[: data.rfind(b"\n") + 1] or data[: MOST_LOG_BYTES * (len(data) >= MOST_LOG_BYTES)]
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


def _printable(line: str) -> str:
    return "".join(c for c in line if c.isprintable())


def _state(number: int) -> str:
    """What the kernel says of a process: a letter, ``Z`` for one that is over; empty = none."""
    try:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0]
    except (OSError, IndexError):
        return ""


def _lock(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
