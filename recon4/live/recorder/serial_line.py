"""Reads a GNSS receiver on a serial line; each sentence becomes a datagram of the capture."""

from __future__ import annotations

import os
import select
import threading
import time
from collections.abc import Callable

from recon4.live.recorder.capture_file import Datagram
from recon4.live.recorder.device_opener import DeviceOpener
from recon4.live.recorder.tuning import SERIAL_LINE
from recon4.locales.coded import CodedText


class SerialLine:
    """Reads sentences in a separate thread; reopens the device after it was unplugged."""

    def __init__(
        self, name: str, opener: DeviceOpener, *, port: int, take: Callable[[Datagram], None]
    ) -> None:
        """Start reading.

        Args:
            name: Of the device, for messages.
            opener: Opens it; closed with this.
            port: UDP port of the datagrams the sentences are recorded as.
            take: Called from the thread with every sentence.
        """
        self.problem = "not opened yet"
        """Why the device is not open; empty = it is open."""
        self._name, self._opener = name, opener
        self._port, self._take = port, take
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="serial", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread."""
        self._ending.set()
        self._thread.join()
        self._opener.close()

    def _run(self) -> None:
        while not self._ending.is_set():
            try:
                line = self._opener.open()
                try:
                    self.problem = ""
                    self._read(line)
                finally:
                    os.close(line)
            except OSError as error:
                self.problem = f"{self._name}: {error}"
            self._ending.wait(SERIAL_LINE.retry_s)

    def _read(self, line: int) -> None:
        rest = b""
        while not self._ending.is_set():
            if not select.select([line], [], [], SERIAL_LINE.poll_s)[0]:
                continue
            data = os.read(line, SERIAL_LINE.at_once)
            if not data:
                raise OSError(CodedText("serial-gone"))
            *whole, rest = (rest + data).split(b"\n")
            for sentence in [*whole, *([rest] if len(rest) > SERIAL_LINE.longest else [])]:
                if sentence.strip():
                    datagram = Datagram(
                        time.time_ns(), ("127.0.0.1", 0), self._port, sentence.strip() + b"\r\n"
                    )
                    self._take(datagram)
            rest = rest if len(rest) <= SERIAL_LINE.longest else b""
