"""What this machine has, and whether it is enough."""

from __future__ import annotations

import os
import platform
import shutil
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

import recon4
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.sandbox import Barrier, available_barriers
from recon4.sandbox.private_cache import cache_in_use, planted
from recon4.system.tuning import NEEDS

_PACKAGES = (
    ("numpy", "numbers"),
    ("numba", "compiled loops"),
    ("gtsam", "pose graph"),
    ("open3d-cpu", "simulation"),
    ("rosbags", "reading bags"),
    ("laspy", "writing LAZ"),
    ("lazrs", "writing LAZ"),
    ("pyproj", "coordinate systems"),
    ("viser", "3D viewer"),
    ("fastapi", "server"),
)
_ELSEWHERE = {"open3d-cpu": "open3d"}


@dataclass(frozen=True, slots=True)
class Check:
    """One thing looked at."""

    what: str
    found: str
    ok: bool
    advice: str = ""
    """What to do if it is not; empty when it is."""


def examine(folder: Path) -> list[Check]:
    """Look at versions, cores, memory, disk, threads and what confines processes.

    Args:
        folder: Where projects would be kept; its disk is looked at.

    Raises:
        ConfigError: If there is no such folder.
    """
    if not folder.is_dir():
        raise ConfigError(CodedText("doctor-no-folder", folder=str(folder)))
    checks = [
        Check("recon4", recon4.__version__, ok=True),
        Check("Python", platform.python_version(), ok=True),
        _at_least("cores", _cores(), NEEDS.cores, unit=""),
        _at_least("memory", _memory_gb(), NEEDS.memory_gb, unit=" GB"),
        _at_least("disk free", shutil.disk_usage(folder).free / 1e9, NEEDS.disk_gb, unit=" GB"),
        Check(
            "threads of BLAS", os.environ.get("OPENBLAS_NUM_THREADS", "as many as cores"), ok=True
        ),
        _kernel_cache(),
    ]
    checks += [_barrier(barrier) for barrier in available_barriers()]
    return checks + [_package(name, purpose) for name, purpose in _PACKAGES]


def _at_least(what: str, found: float, needed: float, *, unit: str) -> Check:
    ok = found >= needed
    advice = "" if ok else f"recon4 works best with {needed:g}{unit} or more"
    return Check(what, f"{found:.3g}{unit}", ok, advice)


def _package(name: str, purpose: str) -> Check:
    for candidate in (name, _ELSEWHERE.get(name, name)):
        try:
            return Check(candidate, metadata.version(candidate), ok=True)
        except metadata.PackageNotFoundError:
            continue
    return Check(name, "missing", ok=False, advice=f"needed for {purpose}: pip install {name}")


def _barrier(barrier: Barrier) -> Check:
    found = barrier.detail if barrier.holds else "missing"
    advice = "" if barrier.holds else barrier.detail
    return Check(f"sandbox: {barrier.name}", found, barrier.holds, advice)


def _kernel_cache() -> Check:
    cache = cache_in_use()
    if cache is None:
        advice = "set NUMBA_CACHE_DIR to a writable folder, or each start compiles"
        return Check("compiled loops kept", "no", ok=False, advice=advice)
    why = planted(cache)
    return Check("compiled loops kept", "unsafe" if why else "yes", not why, why)


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _memory_gb() -> float:
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9
