"""``python -m recon4`` is the command ``recon4``."""

import sys

from recon4.system.stopping import StopSignals, end_process


def main() -> None:
    """Run the command of this process and end it."""
    end_process(_command)


def _command(stop: StopSignals) -> int:
    # signals are caught before these imports, which take half a second
    from recon4.cli.confinement import begin_own_process
    from recon4.cli.main import run

    begin_own_process()
    return run(sys.argv[1:], stop)


if __name__ == "__main__":
    main()
