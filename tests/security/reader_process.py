"""A process that reads hostile recordings: bounded memory, bounded time, outcome as text.

One server imports recon4 once and forks a child for every file, so that a child that dies, hangs
or allocates without end is an outcome and not the end of the tests.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import Self

ROOT = Path(__file__).parents[2]
GIB = 1 << 30


@dataclass(frozen=True, slots=True)
class Outcome:
    """How reading one file ended."""

    kind: str
    """``ok``, ``salvaged``, ``rejected``, or a finding: ``traceback``, ``memory``, ``timeout``,
    ``crash``."""
    text: str
    """The refusal, the traceback, or what was counted."""
    items: int
    seconds: float
    extra_bytes: int
    """Peak memory above that of the server."""

    @property
    def sound(self) -> bool:
        return self.kind in {"ok", "salvaged", "rejected"}


class ReaderProcess:
    """Reads files in children; use as a context manager."""

    def __init__(self, *, max_bytes: int = GIB) -> None:
        self._max_bytes = max_bytes

    def __enter__(self) -> Self:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.security.reader_process", str(self._max_bytes)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=ROOT,
        )
        return self

    def __exit__(self, *_: object) -> None:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        self._process.wait()
        self._process.stdout.close()

    def read(self, path: Path, kind: str = "", *, deadline_s: int = 10) -> Outcome:
        """Read one file as ``recon4 info`` and the stage ``frames`` do, in limited time."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps([str(path), kind, deadline_s]) + "\n")
        self._process.stdin.flush()
        return Outcome(**json.loads(self._process.stdout.readline()))


def _serve(max_bytes: int) -> None:
    from tests.security.fuzz.seeds_recordings import SEEDS, read_pcap

    for kind, (build, read, suffix) in SEEDS.items():
        # so that no child has to import or compile
        path = Path(f"/tmp/recon4-warm-{os.getpid()}{suffix}")
        path.write_bytes(build())
        try:
            read(path)
        finally:
            path.unlink()
    for line in sys.stdin:
        name, kind, deadline_s = json.loads(line)
        read = SEEDS[kind][1] if kind else read_pcap
        sys.stdout.write(json.dumps(_in_child(Path(name), read, max_bytes, deadline_s)) + "\n")
        sys.stdout.flush()


def _in_child(path: Path, read, max_bytes: int, deadline_s: int) -> dict:
    ours, theirs = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(ours)
        # The deadline is time of the processor, so that a busy machine fails no test; the alarm
        # ends a child that waits for something that never comes.
        signal.setitimer(signal.ITIMER_PROF, deadline_s)
        signal.alarm(20 * deadline_s)
        most = _status("VmSize") + max_bytes
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        before = _status("VmRSS")
        answer = _attempt(path, read)
        answer["extra_bytes"] = max(0, _status("VmHWM") - before)
        os.write(theirs, json.dumps(answer).encode())
        os._exit(0)
    os.close(theirs)
    with os.fdopen(ours, "rb") as pipe:
        said = pipe.read()
    _, status, usage = os.wait4(pid, 0)
    if said:
        answer = json.loads(said)
    else:
        number = os.waitstatus_to_exitcode(status)
        kind = "timeout" if number in {-signal.SIGALRM, -signal.SIGPROF} else "crash"
        answer = {"kind": kind, "text": f"exit {number}", "items": 0, "extra_bytes": 0}
    return answer | {"seconds": usage.ru_utime + usage.ru_stime}


def _attempt(path: Path, read) -> dict:
    from recon4.errors import Recon4Error

    try:
        result = read(path)
    except Recon4Error as error:
        return {"kind": "rejected", "text": str(error)[:2000], "items": 0}
    except MemoryError:
        return {"kind": "memory", "text": "MemoryError", "items": 0}
    except BaseException:
        return {"kind": "traceback", "text": traceback.format_exc()[-3000:], "items": 0}
    kind = "ok" if result.outcome == "complete" else "salvaged"
    text = f"{result.counts} {result.findings}"
    return {"kind": kind, "text": text[:3000], "items": result.items}


def _status(field: str) -> int:
    """A figure of ``/proc/self/status`` [bytes]."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(f"{field}:"):
            return int(line.split()[1]) * 1024
    raise KeyError(field)


if __name__ == "__main__":
    _serve(int(sys.argv[1]))
