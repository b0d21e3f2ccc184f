"""What hostile code tries once it runs inside one of our processes.

``python -m tests.security.hostile KIND FACTS.json [UID]`` confines itself as a process of that kind
does (``none`` = not at all), tries everything and writes ``outcomes.json``. Every deed is done for
real; its outcome is ``"done"`` or the name of the error that stopped it.
"""

from __future__ import annotations

import ctypes
import json
import mmap
import os
import resource
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from recon4.live.confinement import confine_mapper, confine_recorder
from recon4.live.session import CaptureSession
from recon4.sandbox import confine, refuse_new_sockets, restart_with_one_thread
from recon4.sandbox.private_cache import is_compiled
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.limits import prepare_worker, worker_policy
from recon4_app.viewer.process import viewer_policy

PTRACE_SEIZE = 0x4206
MAX_FORKS = 64
"""A fork bomb, but one that ends."""


def tcp(port: int) -> None:
    socket.create_connection(("127.0.0.1", port), timeout=2.0).close()


def udp(port: int) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        if sender.sendto(b"signing key", ("127.0.0.1", port)):
            return


def netlink() -> None:
    socket.socket(socket.AF_NETLINK, socket.SOCK_RAW).close()


def fork_bomb() -> None:
    for _ in range(MAX_FORKS):
        if os.fork() == 0:
            signal.pause()


def one_terabyte() -> None:
    flags = mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | 0x4000  # MAP_NORESERVE: ask no heuristic
    mmap.mmap(-1, 1 << 40, flags=flags).close()


def ptrace(parent: int) -> None:
    if ctypes.CDLL(None, use_errno=True).ptrace(PTRACE_SEIZE, parent, 0, 0) < 0:
        raise PermissionError(ctypes.get_errno(), "ptrace")


def read_memory(parent: int) -> None:
    with open(f"/proc/{parent}/mem", "rb") as memory:
        memory.seek(int(Path(f"/proc/{parent}/maps").read_text().split("-")[0], 16))
        memory.read(1)


def starve(parent: int) -> None:
    """A limit of another process of the same user is a way to kill it."""
    resource.prlimit(parent, resource.RLIMIT_CORE, (0, 0))


def call(number: int, *args: Any) -> None:
    """A system call Python has no name for."""
    if ctypes.CDLL(None, use_errno=True).syscall(number, *args) < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))


def deeds(facts: dict[str, Any]) -> dict[str, Callable[[], object]]:
    parent, port = os.getppid(), facts["port"]
    root, mine = Path(facts["root"]), Path(facts["mine"])
    key, other = root / ".recon4" / "signing.key", root / "other" / "project.json"
    return {
        "connect by TCP": lambda: tcp(port),
        "send by UDP": lambda: udp(facts["udp"]),
        "netlink": netlink,
        "read the signing key": key.read_bytes,
        "read another project": other.read_bytes,
        "list the projects": lambda: list(root.iterdir()),
        "read the environment of the parent": Path(f"/proc/{parent}/environ").read_bytes,
        "write another project": lambda: other.write_text("changed"),
        "write a new file outside": lambda: (root / "new.txt").write_text("new"),
        "remove another project": other.unlink,
        "truncate another project": lambda: os.truncate(other, 0),
        "open the key to all": lambda: key.chmod(0o777),
        "change the times of the key": lambda: os.utime(key, (0, 0)),
        "change the times of what it reads": lambda: touch_open(facts["kernel"]),
        "link to the key by name": lambda: (mine / "log.txt.link").symlink_to(key),
        "link to the key": lambda: os.link(key, mine / "hard"),
        "make a pipe the server would wait for": lambda: os.mkfifo(mine / "outcome.json.fifo"),
        "open a terminal": lambda: os.close(os.open("/dev/ptmx", os.O_RDWR | os.O_NOCTTY)),
        "write compiled kernels": lambda: open(facts["kernel"], "r+b").close(),
        "fork bomb": fork_bomb,
        "start a program": lambda: subprocess.run(["/bin/true"], check=True),
        "allocate 1 TB": one_terabyte,
        "trace the parent": lambda: ptrace(parent),
        "read the memory of the parent": lambda: read_memory(parent),
        "kill the parent": lambda: os.kill(parent, signal.SIGCONT),  # the same question as SIGKILL
        "kill everybody": lambda: os.kill(-1, 0),
        "limit the parent": lambda: starve(parent),
        "new namespaces": lambda: call(facts["unshare"], 0x10000000 | 0x00020000),
        "io_uring": lambda: call(425, 8, ctypes.create_string_buffer(120)),
        "bpf": lambda: call(facts["bpf"], 0, ctypes.create_string_buffer(120), 120),
    }


def touch_open(path: str) -> None:
    """Set the times of a file, to what they are, by a descriptor that only reads."""
    with open(path, "rb") as file:
        times = os.stat(file.fileno())
        os.utime(file.fileno(), ns=(times.st_atime_ns, times.st_mtime_ns))


def attempt(deed: Callable[[], object]) -> str:
    try:
        deed()
    except Exception as error:
        return type(error).__name__
    return "done"


def try_all(facts: dict[str, Any]) -> dict[str, str]:
    """Name of each action -> its outcome; children of the fork bomb are ended."""
    found = {name: attempt(deed) for name, deed in deeds(facts).items()}
    with suppress(OSError):
        found["secrets in the environment"] = ", ".join(n for n in os.environ if "SECRET" in n)
    return found


def too_many_threads() -> int:
    """Threads that could be started, at most 5000."""
    over, count = threading.Event(), 0
    try:
        for count in range(5000):
            threading.Thread(target=over.wait, daemon=True).start()
    except RuntimeError:
        pass
    over.set()
    return count


def confine_as(kind: str, facts: dict[str, Any]) -> None:
    """As the process of that kind does in its ``main``."""
    project, mine = Path(facts["root"]) / "mine", Path(facts["mine"])
    session = CaptureSession(project=project)
    match kind:
        case "worker":
            folder = JobFolder(mine)
            prepare_worker(folder, worker_policy(folder))
        case "viewer":
            confine(viewer_policy(project, project / "jobs", mine, socket=mine))
        case "recorder":
            restart_with_one_thread()
            confine_recorder(session)
            refuse_new_sockets()
        case "mapper":
            confine_mapper(session)


def become(user: int) -> None:
    os.setgroups([])
    os.setresgid(user, user, user)
    os.setresuid(user, user, user)
    ctypes.CDLL(None).prctl(4, 1, 0, 0, 0)  # PR_SET_DUMPABLE, which a change of user clears


def main(kind: str, path: Path, user: int | None) -> None:
    facts = json.loads(path.read_text())
    is_compiled()  # imports what the other user may not read
    if user is not None:
        become(user)
    confine_as(kind, facts)
    found: dict[str, Any] = {"outcomes": try_all(facts)}
    if user is not None:
        found["threads"] = too_many_threads()
    (Path(facts["mine"]) / "outcomes.json").write_text(json.dumps(found))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else None)
