"""A filter in the kernel that refuses system calls (seccomp), for all threads of this process.

The program is classic BPF over ``struct seccomp_data``: the number of the call at offset 0, the
architecture at 4, the six arguments from 16 on, eight bytes each. Every rule is a block that
begins with the number of its call and ends with a verdict, so blocks do not depend on each other.
"""

from __future__ import annotations

import ctypes
import errno
import os
import socket
import struct
from collections.abc import Iterable

from recon4.sandbox.kernel import ARCHITECTURES, call, machine
from recon4.sandbox.policy import Network
from recon4.sandbox.syscalls import ALWAYS_REFUSED, number

_SECCOMP_SET_MODE_FILTER, _SECCOMP_FILTER_FLAG_TSYNC = 1, 1
_LOAD, _AND = 0x20, 0x54  # BPF_LD | BPF_W | BPF_ABS, BPF_ALU | BPF_AND | BPF_K
_EQUAL, _AT_LEAST, _ANY_BIT = 0x15, 0x35, 0x45  # BPF_JMP | BPF_J… | BPF_K
_RETURN = 0x06  # BPF_RET | BPF_K
_ALLOW, _ERRNO, _KILL = 0x7FFF0000, 0x00050000, 0x80000000
_X32 = 0x40000000
_CLONE_THREAD = 0x00010000
_CLONE_NAMESPACES = 0x7E020080
_MSG_FASTOPEN = 0x20000000
_TIOCSTI, _TIOCLINUX = 0x5412, 0x541C
_SOCKET_KIND = 0xF

Instruction = tuple[int, int, int, int]
"""``code, jump if true, jump if false, constant``."""


class _Program(ctypes.Structure):
    _fields_ = [("count", ctypes.c_ushort), ("instructions", ctypes.c_char_p)]


def restrict(*, network: Network, processes: bool) -> None:
    """Refuse dangerous calls in every thread of this process and all it starts.

    Needs ``no_new_privs``. Filters add up: a later call can only refuse more.

    Raises:
        OSError: If the kernel refused, or this is not a machine we know.
    """
    program = assemble(network=network, processes=processes)
    packed = b"".join(struct.pack("<HBBI", *instruction) for instruction in program)
    filters = _Program(len(program), packed)
    flags = _SECCOMP_FILTER_FLAG_TSYNC
    if (stranger := call("seccomp", _SECCOMP_SET_MODE_FILTER, flags, ctypes.byref(filters))) != 0:
        raise OSError(errno.ESRCH, f"seccomp: thread {stranger} could not be filtered")


def assemble(*, network: Network, processes: bool) -> list[Instruction]:
    """The filter as instructions.

    Raises:
        OSError: If this is not a machine we know.
    """
    if (name := machine()) is None:
        raise OSError("seccomp: not a machine whose calls are known")
    program: list[Instruction] = [(_LOAD, 0, 0, 4), (_EQUAL, 1, 0, ARCHITECTURES[name])]
    program += [(_RETURN, 0, 0, _KILL), (_LOAD, 0, 0, 0)]
    if name == "x86_64":
        program += [(_AT_LEAST, 0, 1, _X32), (_RETURN, 0, 0, _ERRNO | errno.ENOSYS)]
    for call_name, block in _rules(network, processes=processes):
        if (call_number := number(call_name, name)) is not None:
            program += [(_EQUAL, 0, len(block), call_number), *block]
    return [*program, (_RETURN, 0, 0, _ALLOW)]


def _rules(network: Network, *, processes: bool) -> Iterable[tuple[str, list[Instruction]]]:
    refuse = [(_RETURN, 0, 0, _ERRNO | errno.EPERM)]
    for name in ALWAYS_REFUSED:
        yield name, refuse
    yield "clone3", [(_RETURN, 0, 0, _ERRNO | errno.ENOSYS)]  # its flags cannot be seen; use clone
    if processes:
        yield "clone", _refuse_if_any_bit(0, _CLONE_NAMESPACES)
    else:
        yield "clone", _refuse_unless_any_bit(0, _CLONE_THREAD)
        for name in ("fork", "vfork", "execve", "execveat"):
            yield name, refuse
    me = os.getpid()
    for name in ("kill", "tgkill", "rt_sigqueueinfo", "rt_tgsigqueueinfo"):
        yield name, _only_values(0, (me,))
    for name in ("prlimit64", "sched_setaffinity", "sched_setattr"):
        yield name, _only_values(0, (0, me))
    for name in ("sched_setparam", "sched_setscheduler"):
        yield name, _only_values(0, (0, me))
    yield "setpriority", _only_values(1, (0, me))
    yield "ioctl", _refuse_values(1, (_TIOCSTI, _TIOCLINUX))
    yield from _network_rules(network)


