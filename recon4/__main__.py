"""``python -m recon4`` is the command ``recon4``."""

import os
import signal
import sys

from recon4.stopping import SIGNALS, StopSignals


def main() -> None:
    """Run the command of this process and end it."""
    with StopSignals() as stop:  # before the imports, which take half a second
        try:
            from recon4.cli.confinement import begin_own_process
            from recon4.cli.main import run

            begin_own_process()
            code = run(sys.argv[1:], stop)
        except BaseException:
            if stop.received is None:
                raise
            stop.say()
            code = stop.exit_code
        for number in SIGNALS:  # all is done: there is nothing left to stop
            signal.signal(number, signal.SIG_IGN)
    if stop.received is not None:
        os._exit(code)  # without waiting for what other threads still compute
    sys.exit(code)


if __name__ == "__main__":
    main()
