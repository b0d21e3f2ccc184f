"""Paths every Python process of recon4 reads: installation, libraries, fonts, processor."""

from __future__ import annotations

import sys
from pathlib import Path

import recon4

_SYSTEM = (
    *("/usr/lib", "/usr/lib32", "/usr/lib64", "/usr/libexec", "/usr/share", "/lib", "/lib64"),
    *("/usr/local/lib", "/usr/local/share", "/opt/homebrew"),
    *("/etc/ld.so.cache", "/etc/ld.so.conf", "/etc/ld.so.conf.d", "/etc/localtime", "/etc/passwd"),
    *("/etc/fonts", "/etc/matplotlibrc", "/etc/mime.types"),
    *("/proc/self", "/proc/cpuinfo", "/proc/meminfo", "/proc/stat", "/proc/version"),
    *("/proc/sys/vm/overcommit_memory", "/proc/sys/kernel/osrelease"),
    *("/sys/devices/system/cpu", "/sys/devices/system/node", "/sys/kernel/mm/transparent_hugepage"),
    *("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom"),
)
WRITABLE = ("/dev/null", "/dev/zero", "/dev/full", "/proc/self/clear_refs")
"""Folders without data of users."""
_PACKAGES = ("recon4", "recon4_app", "recon4_web", "app", "web")
"""As installed, and in a checkout."""


def readable_paths() -> tuple[Path, ...]:
    """Files and folders needed to run Python and recon4; none has data of users."""
    prefixes = {sys.prefix, sys.exec_prefix, sys.base_prefix, sys.base_exec_prefix}
    libraries = {"lib", "lib64", "share", "pyvenv.cfg"}  # not bin: it may start no program
    roots = [Path(prefix, name) for prefix in sorted(prefixes) for name in sorted(libraries)]
    suffixes = ("site-packages", "dist-packages")
    homes = [Path(entry) for entry in sys.path if entry.endswith(suffixes)]
    ours = [Path(recon4.__file__).parents[1] / name for name in _PACKAGES]
    return (*map(Path, _SYSTEM), *roots, *homes, *ours)
