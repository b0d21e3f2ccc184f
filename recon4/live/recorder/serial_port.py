"""Opens a serial device, once the kernel has said that it is one.

A rig file names the device, and rigs come from other people: a name may lead to another terminal,
to a disk, or to a device that acts as soon as it is opened. So it is examined before it is opened.
"""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.serial_device import SerialDevice

DRIVERS = Path("/proc/tty/drivers")
"""The kernel's table of terminal drivers: name, node, major, minors, type."""
TERMINALS = Path("/sys/class/tty")


def check_serial_device(device: SerialDevice) -> None:
    """Check that a device is a serial line; one that is not plugged in passes.

    Raises:
        ConfigError: If it is something else, a console of this computer, or cannot be examined.
    """
    try:
        with suppress(FileNotFoundError), _serial_line(device.path):
            pass
    except OSError as error:
        raise ConfigError(
            CodedText("serial-failed", path=str(device.path), why=str(error.strerror or error))
        ) from error


def open_serial_device(device: SerialDevice) -> int:
    """Open a serial device and set its baud rate.

    Returns:
        Its descriptor; reading does not block.

    Raises:
        ConfigError: If the device is no serial line.
        OSError: If it is not there or cannot be opened.
    """
    with _serial_line(device.path) as path:
        return open_line(path, device.baud)


def open_line(path: str, baud: int) -> int:
    """Open a terminal as a raw line with a baud rate.

    Raises:
        OSError: If it cannot be opened, or has no such rate.
    """
    import serial

    try:
        with serial.Serial(path, baud) as line:
            return os.dup(line.fileno())
    except ValueError as error:
        raise OSError(CodedText("serial-baud", baud=baud, why=str(error))) from error


@contextmanager
def _serial_line(path: str) -> Iterator[str]:
    """The path by which a serial line is opened: what was examined, and nothing put in its place.

    Links are followed (``/dev/serial/by-id``). ``O_PATH`` finds a device without opening it.
    """
    if sys.platform != "linux":
        _check_kind(os.stat(path), path)
        yield path
        return
    found = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        _check_kind(os.fstat(found), path)
        _check_driver(os.fstat(found).st_rdev, path)
        yield f"/proc/self/fd/{found}"
    finally:
        os.close(found)


def _check_kind(status: os.stat_result, path: str) -> None:
    if not stat.S_ISCHR(status.st_mode):
        raise ConfigError(CodedText("serial-no-device", path=str(path)))


def _check_driver(device: int, path: str) -> None:
    kind = driver_kind(device, DRIVERS.read_text("utf-8", "replace"))
    if kind != "serial":
        raise ConfigError(
            CodedText("serial-no-line", path=path, kind=kind or CodedText("serial-other-device"))
        )
    if device in _consoles():
        raise ConfigError(CodedText("serial-console", path=str(path)))


def driver_kind(device: int, table: str) -> str:
    """Type of the terminal driver of a device; empty = it is no terminal.

    Args:
        device: Device number (``st_rdev``).
        table: Text of ``/proc/tty/drivers``.
    """
    for row in table.splitlines():
        columns = row.split()
        if len(columns) != 5 or columns[2] != str(os.major(device)):
            continue
        first, _, last = columns[3].partition("-")
        if int(first) <= os.minor(device) <= int(last or first):
            return columns[4]
    return ""


def _consoles() -> set[int]:
    """Device numbers of the terminals that the kernel writes its messages to."""
    found = set()
    with suppress(OSError):  # without the folder, as in some containers, there is no console
        for name in (TERMINALS / "console" / "active").read_text().split():
            major, _, minor = (TERMINALS / name / "dev").read_text().partition(":")
            found.add(os.makedev(int(major), int(minor)))
    return found
