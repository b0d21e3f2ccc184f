"""Settings with which the artifacts of finished stages were made."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from pathlib import Path

from recon4.settings import Settings, current_name
from recon4.store.seal import check_sealed
from recon4.store.stage import read_manifest


def check_recipes(artifacts: Iterable[Path]) -> None:
    """Compare the manifests of artifacts with their seals, before their settings are used.

    Raises:
        Altered: If one was changed.
    """
    for folder in artifacts:
        check_sealed(folder.parent.parent, f"artifacts/{folder.name}/manifest.json")


def settings_in(artifacts: Iterable[Path]) -> Settings:
    """Settings with which artifacts were made; the last artifact counts, the rest are defaults.

    Unknown names of older or newer versions are ignored. Call `check_recipes` first if the seals
    can be read.

    Args:
        artifacts: Their folders.

    Raises:
        StoreError: If an artifact is damaged.
    """
    recorded: dict[str, Mapping[str, object]] = {}
    for folder in artifacts:
        recorded |= read_manifest(folder)["recipe"]["settings"]
    settings = Settings()
    groups = {}
    for name, values in recorded.items():
        group = getattr(settings, name, None)
        if group is not None:
            known = {f.name for f in fields(group)}
            current = {current_name(name, n): value for n, value in values.items()}
            groups[name] = replace(group, **{n: v for n, v in current.items() if n in known})
    return replace(settings, **groups)
