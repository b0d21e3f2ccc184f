"""Compiled kernels for a confined process: it reads those that are there and keeps its own apart.

Numba's cache is code that the next process loads (machine code and pickles), so a confined process
must not write where others read. It has a private cache folder that begins with symbolic links
to the compiled kernels; what it compiles itself lands beside them and goes with the folder.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import recon4

KERNELS = Path(recon4.__file__).parent / "kernels"


def use_private_cache(folder: Path) -> tuple[Path, ...]:
    """Make Numba use a private cache in a folder; call before it is imported.

    Args:
        folder: Below a folder the confined process may write; made when missing.

    Returns:
        The folders with the compiled kernels: the confined process must be able to read them.
    """
    mine = folder / _numba_name(KERNELS)
    mine.mkdir(parents=True, exist_ok=True)
    shared = tuple(shared_caches())
    for cache in shared:
        for path in cache.glob("*.nb[ic]"):
            with suppress(FileExistsError):  # the one in front of it is the one Numba would use
                (mine / path.name).symlink_to(path)
    os.environ["NUMBA_CACHE_DIR"] = str(folder)
    if (config := sys.modules.get("numba.core.config")) is not None:
        config.__dict__["CACHE_DIR"] = str(folder)
    return shared


def shared_caches() -> Iterator[Path]:
    """Folders in which unconfined processes keep compiled kernels, first the one Numba prefers."""
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        yield Path(chosen).resolve() / _numba_name(KERNELS)
    yield KERNELS / "__pycache__"
    yield _user_cache() / _numba_name(KERNELS)


def _numba_name(folder: Path) -> str:
    """How Numba names the cache of a folder of sources."""
    return f"{folder.name}_{hashlib.sha1(str(folder).encode()).hexdigest()}"


def _user_cache() -> Path:
    if sys.platform == "darwin":
        return Path("~/Library/Caches/numba").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()) / "numba"
