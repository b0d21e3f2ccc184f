"""Reads a GNSS receiver on a serial line; each sentence becomes a datagram of the capture."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from recon4.errors import ConfigError
from recon4.live.recorder.capture_file import Datagram

if TYPE_CHECKING:
    from serial import Serial

RETRY_S = 1.0
_LONGEST = 1024
"""Bytes passed on as one sentence if no line end comes."""
_USUAL_BAUD = 9600


class SerialLine:
    """Reads sentences in a separate thread; reopens the device after it was unplugged."""

    def __init__(self, device: str, port: int, *, take: Callable[[Datagram], None]) -> None:
        """Prepare.

        Args:
            device: Device and baud rate, ``/dev/ttyUSB0:115200``; default rate 9600.
            port: UDP port of the datagrams the sentences are recorded as.
            take: Called from the thread with every sentence.

        Raises:
            ConfigError: If the device is not ``DEVICE:BAUD``.
        """
        self.name, self.baud = parse_device(device)
        self.problem = "not opened yet"
        """Why the device is not open; empty = it is open."""
        self._port, self._take = port, take
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="serial", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread."""
        self._ending.set()
        self._thread.join()

    def _run(self) -> None:
        import serial

        while not self._ending.is_set():
            try:
                with serial.Serial(self.name, self.baud, timeout=0.2) as line:
                    self.problem = ""
                    self._read(line)
            except (OSError, ValueError) as error:  # SerialException is an OSError
                self.problem = f"{self.name}: {error}"
            self._ending.wait(RETRY_S)

    def _read(self, line: Serial) -> None:
        rest = b""
        while not self._ending.is_set():
            rest += line.read(max(1, line.in_waiting))
            *whole, rest = rest.split(b"\n")
            for sentence in [*whole, *([rest] if len(rest) > _LONGEST else [])]:
                if sentence.strip():
                    datagram = Datagram(
                        time.time_ns(), ("127.0.0.1", 0), self._port, sentence.strip() + b"\r\n"
                    )
                    self._take(datagram)
            rest = rest if len(rest) <= _LONGEST else b""


def parse_device(text: str) -> tuple[str, int]:
    """Split device and baud rate: ``("/dev/ttyUSB0", 115200)`` of ``/dev/ttyUSB0:115200``.

    Raises:
        ConfigError: If the baud rate is not a number.
    """
    name, colon, baud = text.rpartition(":")
    if not colon:
        return text, _USUAL_BAUD
    if not name or not baud.isdigit() or not 0 < int(baud) < 10_000_000:
        raise ConfigError(
            f"gnss: serial must be DEVICE:BAUD, for example /dev/ttyUSB0:115200, got {text!r}"
        )
    return name, int(baud)
