"""The system calls the sandbox makes, through ctypes; other modules never touch ctypes."""

from __future__ import annotations

import ctypes
import os
import platform
import sys
from functools import cache

PR_SET_NO_NEW_PRIVS = 38
PR_CAPBSET_DROP = 24
CLONE_NEWUSER, CLONE_NEWNET = 0x10000000, 0x40000000

ARCHITECTURES = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
"""Supported machine -> ``AUDIT_ARCH`` as the kernel reports it."""

_CALLS_OF_OURS = {
    "seccomp": (317, 277),
    "capset": (126, 91),
    "landlock_create_ruleset": (444, 444),
    "landlock_add_rule": (445, 445),
    "landlock_restrict_self": (446, 446),
}


def machine() -> str | None:
    """``x86_64`` or ``aarch64``; None on an unsupported machine."""
    name = {"arm64": "aarch64"}.get(platform.machine(), platform.machine())
    known = sys.platform == "linux" and name in ARCHITECTURES and sys.maxsize > 2**32
    return name if known else None


@cache
def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def call(name: str, *args: object) -> int:
    """Make a system call of the sandbox.

    Args:
        name: Of the call, as in the kernel's documentation.
        args: Integers, pointers and None.

    Returns:
        What the kernel returned, not negative.

    Raises:
        OSError: If the kernel refused, or this is not a machine we know.
    """
    if (name_of_machine := machine()) is None:
        raise OSError(f"{name}: not a Linux of {' or '.join(ARCHITECTURES)}")
    number = _CALLS_OF_OURS[name][list(ARCHITECTURES).index(name_of_machine)]
    wide = [ctypes.c_long(arg) if isinstance(arg, int) else arg for arg in args]
    return _checked(_libc().syscall(ctypes.c_long(number), *wide), name)


def prctl(option: int, value: int) -> None:
    """Set a property of this process.

    Raises:
        OSError: If the kernel refused, or this is not Linux.
    """
    if sys.platform != "linux":
        raise OSError("prctl: not Linux")
    numbers = (ctypes.c_ulong(number) for number in (value, 0, 0, 0))
    _checked(_libc().prctl(ctypes.c_int(option), *numbers), "prctl")


def unshare(flags: int) -> None:
    """Leave the namespaces of the parent.

    Raises:
        OSError: If the kernel refused, or this is not Linux.
    """
    if sys.platform != "linux":
        raise OSError("unshare: not Linux")
    _checked(_libc().unshare(ctypes.c_int(flags)), "unshare")


def threads_of_this_process() -> int:
    """Number of threads as counted by the kernel; 1 if it is unknown."""
    try:
        return len(os.listdir("/proc/self/task"))
    except OSError:
        return 1


def _checked(result: int, name: str) -> int:
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, f"{name}: {os.strerror(number)}")
    return result
