"""Limits of a worker: files, memory, processor time."""

from __future__ import annotations

import faulthandler
import os
import shutil
from pathlib import Path

from recon4.review.newest_approval import judging_folders
from recon4.review.trusted_keys import STATE
from recon4.sandbox import Confinement, Policy, confine, restart_with_one_thread
from recon4.sandbox.limits import physical_memory_bytes
from recon4.sandbox.private_cache import use_private_cache
from recon4_app.jobs.compiling import compile_kernels_once
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.tuning import WORKER_LIMITS


def allowed_memory(setting_bytes: int) -> int:
    """Memory limit of a worker [bytes]: 70 % of this computer's, or the setting if that is less."""
    most = int(WORKER_LIMITS.memory_fraction * physical_memory_bytes())
    return min(most, setting_bytes) if setting_bytes > 0 else most


def worker_policy(folder: JobFolder) -> Policy:
    """The sandbox policy: read the job's inputs and the kernels, write the project and its folder.

    ``RLIMIT_DATA`` limits written memory, not mapped memory: mapping a recording larger than the
    memory is harmless. One file may be as large as the free disk space.
    """
    request = folder.request()
    inputs, limits = request.inputs, request.limits
    rig = inputs.rig if os.path.isabs(inputs.rig) else ""  # else a shipped one
    given = [Path(path) for path in (*inputs.recordings, inputs.imu, inputs.gnss, rig) if path]
    times = [path.parent / "times.txt" for path in given if path.is_dir()]
    free = shutil.disk_usage(folder.path).free - limits.reserve_bytes
    return Policy(
        read=(*given, *request.near, *times, *judging_folders(request.project.parent / STATE)),
        write=(request.project, folder.path),
        temporary=folder.temporary,
        memory_bytes=limits.memory_bytes,
        cpu_s=WORKER_LIMITS.max_cpu_s,
        file_bytes=max(WORKER_LIMITS.min_file_bytes, free),
        open_files=WORKER_LIMITS.max_files,
    )


def prepare_worker(folder: JobFolder, policy: Policy) -> Confinement:
    """Confine this process to the policy of its job, before it opens a file of a user."""
    restart_with_one_thread()
    give_way()
    faulthandler.enable()  # a crash in native code writes its stack to the log
    project = folder.request().project
    project.mkdir(parents=True, exist_ok=True)  # the kernel allows only paths that exist
    compile_kernels_once(folder.path)
    cached = use_private_cache(folder.temporary / "caches")
    return confine(policy.adding(read=cached))


def give_way() -> None:
    """Run this process at the low priority of workers."""
    os.nice(max(0, WORKER_LIMITS.niceness - os.nice(0)))
