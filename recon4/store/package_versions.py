"""Versions that a result depends on."""

from __future__ import annotations

import platform
from functools import cache
from importlib import metadata

import recon4

_KEY_PACKAGES = ("numpy", "scipy", "numba", "gtsam", "laspy", "pyproj")


def versions() -> dict[str, str]:
    """Versions of recon4, Python and the packages that influence results."""
    found = {"recon4": recon4.__version__, "python": platform.python_version()}
    return found | {name: _installed(name) for name in _KEY_PACKAGES}


@cache
def _installed(package: str) -> str:
    """Version of a package; reading it from the disk takes 2 ms."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "missing"
