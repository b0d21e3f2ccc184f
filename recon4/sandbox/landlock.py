"""Landlock: the kernel's allow-list of files for one process (``Documentation/userspace-api``)."""

from __future__ import annotations

import ctypes
import os
import stat
from collections.abc import Iterable
from enum import IntEnum, IntFlag
from pathlib import Path

from recon4.sandbox.kernel import call


class FileRight(IntFlag):
    """Rights to files, ``LANDLOCK_ACCESS_FS_*``."""

    EXECUTE = 1 << 0
    WRITE_FILE = 1 << 1
    READ_FILE = 1 << 2
    READ_DIR = 1 << 3
    REMOVE_DIR = 1 << 4
    REMOVE_FILE = 1 << 5
    MAKE_DIR = 1 << 7
    MAKE_REG = 1 << 8
    MAKE_SOCK = 1 << 9
    REFER = 1 << 13
    TRUNCATE = 1 << 14
    IOCTL_DEV = 1 << 15
    READ = READ_FILE | READ_DIR
    WRITE = (
        (READ | WRITE_FILE | REMOVE_DIR | REMOVE_FILE)
        | (MAKE_DIR | MAKE_REG | REFER | TRUNCATE | IOCTL_DEV)
    )  # fmt: skip
    """No symbolic link, device or pipe: the server follows names in these folders."""
    OF_A_FILE = EXECUTE | WRITE_FILE | READ_FILE | TRUNCATE | IOCTL_DEV


class TcpRight(IntFlag):
    """Rights to ports, ``LANDLOCK_ACCESS_NET_*``."""

    BIND = 1 << 0
    CONNECT = 1 << 1


class Scope(IntFlag):
    """What ends at the border of a ruleset, ``LANDLOCK_SCOPE_*``."""

    ABSTRACT_UNIX_SOCKET = 1 << 0
    SIGNAL = 1 << 1


class Since(IntEnum):
    """First ABI that has something."""

    TCP = 4
    SCOPES = 6


class LandlockCall(IntEnum):
    """Arguments of the system calls."""

    CREATE_RULESET_VERSION = 1
    RULE_PATH_BENEATH = 1


_RIGHTS_OF_ABI = {1: 13, 2: 14, 3: 15, 4: 15, 5: 16}
"""ABI -> number of file rights; later ABIs have those of 5."""


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
        return call("landlock_create_ruleset", None, 0, LandlockCall.CREATE_RULESET_VERSION)
    except OSError:
        return 0


def restrict(rules: Iterable[tuple[Path, FileRight]]) -> None:
    """Confine this thread and its children permanently to allowed paths, without TCP.

    Needs ``no_new_privs``. A path that does not exist is skipped.

    Args:
        rules: Paths, and the rights below each.

    Raises:
        OSError: If the kernel refused, or has no Landlock.
    """
    version = abi()
    known = (1 << _RIGHTS_OF_ABI.get(version, 16)) - 1
    tcp = TcpRight.BIND | TcpRight.CONNECT if version >= Since.TCP else 0
    scopes = Scope.ABSTRACT_UNIX_SOCKET | Scope.SIGNAL if version >= Since.SCOPES else 0
    ruleset = _Ruleset(known, tcp, scopes)
    size = ctypes.sizeof(ruleset)
    descriptor = call("landlock_create_ruleset", ctypes.byref(ruleset), size, 0)
    try:
        for path, rights in rules:
            _allow(descriptor, path, rights & known)
        call("landlock_restrict_self", descriptor, 0)
    finally:
        os.close(descriptor)


def _allow(ruleset: int, path: Path, rights: FileRight) -> None:
    try:
        parent = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    try:
        if not stat.S_ISDIR(os.fstat(parent).st_mode):
            rights &= FileRight.OF_A_FILE
        rule = _PathBeneath(rights, parent)
        call("landlock_add_rule", ruleset, LandlockCall.RULE_PATH_BENEATH, ctypes.byref(rule), 0)
    finally:
        os.close(parent)
