"""Times and limits of child processes and of the installation."""

from __future__ import annotations

from msgspec import Struct


class NeedsTuning(Struct, frozen=True, kw_only=True):
    """What recon4 needs of a machine."""

    memory_gb: float = 4.0
    disk_gb: float = 5.0
    cores: int = 2
    """Memory [GB], disk [GB] and cores."""


NEEDS = NeedsTuning()


class ProcessTuning(Struct, frozen=True, kw_only=True):
    """Child processes."""

    looks_every_s: float = 1.0
    """Interval at which `first_line` measures the time of the child [s]."""
    collected_after: int = 10_000
    """New objects after which the garbage collector looks at the newest ones. With the 700 of
    Python, starting a server takes a fifth longer: every module adds objects that stay."""


PROCESSES = ProcessTuning()


class RuntimeFolderLimits(Struct, frozen=True, kw_only=True):
    """The folder of sockets."""

    longest_folder: int = 50
    """Leaves 53 bytes for the names below [bytes]."""


RUNTIME_FOLDERS = RuntimeFolderLimits()


class StoppingTuning(Struct, frozen=True, kw_only=True):
    """How processes end."""

    raised_again_after_s: float = 0.02
    cleaning_up_s: float = 10.0
    """Signals that come while the first one is obeyed are ignored this long, then the process
    ends."""


STOPPING = StoppingTuning()
