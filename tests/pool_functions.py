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
