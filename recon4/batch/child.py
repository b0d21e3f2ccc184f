"""The process of one walk: ``recon4``, but it ends with its parent and waits for its project.

A worker that is killed is replaced at once; the process of its walk may live for another moment,
and on another computer until that one notices. Two never write one project.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from recon4.store.locks import open_lock_file, wait_for_lock
from recon4.system.processes import die_with_parent
from recon4.system.stopping import leave_terminal_to_parent


def main() -> None:
    """Run the command in the arguments of this process."""
    die_with_parent(0)
    leave_terminal_to_parent()
    _wait_for_project(Path(sys.argv[sys.argv.index("--out") + 1]))
    from recon4.__main__ import main as recon4

    recon4()


def _wait_for_project(folder: Path) -> None:
    try:
        lock = open_lock_file(folder / ".lock")
    except OSError:
        return  # there is none yet, or the command says what is wrong
    try:
        wait_for_lock(lock)
    finally:
        os.close(lock)


if __name__ == "__main__":
    main()
