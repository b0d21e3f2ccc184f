"""Confinement of the commands that read files of users, when they have a process of their own.

Such a command may read what its user may read. It may write only where its results belong, open no
socket and start no program: a hostile file that takes over a parser can neither send anything out
nor change other files. `recon4.__main__` turns it on; a caller of `recon4.cli.main.main` in another
program is not confined, because it could not be undone.
"""

from __future__ import annotations

import atexit
import logging
import shutil
import subprocess
import sys
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.sandbox import Policy, confine
from recon4.sandbox.limits import physical_memory_bytes
from recon4.sandbox.private_cache import is_compiled, use_private_cache
from recon4.sandbox.tuning import CONFINEMENT

_REMOVER = """
import os, sys
sys.stdin.buffer.read()
for path in sys.argv[1:]:
    try:
        os.rmdir(path)
    except FileNotFoundError:
        continue
    except OSError:
        break
"""
"""Waits until the other end of its input closes, whatever ended the process that holds it."""
_own_process = False


def begin_own_process() -> None:
    """Let `confine_command` confine this process; it runs one command and ends."""
    global _own_process
    _own_process = True


def result_folder(path: Path) -> Path:
    """The folder, made if it does not exist, before this process may no longer make it.

    What it made and left empty is removed when it ends: after a failed command nothing is left.

    Raises:
        StoreError: If it cannot be made.
    """
    if not _own_process:
        return path
    missing = [folder for folder in (path.absolute(), *path.absolute().parents) if not _is(folder)]
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreError(
            CodedText("cannot-write", name=str(path), why=str(error.strerror))
        ) from error
    if missing:
        _remove_if_empty(missing)
    return path


def _is(folder: Path) -> bool:
    with suppress(OSError):
        return folder.exists()
    return True  # what cannot be looked at was not made here


def _remove_if_empty(folders: list[Path]) -> None:
    """Have another process remove folders that are empty when this one ends.

    Confined, this one may not remove what lies in a folder it may not write.
    """
    remover = subprocess.Popen(
        [sys.executable, "-I", "-S", "-c", _REMOVER, *map(str, folders)],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # Ctrl-C is for the command
    )
    atexit.register(remover.communicate)


def compile_first() -> None:
    """Have another process compile the kernels, if they are not: a confined one cannot keep them.

    Once after an installation; without effect in a process that does not belong to the command.
    """
    if not _own_process or is_compiled():
        return
    sys.stderr.write("compiling the kernels: once after an installation, some minutes\n")
    compiler = [sys.executable, "-P", "-m", "recon4", "compile"]
    if subprocess.run(compiler, stdout=subprocess.DEVNULL, check=False).returncode:
        sys.stderr.write("not compiled: this command compiles them for itself\n")


def confine_command(*, write: Iterable[Path] = ()) -> None:
    """Confine this process to the work of a command, before it opens a file of a user.

    Without effect in a process that does not belong to the command (`begin_own_process`). Where
    the kernel lacks a barrier the others still go up; ``recon4 doctor`` reports them.

    Args:
        write: Folders of the results. One that does not exist yet cannot be written later.
    """
    if not _own_process:
        return
    from recon4.recording.formats.scratch import keep_scratch_folder

    scratch = keep_scratch_folder()
    atexit.register(_empty, scratch)
    use_private_cache(scratch / "caches")
    logging.getLogger("recon4.sandbox").setLevel(logging.ERROR)
    confine(
        Policy(
            read=(Path("/"),),
            write=(*(folder.resolve() for folder in write), scratch),
            temporary=scratch / "tmp",
            memory_bytes=int(CONFINEMENT.memory_fraction * physical_memory_bytes()),
            open_files=CONFINEMENT.open_files,
        )
    )


def _empty(scratch: Path) -> None:
    """Remove what is in a folder but its lock, by which the next command finds it."""
    with suppress(OSError):
        for path in scratch.iterdir():
            if path.is_dir():
                shutil.rmtree(path, ignore_errors=True)
