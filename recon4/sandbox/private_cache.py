"""Library caches of a confined process: it reads existing ones and writes its own.

Numba's cache is code that the next process loads (machine code and pickles), so a confined process
must not write where others read. It has a private folder that begins with symbolic links to the
compiled kernels and to matplotlib's list of fonts; what it makes itself lands beside them and goes
with the folder. Another user who may write a cache could plant code in it: such files are not used.
"""

from __future__ import annotations

import hashlib
import os
import stat
import sys
from collections.abc import Iterable, Iterator
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path

import recon4
from recon4.kernels.processor import instructions

KERNELS = Path(recon4.__file__).parent / "kernels"
LINKS = "links"
"""Folder in a shared cache with a symbolic link to each of its files."""


def use_private_cache(folder: Path) -> tuple[Path, ...]:
    """Make Numba and matplotlib use private caches; call before our kernels are imported.

    Args:
        folder: The confined process may write it; made when missing.

    Returns:
        Files and folders with what is cached already: the process must be able to read them.
    """
    os.environ |= (environment := private_cache(folder))
    if (config := sys.modules.get("numba.core.config")) is not None:  # it read its environment
        config.__dict__["CACHE_DIR"] = environment["NUMBA_CACHE_DIR"]
    return cached_elsewhere(folder)


def private_cache(folder: Path) -> dict[str, str]:
    """Make a private cache folder.

    Returns:
        The environment of a process that is to use it. A parent passes it to a child whose
        modules import the kernels before it can confine itself.
    """
    kernels, fonts = folder / "numba", folder / "matplotlib"
    for cache in shared_caches():
        _link(_files(cache, ".nbi", ".nbc"), kernels / _numba_name(KERNELS))
    _link(_font_lists(), fonts)
    return {"MPLCONFIGDIR": str(fonts), "NUMBA_CACHE_DIR": str(kernels)}


def cached_elsewhere(folder: Path) -> tuple[Path, ...]:
    """Folders of what a private cache folder links to, which its process must read."""
    links = (path for path in folder.rglob("*") if path.is_symlink())
    folders = dict.fromkeys(link.readlink().parent for link in links)
    return tuple(dict.fromkeys(folder.resolve() for folder in folders))


def _link(paths: Iterable[Path], folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for path in paths:
        with suppress(FileExistsError):  # the one in front of it is the one that is used
            _symlink(path.resolve() if path.is_symlink() else path, folder / path.name)


def _symlink(path: Path, link: Path) -> None:
    """Make a symbolic link: another name of the one that `mark_compiled` has made, if it can be.

    A process needs hundreds, and ext4 takes some 0.6 ms of the processor for a new one.
    """
    try:
        os.link(path.parent / LINKS / path.name, link, follow_symlinks=False)
    except FileExistsError:
        raise
    except OSError:  # there is none, it is of another user, or on another disk
        link.symlink_to(path)
        return
    if not (link.is_symlink() and link.readlink() == path):
        link.unlink()
        link.symlink_to(path)


def _files(folder: Path, *suffixes: str) -> list[Path]:
    """Files of some suffixes in a folder; none when it is missing or others may write it."""
    with suppress(OSError):
        if not writable_by_others(folder):
            paths = [folder / name for name in os.listdir(folder) if name.endswith(suffixes)]
            return [path for path in paths if not writable_by_others(path)]
    return []


def writable_by_others(path: Path) -> str:
    """Why a cache may hold code of another user; empty if it may not, or does not exist.

    Who owns recon4's own sources is trusted, and a group that is the user's own (the same number).
    """
    try:
        found = path.stat()
    except OSError:
        return ""
    user, mode = os.getuid(), stat.S_IMODE(found.st_mode)
    if found.st_uid not in (0, user) and found.st_uid != KERNELS.stat().st_uid:
        return f"it belongs to user {found.st_uid}, this is user {user}"
    group = mode & stat.S_IWGRP and found.st_gid not in (0, user)
    if group or mode & stat.S_IWOTH:
        return f"its mode {stat.filemode(found.st_mode)} lets others write it"
    return ""


def planted(cache: Path) -> str:
    """Why a folder of compiled kernels is not to be used; empty if it is safe.

    Args:
        cache: One of `shared_caches`.
    """
    names = sorted(os.listdir(cache)) if cache.is_dir() and os.access(cache, os.R_OK) else []
    files = [cache / name for name in names if name.endswith((".nbi", ".nbc"))]
    for path in (cache.parent, cache, *files):
        if why := writable_by_others(path):
            return f"{path}: {why}"
    return ""


def _font_lists() -> Iterator[Path]:
    """Matplotlib's lists of fonts, which take seconds to make."""
    if chosen := os.environ.get("MPLCONFIGDIR"):
        yield from _files(Path(chosen).resolve(), ".json")
    yield from _files(_user_caches() / "matplotlib", ".json")


def is_compiled(*, where_chosen: bool = False) -> bool:
    """Whether `recon4.system.compile_kernels` has run with the kernels as they are now.

    Args:
        where_chosen: Whether only the folder counts that NUMBA_CACHE_DIR names, if it names one.
    """
    caches = list(shared_caches())
    if where_chosen and os.environ.get("NUMBA_CACHE_DIR"):
        del caches[1:]
    return any((cache / _mark()).exists() for cache in caches)


def mark_compiled() -> None:
    """Note that an unconfined process has compiled all kernels into a shared cache."""
    for cache in shared_caches():
        if _files(cache, ".nbi"):
            with suppress(OSError):
                (cache / LINKS).mkdir(exist_ok=True)
                for path in _files(cache, ".nbi", ".nbc"):
                    with suppress(FileExistsError):
                        (cache / LINKS / path.name).symlink_to(path)
                (cache / _mark()).touch()
                return


def _mark() -> str:
    """A name that changes with the kernels, Numba, Python and the processor's instructions."""
    versions = f"{sys.implementation.cache_tag} {version('numba')} {instructions()}".encode()
    sources = (
        path.read_bytes() for path in sorted((*KERNELS.glob("*.py"), *KERNELS.glob("*.txt")))
    )
    return f"compiled-{hashlib.sha256(b'|'.join((versions, *sources))).hexdigest()[:16]}"


def shared_caches() -> Iterator[Path]:
    """Folders in which unconfined processes keep compiled kernels, first the one Numba prefers."""
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        yield Path(chosen).resolve() / _numba_name(KERNELS)
    yield KERNELS / "__pycache__"
    yield _user_caches() / "numba" / _numba_name(KERNELS)


def cache_in_use() -> Path | None:
    """The folder in which Numba keeps the kernels that this process compiles; None = none."""
    return next((cache for cache in shared_caches() if _can_be_written(cache)), None)


def _can_be_written(folder: Path) -> bool:
    with suppress(OSError):
        there = next(path for path in (folder, *folder.parents) if path.exists())
        return there.is_dir() and os.access(there, os.W_OK | os.X_OK)
    return False


def _numba_name(folder: Path) -> str:
    """How Numba names the cache of a folder of sources."""
    return f"{folder.name}_{hashlib.sha1(str(folder).encode()).hexdigest()}"


def _user_caches() -> Path:
    """Of a user without a home a folder that does not exist, never one in the working folder."""
    if sys.platform == "darwin":
        return Path("/", os.path.expanduser("~/Library/Caches"))
    return Path("/", os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
