"""With which settings finished stages were made."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from recon4.settings import Settings
from recon4.store.seal import check_sealed
from recon4.store.stage import read_manifest


def settings_in(artifacts: Iterable[Path]) -> Settings:
    """The settings artifacts were made with, the last of them counting; the rest are the defaults.

    Names that an older or newer recon4 wrote are left out.

    Args:
        artifacts: Their folders.

    Raises:
        StoreError: If an artifact is damaged.
    """
    told: dict[str, dict[str, Any]] = {}
    for folder in artifacts:
        check_sealed(folder.parent.parent, f"artifacts/{folder.name}/manifest.json")
        told |= read_manifest(folder)["recipe"]["settings"]
    settings = Settings()
    groups = {}
    for name, values in told.items():
        group = getattr(settings, name, None)
        if group is not None:
            known = {f.name for f in fields(group)}
            groups[name] = replace(group, **{n: v for n, v in values.items() if n in known})
    return replace(settings, **groups)
