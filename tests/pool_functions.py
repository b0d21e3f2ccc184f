"""Functions that tests run in children of the compute pool."""

from __future__ import annotations

import os
import signal
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import ConfigError, GraphError, WrongSettings


@dataclass(frozen=True)
class Found:
    tags: tuple[str, ...]
    error_m: float


def identity(value: int) -> tuple[int, int]:
    return value, os.getpid()


def undeclared(value):
    return value


def record() -> Found:
    return Found(("a", "b"), float("nan"))


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def pause() -> None:
    signal.pause()


def refuse() -> None:
    raise GraphError("node 3 hangs in the air")


def refuse_settings() -> None:
    raise WrongSettings({"map.voxel_m": "must be positive"})


def threads() -> str:
    return os.environ["OMP_NUM_THREADS"]


def make(name: str) -> None:
    Path(name).write_text("made")


def make_and_refuse(name: str) -> None:
    make(name)
    raise ConfigError("no")


# -- what a hostile file might make a child do


def read_file(path: str) -> str:
    return Path(path).read_text()


def write_file(path: str) -> None:
    Path(path).write_text("owned")


def connect(port: int) -> None:
    import socket

    socket.create_connection(("127.0.0.1", port), 5.0)


def environment() -> dict[str, str]:
    return dict(os.environ)


def take_memory(count: int) -> int:
    import numpy as np

    return int(np.ones(count, np.uint8).sum())


def run_program() -> None:
    import subprocess

    subprocess.run(["/bin/true"], check=True)


def kill_parent() -> None:
    os.kill(os.getppid(), signal.SIGKILL)


def link_out(name: str, target: str) -> None:
    Path(name).symlink_to(target)


def answer_with_a_pickle() -> int:
    """Write past the protocol, as native code that was taken over would."""
    import pickle

    from recon4_app.compute_pool.messages import HEAD, RESULT

    class Owned:
        def __reduce__(self):
            return os.system, ("touch /tmp/recon4-owned",)

    data = pickle.dumps(Owned())
    for descriptor in range(3, 20):
        try:
            os.write(descriptor, HEAD.pack(RESULT, len(data)) + data)
        except OSError:
            continue
    return 0


def note_and_pause(path: str) -> None:
    Path(path).write_text(str(os.getpid()))
    signal.pause()
