"""Settings with which the artifacts of finished stages were made."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from recon4.settings import Settings, changed_retired, current_values
from recon4.store.seal import check_sealed
from recon4.store.stage import Stage, read_manifest


def check_recipes(artifacts: Iterable[Path]) -> None:
    """Compare the manifests of artifacts with their seals, before their settings are used.

    Raises:
        Altered: If one was changed.
    """
    for folder in artifacts:
        check_sealed(folder.parent.parent, f"artifacts/{folder.name}/manifest.json")


def settings_to_repeat(made: Mapping[str, Path], kept: Sequence[Stage[Any, Any]]) -> Settings:
    """Settings for the stages after some that are kept as they are.

    Of a setting that a cut-off run changed, what the kept stages were made with counts.

    Args:
        made: Stage -> folder of its artifact.
        kept: Stages that are not run again.

    Raises:
        Altered: If a manifest was changed.
        StoreError: If an artifact is damaged.
    """
    check_recipes(made.values())
    names = {stage.name for stage in kept}
    return settings_in(made[name] for name in sorted(made, key=names.__contains__))


def settings_in(artifacts: Iterable[Path]) -> Settings:
    """Settings with which artifacts were made; the last artifact counts, the rest are defaults.

    Retired names are left out, see `retired_settings`; unknown ones of newer versions, too. Call
    `check_recipes` first if the seals can be read.

    Args:
        artifacts: Their folders.

    Raises:
        StoreError: If an artifact is damaged.
    """
    recorded = _recorded(artifacts)
    settings = Settings()
    groups = {}
    for name, values in recorded.items():
        group = getattr(settings, name, None)
        if group is not None:
            known = {f.name for f in fields(group)}
            current = current_values(name, values)
            groups[name] = replace(group, **{n: v for n, v in current.items() if n in known})
    return replace(settings, **groups)


def retired_settings(artifacts: Iterable[Path]) -> list[str]:
    """Sentences on settings that artifacts were made with and that are fixed now at other values.

    Raises:
        StoreError: If an artifact is damaged.
    """
    return changed_retired(_recorded(artifacts))


def _recorded(artifacts: Iterable[Path]) -> dict[str, Mapping[str, object]]:
    recorded: dict[str, Mapping[str, object]] = {}
    for folder in artifacts:
        recorded |= read_manifest(folder)["recipe"]["settings"]
    return recorded
