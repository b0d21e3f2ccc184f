"""A process that opens one device again and again, for the recorder, which may open none.

The recorder reads bytes of strangers. A receiver that was unplugged comes back as another file in
``/dev``, which no permission of a confined process can name beforehand. So this process, which
reads no byte of anyone, opens the device and hands over the descriptor.
"""

from __future__ import annotations

import os
import signal
import socket
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from recon4.errors import Recon4Error
from recon4.live.recorder.serial_port import DRIVERS, TERMINALS
from recon4.live.recorder.tuning import DEVICE_OPENER
from recon4.sandbox import Policy, confine
from recon4.system.stopping import SIGNALS


class DeviceOpener:
    """Opens a device by a child process, which ends with this one."""

    def __init__(self, open_device: Callable[[], int]) -> None:
        """Start the child; call it before other threads start and before `confine`.

        Args:
            open_device: Run in the child for each `open`; returns a descriptor.
        """
        self._ours, theirs = socket.socketpair()
        self._child = os.fork()
        if self._child == 0:
            self._ours.close()
            try:
                _serve(theirs, open_device)
            finally:
                os._exit(0)
        theirs.close()

    def open(self) -> int:
        """Open the device.

        Returns:
            Its descriptor, to be closed by the caller.

        Raises:
            OSError: With the reason why it cannot be opened.
        """
        self._ours.send(b"open")
        words, files, _, _ = socket.recv_fds(self._ours, DEVICE_OPENER.max_words, 1)
        if not files:
            raise OSError(words.decode("utf-8", "replace") or "its process ended")
        return files[0]

    def close(self) -> None:
        """End the child."""
        self._ours.close()
        os.waitpid(self._child, 0)


def _serve(connection: socket.socket, open_device: Callable[[], int]) -> None:
    # Ctrl-C reaches all processes of a terminal; the recorder ends this one when it is done.
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    confine(Policy(read=(DRIVERS, TERMINALS, Path("/sys/devices")), write=(Path("/dev"),)))
    while connection.recv(16):
        try:
            file = open_device()
        except (OSError, Recon4Error) as error:
            connection.send(
                str(error).encode()[: DEVICE_OPENER.max_words] or b"it cannot be opened"
            )
            continue
        with suppress(OSError):
            socket.send_fds(connection, [b"opened"], [file])
        os.close(file)
