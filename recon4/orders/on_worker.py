"""Makes a part on a worker: checks it, and passes it to a confined process of its own.

The worker is trusted by the scheduler and all who use it, so it opens none of the files itself.
"""

from __future__ import annotations

import atexit
import os
import select
import socket
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import msgspec

from recon4.executors.executor import Say
from recon4.orders.order import OrderKind, OrderRefused, ordered_folder
from recon4.orders.tuning import ORDERS
from recon4.sandbox import ONE_THREAD, allowed_environment
from recon4.sandbox.private_cache import is_compiled
from recon4.store.package_versions import versions
from recon4.untrusted.typed import decoded


@dataclass(frozen=True, slots=True)
class PartTask:
    """A part that is sent to a worker: texts and integers."""

    item: int
    """Its place in the order."""
    kind: str
    """An `OrderKind`."""
    project: str
    """Absolute path of the project, the same on all computers."""
    folder: str
    """Of the order."""
    numbers: tuple[int, ...]
    versions: tuple[tuple[str, str], ...]
    """Of the packages that influence results, where the order was given."""


class PartOrder(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One line to a maker."""

    kind: OrderKind
    numbers: tuple[int, ...]


class PartReply(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One line of a maker."""

    failure: str = ""
    """Why the part could not be made; empty = it is made."""


def make_part(task: PartTask, say: Say) -> str:
    """Have a part made by a confined process; the result is a file of the folder.

    Args:
        task: The part.
        say: Called with nothing now and then; may raise `Cancelled`.

    Returns:
        Why it could not be made; empty if it is made.
    """
    if differs := _other_versions(dict(task.versions)):
        return f"this worker has {differs}"
    project = Path(task.project)
    try:
        folder = ordered_folder(project, task.folder)
    except OrderRefused as error:
        return str(error)
    order = PartOrder(kind=OrderKind(task.kind), numbers=task.numbers)
    maker = _taken(project.resolve(), folder)
    try:
        failure = maker.make(order, say)
        for line in maker.said():
            say(str(task.item), f"{worker_name()}: {line}")
    except BaseException:
        maker.end()
        raise
    _give_back(maker)
    return failure


@cache
def worker_name() -> str:
    """Computer and number of this process."""
    return f"{socket.gethostname()} {os.getpid()}"


def _other_versions(wanted: dict[str, str]) -> str:
    """What is not as wanted here; empty = nothing."""
    here = versions()
    return ", ".join(
        f"{name} {here.get(name, 'missing')} instead of {version}"
        for name, version in wanted.items()
        if here.get(name) != version
    )


class _Maker:
    """A confined process that makes parts of one folder; ends with this one."""

    def __init__(self, project: Path, folder: Path) -> None:
        self.serves = project, folder
        self._noise, self._is_mute = b"", False
        self.expiry: threading.Timer | None = None
        read, self._lifeline = os.pipe()
        command = [sys.executable, "-P", "-m", "recon4.orders.maker", str(read)]
        try:
            self._process = subprocess.Popen(
                [*command, str(project), str(folder)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                pass_fds=(read,),
                env=allowed_environment(os.environ) | ONE_THREAD,
                start_new_session=True,
            )
        finally:
            os.close(read)

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    def make(self, order: PartOrder, say: Say) -> str:
        """Why a part could not be made; empty if it is made."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(msgspec.json.encode(order) + b"\n")
            self._process.stdin.flush()
            return decoded(self._reply(say), PartReply).failure[: ORDERS.failure]
        except (BrokenPipeError, EOFError):
            return f"the process that made it ended with code {self._process.wait()}"
        except (TimeoutError, msgspec.DecodeError, RecursionError) as error:
            self.end()
            return f"the process that made it was ended: {str(error)[: ORDERS.failure]}"

    def said(self) -> list[str]:
        """Lines that it has written beside its reply, as a crash does; each only once."""
        while self._hear(0.0):
            pass
        lines = self._noise.decode("utf-8", "replace").splitlines()
        self._noise = b""
        return [line for line in lines if line.strip()]

    def _reply(self, say: Say) -> bytes:
        """The next line, whatever the process does with its output."""
        assert self._process.stdout is not None
        descriptor, line = self._process.stdout.fileno(), b""
        latest_s = time.monotonic() + ORDERS.within_s
        while not line.endswith(b"\n"):
            if time.monotonic() > latest_s or len(line) > ORDERS.reply_bytes:
                raise TimeoutError(f"no reply within {ORDERS.within_s:.0f} s")
            if not self._hear(ORDERS.looks_every_s, descriptor):
                say("", "")
            elif select.select([descriptor], [], [], 0.0)[0]:
                more = os.read(descriptor, ORDERS.reply_bytes)
                if not more:
                    raise EOFError
                line += more
        return line

    def _hear(self, within_s: float, *others: int) -> bool:
        """Read what it says beside its replies; whether there is something on any descriptor."""
        assert self._process.stderr is not None
        muted = self._is_mute or self._process.stderr.closed
        beside = [] if muted else [self._process.stderr.fileno()]
        ready = select.select([*beside, *others], [], [], within_s)[0]
        if beside and beside[0] in ready:
            more = os.read(beside[0], ORDERS.reply_bytes)
            self._is_mute = not more
            self._noise = (self._noise + more)[: ORDERS.said_bytes]
        return bool(ready)

    def end(self) -> None:
        """End it at once."""
        if self._lifeline >= 0:
            os.close(self._lifeline)
            self._lifeline = -1
        self._process.kill()
        with self._process:
            pass


_idle: list[_Maker] = []
_lock = threading.Lock()


def _taken(project: Path, folder: Path) -> _Maker:
    """A maker of a folder: one that waits, or a new one; those of other folders are ended."""
    _compile_once()
    with _lock:
        waiting, _idle[:] = list(_idle), []
    found = None
    for maker in waiting:
        if maker.expiry is not None:
            maker.expiry.cancel()
        if found is None and maker.serves == (project, folder) and maker.alive:
            found = maker
        elif maker.serves == (project, folder) and maker.alive:
            _give_back(maker)
        else:
            maker.end()
    return found or _Maker(project, folder)


def _give_back(maker: _Maker) -> None:
    if not maker.alive:
        maker.end()
        return
    with _lock:
        _idle.append(maker)
        maker.expiry = threading.Timer(ORDERS.idle_s, _end_unused, [maker])
        maker.expiry.daemon = True
        maker.expiry.start()


def _end_unused(maker: _Maker) -> None:
    """End a maker that waits; one that was taken for a part is not in the list.

    It does not end itself: it could do so when it has just been taken.
    """
    with _lock:
        if maker not in _idle:
            return
        _idle.remove(maker)
    maker.end()


@atexit.register
def _end_idle() -> None:
    while _idle:
        _idle.pop().end()


def _compile_once() -> None:
    """Compile the kernels if they are not: a confined process cannot keep them."""
    with _lock:
        if not is_compiled():
            compiler = [sys.executable, "-P", "-m", "recon4", "compile"]
            subprocess.run(compiler, stdout=subprocess.DEVNULL, check=False)
