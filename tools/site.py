"""Builds the documentation site: ``python -m tools.site``, and each wheel that is built (hatch)."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

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


class SiteHook(BuildHookInterface[Any]):
    """Puts the site into a wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build it first, unless the installation only points to the checkout."""
        if version != "editable":
            site = build(Path(self.root))
            build_data["force_include"][str(site)] = "recon4_web/docs"


if __name__ == "__main__":
    build(Path(__file__).parents[1])
