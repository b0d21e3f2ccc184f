"""Runs commands as a user other than root, in a mount namespace of their own.

The interpreter and its packages may lie below a home that only root may enter. There a folder with
nothing but them takes its place, for these commands alone.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]
_SCRIPT = """
set -e
stash=$1; shift
closed=$1; shift
wanted=$1; shift
if [ -n "$closed" ]; then
    mount --bind "$wanted" "$stash"
    mount -t tmpfs -o mode=755 tmpfs "$closed"
    mkdir -p "$wanted"
    mount --bind "$stash" "$wanted"
fi
exec "$@"
"""


def possible() -> bool:
    """Whether this process may become another user and mount folders for itself."""
    if not all(map(shutil.which, ("setpriv", "unshare", "mount"))):
        return False
    tried = subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "tmpfs", "/mnt"], check=False)
    return tried.returncode == 0


def command_as(
    user: int, words: Sequence[str], *, environment: Mapping[str, str], stash: Path
) -> list[str]:
    """The command that runs ``recon4`` as a user.

    Args:
        user: Its number; it need not have a name.
        words: Those behind ``recon4``.
        environment: All variables it gets, besides those that find the program.
        stash: An empty folder.
    """
    interpreter = Path(sys.base_prefix).resolve()
    closed = next((p for p in reversed(interpreter.parents) if not p.stat().st_mode & 0o001), None)
    variables = {"PATH": "/usr/bin:/bin", "PYTHONPATH": str(ROOT), **environment}
    return [
        *("unshare", "-m", "sh", "-c", _SCRIPT, "sh", str(stash)),
        *(str(closed or ""), str(interpreter)),
        *("setpriv", f"--reuid={user}", f"--regid={user}", "--clear-groups"),
        *("env", "-i", *(f"{name}={value}" for name, value in variables.items())),
        *(sys.executable, "-m", "recon4", *words),
    ]
