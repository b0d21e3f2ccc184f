"""Builds the documentation site: ``python -m tools.site``, and each wheel that is built (hatch).

A wheel brings compiled kernels, too, if the variable `COMPILED_KERNELS` names their folder: `make
wheel` compiles them first.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

COMPILED_KERNELS = "RECON4_COMPILED_KERNELS"
CACHED = (".nbi", ".nbc", "")
"""Endings of Numba's files, and of the mark that all kernels are compiled."""
SITE = "site"
"""Folder of the built site, in the folder of `zensical.toml`."""


def build(root: Path) -> Path:
    """Build the site from scratch; a link that leads nowhere ends the build.

    Args:
        root: Where `zensical.toml` is.
    """
    site = root / SITE
    shutil.rmtree(site, ignore_errors=True)
    command = [sys.executable, "-m", "zensical", "build", "--clean", "--strict"]
    subprocess.run(command, cwd=root, check=True)
    return site


class WheelHook(BuildHookInterface[Any]):
    """Puts the site and compiled kernels into a wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build it first, unless the installation only points to the checkout."""
        if version != "editable":
            site = build(Path(self.root))
            build_data["force_include"][str(site)] = "recon4_web/docs"
            build_data["force_include"].update(_compiled_kernels())


def _compiled_kernels() -> dict[str, str]:
    """Where a wheel has the files of Numba's cache: where Numba looks for them."""
    folder = os.environ.get(COMPILED_KERNELS)
    files = sorted(Path(folder).iterdir()) if folder else []
    return {
        str(path): f"recon4/kernels/__pycache__/{path.name}"
        for path in files
        if path.suffix in CACHED and path.is_file()
    }


if __name__ == "__main__":
    build(Path(__file__).parents[1])
