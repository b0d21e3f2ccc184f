"""Confinement of a child of the pool: the sandbox policy for its file access."""

from __future__ import annotations

import os
from pathlib import Path

from recon4.sandbox import Confinement, Policy, confine
from recon4_app.compute_pool.model import FileAccess

MAX_FILE_BYTES = 64 << 30
MAX_MEMORY_BYTES = 8 << 30
"""Private memory of a child; memory-mapped files do not count."""


def confine_child(access: FileAccess, scratch: Path, kernels: tuple[Path, ...]) -> Confinement:
    """Confine this process: no network, no other files, no programs, bounded memory.

    Args:
        access: Files its work may open.
        scratch: Its working folder, the only place it can write besides ``access.write``.
        kernels: Folders of compiled kernels that it may read.
    """
    return confine(
        Policy(
            read=(*access.read, *kernels),
            write=(*access.write, scratch),
            temporary=scratch / "tmp",
            memory_bytes=min(MAX_MEMORY_BYTES, _half_of_the_memory()),
            file_bytes=MAX_FILE_BYTES,
        )
    )


def _half_of_the_memory() -> int:
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
