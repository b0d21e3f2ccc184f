"""Confinement of a child of the pool: the sandbox policy for its file access."""

from __future__ import annotations

import os
from pathlib import Path

from recon4.sandbox import Confinement, Policy, confine
from recon4_app.compute_pool.model import FileAccess
from recon4_app.compute_pool.tuning import CHILD_LIMITS


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
            memory_bytes=min(CHILD_LIMITS.max_memory_bytes, _half_of_the_memory()),
            file_bytes=CHILD_LIMITS.max_file_bytes,
        )
    )


def _half_of_the_memory() -> int:
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
