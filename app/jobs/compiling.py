"""Compile the kernels once, on simulated data, before the first worker reads a user's file.

A confined worker must not write code that other processes load, so what it compiles is lost with
it. On a new installation the first worker therefore starts a small simulated walk through the
pipeline, outside its confinement.
"""

from __future__ import annotations

import contextlib
import logging
import subprocess
import sys
import time
from pathlib import Path

from recon4.sandbox.private_cache import is_cold

log = logging.getLogger("recon4.job")

WALK_S = 6
WITHIN_S = 1800.0
BEAT_EVERY_S = 1.0


def compile_kernels_once(scratch: Path, heartbeat: Path) -> None:
    """Fill the shared cache of compiled kernels if it is empty; a failure is only logged.

    Args:
        scratch: Folder for the simulated walk, made when missing.
        heartbeat: File that is touched meanwhile.
    """
    if not is_cold():
        return
    log.info("compiling the kernels: once after an installation, some minutes")
    walk, rig = scratch / "walk", "4recon"
    scratch.mkdir(parents=True, exist_ok=True)
    simulate = ["simulate", "office", str(walk), "--seconds", str(WALK_S), "--no-bag", "--rig", rig]
    process = ["process", str(walk / "recording.pcap"), "--rig", rig]
    process += ["--imu", str(walk / "imu.csv"), "--out", str(scratch / "project")]
    deadline_s = time.monotonic() + WITHIN_S
    for command in (simulate, process):
        if not _ran(command, heartbeat, deadline_s):
            log.warning("the kernels could not be compiled ahead; every job compiles its own")
            return


def _ran(command: list[str], heartbeat: Path, deadline_s: float) -> bool:
    child = subprocess.Popen([sys.executable, "-m", "recon4", *command], stdin=subprocess.DEVNULL)
    while time.monotonic() < deadline_s:
        heartbeat.touch()
        with contextlib.suppress(subprocess.TimeoutExpired):
            return child.wait(BEAT_EVERY_S) == 0
    child.kill()
    child.wait()
    return False
