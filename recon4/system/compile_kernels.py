"""Compile the kernels once after an installation, for every later process.

Numba's cache is code that the next process loads, so a confined process must not write it: what it
compiles itself is lost with it. `compile_kernels` compiles what `recon4/kernels/signatures.txt`
names, on all processors, outside any confinement, before a process reads a file of a user.
"""

from __future__ import annotations

import gc
import multiprocessing
import os
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait

from recon4.kernels.signatures import kernels
from recon4.progress import Progress, track
from recon4.sandbox.private_cache import is_compiled, mark_compiled
from recon4.store.locks import open_lock_file, wait_for_lock
from recon4.system.processes import die_with_parent
from recon4.system.runtime_folder import runtime_folder
from recon4.system.tuning import PROCESSES


def compile_kernels(progress: Progress) -> bool:
    """Compile all kernels, unless they are compiled; a second process waits for the first.

    Args:
        progress: Receives each kernel.

    Returns:
        Whether there was anything to compile.

    Raises:
        StoreError: If there is no place for the lock of those who wait.
    """
    lock = open_lock_file(runtime_folder() / "compiling.lock")
    try:
        wait_for_lock(lock)
        if is_compiled(where_chosen=True):
            return False
        calls = {name: set(kernel.calls) for name, kernel in kernels().items()}
        spawn = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(mp_context=spawn, initializer=_begin) as pool:
            done = _compiled(pool, calls)
            for _ in track(done, progress, what="kernels", unit="kernels", total=len(calls)):
                pass
        mark_compiled()
        return True
    finally:
        os.close(lock)


def _compiled(pool: ProcessPoolExecutor, calls: dict[str, set[str]]) -> Iterator[str]:
    """Names of the kernels as they are compiled, what a kernel calls before itself.

    Numba compiles what is called with the kernel that calls it, so two processes would do the same.

    Args:
        pool: Its processes compile.
        calls: For each kernel those that it calls.
    """
    waiting = dict(calls)
    running: dict[Future[None], str] = {}
    done: set[str] = set()
    while waiting or running:
        for name in [name for name, needs in waiting.items() if needs <= done]:
            running[pool.submit(_compile, name)] = name
            del waiting[name]
        finished, _ = wait(running, return_when=FIRST_COMPLETED)
        for future in finished:
            future.result()
            done.add(name := running.pop(future))
            yield name


def _begin() -> None:
    die_with_parent()
    gc.set_threshold(PROCESSES.collected_after)


def _compile(name: str) -> None:
    kernels()[name].compile()
