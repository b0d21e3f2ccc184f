"""Landlock: the kernel's allow-list of files for one process (``Documentation/userspace-api``)."""

from __future__ import annotations

import ctypes
import os
import stat
from collections.abc import Iterable
from pathlib import Path

from recon4.sandbox.kernel import call

EXECUTE, WRITE_FILE, READ_FILE, READ_DIR = 1 << 0, 1 << 1, 1 << 2, 1 << 3
REMOVE_DIR, REMOVE_FILE = 1 << 4, 1 << 5
MAKE_DIR, MAKE_REG, MAKE_SOCK = 1 << 7, 1 << 8, 1 << 9
REFER, TRUNCATE, IOCTL_DEV = 1 << 13, 1 << 14, 1 << 15
READ = READ_FILE | READ_DIR
WRITE = (
    (READ | WRITE_FILE | REMOVE_DIR | REMOVE_FILE)
    | (MAKE_DIR | MAKE_REG | REFER | TRUNCATE | IOCTL_DEV)
)  # fmt: skip
"""No symbolic link, device or pipe: the server follows names in these folders."""
_OF_A_FILE = EXECUTE | WRITE_FILE | READ_FILE | TRUNCATE | IOCTL_DEV

_BIND_TCP, _CONNECT_TCP = 1 << 0, 1 << 1
_SCOPE_ABSTRACT_UNIX_SOCKET, _SCOPE_SIGNAL = 1 << 0, 1 << 1
_PATH_BENEATH, _VERSION = 1, 1
_RIGHTS_OF_ABI = {1: 13, 2: 14, 3: 15, 4: 15, 5: 16}
"""ABI -> number of file rights; later ABIs have those of 5."""

TCP_SINCE, TRUNCATE_SINCE, SCOPES_SINCE = 4, 3, 6
"""First ABI of each right."""


class _Ruleset(ctypes.Structure):
    _fields_ = [
        ("fs", ctypes.c_uint64),
        ("net", ctypes.c_uint64),
        ("scoped", ctypes.c_uint64),
    ]


class _PathBeneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = [("access", ctypes.c_uint64), ("parent", ctypes.c_int32)]


def abi() -> int:
    """Version of Landlock in this kernel; 0 = it has none, or it is turned off."""
    try:
        return call("landlock_create_ruleset", None, 0, _VERSION)
    except OSError:
        return 0


def restrict(rules: Iterable[tuple[Path, int]]) -> None:
    """Confine this thread and its children permanently to allowed paths, without TCP.

    Needs ``no_new_privs``. A path that does not exist is skipped.

    Args:
        rules: Paths, and the rights below each.

    Raises:
        OSError: If the kernel refused, or has no Landlock.
    """
    version = abi()
    known = (1 << _RIGHTS_OF_ABI.get(version, 16)) - 1
    tcp = _BIND_TCP | _CONNECT_TCP if version >= TCP_SINCE else 0
    scopes = _SCOPE_ABSTRACT_UNIX_SOCKET | _SCOPE_SIGNAL if version >= SCOPES_SINCE else 0
    ruleset = _Ruleset(known, tcp, scopes)
    size = ctypes.sizeof(ruleset)
    descriptor = call("landlock_create_ruleset", ctypes.byref(ruleset), size, 0)
    try:
        for path, rights in rules:
            _allow(descriptor, path, rights & known)
        call("landlock_restrict_self", descriptor, 0)
    finally:
        os.close(descriptor)


def _allow(ruleset: int, path: Path, rights: int) -> None:
    try:
        parent = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    try:
        if not stat.S_ISDIR(os.fstat(parent).st_mode):
            rights &= _OF_A_FILE
        rule = _PathBeneath(rights, parent)
        call("landlock_add_rule", ruleset, _PATH_BENEATH, ctypes.byref(rule), 0)
    finally:
        os.close(parent)
