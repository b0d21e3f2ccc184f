"""Records of the sandbox: the policy of a process, and the barriers in effect."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path


class Network(StrEnum):
    """Sockets a confined process may create."""

    NONE = "none"
    """None; inherited ones stay usable."""
    UNIX = "unix"
    """Unix sockets only: to listen and to connect."""
    RECEIVE = "receive"
    """UDP sockets that receive, and Unix sockets."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Policy:
    """What a confined process may do. Everything not named here is refused."""

    read: tuple[Path, ...] = ()
    """Files and folders (with all below) to read; paths that do not exist are skipped."""
    write: tuple[Path, ...] = ()
    """Files and folders (with all below) to read and write; no links, devices or pipes in them."""
    network: Network = Network.NONE
    processes: bool = False
    """Whether it may start processes and programs; threads are always allowed."""
    temporary: Path | None = None
    """Private folder for temporary files, made with mode 0700; None = it has none."""
    memory_bytes: int | None = None
    """Private memory (``RLIMIT_DATA``); files mapped read-only do not count."""
    address_space_bytes: int | None = None
    """All mapped memory (``RLIMIT_AS``), files included."""
    cpu_s: int | None = None
    """Processor time; the process is killed when it is used up."""
    file_bytes: int | None = None
    """Size of one written file; more is a full disk to the process."""
    open_files: int = 1024
    threads: int = 256
    """Threads it may add to those its user has; the kernel does not count those of root."""

    def adding(self, *, read: Iterable[Path] = (), write: Iterable[Path] = ()) -> Policy:
        """The same policy with more paths."""
        return replace(self, read=(*self.read, *read), write=(*self.write, *write))


@dataclass(frozen=True, slots=True)
class Barrier:
    """One restriction enforced by the kernel."""

    name: str
    """``files``, ``network``, …: one word."""
    holds: bool
    detail: str
    """How it is enforced, or the consequence of its absence."""


@dataclass(frozen=True, slots=True)
class Confinement:
    """The barriers in effect for this process."""

    barriers: tuple[Barrier, ...]

    @property
    def missing(self) -> tuple[Barrier, ...]:
        """The barriers this computer does not provide."""
        return tuple(barrier for barrier in self.barriers if not barrier.holds)

    def holds(self, name: str) -> bool:
        """Whether a barrier of that name is in effect.

        Raises:
            KeyError: If there is no such barrier.
        """
        return {barrier.name: barrier.holds for barrier in self.barriers}[name]

    def __str__(self) -> str:
        held = ", ".join(barrier.name for barrier in self.barriers if barrier.holds)
        lost = "; ".join(f"{barrier.name}: {barrier.detail}" for barrier in self.missing)
        return f"confined: {held or 'nothing'}" + (f"; NOT confined: {lost}" if lost else "")
