"""Gives a process an empty network namespace and drops its capabilities."""

from __future__ import annotations

import ctypes
import os
import struct
from contextlib import suppress
from pathlib import Path

from recon4.sandbox.kernel import (
    CLONE_NEWNET,
    CLONE_NEWUSER,
    PR_CAPBSET_DROP,
    call,
    prctl,
    unshare,
)

_CAP_DAC_OVERRIDE, _CAP_FOWNER = 1, 3
_KEPT_BY_ROOT = (_CAP_DAC_OVERRIDE, _CAP_FOWNER)
"""Root may still write files of other users, within the allowed paths."""
_LAST_CAPABILITY = 63
_CAPABILITY_VERSION_3 = 0x20080522


def own_network() -> str:
    """Give this process a network without interfaces; returns a description of the method.

    Without root it takes a user namespace, which some distributions forbid. That is tried in a
    child first, because a namespace without its table of users leaves a process unable to write.

    Raises:
        OSError: If the kernel refused.
    """
    with suppress(OSError):
        unshare(CLONE_NEWNET)
        return "network namespace"
    child = os.fork()
    if child == 0:
        try:
            _enter_user_namespace()
        except BaseException:
            os._exit(1)
        os._exit(0)
    if os.waitpid(child, 0)[1] != 0:
        raise OSError("user namespaces are not allowed here")
    _enter_user_namespace()
    return "network namespace in a user namespace"


def _enter_user_namespace() -> None:
    user, group = os.geteuid(), os.getegid()
    unshare(CLONE_NEWUSER | CLONE_NEWNET)
    Path("/proc/self/setgroups").write_text("deny")
    Path("/proc/self/uid_map").write_text(f"{user} {user} 1")
    Path("/proc/self/gid_map").write_text(f"{group} {group} 1")


def drop_capabilities() -> None:
    """Give up the rights of root, all but those over ordinary files.

    Raises:
        OSError: If the kernel refused.
    """
    own = _effective()
    kept = sum(1 << number for number in _KEPT_BY_ROOT) & own if os.geteuid() == 0 else 0
    for number in range(_LAST_CAPABILITY + 1):
        with suppress(OSError):  # not allowed without root, and past the kernel's last one
            prctl(PR_CAPBSET_DROP, number)
    header = struct.pack("<II", _CAPABILITY_VERSION_3, 0)
    low, high = kept & 0xFFFFFFFF, kept >> 32
    sets = struct.pack("<IIIIII", low, low, 0, high, high, 0)
    call("capset", ctypes.c_char_p(header), ctypes.c_char_p(sets))


def _effective() -> int:
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("CapEff:"):
            return int(line.split()[1], 16)
    return 0
