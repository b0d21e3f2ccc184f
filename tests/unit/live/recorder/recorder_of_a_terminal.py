"""A recorder whose GNSS receiver is a pseudo terminal: no computer of a test has a serial line.

Run as a module. ``RECEIVER`` in the folder of the project names the terminal; everything but the
question whether the device is a serial line is as in the real process.
"""

import sys
from pathlib import Path

from recon4.live.recorder.process import main
from recon4.live.recorder.serial_port import open_line
from recon4.system.stopping import end_process

RECEIVER = "receiver"

if __name__ == "__main__":
    project = Path(sys.argv[1])
    terminal = (project / RECEIVER).read_text()
    end_process(
        lambda stop: main(
            project, stop, open_device=lambda device: open_line(terminal, device.baud)
        )
    )