def _network_rules(network: Network) -> Iterable[tuple[str, list[Instruction]]]:
    refuse = [(_RETURN, 0, 0, _ERRNO | errno.EACCES)]
    unix = [(socket.AF_UNIX, None)]
    internet = (socket.AF_INET, socket.AF_INET6)
    match network:
        case Network.NONE:
            yield "socket", refuse
            for name in ("connect", "bind", "listen"):
                yield name, refuse
        case Network.UNIX:
            yield "socket", _only_sockets(unix)
        case Network.RECEIVE:
            datagrams: list[tuple[int, int | None]] = [(f, socket.SOCK_DGRAM) for f in internet]
            yield "socket", _only_sockets(unix + datagrams)
    yield "sendto", _only_without_address() if network is not Network.UNIX else _allow()
    yield "sendmsg", _refuse_if_any_bit(2, _MSG_FASTOPEN)
    yield "sendmmsg", refuse


def _allow() -> list[Instruction]:
    return [(_RETURN, 0, 0, _ALLOW)]


def _load(argument: int, *, high: bool = False) -> Instruction:
    """Half of an argument; both machines are little-endian."""
    return (_LOAD, 0, 0, 16 + 8 * argument + 4 * high)


def _only_values(argument: int, values: Iterable[int]) -> list[Instruction]:
    block = [_load(argument)]
    for value in values:
        block += [(_EQUAL, 0, 1, value), (_RETURN, 0, 0, _ALLOW)]
    return [*block, (_RETURN, 0, 0, _ERRNO | errno.EPERM)]


def _refuse_values(argument: int, values: Iterable[int]) -> list[Instruction]:
    block = [_load(argument)]
    for value in values:
        block += [(_EQUAL, 0, 1, value), (_RETURN, 0, 0, _ERRNO | errno.EPERM)]
    return [*block, (_RETURN, 0, 0, _ALLOW)]


def _refuse_if_any_bit(argument: int, bits: int) -> list[Instruction]:
    refused, allowed = (_RETURN, 0, 0, _ERRNO | errno.EPERM), (_RETURN, 0, 0, _ALLOW)
    return [_load(argument), (_ANY_BIT, 0, 1, bits), refused, allowed]


def _refuse_unless_any_bit(argument: int, bits: int) -> list[Instruction]:
    refused, allowed = (_RETURN, 0, 0, _ERRNO | errno.EPERM), (_RETURN, 0, 0, _ALLOW)
    return [_load(argument), (_ANY_BIT, 0, 1, bits), allowed, refused]


def _only_sockets(allowed: Iterable[tuple[int, int | None]]) -> list[Instruction]:
    """``socket`` of these families and kinds (None = any kind)."""
    block: list[Instruction] = []
    for family, kind in allowed:
        if kind is None:
            block += [_load(0), (_EQUAL, 0, 1, family), (_RETURN, 0, 0, _ALLOW)]
        else:
            block += [_load(0), (_EQUAL, 0, 4, family), _load(1), (_AND, 0, 0, _SOCKET_KIND)]
            block += [(_EQUAL, 0, 1, kind), (_RETURN, 0, 0, _ALLOW)]
    return [*block, (_RETURN, 0, 0, _ERRNO | errno.EACCES)]


def _only_without_address() -> list[Instruction]:
    """``sendto`` on a socket that is connected, that is, without an address and fast open."""
    refused = (_RETURN, 0, 0, _ERRNO | errno.EACCES)
    block = [_load(4), (_EQUAL, 1, 0, 0), refused]
    block += [_load(4, high=True), (_EQUAL, 1, 0, 0), refused]
    return [*block, *_refuse_if_any_bit(3, _MSG_FASTOPEN)]
